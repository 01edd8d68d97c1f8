# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of solids in plane layers: their keys, their refusals, and the bracket to a program for an
840D."""

import csv
import json
import re
import shutil

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.filled import DevelopableParameters, SolidParameters

START = "part: {file: part.step}\nstrategy:\n  kind: solid\n"


@pytest.fixture
def read(tmp_path):
    for name in ("part.step", "part.stl", "plate.step"):
        (tmp_path / name).write_text("")

    def read_text(text):
        path = tmp_path / "job.yaml"
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def test_keys_and_their_forms(read):
    assert read(START).strategy == SolidParameters() == read(START + "  layers: planes\n").strategy
    assert read(START + "  direction: [0, -1, 0.5]\n").strategy.direction == (0.0, -1.0, 0.5)
    assert read(START + "  direction: auto\n").strategy.direction is None
    assert read(START + "  direction: 1 0 0\n").strategy.direction == (1.0, 0.0, 0.0)
    assert read(START.replace("part.step}", "part.stl, fuse: none}")).strategy.fuse == "none"
    assert read(START + "substrate: {file: plate.step}\n").substrate.file.endswith("plate.step")
    assert read(START + "  layers: developable\n").strategy == DevelopableParameters()
    assert (
        read(START + "  fill: zigzag\nprocess: {bead_width: 5 mm}\n").process.fill_width
        == "bead_width"
    )
    assert read(START + "build_direction: {mode: fixed}\n").build_direction.mode == "fixed"


@pytest.mark.parametrize(
    ("more", "code", "where"),
    [
        ("  direction: [0, 0, 0]\n", "BAD_VALUE", "strategy.direction"),
        ("  direction: [0, 0]\n", "BAD_VALUE", "strategy.direction"),
        ("  direction: [0, 0, 1 mm]\n", "BAD_UNIT", "strategy.direction"),
        ("  direction: up\n", "BAD_VALUE", "strategy.direction"),
        ("  layers: bananas\n", "BAD_VALUE", "strategy.layers"),
        ("  cut_at: side\n", "BAD_VALUE", "strategy.cut_at"),
        ("  base: auto\n", "UNKNOWN_KEY", "strategy.base"),
        ("  wall: outer\n", "UNKNOWN_KEY", "strategy.wall"),
        ("build_direction: {mode: symmetry-plane}\n", "NOT_FOR_FAMILY", "build_direction.mode"),
    ],
)
def test_what_is_refused(read, more, code, where):
    with pytest.raises(InputError) as caught:
        read(START + more)
    assert caught.value.code == code and where in caught.value.where


@pytest.mark.parametrize(
    ("part", "code", "where"),
    [
        ("{file: part.step, faces: [Face1]}", "NOT_FOR_FAMILY", "part.faces"),
        ("{file: part.step, start_edges: [Edge1]}", "NOT_FOR_FAMILY", "part.start_edges"),
        ("{file: part.step, fuse: perhaps}", "BAD_VALUE", "strategy.fuse"),
    ],
)
def test_what_of_a_part_is_refused(read, part, code, where):
    with pytest.raises(InputError) as caught:
        read(START.replace("{file: part.step}", part))
    assert caught.value.code == code and where in caught.value.where


def test_only_solids_are_fused(read):
    with pytest.raises(InputError) as caught:
        read("part: {file: part.step, fuse: auto}\n")
    assert caught.value.code == "NOT_FOR_FAMILY" and "part.fuse" in caught.value.where


def test_the_bracket_to_a_program(workshop, root):
    """With coarser settings than shipped, waypoints, raised by half a layer, are in the part,
    layers rise one by one, and the figures of the report add up."""
    for name in ("bracket.step", "bracket.yaml"):
        shutil.copy(root / "resources" / "examples" / name, workshop.folder)
    job = (workshop.folder / "bracket.yaml").read_text(encoding="utf-8")
    (workshop.folder / "bracket.yaml").write_text(
        job.replace("layer_height: 2 mm", "layer_height: 5 mm"), encoding="utf-8"
    )
    command = workshop.run("plan", "bracket.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "ok" and report["counts"]["layers"] == 18
    assert {"DIRECTION"} <= {issue["code"] for issue in report["issues"]}
    shape = Part.Shape()
    shape.read(str(workshop.folder / "bracket.step"))
    assert report["deposit"]["part_cm3"] == pytest.approx(shape.Volume / 1000.0, rel=1e-3)
    assert (
        report["deposit"]["left_out_cm3"]
        < 0.01 * report["deposit"]["part_cm3"]
        > report["deposit"]["beside_cm3"]
    )
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    layer = np.array([int(row["layer"]) for row in rows])
    points = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])
    np.testing.assert_allclose(
        points[:, 1], 5.0 * layer, atol=1e-5
    )  # stacked along Y, because the wall is on its back
    sample = np.random.default_rng(0).permutation(len(points))[:200]
    vertices = [FreeCAD.Vector(*(points[k] + (0.0, 2.5, 0.0))) for k in sample]
    off = [
        shape.distToShape(Part.Vertex(vertex))[0]
        for vertex in vertices
        if not shape.isInside(vertex, 1e-6, True)
    ]
    assert max(off, default=0.0) < 0.05 + 1e-3
    assert (
        sorted(name.name for name in (workshop.folder / "out" / "program").iterdir())[0]
        == "BRACKET.MPF"
    )


def test_a_mesh_file_of_several_bodies(workshop):
    import Mesh

    lower, upper = Mesh.createBox(30, 30, 10), Mesh.createBox(20, 20, 10)
    upper.translate(60, 0, 0)
    lower.addMesh(upper)
    lower.write(str(workshop.folder / "two.stl"))
    (workshop.folder / "job.yaml").write_text(
        "part: {file: two.stl}\nstrategy: {kind: solid, layer_height: 5 mm, chord_error: 0.1 mm}\n",
        encoding="utf-8",
    )
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["counts"]["layers"] == 2
    assert report["deposit"]["part_cm3"] == pytest.approx(13.0, rel=1e-3)


def test_a_small_part_by_a_robot_that_takes_no_short_moves(workshop):
    """Beads of 0.6 mm have points hundredths of a millimetre apart at corners; the script keeps the
    points that matter."""
    import Mesh

    tube = (
        Part.makeCylinder(3, 1)
        .cut(Part.makeBox(2.2, 2.2, 1, FreeCAD.Vector(-1.1, -1.1, 0)))
        .cut(Part.makeCylinder(1.2, 1, FreeCAD.Vector(3, 0, 0)))
    )
    Mesh.Mesh(tube.tessellate(0.01)).write(str(workshop.folder / "nut.stl"))
    job = (
        "part: {file: nut.stl}\nstrategy: {kind: solid, layer_height: 0.5 mm, bead_spacing: 0.6 mm, chord_error: 0.01 mm}\n"
        "process: {bead_width: 0.6 mm, travel_speed: 20 mm/s}\n"
        "cell: {machine: %s, setup: tool-on-robot, mount: feature, branch: auto, platform_diameter: 100 mm}\n"
        "program: {post: %s, max_points: 40}\n"
    )
    (workshop.folder / "job.yaml").write_text(job % ("ur-ur10e", "ur"), encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    counts = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))[
        "counts"
    ]
    script = (workshop.folder / "out" / "program" / "job.script").read_text(encoding="ascii")
    times = [
        float(time) for time in re.findall(r"t=([\d.]+), r=0\.0*[1-9]", script)
    ]  # the robot does not stop within beads
    assert min(times) >= 0.002 and 0.5 < len(times) / (counts["points"] - 2 * counts["beads"]) < 0.9
    (workshop.folder / "job.yaml").write_text(job % ("abb-irb4600-40-255", "abb"), encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == 2
    refusal = re.search(
        r"error\[BEAD_TOO_LONG\] job.yaml: program.max_points: layer 1 bead 0 has (\d+) points, and"
        r".* at least (\d+)",
        command.err,
    )
    assert refusal and 40 < int(refusal[1]) < int(refusal[2])
    assert "with its approach" not in command.err  # reported before the joints are planned
