# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths for other programs: FreeCAD and independent readers read them back, and the tests compare
them with the beads."""

import dataclasses
import functools
import math
import os

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.geometry.frames import rotation_about
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.interop import Line, attitudes, lines_of_motion, lines_of_toolpath, thinned
from freecad_am.sections import cell as job_cell
from tests.core.kinematics.test_calibration import FILE as calibrated_robot

LABEL = "Hémisphère n° 1"


@pytest.fixture(scope="module")
def job():
    doc = App.newDocument("Interop")
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Label, sphere.Radius, sphere.Angle1, sphere.Angle2 = LABEL, 45.0, 0, 90
    sphere.Placement = App.Placement(
        App.Vector(100, -50, 20), App.Rotation(App.Vector(1, 2, 3), 20)
    )
    doc.recompute()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            api,
            "make_feature_of",
            functools.partial(api.make_feature_of, values={"layer_height": 15.0}),
        )
        joint_path = api.make_all(doc, sphere)[3]
    yield joint_path
    App.closeDocument(doc.Name)


def beads(job):
    return [bead.points for _, _, bead in api.result(job.Toolpath)]


def polylines(path):
    """Return the POLYLINE entities of a DXF file: layer, flag and points, with group codes
    according to the format."""
    with open(path, encoding="ascii", newline="") as stream:
        words = stream.read().split("\r\n")
    pairs = list(zip([int(word) for word in words[:-1:2]], words[1::2], strict=True))
    assert pairs[-1] == (0, "EOF")
    entities, now = [], None
    for code, value in pairs:
        if code == 0:
            now = value
            if value == "POLYLINE":
                entities.append({"layer": "", "flag": 0, "points": []})
            elif value == "VERTEX":
                entities[-1]["points"].append([0.0, 0.0, 0.0])
        elif now == "POLYLINE" and code in (8, 70):
            entities[-1]["layer" if code == 8 else "flag"] = value if code == 8 else int(value)
        elif now == "VERTEX" and code in (10, 20, 30):
            entities[-1]["points"][-1][code // 10 - 1] = float(value)
        elif now == "VERTEX" and code == 70:
            assert int(value) == 32
    return entities


@pytest.mark.any_version
def test_motion_and_toolpath_give_the_same_beads(job):
    planned = api.result(job)
    ours, theirs = (
        lines_of_toolpath(api.result(job.Toolpath)),
        [line for line in lines_of_motion(planned.motion) if line.deposit],
    )
    names, other_names = (
        [(line.layer, line.bead, line.closed) for line in lines] for lines in (ours, theirs)
    )
    assert names == other_names
    for motion_bead, toolpath_bead in zip(ours, theirs, strict=True):
        gaps = np.linalg.norm(motion_bead.points[:, None] - toolpath_bead.points[None], axis=2).min(
            axis=1
        )
        assert gaps.max() < 1e-9  # planning adds points and drops none
    travelled = np.concatenate([line.points for line in lines_of_motion(planned.motion)])
    assert np.isfinite(travelled).all()
    joined = lines_of_motion(planned.motion)
    for previous, following in zip(joined, joined[1:], strict=False):
        assert np.array_equal(previous.points[-1], following.points[0])


def test_step_read_back_has_every_point_of_every_bead(job, tmp_path):
    path = str(tmp_path / "hémisphère wires.step")
    active = App.ActiveDocument.Name
    count = len(App.listDocuments())
    assert api.export_wires(job.Toolpath, path) == path
    assert (App.ActiveDocument.Name, len(App.listDocuments())) == (active, count)
    assert os.listdir(tmp_path) == ["hémisphère wires.step"]
    edges = Part.read(path).Edges
    expected = beads(job)
    assert len(edges) == len(expected)
    for edge, points in zip(edges, expected, strict=True):
        for point in points[:: max(1, len(points) // 40)]:
            assert edge.distToShape(Part.Vertex(App.Vector(*point)))[0] < 1e-6
        assert edge.Length == pytest.approx(
            np.linalg.norm(np.diff(points, axis=0), axis=1).sum(), abs=1e-4
        )
    with open(path, encoding="utf-8") as stream:
        assert "'Layer 000" in stream.read()


def test_dxf_is_the_beads_to_the_last_written_digit(job, tmp_path):
    path = str(tmp_path / "wires.dxf")
    api.export_wires(job.Toolpath, path)
    entities = polylines(path)
    assert len(entities) == len(beads(job))
    for index, (polyline, points) in enumerate(zip(entities, beads(job), strict=True)):
        assert polyline["flag"] == 8
        assert np.abs(np.array(polyline["points"]) - points).max() <= 0.5000001e-6
        assert polyline["layer"].startswith("LAYER_") and (
            index or polyline["layer"] == "LAYER_000"
        )
    api.export_wires(job, path, rapids=True)
    assert {"RAPID"} < {polyline["layer"] for polyline in polylines(path)}


def test_dxf_is_read_by_freecad(job, tmp_path):
    import Import

    path = str(tmp_path / "wires.dxf")
    api.export_wires(job.Toolpath, path)
    document = App.newDocument("Read")
    try:
        Import.readDXF(path)
        shapes = [
            obj.Shape for obj in document.Objects if hasattr(obj, "Shape") and obj.Shape.Edges
        ]
        length = sum(shape.Length for shape in shapes)
    finally:
        App.closeDocument(document.Name)
    expected_length = sum(
        np.linalg.norm(np.diff(points, axis=0), axis=1).sum() for points in beads(job)
    )
    assert length == pytest.approx(expected_length, rel=1e-5)


def test_cam_path_runs_through_every_bead_and_survives_saving(job, tmp_path):
    doc = job.Document
    cam_path = api.make_cam_path(job)
    assert "Touched" not in cam_path.State
    commands = [(command.Name, command.Parameters) for command in cam_path.Path.Commands]
    position, on, runs = None, False, []
    for name, words in commands:
        if name == "(deposit on)":
            on = True
            runs.append([position])
        elif name == "(deposit off)":
            on = False
        elif name in ("G0", "G1"):
            assert on == (name == "G1")
            position = (words["X"], words["Y"], words["Z"])
            if on:
                runs[-1].append(position)
                assert words["F"] > 0.0
    expected = [line.points for line in lines_of_motion(api.result(job).motion) if line.deposit]
    assert len(runs) == len(expected)
    for run, points in zip(runs, expected, strict=True):
        assert np.abs(np.array(run) - points).max() < 1e-9
    path = str(tmp_path / "job.FCStd")
    length = cam_path.Path.Length
    doc.saveCopy(path)
    copy = App.openDocument(path, True)
    try:
        assert copy.getObject(cam_path.Name).Path.Length == pytest.approx(length, rel=1e-6)
    finally:
        App.closeDocument(copy.Name)
        App.setActiveDocument(doc.Name)


def test_trajectory_keeps_within_what_was_asked_and_survives_saving(job, tmp_path):
    doc = job.Document
    trajectory = api.make_trajectory(job, tolerance=0.05, turn=1.0)
    assert "Touched" not in trajectory.State
    waypoints = trajectory.Trajectory.Waypoints
    lines = lines_of_motion(api.result(job).motion)
    assert 2 < len(waypoints) < 0.8 * sum(len(line.points) for line in lines)
    positions = np.array([list(waypoint.Pos.Base) for waypoint in waypoints])
    nozzle = np.array(
        [list(waypoint.Pos.Rotation.multVec(App.Vector(0, 0, 1))) for waypoint in waypoints]
    )
    starts, along = positions[:-1], np.diff(positions, axis=0)
    for line in lines:
        for point, tool in zip(line.points[::5], line.tool[::5], strict=True):
            share = np.clip(
                ((point - starts) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-30),
                0.0,
                1.0,
            )
            off = np.linalg.norm(starts + share[:, None] * along - point, axis=1)
            is_near = off < 0.05 + 1e-6
            assert is_near.any()
            turned = np.degrees(np.arccos(np.clip(-(nozzle[:-1][is_near] @ tool), -1.0, 1.0)))
            angles = np.degrees(np.arccos(np.clip(-(nozzle[1:][is_near] @ tool), -1.0, 1.0)))
            assert min(turned.min(), angles.min()) < 1.0 + 1e-6
    assert min(waypoint.Velocity for waypoint in waypoints) > 0.0
    path = str(tmp_path / "job.FCStd")
    doc.saveCopy(path)
    copy = App.openDocument(path, True)
    try:
        again = copy.getObject(trajectory.Name).Trajectory
        assert len(again.Waypoints) == len(waypoints) and again.Length == pytest.approx(
            trajectory.Trajectory.Length, rel=1e-6
        )
    finally:
        App.closeDocument(copy.Name)
        App.setActiveDocument(doc.Name)


@pytest.mark.parametrize("seed", range(5))
def test_thinning_keeps_every_point_within_the_tolerance(seed):
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0.0, 0.3, (400, 3)) + [0.5, 0.0, 0.0], axis=0)
    tilt = np.cumsum(rng.normal(0.0, 0.01, 400))
    tool = rotation_about(np.tile([0.0, 1.0, 0.0], (400, 1)), tilt)[:, :, 2]
    line = Line(0, 0, True, points, tool, np.full(400, 6.0))
    thinned_line = thinned(line, 0.5, math.radians(3.0))
    assert (
        np.array_equal(thinned_line.points[[0, -1]], points[[0, -1]])
        and len(thinned_line.points) < 350
    )
    kept_rows = np.flatnonzero(
        (points[:, None] == thinned_line.points[None]).all(axis=2).any(axis=1)
    )
    for start, end in zip(kept_rows, kept_rows[1:], strict=False):
        chord = points[end] - points[start]
        for k in range(start, end + 1):
            share = np.clip((points[k] - points[start]) @ chord / (chord @ chord), 0.0, 1.0)
            assert np.linalg.norm(points[start] + share * chord - points[k]) <= 0.5
            assert (
                min(abs(tilt[k] - tilt[start]), abs(tilt[k] - tilt[end]))
                <= math.radians(3.0) + 1e-9
            )


def test_the_nozzle_points_against_the_tool_axis_and_hardly_turns_about_it():
    rng = np.random.default_rng(1)
    tool = rng.normal(size=(500, 3)) + [0.0, 0.0, 2.0]
    tool /= np.linalg.norm(tool, axis=1, keepdims=True)
    turned = attitudes(tool)
    assert np.abs(turned[:, :, 2] + tool).max() < 1e-12
    assert np.abs(np.linalg.det(turned) - 1.0).max() < 1e-12
    assert (
        np.abs(attitudes(np.array([[0.0, 0.0, 1.0]]))[0] - np.diag([1.0, -1.0, -1.0])).max() < 1e-15
    )


@pytest.mark.parametrize(
    ("path", "code"),
    [
        ("wires.iges", "UNSUPPORTED_FILE"),
        ("wires", "UNSUPPORTED_FILE"),
        ("file/wires.dxf", "NO_FOLDER"),
        ("new/wires.step", "NO_FOLDER"),
        ("full.dxf", "NOT_WRITABLE"),
    ],
)
def test_what_cannot_be_written_is_refused_and_leaves_nothing(job, tmp_path, path, code):
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "full.dxf").mkdir()
    with pytest.raises(InputError) as caught:
        api.export_wires(job, str(tmp_path / path))
    assert caught.value.code == code
    assert (
        sorted(os.listdir(tmp_path)) == ["file", "full.dxf"]
        and os.listdir(tmp_path / "full.dxf") == []
    )
    if code == "NO_FOLDER":
        assert str((tmp_path / path).parent) in caught.value.message


def test_only_paths_are_exported(job, tmp_path):
    for call in (
        lambda: api.export_wires(job.Cell, str(tmp_path / "a.dxf")),
        lambda: api.make_cam_path(job.Cell),
    ):
        with pytest.raises(InputError, match="no path"):
            call()
    with pytest.raises(InputError, match="not positive"):
        api.make_trajectory(job, tolerance=0.0)


def test_a_saved_cell_is_the_cell_again_where_jobs_name_it(tmp_path):
    """A cell is written from the document and read by the commands; it names its files relative to
    its folder, so that the folder can move."""
    doc = App.newDocument("SavedCell")
    (tmp_path / "robot 1.yaml").write_text(calibrated_robot, encoding="utf-8")
    Part.makeBox(1200, 800, 30).exportStep(str(tmp_path / "a table.step"))
    Part.makeBox(4, 4, 90, App.Vector(-2, -2, -100)).exportStep(str(tmp_path / "a torch.step"))
    parameters = CellParameters(
        machine=f"ur-ur10e calibration={tmp_path / 'robot 1.yaml'}",
        setup="tool-on-robot",
        branch="auto",
        platform=(1.0, 2.0, 3.0, 0.1, -0.2, 0.3),
        platform_diameter=250.0,
        mount="part",
        world_up="0 0.5 1",
        arm_clearance=12.5,
        obstacles=f"table = {tmp_path / 'a table.step'} at 300 -400 -230 0 0 15; "
        "le post = box 60 50.5 400 at 900 -200 0 0 0 0",
        nozzle=NozzleParameters(
            half_angle=0.3,
            tool=(1.5, 0.0, 210.0, 0.0, 0.4, 0.0),
            shape=str(tmp_path / "a torch.step"),
        ),
        external="motoman-motopos-d500 at 900 10.5 -200 0 0 30 carries part",
    )
    cell = api.make_cell(doc, parameters=parameters)
    path = api.export_cell(cell, str(tmp_path / "hall.yaml"))
    with open(path, encoding="utf-8") as stream:
        assert str(tmp_path) not in stream.read()
    again = job_cell.read("hall.yaml", str(tmp_path))
    assert api.make_cell(doc, parameters=again).Status == cell.Status == "up to date"
    for field in ("platform", "nozzle"):
        reread, original = getattr(again, field), getattr(parameters, field)
        reread, original = (
            np.hstack(dataclasses.astuple(value_)[:4] if field == "nozzle" else value_)
            for value_ in (reread, original)
        )
        assert np.allclose(reread, original, atol=1e-12)
    assert again.nozzle.shape == parameters.nozzle.shape
    same = {"platform": parameters.platform, "nozzle": parameters.nozzle}
    assert dataclasses.replace(again, **same) == dataclasses.replace(parameters, **same)
    assert (
        job_cell.read(api.export_cell(api.make_cell(doc), str(tmp_path / "usual.yaml")), "/")
        == CellParameters()
    )
    for wrong, where in (
        (cell, "cell.txt"),
        (doc.addObject("App::FeaturePython", "Nothing"), "cell.yaml"),
    ):
        with pytest.raises(InputError):
            api.export_cell(wrong, str(tmp_path / where))
    App.closeDocument(doc.Name)


@pytest.mark.parametrize("unit", [0, 1, 2])
def test_a_step_file_has_the_same_size_whatever_unit_the_user_prefers(job, tmp_path, unit):
    preferences = App.ParamGet("User parameter:BaseApp/Preferences/Mod/Part/STEP")
    preferences.SetInt("Unit", unit)
    Part.setStaticValue(
        "write.step.unit", ("MM", "M", "INCH")[unit]
    )  # as FreeCAD does at its start
    try:
        path = api.export_wires(job.Toolpath, str(tmp_path / "wires.step"))
        text = (tmp_path / "wires.step").read_text(encoding="latin-1")
        box, want = Part.read(path).BoundBox, np.vstack(beads(job))
        # the user's files keep the preferred unit
        own_text = doc_wire(tmp_path / "own.step")
    finally:
        preferences.RemInt("Unit")
        Part.setStaticValue("write.step.unit", "MM")
    assert "SI_UNIT(.MILLI.,.METRE.)" in text and "INCH" not in text and "AUTOMOTIVE_DESIGN" in text
    assert [box.XMin, box.YMin, box.ZMin] == pytest.approx(want.min(axis=0), abs=1e-6)
    assert [box.XMax, box.YMax, box.ZMax] == pytest.approx(want.max(axis=0), abs=1e-6)
    assert ("INCH" in own_text) == (unit == 2)


def doc_wire(path):
    """Return the text of a STEP file that FreeCAD writes with the user's preferences."""
    Part.makeLine(App.Vector(0, 0, 0), App.Vector(1, 0, 0)).exportStep(str(path))
    return path.read_text(encoding="latin-1")
