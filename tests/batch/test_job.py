# SPDX-License-Identifier: LGPL-2.1-or-later
"""Job files are read completely, or rejected with the position and the remedy."""

import dataclasses
import math
import re
import textwrap
from pathlib import Path

import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.proposed_cell import cell_of
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import RevolutionParameters, SurfaceParameters

# every key of the public interface with its default
ALL_KEYS = """\
version: 1
name: hemisphere
part:
  file: part.step
  faces: [Face1, Face2]
strategy:
  kind: revolution
  layer_height: 1 mm
  chord_error: 0.01 mm
  spacing: arc-length
  wall: outer
  path: layers
build_direction: {mode: local, lead: 0 deg, tilt: 0 deg, max_tilt: 90 deg, clearance: nozzle}
cell:
  machine: fanuc-arcmate120ic
  limits: maker
  setup: part-on-robot
  deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0]
  platform: 5 mm
  platform_diameter: 113 mm
  mount: feature
  branch: [front, up, flip]
  nozzle: {half_angle: 20 deg, diameter: 1 mm, length: 60 mm}
joints:
  method: layer-by-layer
  rz: auto
  degree: 1
  parameter: rotation
  rotation_range: [-180 deg, 180 deg]
  objective: displacement
  min_condition: auto
  characteristic_length: 1000 mm
process:
  travel_speed: 6 mm/s
  rapid_speed: 100 mm/s
  seam: {angle: 0 deg, step: 0 deg}
  direction: counter-clockwise
  bead_width: 8 mm
  wire: {diameter: 1.2 mm, feed: 10 mm/s}
  lead_on: 0 s
  lead_off: 0 s
  overlap: 0 mm
  between_layers: {lift: 20 mm, wait: 0 s, input: null, call: null}
  bead_model: none
program:
  post: fanuc
  motion: joint
  max_points: 2000
  dry_run: false
  start_at: null
"""


@pytest.fixture
def read(tmp_path):
    for name in ("part.step", "wall.step"):
        (tmp_path / name).write_text("")

    def read_text(text, name="job.yaml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def refused(function, text):
    with pytest.raises(InputError) as caught:
        function(text)
    return caught.value


def test_the_documented_job_is_all_defaults(read):
    job = read(ALL_KEYS)
    assert job.name == "hemisphere"
    assert job.part.faces == ("Face1", "Face2")
    assert job.strategy == RevolutionParameters()
    assert job.build_direction == BuildDirectionParameters()
    assert job.cell == dataclasses.replace(CellParameters(), mount="feature")
    assert job.joints == JointParameters()
    assert job.process == ProcessParameters(wire=WireParameters(feed=10.0))  # auto is the default
    assert job.program == ProgramParameters()


def test_what_is_left_out(read):
    job = read("part: {file: part.step}", "some job.yaml")
    assert job.name == "some job"
    assert job.cell is None and job.program is None
    assert job.strategy == RevolutionParameters()
    assert read("part: {file: part.step}\ncell:\nprogram:\n").cell == cell_of("")
    assert read("part: {file: part.step}\ncell: null\nprogram: {post: none}\n").program is None


@pytest.mark.parametrize(
    "cell, wanted",
    [
        ("{machine: kuka-kr16-2}", cell_of("kuka-kr16-2")),
        ("{branch: auto}", dataclasses.replace(cell_of(""), branch="auto")),
        ("{limits: paper}", CellParameters(limits="paper")),
        (
            "{branch: [front, up, flip], deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0]}",
            CellParameters(),
        ),
        (
            "{deposition_point: [500, 0, 700, 0, 0, 0]}",
            CellParameters(deposition_point=(500.0, 0.0, 700.0, 0.0, 0.0, 0.0)),
        ),
        ("{machine: no-such-robot}", CellParameters(machine="no-such-robot")),
    ],
)
def test_where_it_deposits_is_proposed_where_it_is_left_out(read, cell, wanted):
    """Position and configuration get defaults, as in the papers, within their limits. Planning
    reports an unknown machine."""
    assert read(f"part: {{file: part.step}}\ncell: {cell}\n").cell == wanted


def test_values_reach_the_parameters(read):
    job = read(
        ALL_KEYS.replace("platform: 5 mm", "platform: [1, 2 cm, 3, 0, 90 deg, 1 rad]")
        .replace("[front, up, flip]", "auto")
        .replace("rz: auto", "rz: 45")
        .replace("start_at: null", "start_at: {layer: 12}")
        .replace("input: null", "input: 3")
        .replace("layer_height: 1 mm", "layer_height: 1/16 in")
        .replace("degree: 1", "degree: 1\n  compare: [constant, point-by-point]")
    )
    assert job.cell.platform == pytest.approx((1, 20, 3, 0, math.pi / 2, 1))
    assert job.cell.branch == "auto"
    assert job.joints.rz == pytest.approx(math.pi / 4)
    assert job.joints.compare == ("constant", "point-by-point")
    assert job.program.start_at.layer == 12 and job.program.start_at.bead == 0
    assert job.process.between_layers.input == 3
    assert job.strategy.layer_height == pytest.approx(25.4 / 16)


def test_paths_are_relative_to_the_job(read, tmp_path, monkeypatch):
    monkeypatch.chdir("/")
    assert read(ALL_KEYS).part.file == str(tmp_path / "part.step")
    job = read(ALL_KEYS.replace("machine: fanuc-arcmate120ic", "machine: my/robot.json"))
    assert job.cell.machine == str(tmp_path / "my" / "robot.json")
    for written, links in (
        ("arm.urdf", ""),
        ("my/arm.URDF", ""),
        ("{file: my/arm.urdf}", ""),
        ("{file: arm.urdf, tip: tool0}", " tip=tool0"),
        ("{file: my/arm.urdf, base: base_link, tip: tool0}", " base=base_link tip=tool0"),
        ("arm.urdf base=base_link tip=tool0", " base=base_link tip=tool0"),
    ):
        job = read(ALL_KEYS.replace("machine: fanuc-arcmate120ic", f"machine: {written}"))
        file = re.search(r"[\w/]+\.(urdf|URDF)", written)[0]
        assert job.cell.machine == f"{tmp_path / file}{links}"


def test_a_calibration_is_beside_the_job(read, tmp_path):
    for written, named in (
        ("{name: ur-ur10e, calibration: my/robot.yaml}", "ur-ur10e"),
        ("ur-ur10e calibration=my/robot.yaml", "ur-ur10e"),
        ("{name: my/arm.json, calibration: my/robot.yaml}", f"{tmp_path}/my/arm.json"),
    ):
        job = read(ALL_KEYS.replace("machine: fanuc-arcmate120ic", f"machine: {written}"))
        assert job.cell.machine == f"{named} calibration={tmp_path}/my/robot.yaml"


@pytest.mark.parametrize(
    "written,where,words",
    [
        ("{calibration: my.yaml}", "cell.machine", "write machine: {name: ur-ur10e, calibration"),
        ("{name: ur-ur10e}", "cell.machine", "write machine: {name: ur-ur10e, calibration"),
        (
            "{file: arm.urdf, calibration: my.yaml}",
            "cell.machine",
            "write machine: {name: ur-ur10e, calibration",
        ),
        ("{base: base_link}", "cell.machine.file", "write machine: {file: robot.urdf}"),
        ("{file: arm.json}", "cell.machine.file", "arm.json is not a URDF"),
        (
            "{file: arm.urdf, top: tool0}",
            "cell.machine.top",
            "the key 'top' is unknown; did you mean tip",
        ),
        ("{file: arm.urdf, tip: 3}", "cell.machine.tip", "3 is not a text"),
    ],
)
def test_a_urdf_is_named_with_file_and_links_alone(read, written, where, words):
    with pytest.raises(InputError) as error_info:
        read(ALL_KEYS.replace("machine: fanuc-arcmate120ic", f"machine: {written}"))
    assert where in error_info.value.where and words in error_info.value.message


def test_a_cell_is_a_file_of_its_own(read, tmp_path):
    full_cell = read(
        ALL_KEYS.replace("machine: fanuc-arcmate120ic", "machine: hall/my/robot.json")
    ).cell
    section = ALL_KEYS[ALL_KEYS.index("cell:") :]
    section = section[: section.index("joints:")]
    (tmp_path / "hall").mkdir()
    lines = textwrap.dedent(section.split("\n", 1)[1]).replace(
        "machine: fanuc-arcmate120ic", "machine: my/robot.json"
    )
    (tmp_path / "hall" / "cell 3.yaml").write_text(lines, encoding="utf-8")
    assert read(ALL_KEYS.replace(section, "cell: hall/cell 3.yaml\n")).cell == full_cell


@pytest.mark.parametrize(
    ("text", "code", "where", "says"),
    [
        ("", "EMPTY_FILE", "mine.yaml", "give at least machine:"),
        ("- 1", "BAD_FILE", "mine.yaml", "give keys such as machine and setup"),
        ("limits: maker\nplatform: 5 kg", "BAD_UNIT", "mine.yaml: cell.platform", "(line 2)"),
        (
            "part: {file: part.step}",
            "UNKNOWN_KEY",
            "mine.yaml: cell.part",
            "the key 'part' is unknown",
        ),
        (None, "NO_FILE", "mine.yaml", "the file does not exist"),
    ],
)
def test_a_broken_cell_file_is_told_by_its_own_place(read, tmp_path, text, code, where, says):
    if text is not None:
        (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    error = refused(read, "part: {file: part.step}\ncell: mine.yaml\n")
    assert error.code == code and error.where.endswith(where) and says in error.message


LINE = {
    key: number
    for number, line in enumerate(ALL_KEYS.splitlines(), 1)
    for key in [line.split(":")[0].strip()]
}


@pytest.mark.parametrize(
    ("old", "new", "code", "where", "says"),
    [
        (
            "layer_height: 1 mm",
            "layer_heigth: 1 mm",
            "UNKNOWN_KEY",
            "strategy.layer_heigth",
            "did you mean layer_height",
        ),
        ("half_angle: 20 deg", "angle: 20 deg", "UNKNOWN_KEY", "cell.nozzle.angle", "half_angle"),
        ("version: 1", "version: 2", "BAD_VERSION", "version", "write version: 1"),
        ("version: 1", "version: true", "BAD_VERSION", "version", "true"),
        (
            "layer_height: 1 mm",
            "layer_height: 0 mm",
            "BAD_VALUE",
            "strategy.layer_height",
            "more than 0 mm",
        ),
        (
            "layer_height: 1 mm",
            "layer_height: -1 mm",
            "BAD_VALUE",
            "strategy.layer_height",
            "-1 mm",
        ),
        (
            "layer_height: 1 mm",
            "layer_height: 1,5 mm",
            "BAD_VALUE",
            "strategy.layer_height",
            "1.5 mm",
        ),
        (
            "layer_height: 1 mm",
            "layer_height: 1 deg",
            "BAD_UNIT",
            "strategy.layer_height",
            "length such as 1 mm",
        ),
        ("layer_height: 1 mm", "layer_height: yes", "BAD_VALUE", "strategy.layer_height", "true"),
        ("layer_height: 1 mm", "layer_height: null", "BAD_VALUE", "strategy.layer_height", "null"),
        (
            "layer_height: 1 mm",
            "layer_height:",
            "BAD_VALUE",
            "strategy.layer_height",
            "the value is missing",
        ),
        ("layer_height: 1 mm", "layer_height: .inf", "BAD_VALUE", "strategy.layer_height", "inf"),
        ("layer_height: 1 mm", "layer_height: .nan", "BAD_UNIT", "strategy.layer_height", "nan"),
        ("layer_height: 1 mm", "layer_height: 1:30", "BAD_UNIT", "strategy.layer_height", "1:30"),
        (
            "layer_height: 1 mm",
            "layer_height: [1 mm]",
            "BAD_VALUE",
            "strategy.layer_height",
            "list",
        ),
        (
            "layer_height: 1 mm",
            "layer_height: 1 mm\n  layer_height: 2",
            "DUPLICATE_KEY",
            "strategy.layer_height",
            "8 and 9",
        ),
        (
            "kind: revolution",
            "kind: torus",
            "BAD_VALUE",
            "strategy.kind",
            "revolution, surface, developable",
        ),
        (
            "setup: part-on-robot",
            "setup: tool-on-robot+positioner",
            "NOT_YET",
            "cell.setup",
            "part-on-robot",
        ),
        ("mode: local", "mode: symmetry-plane", "NOT_FOR_FAMILY", "build_direction.mode", "local"),
        (
            "setup: part-on-robot",
            "setup: part_on_robot",
            "BAD_VALUE",
            "cell.setup",
            "did you mean part-on-robot",
        ),
        ("[front, up, flip]", "[front, flip]", "BAD_VALUE", "cell.branch", "up|down"),
        ("653.167, 0, 0, 0]", "653.167]", "BAD_VALUE", "cell.deposition_point", "six"),
        ("653.167, 0, 0, 0]", "653.167, 0, 0, 5 mm]", "BAD_UNIT", "cell.deposition_point", "angle"),
        ("degree: 1", "degree: 1.5", "BAD_VALUE", "joints.degree", "whole number"),
        (
            "degree: 1",
            "degree: 1\n  compare: [best]",
            "BAD_VALUE",
            "joints.compare",
            "point-by-point",
        ),
        ("dry_run: false", "dry_run: 'no'", "BAD_VALUE", "program.dry_run", "true nor false"),
        ("min_condition: auto", "min_condition: some", "BAD_VALUE", "joints.min_condition", "auto"),
        (
            "min_condition: auto",
            "min_condition: 1.5",
            "BAD_VALUE",
            "joints.min_condition",
            "at most 1",
        ),
        (
            "[-180 deg, 180 deg]",
            "[180 deg, -180 deg]",
            "BAD_VALUE",
            "joints.rotation_range",
            "smaller first",
        ),
        ("name: hemisphere", "name: a/b", "BAD_NAME", "name", "slash"),
        ("name: hemisphere", "name: .hidden", "BAD_NAME", "name", "dot"),
        ("name: hemisphere", f"name: {'x' * 300}", "BAD_NAME", "name", "too long"),
        ("file: part.step", "file: other.step", "NO_FILE", "part.file", "other.step"),
        ("file: part.step", "object: Revolve", "NO_PART", "part.file", "shape.step"),
        (
            "file: part.step",
            "file: part.step\n  object: Revolve",
            "BAD_VALUE",
            "part.object",
            "FCStd",
        ),
        ("faces: [Face1, Face2]", "faces: [Edge1]", "BAD_VALUE", "part.faces", "Face1"),
        ("post: fanuc", "post: !!python/name:os.system fanuc", "BAD_VALUE", "program.post", "tag"),
        (
            "strategy:\n",
            "substrate: {file: part.step}\nstrategy:\n",
            "NOT_FOR_FAMILY",
            "substrate",
            "remove the substrate",
        ),
    ],
)
def test_refusals_name_file_key_line_and_remedy(read, old, new, code, where, says):
    assert old in ALL_KEYS
    error = refused(read, ALL_KEYS.replace(old, new, 1))
    assert error.code == code
    assert error.where == f"job.yaml: {where}"
    assert says in error.message
    assert re.search(r"\(lines? \d+", error.message) or code == "NO_PART"
    assert "\n" not in error.line()


@pytest.mark.parametrize(
    ("text", "code", "says"),
    [
        ("", "EMPTY_FILE", "empty"),
        ("# only a remark\n", "EMPTY_FILE", "empty"),
        ("- 1\n- 2\n", "BAD_FILE", "mapping"),
        ("just words", "BAD_FILE", "mapping"),
        ("part: {file: [", "BAD_FILE", "not valid YAML"),
        ("a:\n\t- b", "BAD_FILE", "line 2"),
        ("version: 1", "NO_PART", "part: {file"),
        ("a: &a [*a]", "BAD_FILE", "alias"),
        ("[" * 3000, "BAD_FILE", ""),
        ("{1: 2, [3]: 4}: 5", "BAD_FILE", "word"),
        ("part: 5", "BAD_VALUE", "section"),
        ("part: &a\n  file: *b", "BAD_FILE", ""),
        ("---\npart: {file: part.step}\n---\npart: 1", "BAD_FILE", "document"),
        (
            "a0: &a0 [1,1,1,1,1,1,1,1,1]\n"
            + "".join(f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 9)),
            "BAD_FILE",
            "too many",
        ),
    ],
)
def test_files_that_are_no_jobs(read, text, code, says):
    error = refused(read, text)
    assert error.code == code
    assert says in error.message
    assert error.exit_status == 2


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="the file does not exist"):
        jobs.read_job(str(tmp_path / "none.yaml"))
    with pytest.raises(InputError) as caught:
        jobs.read_job(str(tmp_path))
    assert caught.value.code == "NO_FILE"
    binary = tmp_path / "binary.yaml"
    for start in (b"", b"\xef\xbb\xbf"):
        binary.write_bytes(start + b"version: 1\n\xff\xfe\x00")
        with pytest.raises(InputError, match="line 2"):
            jobs.read_job(str(binary))
    large = tmp_path / "large.yaml"
    large.write_bytes(b"#" * 5_000_000)
    with pytest.raises(InputError, match="larger than 4 MB"):
        jobs.read_job(str(large))


@pytest.mark.parametrize("name", ["hemisphere", "laval-nozzle", "intake-funnel"])
def test_the_examples_are_valid_and_are_those_of_the_paper(root, name):
    job = jobs.read_job(str(root / "resources" / "examples" / f"{name}.yaml"))
    assert Path(job.part.file).name == f"{name}.step"
    assert job.strategy.layer_height == 1.0 and job.strategy.chord_error == 0.01
    assert job.cell.limits == "paper"
    assert job.cell.deposition_point == (1045.747, -630.155, 653.167, 0.0, 0.0, 0.0)
    assert job.cell.branch == ("front", "up", "flip")
    assert job.joints.compare == ("constant", "point-by-point")


SURFACE = """\
part: {file: wall.step}
substrate: {file: part.step}
strategy:
  kind: surface
  layer_height: 5 mm
  band: 10 %
  end: whole
build_direction: {mode: symmetry-plane, clearance: none}
"""


def test_fixtures(read):
    job = read(SURFACE + "fixtures:\n- {file: part.step}\n- {file: part.step}\n")
    assert job.fixtures == (job.substrate, job.substrate)
    assert read(SURFACE).fixtures == ()
    for entry, code, where in (
        ("{file: part.step}", "BAD_VALUE", "fixtures"),
        ("[{file: none.step}]", "NO_FILE", "fixtures[0].file"),
        (
            "[{file: part.step}, {file: part.step, faces: [Face1]}]",
            "BAD_VALUE",
            "fixtures[1].faces",
        ),
        ("[{file: part.step}, part.step]", "BAD_VALUE", "fixtures[1]"),
        ("[{name: part.step}]", "UNKNOWN_KEY", "fixtures[0].name"),
    ):
        error = refused(read, f"{SURFACE}fixtures: {entry}\n")
        assert error.code == code and error.where.endswith(where), error


def test_a_wall_on_a_substrate(read):
    job = read(SURFACE)
    assert job.strategy == SurfaceParameters(layer_height=5.0, band=0.1, end="whole")
    assert job.substrate.file == job.part.file.replace("wall.step", "part.step")
    assert read("part: {file: part.step}\n").substrate is None


@pytest.mark.parametrize(
    ("old", "new", "code", "where", "says"),
    [
        (
            "substrate: {file: part.step}",
            "substrate: {file: none.step}",
            "NO_FILE",
            "substrate.file",
            "none.step",
        ),
        (
            "step}\nstrategy",
            "step, faces: [Face1]}\nstrategy",
            "NOT_YET",
            "substrate.faces",
            "whole",
        ),
        (
            "substrate: {file: part.step}",
            "substrate: {object: A}",
            "NO_PART",
            "substrate.file",
            "write substrate",
        ),
        ("end: whole", "spacing: arc-length", "BAD_VALUE", "strategy.spacing", "constant-distance"),
        ("end: whole", "wall: outer", "UNKNOWN_KEY", "strategy.wall", "band"),
        ("band: 10 %", "band: 110 %", "BAD_VALUE", "strategy.band", "100 %"),
        ("end: whole", "tolerance: 0 mm", "BAD_VALUE", "strategy.tolerance", "1e-06 mm"),
    ],
)
def test_refusals_of_walls_on_a_substrate(read, old, new, code, where, says):
    assert old in SURFACE
    error = refused(read, SURFACE.replace(old, new, 1))
    assert (error.code, says in error.message) == (code, True), error
    assert where in error.where


@pytest.mark.parametrize(
    ("part", "substrate", "same"),
    [
        ("file: part.step, faces: [Face1]", "file: ./part.step", True),
        ("file: part.step", "file: part.step", True),
        ("file: part.step, solids: [Solid1]", "file: part.step, solids: [Solid2]", False),
        ("file: part.step, start_edges: [Edge1]", "file: part.step", False),
    ],
)
def test_a_wall_on_itself_is_refused_at_the_substrate(read, part, substrate, same):
    text = f"part: {{{part}}}\nsubstrate: {{{substrate}}}\nstrategy: {{kind: surface}}\n"
    if not same:
        assert read(text).substrate.file.endswith("part.step")
        return
    error = refused(read, text)
    assert (error.code, error.where.split(": ")[-1]) == (
        "OWN_SUBSTRATE",
        "substrate",
    ) and "part.step" in error.message
    assert error.message.endswith("(line 2)")


@pytest.mark.parametrize(
    ("strategy", "process", "spacing"),
    [
        ("{kind: solid}", "{bead_width: 3 mm}", 3.0),
        ("{kind: solid}", "{}", 5.0),
        ("{kind: solid}", "{bead_width: 9 mm}", 5.0),
        ("{kind: solid, bead_spacing: 4 mm}", "{bead_width: 3 mm}", 4.0),
        ("{kind: solid}", "{bead_width: 3 mm, fill_width: spacing}", 5.0),
    ],
)
def test_the_default_spacing_is_at_most_the_bead_width(read, strategy, process, spacing):
    """A job that gives only the bead width leaves no gaps between beads."""
    job = read(
        f"version: 1\nname: part\npart: {{file: part.step}}\n"
        f"strategy: {strategy}\nprocess: {process}\n"
    )
    assert job.features[0].strategy.bead_spacing == spacing
