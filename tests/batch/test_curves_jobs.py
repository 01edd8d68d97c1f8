# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of curves as beads: waypoints.csv has the points of the table, or of the shape."""

import csv
import json
import shutil

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.batch.job.job import read_job
from tests.batch import row_limits

V = FreeCAD.Vector
TABLE = """\
x,y,z,i,j,k,bead
0,0,0,0,0,1,1
30,0,0,0,0.1,1,1
30,20,0,0,0.2,1,1
0,5,0,0,0,2,2
20,5,0.5,0,0,2,2
"""
JOB = """\
part: {{file: {file}{part}}}
strategy: {{kind: curves, layer_height: 2 mm, chord_error: 0.05 mm{more}}}
process: {{bead_width: 4 mm}}
build_direction: {{clearance: none{mode}}}
"""


@pytest.fixture
def planned(workshop):
    def run(file="beads.csv", text=TABLE, part="", more="", mode=""):
        if not file.endswith(".step"):
            (workshop.folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
        job = workshop.write_job(JOB.format(file=file, part=part, more=more, mode=mode))
        command = workshop.run("plan", job.name, "-o", "out", "--no-page")
        if command.status:
            return command, None, None
        out = workshop.folder / "out"
        with open(next(out.rglob("waypoints.csv")), encoding="utf-8", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
        return command, json.loads(next(out.rglob("report.json")).read_text(encoding="utf-8")), rows

    return run


def column(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def test_a_table_is_laid_as_it_is_and_over_itself(planned):
    command, report, rows = planned(more=", repeat: 3")
    assert command.status == 0, command.err
    table = np.array([[float(cell) for cell in line.split(",")] for line in TABLE.splitlines()[1:]])
    directions = table[:, 3:6] / np.linalg.norm(table[:, 3:6], axis=1)[:, None]
    expected = np.vstack([table[:, :3] + 2.0 * k * directions for k in range(3)])
    np.testing.assert_allclose(column(rows, "x_mm", "y_mm", "z_mm"), expected, atol=2e-6)
    np.testing.assert_allclose(
        column(rows, "bx", "by", "bz"), np.tile(directions, (3, 1)), atol=1e-8
    )
    assert [(row["layer"], row["bead"]) for row in rows[:5]] == [("0", "0")] * 3 + [("0", "1")] * 2
    assert (
        report["counts"] == {"layers": 3, "beads": 6, "points": 15}
        and report["unsupported_mm"] == 0.0
    )


@pytest.mark.parametrize(
    "text",
    [
        "0;0;0\n10;0;0\n10;10;0\n",
        "X_mm,Y_mm,Z_mm\n0,0,0\n10,0,0\n10,10,0\n\n",
        "﻿x,y,z,bead\n0,0,0,7\n10,0,0,7\n10,10,0,7\n",
    ],
)
def test_forms_of_a_table(planned, text):
    command, _, rows = planned(text=text, more=", direction: [0, 1, 1]")
    assert command.status == 0, command.err
    np.testing.assert_allclose(
        column(rows, "x_mm", "y_mm", "z_mm"), [[0, 0, 0], [10, 0, 0], [10, 10, 0]], atol=1e-9
    )
    np.testing.assert_allclose(
        column(rows, "bx", "by", "bz"), np.tile([0, 0.5**0.5, 0.5**0.5], (3, 1)), atol=1e-8
    )


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("x,y,z\n0,0,0\n1,,0\n2,0,0\n", "line 3", "2 numbers instead of 3"),
        ("0,0,0\n\n1,0,0\n", "line 2", "the line is empty"),
        ("0,0,0\n1,nan,0\n", "line 2", "y is nan"),
        ("0,0,0\n1,inf,0\n", "line 2", "y is inf"),
        ("0,0,0\n1,0,0\n1,0,0\n", "line 3", "remove the line"),
        ("0,0,0\n", "line 1", "one point"),
        ("0,0,0,1\n1,0,0,1\n2,0,0,2\n", "line 3", "one point"),
        ("0,0,0\n1,0,zero\n", "line 2", "'zero' is not a number"),
        (
            "0,0,0,1\n1,0,0,1\n0,1,0,2\n1,1,0,2\n5,0,0,1\n6,0,0,1\n",
            "line 5",
            "starts a second time",
        ),
        ("", "beads.csv", "no points"),
        ("x,y\n0,0\n", "line 1", "columns"),
        ("x,y,w\n0,0,0\n1,0,0\n", "line 1", "columns"),
        ("0,0,0,0,0,0\n1,0,0,0,0,1\n", "line 1", "give a direction"),
        (b"\xff\xfe\x00", "beads.csv", "not text"),
    ],
)
def test_bad_tables_are_told_with_their_line(planned, text, line, words):
    command, _, _ = planned(text=text)
    assert (
        command.status == 2
        and line in command.err
        and words in command.err
        and command.err.count("error[") == 1
    ), command.err


def test_curves_that_lie_on_one_another_are_told(planned):
    """A bead of 40 mm is 1 mm from another of 30 mm; both are 4 mm wide and 2 mm high."""
    command, report, _ = planned(text="0,0,0,1\n40,0,0,1\n5,1,0,2\n35,1,0,2\n")
    assert command.status == 0, command.err
    assert report["deposit"]["twice_cm3"] == pytest.approx(30.0 * 3.0 * 2.0 / 1000.0, rel=0.03)
    assert report["deposit"]["left_out_cm3"] is None and report["on_part"] is None
    (issue_,) = [issue for issue in report["issues"] if issue["code"] == "DEPOSITED_TWICE"]
    assert issue_["level"] == "warning" and "32 % of the beads of beads" in issue_["message"]
    promises = {entry["promise"]: entry for entry in report["preflight"]}
    assert (
        promises["Over-deposition is small"]["ok"] is False
        and promises["The whole part is deposited"]["ok"] is None
    )


@pytest.mark.parametrize(
    ("part", "more", "mode", "code"),
    [
        (", edges: [Edge1]", "", "", "NOT_FOR_FAMILY"),
        (", faces: [Face1]", "", "", "NOT_FOR_FAMILY"),
        ("", ", repeat: 0", "", "BAD_VALUE"),
        ("", ", direction: [0, 0, 0]", "", "BAD_VALUE"),
        ("", "", ", mode: symmetry-plane", "NOT_FOR_FAMILY"),
        ("", ", fill: lines", "", "UNKNOWN_KEY"),
    ],
)
def test_keys_that_do_not_fit_are_told(planned, part, more, mode, code):
    command, _, _ = planned(part=part, more=more, mode=mode)
    assert command.status == 2 and f"error[{code}]" in command.err, command.err


def test_a_bead_along_its_own_direction_is_refused(planned):
    command, _, _ = planned(text="0,0,0\n0,0,10\n")
    assert command.status == 2 and "error[ALONG_DIRECTION]" in command.err, command.err


def test_edges_lie_on_their_shape_with_the_normals_of_its_faces(planned, workshop):
    """The ends of a horizontal cylinder get the normals of its side."""
    Part.makeCylinder(20, 60, V(), V(1, 0, 0)).exportStep(str(workshop.folder / "rod.step"))
    rod = Part.read(str(workshop.folder / "rod.step"))
    round_ones = [f"Edge{k}" for k, edge in enumerate(rod.Edges, 1) if edge.Closed]
    side = next(
        f"Face{k}"
        for k, face in enumerate(rod.Faces, 1)
        if face.Surface.TypeId == "Part::GeomCylinder"
    )
    options = f", edges: [{', '.join(round_ones)}], faces: [{side}]"
    command, report, rows = planned("rod.step", part=options, more=", repeat: 2")
    assert command.status == 0, command.err
    points, build = column(rows, "x_mm", "y_mm", "z_mm"), column(rows, "bx", "by", "bz")
    layer = column(rows, "layer")[:, 0]
    radius = np.hypot(points[:, 1], points[:, 2])
    np.testing.assert_allclose(radius, 20.0 + 2.0 * layer, atol=1e-5)
    np.testing.assert_allclose(build[:, 1:], points[:, 1:] / radius[:, None], atol=1e-6)
    assert report["counts"]["beads"] == 4
    on_part = report["on_part"]
    assert (
        0.0 < on_part["worst_mm"] < on_part["allowed_mm"] == pytest.approx(0.07)
        and on_part["places"] > 100
    )
    chord = np.linalg.norm(np.diff(points[:10], axis=0), axis=1).max()
    assert (
        chord**2 / (8.0 * 20.0) < 0.06
    )  # within the chord error, or as near as directions require


def test_edges_off_the_faces_are_refused(planned, workshop):
    Part.makeBox(20, 20, 20).exportStep(str(workshop.folder / "box.step"))
    box = Part.read(str(workshop.folder / "box.step"))
    top = next(
        f"Face{k}" for k, face in enumerate(box.Faces, 1) if abs(face.CenterOfMass.z - 20) < 1e-6
    )
    low = next(f"Edge{k}" for k, edge in enumerate(box.Edges, 1) if edge.BoundBox.ZMax < 1e-6)
    command, _, _ = planned("box.step", part=f", edges: [{low}], faces: [{top}]")
    assert (
        command.status == 2 and "error[OFF_FACE]" in command.err and "20 mm off" in command.err
    ), command.err


def test_the_example_lays_the_points_of_its_table(workshop, root):
    """Two layers of a rose with six leaves of 5 mm about 34 mm, and of a ring of 18 mm."""
    for name in ("rosette.csv", "rosette.yaml"):
        shutil.copy(root / "resources" / "examples" / name, workshop.folder)
    path = workshop.folder / "rosette.yaml"
    path.write_text(
        path.read_text(encoding="utf-8").replace("repeat: 8", "repeat: 2"), encoding="utf-8"
    )
    command = workshop.run("plan", path.name, "-o", "out", "--no-page")
    assert command.status == 0, command.err
    cell = read_job(str(path)).cell
    assert row_limits.over_all(workshop.folder / "out", cell.machine, cell.limits) <= 0.0
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    positions = column(rows, "x_mm", "y_mm", "z_mm")
    radius, angle = (
        np.hypot(positions[:, 0], positions[:, 1]),
        np.arctan2(positions[:, 1], positions[:, 0]),
    )
    rose = np.array([int(row["bead"]) == 0 for row in rows])
    assert (
        np.abs(radius[rose] - 34.0 - 5.0 * np.cos(6.0 * angle[rose])).max() < 0.2
    )  # chords of the table
    assert np.abs(radius[~rose] - 18.0).max() < 0.01 and set(positions[:, 2].round(6)) == {0.0, 2.0}


def test_a_program_of_a_slicer_is_laid_in_its_layers(planned):
    text = "".join(
        f";LAYER:{k}\nG0 X0 Y0 Z{2 * k + 2}\nG1 X30 E1\nG3 X30 Y20 I0 J10 E1\n" for k in range(2)
    )
    command, report, rows = planned("slicer.gcode", "G21\nM83\n" + text)
    assert command.status == 0, command.err
    assert (
        report["counts"]["layers"] == report["counts"]["beads"] == 2
        and report["unsupported_mm"] == 0.0
    )
    points = column(rows, "x_mm", "y_mm", "z_mm")
    np.testing.assert_allclose(points[:, 2], 2.0 + 2.0 * column(rows, "layer")[:, 0], atol=1e-9)
    straight = points[:, 0] <= 30.0
    np.testing.assert_allclose(
        np.hypot(points[~straight, 0] - 30.0, points[~straight, 1] - 10.0), 10.0, atol=1e-6
    )
    np.testing.assert_allclose(
        column(rows, "bx", "by", "bz"), np.tile([0, 0, 1], (len(rows), 1)), atol=1e-12
    )
    for options_, words in (
        ("G20\n", "none of the moves extrudes"),
        ("G0 X1\n", "none of the moves extrudes"),
    ):
        command, _, _ = planned("slicer.gcode", options_)
        assert command.status == 2 and "error[BAD_GCODE]" in command.err and words in command.err, (
            command.err
        )


def test_a_turn_of_a_vase_may_end_where_it_turns_back(workshop, planned):
    command, report, rows = planned(
        "vase.gcode", "M83\nG0 X0 Y0 Z0.4\nG1 X10 E1\nG1 X0 Z0.8 E1\nG1 X10 Z0.8 E1\n"
    )
    assert command.status == 0, command.err
    assert report["length_mm"] == pytest.approx(20.0 + np.hypot(10.0, 0.4))
    assert np.isfinite(column(rows, "tx", "ty", "tz")).all()
    for moves in ("G1 Z5 E1\nG1 Z9 E1", "G1 Z5 E1\nG1 X0 E1", "G1 Z5 E1\nG1 X20 E1"):
        command, _, _ = planned("up.gcode", f"M83\nG0 X0 Y0 Z0.4\nG1 X10 E1\n{moves}\n")
        assert command.status == 2 and "error[ALONG_DIRECTION]" in command.err, command.err


def test_roles_of_g_code_in_a_job_file(workshop):
    lines = "M83\nG0 X0 Y0 Z2\n;TYPE:Custom\nG1 X60 E1\n;LAYER_CHANGE\n;TYPE:Skirt/Brim\nG0 X0 Y9\nG1 X24 E1\n"
    (workshop.folder / "s.gcode").write_text(lines + ";TYPE:Perimeter\nG0 X0 Y19\nG1 X48 E1\n")
    lengths = {
        "": 48.0,
        "roles: all, ": 132.0,
        "roles: [part, skirt], ": 72.0,
        "roles: [Custom], ": 60.0,
    }
    for roles, expected in lengths.items():
        job = workshop.write_job(
            "version: 1\nname: s\npart: {file: s.gcode}\nprocess: {bead_width: 4 mm}\n"
            f"strategy: {{kind: curves, {roles}layer_height: 2 mm}}\n"
        )
        command = workshop.run("plan", job.name, "-o", "out", "--no-page")
        assert command.status == 0, command.err
        report = json.loads((workshop.folder / "out" / "report.json").read_text())
        assert report["length_mm"] == pytest.approx(expected) and report["unsupported_mm"] == 0.0
        assert ("ROLES_LEFT_OUT" in command.err) == ("all" not in roles)


def test_beads_that_begin_beside_the_end_of_others_have_a_kuka_program(workshop):
    """The travel is so short that the axes would need less than the smallest speed share of KRL."""
    (workshop.folder / "beads.csv").write_text(
        "x,y,z,bead\n0,0,0,1\n30,0,0,1\n30.4,0,0,2\n60,0,0,2\n"
    )
    job = workshop.write_job(
        JOB.format(file="beads.csv", part="", more="", mode="")
        + """\
cell: {machine: kuka-kr8-r2100-2-arc-hw, setup: tool-on-robot, branch: auto, nozzle: {tool: [0, 0, 300, 0, 0, 0]}}
program: {post: kuka, motion: cartesian}
"""
    )
    command = workshop.run("plan", job.name, "-o", "out", "--no-page")
    assert command.status == 0, command.err
    assert (
        next(workshop.folder.rglob("*.src")).read_text(encoding="ascii").count("BAS(#VEL_PTP,1)")
        == 1
    )


def test_a_sketch_of_a_document_is_laid_where_it_stands(workshop, planned):
    """Two lines and an arc on an inclined plane are transformed back by their own placement."""
    placement = FreeCAD.Placement(V(5, -7, 30), FreeCAD.Rotation(V(1, 0, 0), 25))
    document = FreeCAD.newDocument("Drawn")
    try:
        sketch = document.addObject("Sketcher::SketchObject", "Path")
        sketch.addGeometry(
            [
                Part.LineSegment(V(0, 0, 0), V(30, 0, 0)),
                Part.LineSegment(V(30, 20, 0), V(0, 20, 0)),
                Part.ArcOfCircle(Part.Circle(V(30, 10, 0), V(0, 0, 1), 10), -np.pi / 2, np.pi / 2),
            ],
            False,
        )
        sketch.Placement = placement
        document.recompute()
        document.saveAs(str(workshop.folder / "drawn.FCStd"))
    finally:
        FreeCAD.closeDocument(document.Name)
    content = (workshop.folder / "drawn.FCStd").read_bytes()
    command, report, rows = planned("drawn.FCStd", content, part=", object: Path")
    assert command.status == 0, command.err
    back = np.array(
        [placement.inverse().multVec(V(*point)) for point in column(rows, "x_mm", "y_mm", "z_mm")]
    )
    assert np.abs(back[:, 2]).max() < 1e-5 and report["counts"]["beads"] == 1
    on_lines = (np.abs(back[:, 1] - np.where(back[:, 1] < 10.0, 0.0, 20.0)) < 1e-5) & (
        back[:, 0] < 30.0 + 1e-5
    )
    on_arc = np.abs(np.hypot(back[:, 0] - 30.0, back[:, 1] - 10.0) - 10.0) < 1e-5
    assert (on_lines | on_arc).all() and on_arc.sum() > 10
    length = np.linalg.norm(np.diff(back, axis=0), axis=1).sum()
    assert length == pytest.approx(60.0 + 10.0 * np.pi, abs=0.2)


def test_a_program_counts_from_a_base_frame_that_is_not_known(workshop):
    """Only a Cartesian program depends on a frame; joint values do not."""
    (workshop.folder / "beads.csv").write_text("x,y,z,bead\n0,0,0,1\n30,0,0,1\n")
    for motion, machine, warned in (
        ("cartesian", "staubli-rx60b", True),
        ("joint", "staubli-rx60b", False),
        ("cartesian", "staubli-tx90", False),
    ):
        job = workshop.write_job(
            JOB.format(file="beads.csv", part="", more="", mode="")
            + f"cell: {{machine: {machine}, setup: tool-on-robot, branch: auto, nozzle: {{tool: [0, 0, 200, 0, 0, 0]}}}}\n"
            f"program: {{post: staubli, motion: {motion}}}\n"
        )
        command = workshop.run("plan", job.name, "-o", "out", "--no-page")
        assert command.status == 0, command.err
        assert ("warning[BASE_NOT_KNOWN]" in command.err) == warned, command.err
        text = "".join(path.read_text() for path in (workshop.folder / "out").rglob("start.pgx"))
        assert ("Base frame not known" in text) == warned


def test_the_size_of_a_program_is_told_before_joints_are_planned():
    from freecad_am.core.geometry.curves.bead_curves import BeadCurve, Curves
    from freecad_am.core.parameters.build_direction import BuildDirectionParameters
    from freecad_am.core.parameters.process import ProcessParameters
    from freecad_am.core.parameters.program import ProgramParameters
    from freecad_am.core.parameters.strategy import CurvesParameters
    from freecad_am.core.strategies import curves
    from freecad_am.objects.checks import controllers

    def size_message(points, post):
        line = np.column_stack([np.linspace(0.0, 600.0, points), np.zeros((points, 2))])
        given = Curves("line", (BeadCurve(line), BeadCurve(line + (0.0, 9.0, 0.0))))
        toolpath = curves.plan(
            given, CurvesParameters(), BuildDirectionParameters(), ProcessParameters()
        )
        return controllers.size_issues(toolpath, ProgramParameters(post=post, max_points=1800))

    (issue,) = size_message(30_050, "kuka")
    assert (issue.level, issue.code) == ("warning", "PROGRAM_SIZE")
    assert "60,000 points in 35 files, 4.5 MB" in issue.message and "4 MB" in issue.message
    (issue,) = size_message(20_000, "kuka")
    assert issue.level == "note" and "3 MB" in issue.message
    (issue,) = size_message(20_000, "linuxcnc")
    assert issue.level == "note" and "controller is unknown" in issue.message
    assert size_message(2_000, "kuka") == [] and size_message(30_050, "none") == []
