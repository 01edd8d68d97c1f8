# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job is ready only where arm and platform stay out of part and substrate, held against a sampling of the substrate by
the frames of PyKDL chains; another placement is proposed where the usual one does not serve."""

import dataclasses
import math
import time

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError, has_errors
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.collisions import CORE, flange_passes
from freecad_am.core.kinematics.links.self_collision import round_solid
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.planning.other_cells import Tried
from freecad_am.core.planning.remedies import remedies
from freecad_am.objects.checks.collisions import look, margin_issues
from freecad_am.objects.joint_path import planned_of
from freecad_am.objects.shapes import cell_obstacles
from tests.kdl_links import KdlLinks

pytestmark = pytest.mark.any_version

V = App.Vector
OUTER, INNER, HALF, BRANCH = 60.0, 52.0, 150.0, 25.0
WRIST = (
    30.0  # mm, a radius that the forearm and wrist of a robot of 20 kg surely fill about their axes
)


def feature(doc, name, shape):
    obj = doc.addObject("Part::Feature", name)
    obj.Shape = shape
    return obj


def pipe_and_branch(doc, up=0.0):
    """A pipe along X, its axis `up` above the origin, and a tube of one face that stands on it."""
    bar, bore = (
        Part.makeCylinder(r, 2 * HALF, V(-HALF, 0, up), V(1, 0, 0)) for r in (OUTER, INNER)
    )
    tube = Part.makeCylinder(BRANCH, 100.0, V(0, 0, up), V(0, 0, 1))
    skin = next(one for one in tube.Faces if one.Surface.TypeId == "Part::GeomCylinder")
    return feature(doc, "Pipe", bar.cut(bore)), feature(doc, "Branch", skin.cut(bar))


def samples(shape, step=6.0):
    """Points of a grid in the pipe."""
    box = shape.BoundBox
    axes = [
        np.arange(low + 0.5, high, step)
        for low, high in ((box.XMin, box.XMax), (box.YMin, box.YMax), (box.ZMin, box.ZMax))
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    radius = np.hypot(grid[:, 1] - box.Center.y, grid[:, 2] - box.Center.z)
    return grid[(radius > INNER) & (radius < OUTER)]


def deepest_in_wrist(path, solid):
    """How many mm points of a solid are, at most, inside of WRIST about the line from the elbow to the wrist's centre, and from
    that to the flange, over the points of the beads of a joint path; the part hangs on the flange."""
    planned, toolpath, settings = planned_of(path, "path")
    cell = cell_obstacles.resolved(settings, toolpath, ())
    links = KdlLinks(machines.load(settings.machine, ()))
    points = samples(solid)
    hung = (
        np.c_[points, np.ones(len(points))]
        @ np.linalg.inv(cell.poses.mount).T
        @ cell.poses.carried.T
    )
    joints = np.vstack([bead.joints for bead in planned.joint_path.beads])[::40]
    deepest = -math.inf
    for row in joints:
        flange, elbow, wrist = (
            links.frame(row),
            links.frame(row, 4)[:3, 3],
            links.frame(row, 5)[:3, 3],
        )
        seen = (hung @ flange.T)[:, :3]
        for start, end in ((elbow, wrist), (wrist, flange[:3, 3])):
            way = end - start
            share = (seen - start) @ way / (way @ way)
            away = np.linalg.norm(seen - start - share[:, None] * way, axis=1)
            away[(share < 0.0) | (share > 1.0)] = np.inf  # the flange ends there
            deepest = max(deepest, WRIST - float(away.min()))
    return deepest


def in_plate(settings, solid, frame):
    """How many points of a solid are in the plate between flange and platform."""
    points = samples(solid, 3.0)
    local = np.c_[points, np.ones(len(points))] @ np.linalg.inv(frame).T
    inside = np.hypot(local[:, 0], local[:, 1]) < 0.5 * settings.platform_diameter - 0.5
    return int((inside & (local[:, 2] < -0.5) & (local[:, 2] > -4.5)).sum())


def codes(obj):
    return {issue.code for issue in api.issues(obj)}


def test_a_pipe_about_the_origin_is_held_clear_of_arm_and_platform(doc, monkeypatch):
    pipe, branch = pipe_and_branch(doc)
    cell, _, _, path, program = api.make_all(doc, branch, kind="surface", substrate=pipe)
    assert path.Status == program.Status == "up to date", api.issues(path)
    settings = api.result(cell)
    assert in_plate(settings, pipe.Shape, np.eye(4)) == 0
    assert deepest_in_wrist(path, pipe.Shape) < 0.0

    # as it was placed before; what would help is looked for in other tests
    monkeypatch.setattr("freecad_am.objects.joint_path.remedies", lambda *_: [])
    api.change(cell, platform=5.0, platform_diameter=113.0)
    assert path.Status == "infeasible" and program.Status != "up to date"
    assert in_plate(api.result(cell), pipe.Shape, np.eye(4)) > 0
    assert {"PLATFORM_COLLISION", "ARM_COLLISION"} <= codes(path)
    assert deepest_in_wrist(path, pipe.Shape) > 10.0
    with pytest.raises(InputError):
        api.export(program, "/nowhere")

    # without a plate the arm alone is in it, and that is an error with link and place
    api.change(cell, platform_diameter=0.0)
    (wrong,) = (one for one in api.issues(path) if one.code == "ARM_COLLISION")
    assert "PLATFORM_COLLISION" not in codes(path)
    assert "Pipe" in wrong.message and wrong.layer is not None and has_errors([wrong])


def test_a_pipe_above_the_platform_keeps_the_usual_place(doc):
    pipe, branch = pipe_and_branch(doc, up=OUTER)
    cell, *_, path, program = api.make_all(doc, branch, kind="surface", substrate=pipe)
    assert program.Status == "up to date"
    assert api.result(cell).platform == CellParameters().platform
    assert deepest_in_wrist(path, pipe.Shape) < 0.0


def test_the_platform_is_sized_and_placed_from_the_part(doc):
    bracket = feature(
        doc,
        "Bracket",
        Part.makeBox(160, 80, 8, V(40, 30, 0)).fuse(Part.makeBox(20, 80, 16, V(40, 30, 0))),
    )
    cell, _, toolpath, path, *_ = api.make_all(doc, bracket, kind="solid")
    settings, made = api.result(cell), api.result(toolpath)
    assert "OVER_PLATFORM" not in codes(toolpath) and path.Status == "up to date"
    frame = made.frame if settings.mount == "feature" else np.eye(4)
    points = np.vstack([bead.points for bead in made.layers[0].beads])
    local = (points - frame[:3, 3]) @ frame[:3, :3]
    reach = np.hypot(local[:, 0], local[:, 1]).max()
    assert reach < 0.5 * settings.platform_diameter < reach + 15.0
    assert settings.platform_diameter < 1.3 * math.hypot(160, 80)


def test_a_saved_cell_keeps_its_platform(doc, tmp_path):
    saved = tmp_path / "mine.yaml"
    api.export_cell(api.make_cell(doc, platform_diameter=50), str(saved))
    plate = feature(doc, "Plate", Part.makeBox(90, 60, 4))
    cell, _, toolpath, *_ = api.make_all(doc, plate, kind="solid", cell=str(saved))
    assert api.result(cell).platform_diameter == 50.0 and "OVER_PLATFORM" in codes(toolpath)


def test_margins_at_a_limit_are_reported(doc):
    """A shifted motion whose nearest axis is 0.2 deg from its limit, and 0.7 deg."""
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1 = 20, 0
    doc.recompute()
    *_, path, _ = api.make_all(doc, ball)
    planned, toolpath, settings = planned_of(path, "path")
    cell = cell_obstacles.resolved(settings, toolpath, ())
    joints = planned.motion.joints
    room = cell.limits.upper[0] - np.nanmax(joints[:, 0])
    for left, reported in ((0.2, True), (0.7, False)):
        moved = joints.copy()
        moved[:, 0] += room - math.radians(left)
        found = margin_issues(dataclasses.replace(planned.motion, joints=moved), cell)
        found = [issue for issue in found if issue.message.startswith("q1 ")]
        assert [issue.code for issue in found] == (["LOW_MARGIN"] if reported else [])
        if reported:
            row = int(np.nanargmax(moved[:, 0]))
            assert found[0].layer == planned.motion.layer[row] and found[0].level == "warning"
            assert "0.2 deg" in found[0].message
    # the last axis is at its limit in many plans, which is told too
    least = math.degrees(np.nanmin(cell.limits.upper[5] - np.abs(joints[:, 5])))
    assert any(one.message.startswith("q6 comes") for one in api.issues(path)) == (least < 0.5)


@pytest.mark.parametrize("machine", ["kuka-kr16-2", "abb-irb2400-12-155"])
def test_a_cell_by_itself_is_placed_as_that_of_a_new_job(doc, machine):
    from freecad_am.core.kinematics.proposed_cell import cell_of

    assert api.result(api.make_cell(doc, machine=machine)) == cell_of(machine)
    given = api.result(
        api.make_cell(doc, machine=machine, deposition_point=(1000, 0, 700, 0, 0, 0))
    )
    assert given.deposition_point == (1000.0, 0.0, 700.0, 0.0, 0.0, 0.0)
    assert api.result(api.make_cell(doc)) == CellParameters()


@pytest.mark.parametrize(("up", "apart"), [(0.0, False), (1.4, False), (30.0, True)])
def test_a_named_substrate_far_below_is_reported(doc, up, apart):
    """Of every family that takes a substrate without looking for where it begins on it; no cell is needed."""
    slab = feature(doc, "Slab", Part.makeBox(60, 60, 10, V(-30, -30, -10)))
    block = feature(doc, "Block", Part.makeBox(30, 30, 10, V(-15, -15, up)))
    line = feature(doc, "Line", Part.makeLine(V(-10, 0, up), V(20, 0, up)))
    corners = [V(x, y, up) for x, y in ((-10, -10), (10, -10), (10, 10), (-10, 10), (-10, -10))]
    sheet = feature(doc, "Sheet", Part.Face(Part.makePolygon(corners)))
    for made in (
        api.make_solid_feature(doc, block, substrate=slab),
        api.make_curves_feature(doc, line, substrate=slab),
        api.make_cladding_feature(doc, sheet, substrate=slab),
    ):
        found = [issue for issue in api.issues(made) if issue.code == "ABOVE_SUBSTRATE"]
        assert bool(found) == apart
        assert all(
            one.level == "warning" and "the smallest gap is 30 mm" in one.message for one in found
        )
    toolpath = api.make_toolpath(doc, api.make_solid_feature(doc, block, substrate=slab))
    assert ("ABOVE_SUBSTRATE" in codes(toolpath)) == apart


def test_a_search_for_remedies_stops_in_time(doc):
    """Out of reach; what was tried by then is told."""
    ring = doc.addObject("Part::Cylinder", "Ring")
    ring.Radius, ring.Height = 60, 4
    doc.recompute()
    skin = feature(
        doc, "Skin", next(f for f in ring.Shape.Faces if f.Surface.TypeId.endswith("Cylinder"))
    )
    cell = api.make_cell(doc, platform_diameter=0, deposition_point=(5000, 0, 900, 0, 0, 0))
    made = api.make_feature(doc, skin, layer_height=2, chord_error=1)
    toolpath = api.make_toolpath(doc, made, cell)
    path = api.make_joint_path(doc, toolpath, cell)
    assert path.Status == "infeasible"
    job = path.Proxy.job(path)
    asked = Tried(
        job.toolpath,
        job.settings,
        job.folders,
        job.process,
        job.parameters,
        cylinders=(),
        look=look,
    )
    planned = api.result(path).joint_path
    calls = []

    def slow(share, text):
        calls.append(text)
        time.sleep(0.2)

    started = time.monotonic()
    (note,) = remedies(asked, planned, planned.issues, slow, longest=0.5)
    assert note.code == "NO_REMEDY" and "stopped after" in note.message
    assert len(calls) <= 4 and time.monotonic() - started < 30.0


def test_a_wrist_of_which_no_shape_is_known_is_warned_about(doc):
    """The forearm of the default robot is hollow and forked: what is drawn of it is no proof that the platform hits it."""
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1, ball.Angle2 = 45, 0, 90
    doc.recompute()
    cell = api.make_cell(doc)
    toolpath = api.make_toolpath(doc, api.make_feature(doc, ball, layer_height=10), cell)
    path = api.make_joint_path(doc, toolpath, cell)
    assert path.Status == "up to date"
    (near,) = (one for one in api.issues(path) if one.code == "ARM_NEAR" and one.level == "warning")
    assert "q4" in near.message and "platform" in near.message and near.layer is not None


def test_the_flange_tells_what_of_a_forearm_is_not_there():
    def passes(name, share):
        robot = machines.load(name, ())
        link = external_links.robot_cylinders(robot.chain)[4]
        inner = [dataclasses.replace(one, radius=share * one.radius) for one in link]
        return flange_passes(robot, [round_solid(one, 0.0) for one in inner])

    assert passes("fanuc-arcmate120ic", 0.5) and not passes("fanuc-arcmate120ic", CORE)
    assert passes("fanuc-m10-8-20d", 0.001)  # its arm is bent aside, its wrist turns by 180 deg
    assert not passes("abb-irb1600-8-145", 0.5)
