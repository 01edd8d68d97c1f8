# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job is ready only if arm and platform stay out of part and substrate, checked with samples
of the substrate and the frames of PyKDL chains; if the usual placement does not work, the job
proposes another."""

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
OUTER_RADIUS, INNER_RADIUS, HALF_LENGTH, BRANCH_RADIUS = 60.0, 52.0, 150.0, 25.0
WRIST = (
    # mm, a radius about their axes that the forearm and wrist of a robot of 20 kg certainly fill
    30.0
)


def feature(doc, name, shape):
    obj = doc.addObject("Part::Feature", name)
    obj.Shape = shape
    return obj


def pipe_and_branch(doc, up=0.0):
    """Return a pipe along X, its axis `up` above the origin, and a tube of one face on top of
    it."""
    bar, bore = (
        Part.makeCylinder(r, 2 * HALF_LENGTH, V(-HALF_LENGTH, 0, up), V(1, 0, 0))
        for r in (OUTER_RADIUS, INNER_RADIUS)
    )
    tube = Part.makeCylinder(BRANCH_RADIUS, 100.0, V(0, 0, up), V(0, 0, 1))
    skin = next(face for face in tube.Faces if face.Surface.TypeId == "Part::GeomCylinder")
    return feature(doc, "Pipe", bar.cut(bore)), feature(doc, "Branch", skin.cut(bar))


def samples(shape, step=6.0):
    """Return grid points in the pipe."""
    box = shape.BoundBox
    axes = [
        np.arange(low + 0.5, high, step)
        for low, high in ((box.XMin, box.XMax), (box.YMin, box.YMax), (box.ZMin, box.ZMax))
    ]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    radius = np.hypot(grid[:, 1] - box.Center.y, grid[:, 2] - box.Center.z)
    return grid[(radius > INNER_RADIUS) & (radius < OUTER_RADIUS)]


def deepest_in_wrist(path, solid):
    """Return how deep in mm points of a solid are inside of WRIST about the lines from the elbow to
    the wrist centre and from there to the flange, over the points of the beads of a joint path; the
    part is on the flange."""
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
        part_points = (hung @ flange.T)[:, :3]
        for start, end in ((elbow, wrist), (wrist, flange[:3, 3])):
            segment = end - start
            share = (part_points - start) @ segment / (segment @ segment)
            distances = np.linalg.norm(part_points - start - share[:, None] * segment, axis=1)
            distances[(share < 0.0) | (share > 1.0)] = np.inf  # the flange ends there
            deepest = max(deepest, WRIST - float(distances.min()))
    return deepest


def in_plate(settings, solid, frame):
    """Return how many points of a solid are in the plate between flange and platform."""
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

    # at the earlier placement; other tests cover the remedies
    monkeypatch.setattr("freecad_am.objects.joint_path.remedies", lambda *_: [])
    api.change(cell, platform=5.0, platform_diameter=113.0)
    assert path.Status == "infeasible" and program.Status != "up to date"
    assert in_plate(api.result(cell), pipe.Shape, np.eye(4)) > 0
    assert {"PLATFORM_COLLISION", "ARM_COLLISION"} <= codes(path)
    assert deepest_in_wrist(path, pipe.Shape) > 10.0
    with pytest.raises(InputError):
        api.export(program, "/nowhere")

    # without a plate only the arm is in it, which is an error with link and position
    api.change(cell, platform_diameter=0.0)
    (collision,) = (issue for issue in api.issues(path) if issue.code == "ARM_COLLISION")
    assert "PLATFORM_COLLISION" not in codes(path)
    assert "Pipe" in collision.message and collision.layer is not None and has_errors([collision])


def test_a_pipe_above_the_platform_keeps_the_usual_place(doc):
    pipe, branch = pipe_and_branch(doc, up=OUTER_RADIUS)
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
    settings, toolpath_result = api.result(cell), api.result(toolpath)
    assert "OVER_PLATFORM" not in codes(toolpath) and path.Status == "up to date"
    frame = toolpath_result.frame if settings.mount == "feature" else np.eye(4)
    points = np.vstack([bead.points for bead in toolpath_result.layers[0].beads])
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
    """A shifted motion whose nearest axis is 0.2 deg from its limit gives a warning, at 0.7 deg
    none."""
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1 = 20, 0
    doc.recompute()
    *_, path, _ = api.make_all(doc, ball)
    planned, toolpath, settings = planned_of(path, "path")
    cell = cell_obstacles.resolved(settings, toolpath, ())
    joints = planned.motion.joints
    room = cell.limits.upper[0] - np.nanmax(joints[:, 0])
    for margin, reported in ((0.2, True), (0.7, False)):
        moved = joints.copy()
        moved[:, 0] += room - math.radians(margin)
        issues = margin_issues(dataclasses.replace(planned.motion, joints=moved), cell)
        issues = [issue for issue in issues if issue.message.startswith("q1 ")]
        assert [issue.code for issue in issues] == (["LOW_MARGIN"] if reported else [])
        if reported:
            row = int(np.nanargmax(moved[:, 0]))
            assert issues[0].layer == planned.motion.layer[row] and issues[0].level == "warning"
            assert "0.2 deg" in issues[0].message
    # in many plans the last axis is at its limit, which is reported too
    smallest = math.degrees(np.nanmin(cell.limits.upper[5] - np.abs(joints[:, 5])))
    assert any(issue_.message.startswith("q6 comes") for issue_ in api.issues(path)) == (
        smallest < 0.5
    )


@pytest.mark.parametrize("machine", ["kuka-kr16-2", "abb-irb2400-12-155"])
def test_a_cell_by_itself_is_placed_as_that_of_a_new_job(doc, machine):
    from freecad_am.core.kinematics.proposed_cell import cell_of

    assert api.result(api.make_cell(doc, machine=machine)) == cell_of(machine)
    cell_result = api.result(
        api.make_cell(doc, machine=machine, deposition_point=(1000, 0, 700, 0, 0, 0))
    )
    assert cell_result.deposition_point == (1000.0, 0.0, 700.0, 0.0, 0.0, 0.0)
    assert api.result(api.make_cell(doc)) == CellParameters()


@pytest.mark.parametrize(("up", "apart"), [(0.0, False), (1.4, False), (30.0, True)])
def test_a_named_substrate_far_below_is_reported(doc, up, apart):
    """Every family that takes a substrate without searching its start on it reports the gap,
    without a cell."""
    slab = feature(doc, "Slab", Part.makeBox(60, 60, 10, V(-30, -30, -10)))
    block = feature(doc, "Block", Part.makeBox(30, 30, 10, V(-15, -15, up)))
    line = feature(doc, "Line", Part.makeLine(V(-10, 0, up), V(20, 0, up)))
    corners = [V(x, y, up) for x, y in ((-10, -10), (10, -10), (10, 10), (-10, 10), (-10, -10))]
    sheet = feature(doc, "Sheet", Part.Face(Part.makePolygon(corners)))
    for planned_toolpath in (
        api.make_solid_feature(doc, block, substrate=slab),
        api.make_curves_feature(doc, line, substrate=slab),
        api.make_cladding_feature(doc, sheet, substrate=slab),
    ):
        issues = [
            issue for issue in api.issues(planned_toolpath) if issue.code == "ABOVE_SUBSTRATE"
        ]
        assert bool(issues) == apart
        assert all(
            issue_.level == "warning" and "the smallest gap is 30 mm" in issue_.message
            for issue_ in issues
        )
    toolpath = api.make_toolpath(doc, api.make_solid_feature(doc, block, substrate=slab))
    assert ("ABOVE_SUBSTRATE" in codes(toolpath)) == apart


def test_a_search_for_remedies_stops_in_time(doc):
    """The part is out of reach; the message names the remedies tried by then."""
    ring = doc.addObject("Part::Cylinder", "Ring")
    ring.Radius, ring.Height = 60, 4
    doc.recompute()
    skin = feature(
        doc, "Skin", next(f for f in ring.Shape.Faces if f.Surface.TypeId.endswith("Cylinder"))
    )
    cell = api.make_cell(doc, platform_diameter=0, deposition_point=(5000, 0, 900, 0, 0, 0))
    skin_feature = api.make_feature(doc, skin, layer_height=2, chord_error=1)
    toolpath = api.make_toolpath(doc, skin_feature, cell)
    path = api.make_joint_path(doc, toolpath, cell)
    assert path.Status == "infeasible"
    job = path.Proxy.job(path)
    candidate = Tried(
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
    (note,) = remedies(candidate, planned, planned.issues, slow, longest=0.5)
    assert note.code == "NO_REMEDY" and "stopped after" in note.message
    assert len(calls) <= 4 and time.monotonic() - started < 30.0


def test_a_wrist_of_which_no_shape_is_known_is_warned_about(doc):
    """The forearm of the default robot is hollow and forked, so its drawn shape does not prove a
    collision with the platform."""
    ball = doc.addObject("Part::Sphere", "Ball")
    ball.Radius, ball.Angle1, ball.Angle2 = 45, 0, 90
    doc.recompute()
    cell = api.make_cell(doc)
    toolpath = api.make_toolpath(doc, api.make_feature(doc, ball, layer_height=10), cell)
    path = api.make_joint_path(doc, toolpath, cell)
    assert path.Status == "up to date"
    (warning,) = (
        issue for issue in api.issues(path) if issue.code == "ARM_NEAR" and issue.level == "warning"
    )
    assert "q4" in warning.message and "platform" in warning.message and warning.layer is not None


def test_the_flange_tells_what_of_a_forearm_is_not_there():
    def passes(name, share):
        robot = machines.load(name, ())
        link = external_links.robot_cylinders(robot.chain)[4]
        inner = [dataclasses.replace(capsule, radius=share * capsule.radius) for capsule in link]
        return flange_passes(robot, [round_solid(capsule, 0.0) for capsule in inner])

    assert passes("fanuc-arcmate120ic", 0.5) and not passes("fanuc-arcmate120ic", CORE)
    assert passes("fanuc-m10-8-20d", 0.001)  # its arm is bent sideways, its wrist turns by 180 deg
    assert not passes("abb-irb1600-8-145", 0.5)
