# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of several features: their keys and refusals, and from the waypoints and text, with OpenCASCADE, that each lies on
its part, that what comes later keeps clear of what is there, and that layers are numbered through."""

import csv
import json
import math
import shutil

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError

START = """\
strategy: {kind: solid, layer_height: 5 mm, chord_error: 0.1 mm}
process: {travel_speed: 6 mm/s}
features:
  - {name: plate, part: {file: plate.step}}
"""
POST = "  - {name: post, part: {file: post.step}}\n"


@pytest.fixture
def read(tmp_path):
    for name in ("plate.step", "post.step", "wall.stl"):
        (tmp_path / name).write_text("")

    def read_text(text):
        path = tmp_path / "job.yaml"
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def test_what_stands_at_the_top_is_the_default_of_all(read):
    job = read(
        START
        + """\
  - {name: post, part: {file: post.step}, strategy: {layer_height: 2 mm}, process: {seam: {angle: 90 deg}}}
  - {part: {file: post.step}, strategy: {kind: revolution}, process: {travel_speed: 9 mm/s}}
sequence: height
"""
    )
    assert [one.name for one in job.features] == [
        "plate",
        "post",
        "feature 3",
    ] and job.sequence == "height"
    assert [one.strategy.layer_height for one in job.features] == [5.0, 2.0, 5.0]
    assert [one.process.travel_speed for one in job.features] == [6.0, 6.0, 9.0]
    assert (
        job.features[1].process.seam.angle == pytest.approx(math.pi / 2)
        and job.process.seam.angle == 0.0
    )
    assert job.part.file.endswith("plate.step") and read(START).features[0].name == "plate"


def test_defaults_that_a_family_does_not_have_are_left_out(read):
    job = read(
        "part: {file: plate.step, solids: [Solid1]}\nsubstrate: {file: post.step}\nprocess: {bead_model: csw}\n"
        "strategy: {kind: solid, fill: zigzag, layer_height: 2 mm}\nbuild_direction: {mode: fixed}\nfeatures:\n"
        "  - {name: a}\n  - {name: b, part: {solids: [Solid2]}, strategy: {kind: revolution}}\n"
        "  - {name: c, strategy: {kind: developable}}\n  - {name: d, part: {file: wall.stl}}\n"
    )
    first, second, third, fourth = job.features
    assert (first.part.solids, second.part.solids, fourth.part.solids) == (
        ("Solid1",),
        ("Solid2",),
        (),
    )
    assert first.substrate.file.endswith("post.step") and second.substrate is None
    assert (second.strategy.layer_height, second.process.bead_model, third.process.bead_model) == (
        2.0,
        "none",
        "csw",
    )
    assert (second.build_direction.mode, third.build_direction.mode) == ("fixed", "local")


@pytest.mark.parametrize(
    ("more", "code", "told"),
    [
        (
            "  - {name: post, part: {file: missing.step}}\n",
            "NO_FILE",
            ["features[1].part.file", "feature post", "line 5"],
        ),
        (
            "  - {name: post, part: {file: post.step}, strategy: {layer_height: 0 mm}}\n",
            "BAD_VALUE",
            ["features[1].strategy.layer_height", "feature post"],
        ),
        (
            "  - {name: post, part: {file: post.step}, strategy: {wall: inner}}\n",
            "UNKNOWN_KEY",
            ["features[1].strategy.wall"],
        ),
        (
            "  - {name: post, part: {file: post.step}, cell: {}}\n",
            "UNKNOWN_KEY",
            ["features[1].cell"],
        ),
        (
            "  - {name: plate, part: {file: post.step}}\n",
            "BAD_VALUE",
            ["features[1].name", "'plate' is the name of another"],
        ),
        ("  - {name: post}\n", "NO_PART", ["features[1].part", "feature post"]),
        ("  - post.step\n", "BAD_VALUE", ["features[1]", "not a section"]),
        (
            "  - {name: post, part: {file: post.step, solids: [Face1]}}\n",
            "BAD_VALUE",
            ["features[1].part.solids"],
        ),
        (
            "  - {name: post, part: {file: wall.stl, solids: [Solid1]}}\n",
            "BAD_VALUE",
            ["features[1].part.solids", "mesh"],
        ),
        (POST + "sequence: random\n", "BAD_VALUE", ["sequence", "feature, height"]),
    ],
)
def test_what_is_refused_names_feature_and_key(read, more, code, told):
    with pytest.raises(InputError) as caught:
        read(START + more)
    line = caught.value.line()
    assert caught.value.code == code and all(text in line for text in told), line


@pytest.mark.parametrize(
    "features",
    [
        "features: []",
        "features: {}",
        "features: hub",
        "part: {file: plate.step}\nsequence: height",
    ],
)
def test_a_list_that_is_none(read, features):
    with pytest.raises(InputError) as caught:
        read(features + "\n")
    assert caught.value.code == "BAD_VALUE"


def planned(workshop, text, **shapes):
    """Ended, report and rows of waypoints of a job with parts of these names."""
    for name, shape in shapes.items():
        shape.exportStep(str(workshop.folder / f"{name}.step"))
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    done = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    report = workshop.folder / "out" / "report.json"
    rows = waypoints(workshop.folder) if report.is_file() else []
    return done, json.loads(report.read_text(encoding="utf-8")) if report.is_file() else None, rows


def waypoints(folder):
    with open(folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        return [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]


def of(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


PLATE = Part.makeBox(40, 40, 20)
JOB = START + POST


def test_a_feature_that_floats_or_overlaps_is_refused(workshop):
    done, report, _ = planned(
        workshop, JOB, plate=PLATE, post=Part.makeBox(10, 10, 10, Vector(100, 0, 30))
    )
    assert done.status == 2 and report is None and "error[FLOATS] post:" in done.err
    done, report, _ = planned(
        workshop, JOB, plate=PLATE, post=Part.makeCylinder(12, 30, Vector(20, 20, 15))
    )
    assert (
        done.status == 2
        and report is None
        and "error[OVERLAP] post:" in done.err
        and "overlap plate" in done.err
    )
    assert f"{math.pi * 12**2 * 5 / 1000:.4g} cm3" in done.err
    upside = START.replace("plate", "post") + POST.replace(
        "post", "plate"
    )  # what carries it comes later
    done, report, _ = planned(
        workshop, upside, plate=PLATE, post=Part.makeCylinder(12, 30, Vector(20, 20, 20))
    )
    assert done.status == 2 and "error[FLOATS] post:" in done.err


def test_what_holds_for_the_whole_program_is_no_features_own(workshop):
    text = JOB.replace("post.step}}", "post.step}, process: {rapid_speed: 5 mm/s}}")
    done, _, _ = planned(workshop, text, plate=PLATE, post=Part.makeBox(9, 9, 9, Vector(0, 0, 20)))
    assert done.status == 2 and "NOT_FOR_FEATURE" in done.err and "process.rapid_speed" in done.err


def test_a_list_of_one_is_the_job_without_it(workshop):
    done, report, listed = planned(workshop, START, plate=PLATE)
    assert done.status == 0 and "features" not in report
    plain = "part: {file: plate.step}\n" + START[: START.index("features")]
    assert planned(workshop, plain, plate=PLATE)[2] == listed


TOWERS = """\
strategy: {kind: solid, layer_height: 4 mm, chord_error: 0.2 mm, bead_spacing: 4 mm}
features:
  - {name: plate, part: {file: plate.step}}
  - {name: left, part: {file: left.step}}
  - {name: right, part: {file: right.step}, strategy: {layer_height: 3 mm}, process: {travel_speed: 9 mm/s}}
"""
GAP, TALL = 4.0, 36.0
LEFT = Part.makeBox(16, 20, TALL, Vector(0, 0, 8))
TOWER_PARTS = {
    "plate": Part.makeBox(36, 20, 8),
    "left": LEFT,
    "right": Part.makeBox(16, 20, TALL, Vector(16 + GAP, 0, 8)),
}


SURE = Part.makeBox(15.5, 20, TALL - 4.0, Vector(0, 0, 8))  # of it, beads being round
SLOPE, LENGTH = math.tan(math.radians(20.0)), 60.0


def nozzle(point, tool, clear=4.5):
    """The usual nozzle from a little above the tip on, as a solid."""
    foot = Vector(*(point + clear * tool))
    return Part.makeCone(
        0.5 + clear * SLOPE, 0.5 + LENGTH * SLOPE, LENGTH - clear, foot, Vector(*tool)
    )


def test_later_features_keep_clear_of_earlier_ones(workshop):
    """A tower beside one that stands: the upright nozzle would cut it, the tilted one does not."""
    done, report, rows = planned(workshop, TOWERS, **TOWER_PARTS)
    assert done.status == 0, done.err
    layer, speed = of(rows, "layer").ravel(), of(rows, "speed_mm_s").ravel()
    assert sorted(set(layer)) == list(range(2 + 9 + 12)) and (np.diff(layer) >= 0).all()
    assert [one["layers"] for one in report["features"]] == [
        [0, 1],
        list(range(2, 11)),
        list(range(11, 23)),
    ]
    points, build, tool = (
        of(rows, "x_mm", "y_mm", "z_mm"),
        of(rows, "bx", "by", "bz"),
        of(rows, "tx", "ty", "tz"),
    )
    # layers are numbered through, and lie on their planes
    np.testing.assert_allclose(
        points[:, 2], np.where(layer < 11, 4.0 * layer, 8.0 + 3.0 * (layer - 11)), atol=1e-6
    )
    assert set(np.round(speed[layer >= 11], 6)) == {9.0} and set(
        np.round(speed[layer < 11], 6)
    ) == {6.0}
    np.testing.assert_allclose(tool[layer < 11], build[layer < 11], atol=1e-9)
    near = np.flatnonzero((layer == 13) & (points[:, 0] < 16 + GAP + 5.0))
    assert len(near) and any(nozzle(points[k], build[k]).common(SURE).Volume > 1.0 for k in near)
    for k in near:
        assert nozzle(points[k], tool[k]).common(SURE).Volume < 1e-6
    volume = sum(part.Volume for part in TOWER_PARTS.values()) / 1000.0
    assert report["deposit"]["part_cm3"] == pytest.approx(volume, rel=1e-3)
    laid = sum(one["length_mm"] * 4.0 * one["layer_height_mm"] for one in report["features"])
    assert report["totals"]["volume_cm3"] == pytest.approx(laid / 1000.0, rel=1e-6)


RINGS = """\
strategy: {kind: revolution, layer_height: 4 mm, chord_error: 0.2 mm}
features:
  - {name: outer, part: {file: outer.step, faces: [Face1]}, process: {bead_width: 16 mm}}
  - {name: inner, part: {file: inner.step, faces: [Face1]}}
"""


def test_a_part_of_revolution_keeps_clear_of_the_flank_of_a_wider_bead_that_stands(workshop):
    """A ring of beads of 16 mm about one of 8 mm: the upright nozzle passes the middle line of the wide beads and cuts their
    flank, half of their width nearer."""
    done, report, rows = planned(
        workshop, RINGS, outer=Part.makeCylinder(40, 32), inner=Part.makeCylinder(25, 32)
    )
    assert done.status == 0, done.err
    assert [len(one["layers"]) for one in report["features"]] == [9, 9]
    layer = of(rows, "layer").ravel()
    points, build, tool = (
        of(rows, "x_mm", "y_mm", "z_mm"),
        of(rows, "bx", "by", "bz"),
        of(rows, "tx", "ty", "tz"),
    )
    radius = np.hypot(points[:, 0], points[:, 1])
    np.testing.assert_allclose(radius, np.where(layer < 9, 40.0, 25.0), atol=1e-6)
    np.testing.assert_allclose(tool[layer < 9], build[layer < 9], atol=1e-9)
    # beads are round beside: of each the half that is as wide is left
    line, ring = (
        Part.makeCylinder(outer, 32).cut(Part.makeCylinder(inner, 32))
        for outer, inner in ((40.1, 39.9), (46.0, 34.0))
    )
    first = np.flatnonzero(layer == 9)
    for k in first[:: len(first) // 8]:
        upright = nozzle(points[k], build[k])
        assert upright.common(line).Volume == 0.0 and upright.common(ring).Volume > 1.0
    for k in np.flatnonzero(layer >= 9)[::11]:
        assert nozzle(points[k], tool[k]).common(ring).Volume < 1e-6


def test_by_height_the_lowest_layer_comes_first(workshop):
    """So that nothing stands beside what is deposited, and no tool is tilted."""
    done, report, rows = planned(workshop, TOWERS + "sequence: height\n", **TOWER_PARTS)
    assert done.status == 0, done.err
    points, layer = of(rows, "x_mm", "y_mm", "z_mm"), of(rows, "layer").ravel()
    assert (np.diff(points[:, 2]) >= -1e-9).all() and sorted(set(layer)) == list(range(23))
    left, right = (one["layers"] for one in report["features"][1:])
    assert sorted([0, 1, *left, *right]) == list(range(23)) and left[1] > right[0]
    for numbers, low, high in ((left, 0.0, 16.0), (right, 16.0 + GAP, 36.0)):
        mine = points[np.isin(layer, numbers), 0]
        assert low < mine.min() and mine.max() < high
    np.testing.assert_allclose(of(rows, "tx", "ty", "tz"), of(rows, "bx", "by", "bz"), atol=1e-9)
    assert report["unsupported_mm"] == 0.0


def test_the_shipped_hub_with_fins_and_branch(workshop, root):
    """Three families in one program: each feature on its own solid or face of the file, and the text has all points."""
    for name in ("finned-hub.step", "finned-hub.yaml"):
        shutil.copy(root / "resources" / "examples" / name, workshop.folder)
    text = (workshop.folder / "finned-hub.yaml").read_text(encoding="utf-8")
    text = text.replace("layer_height: 2 mm", "layer_height: 5 mm").replace(
        "chord_error: 0.02 mm", "chord_error: 0.1 mm"
    )
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    done = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    rows = waypoints(workshop.folder)
    assert [one["name"] for one in report["features"]] == ["hub", "fins", "branch"] and report[
        "status"
    ] == "ok"
    layer, points = of(rows, "layer").ravel(), of(rows, "x_mm", "y_mm", "z_mm")
    build, tool = of(rows, "bx", "by", "bz"), of(rows, "tx", "ty", "tz")
    assert (np.diff(layer) >= 0).all() and sorted(set(layer)) == list(
        range(report["counts"]["layers"])
    )
    whole = Part.Shape()
    whole.read(str(workshop.folder / "finned-hub.step"))
    hub, *fins = whole.Solids
    meant = {"hub": hub, "fins": Part.makeCompound(fins), "branch": whole.Faces[17]}
    for one in report["features"]:
        mine = np.flatnonzero(np.isin(layer, one["layers"]))
        some = mine[:: max(1, len(mine) // 60)]
        # a line of fill may run in the middle of the first layer's bead: on the surface of the hub
        part = meant[one["name"]]
        off = max(
            0.0
            if part.Solids
            and any(solid.isInside(Vector(*points[k]), 1e-6, True) for solid in part.Solids)
            else Part.Vertex(*points[k]).distToShape(part)[0]
            for k in some
        )
        assert len(some) > 20 and off < 0.1 + 0.02, (one["name"], off)
        if one["name"] != "hub":
            assert all(nozzle(points[k], tool[k], 7.0).common(hub).Volume < 1e-6 for k in some)
    radial = points[np.isin(layer, report["features"][1]["layers"])]
    assert set(np.sign(radial[:, 0])) == {-1.0, 1.0}
    assert report["unsupported_mm"] == 0.0 and (np.einsum("ij,ij->i", build, tool) > 0.5).all()
    (program,) = (workshop.folder / "out" / "program").iterdir()
    assert (
        program.read_text(encoding="ascii").count("\nP[") >= len(rows) - report["counts"]["beads"]
    )


def test_a_wall_in_the_middle_lies_on_its_part(workshop):
    """It was refused as off the part, being measured from faces that it is halfway between."""
    tube = Part.makeCylinder(30, 20).cut(Part.makeCylinder(24, 20))
    done, report, rows = planned(
        workshop,
        "part: {file: tube.step}\nstrategy: {wall: middle, layer_height: 5 mm, chord_error: 0.1 mm}\n"
        "process: {bead_width: 6 mm}\n",
        tube=tube,
    )
    assert done.status == 0, done.err
    assert (
        np.abs(np.hypot(*of(rows, "x_mm", "y_mm").T) - 27.0).max() < 1e-6
        and report["on_part"]["worst_mm"] < 1e-6
    )


FIGURES = """\
strategy: {layer_height: 8 mm, chord_error: 0.3 mm}
build_direction: {clearance: none}
features:
"""
BLOCK = """\
  - name: block
    part: {file: block.step}
    strategy: {kind: solid, bead_spacing: 8 mm}
    process: {bead_model: csw, bead_width: 9.5 mm}
"""
ELBOW = "  - {name: elbow, part: {file: elbow.step}, strategy: {kind: surface}MORE}\n"


def test_each_feature_has_the_figures_of_a_job_of_its_own(workshop):
    """What a bead model predicts, and how else a wall may be cut, were told of jobs of one feature alone."""
    Part.makeBox(50, 40, 24, Vector(0, -20, -24)).exportStep(str(workshop.folder / "block.step"))
    shell = Part.makeTorus(30.0, 8.0, Vector(-5, 0, 0), Vector(0, -1, 0), -180, 180, 50)
    shell.rotate(Vector(), Vector(0, 1, 0), -90)
    (face,) = (face for face in shell.Faces if isinstance(face.Surface, Part.Toroid))
    face.exportStep(str(workshop.folder / "elbow.step"))

    def report(*features, page="--no-page"):
        (workshop.folder / "job.yaml").write_text(FIGURES + "".join(features), encoding="utf-8")
        done = workshop.run("plan", "job.yaml", "-o", "out", *([page] if page else []))
        assert done.status == 0, done.err
        return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))

    block = report(BLOCK)
    elbow = report(ELBOW.replace("MORE", ", substrate: {file: block.step}"))
    both = report(BLOCK, ELBOW.replace("MORE", ""), page="")
    first, second = both["features"]
    assert (
        first["beads"] == block["beads"]
        and len(first["beads"]["layers"]) == 3
        and first["spacing_comparison"] == []
    )
    assert second["spacing_comparison"] == elbow["spacing_comparison"] and second["beads"] is None
    assert sum(row["layers"] is not None for row in second["spacing_comparison"]) > 2
    assert both["spacing_comparison"] == [] and both["beads"] is None
    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    for title in (
        "Distances between layers: elbow",
        "block: distance to the previous layer",
        "elbow: distance to the previous layer",
    ):
        assert title in page
