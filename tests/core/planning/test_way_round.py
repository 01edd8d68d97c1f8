# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rapids that no retract brings clear are led round what is in the way, or refused by its name. Judged by PyKDL's frames of
links and nozzle, at ten times as many places as were looked at."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import box
from freecad_am.core.geometry.step_count import spread_points
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics.cell import CellShapes
from freecad_am.core.motion import TRAVEL
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning import nozzle_obstacles
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.rapids import path_around_obstacles as sampled
from freecad_am.core.planning.rapids.path_around_obstacles import Ranges, way_round
from freecad_am.core.simulation import rapid_contacts
from freecad_am.core.toolpath import Layer, MotionRules, Toolpath
from tests.core.planning.test_arm_clearance import CELL, CLEARANCE, dome, planned
from tests.core.planning.test_obstacles import cell_with, nearest, nozzle_points
from tests.kdl_links import KdlLinks
from tests.posts import planned_jobs

__all__ = ["dome"]  # a fixture

SIZE = (240.0, 12.0, 1500.0)  # of a wall between beads, mm: no nozzle gets over it
WALL = frames.pose(np.eye(3), np.array([1020.0, 0.0, 640.0]))


def on_sides(dome, *across):
    """A bead along x at each place across it, mm."""
    x, up = np.linspace(-30.0, 30.0, 7), np.tile([0.0, 0.0, 1.0], (7, 1))
    beads = tuple(
        dataclasses.replace(
            dome.layers[0].beads[0],
            points=np.column_stack([x, 0.0 * x + y, 0.0 * x]),
            build=up,
            tool=up,
            parameter=x + 30.0,
            speed=np.full(7, 8.0),
            tangents=None,
            closed=False,
        )
        for y in across
    )
    return dataclasses.replace(
        dome, layers=(dataclasses.replace(dome.layers[0], beads=beads),), family="surface"
    )


def looked_at(motion):
    """Places of a motion where plans look: 2 deg of the joint that moves most apart."""
    rows = [motion.joints[:1]]
    for start, end in zip(motion.joints[:-1], motion.joints[1:]):
        count = int(np.ceil(np.degrees(np.abs(end - start).max()) / 2.0)) or 1
        rows.append(start + np.arange(1, count + 1)[:, None] / count * (end - start))
    return SimpleNamespace(joints=np.concatenate(rows))


def nozzle_near(motion, cell, poses, sizes):
    """The least mm between points on the nozzle, by PyKDL, and boxes at poses in the maker's base frame, at ten times as
    many places as plans look at."""
    arm, points, least = KdlLinks(cell.robot), nozzle_points(cell)[48:], np.inf
    joints = looked_at(motion).joints[:, : len(cell.robot.axes)]
    dense = np.concatenate(
        [joints[:-1] + share * np.diff(joints, axis=0) for share in np.linspace(0.1, 1.0, 10)]
    )
    for pose, size in zip(poses, sizes, strict=True):
        to_box = np.linalg.inv(cell.robot.base @ pose)
        for q in dense:
            place = to_box @ arm.frame(q)
            off = np.abs(points @ place[:3, :3].T + place[:3, 3]) - 0.5 * np.asarray(size)
            least = min(least, np.linalg.norm(np.maximum(off, 0.0), axis=1).min())
    return least


@pytest.mark.parametrize("clearance", [None, CLEARANCE])
@pytest.mark.always("None")
def test_rapids_are_led_round_a_wall_that_no_retract_gets_over(dome, monkeypatch, clearance):
    job = on_sides(dome, -60.0, 60.0)
    cell = cell_with(job, WALL, "wall", SIZE, **CELL, arm_clearance=clearance)
    motion, issues = planned(job, cell)
    assert not has_errors(issues) and "RAPID_ROUND" in {issue.code for issue in issues}
    # nothing is met, by others and by what looks at rapids alone
    assert nozzle_near(motion, cell, [WALL], [SIZE]) > 0.0
    beads = [bead for _, _, bead in job]
    assert not len(rapid_contacts.looked_at(motion, beads, cell, (), 0.0, 0.0, 50_000).rows)
    # within limits and speeds, and of one configuration: a program may tell places instead of joints
    assert not cell.limits.exceeded(motion.joints).any()
    rapid = 1 + np.flatnonzero(~motion.deposit[1:])
    speed = np.abs(motion.joints[rapid] - motion.joints[rapid - 1]) / motion.duration[rapid, None]
    assert (speed < cell.machine.max_speed).all()
    assert len(set(cell.machine.arm.branch_of(motion.joints))) == 1
    if clearance:
        assert (
            nearest(looked_at(motion), cell, WALL, np.full((1, 3), 1e5), SIZE, every=1).min()
            >= CLEARANCE
        )
        return
    # the same again, to the last bit
    assert (planned(job, cell)[0].joints == motion.joints).all()
    # and without: refused by the name of what is met
    monkeypatch.setattr(sampled, "ROUNDS", 0)
    told = [issue for issue in planned(job, cell)[1] if issue.level == "error"]
    assert {(issue.layer, issue.bead) for issue in told} == {(0, 1)}
    assert any(
        "the nozzle would hit" in issue.message and "wall" in issue.message for issue in told
    )


def test_what_cannot_be_led_round_is_refused_by_name(dome, monkeypatch):
    """Walls on all sides of one of two beads, and no way over them."""
    job = on_sides(dome, -60.0, 60.0)
    sizes = [
        (12.0, 112.0, 1500.0),
        (12.0, 112.0, 1500.0),
        (132.0, 12.0, 1500.0),
        (132.0, 12.0, 1500.0),
    ]
    at = [(940.0, 60.0), (1060.0, 60.0), (1000.0, 10.0), (1000.0, 116.0)]
    poses = [frames.pose(np.eye(3), np.array([x, y, 640.0])) for x, y in at]
    cell = cell_with(job, poses[0], "west", sizes[0], **CELL)
    names = ("west", "east", "south", "north")
    monkeypatch.setattr(sampled, "ROUNDS", 4)  # there is none however long it is looked for
    cell = dataclasses.replace(
        cell,
        shapes=CellShapes(
            tuple(
                box(size, pose, name) for size, pose, name in zip(sizes, poses, names, strict=True)
            )
        ),
    )
    _, issues = planned(job, cell)
    (told,) = [issue for issue in issues if issue.level == "error"]
    assert told.code == "RAPID_COLLISION" and (told.layer, told.bead) == (0, 1)
    assert "south" in told.message and "no detour was found" in told.message


@pytest.mark.long
def test_rapids_over_a_positioner_are_led_past_an_obstacle(monkeypatch):
    """The robot stands still beside it: where its nozzle is in the world is told by PyKDL's arm alone."""
    setup = planned_jobs.SETUPS["fanuc positioner"]
    cell, beads, motion = planned_jobs.planned("fanuc positioner")
    size, arm = (6.0, 6.0, 6.0), KdlLinks(cell.robot)
    for row in np.flatnonzero(motion.role == TRAVEL)[1:]:
        middle = 0.5 * (motion.joints[row - 1] + motion.joints[row])[: len(cell.robot.axes)]
        nozzle = np.linalg.inv(cell.robot.base) @ arm.frame(middle) @ cell.poses.carried
        pose = nozzle @ frames.pose(np.eye(3), np.array([0.0, 0.0, -30.0]))
        there = dataclasses.replace(cell, shapes=CellShapes((box(size, pose, "lamp"),)))
        if not nozzle_obstacles.findings(motion, there):  # it is in the way of travels alone
            break
    layers = tuple(Layer(tuple(beads[k : k + len(beads) // 2])) for k in (0, len(beads) // 2))
    toolpath = Toolpath(
        layers,
        np.eye(4),
        planned_jobs.HEIGHT,
        planned_jobs.CHORD_ERROR,
        family="developable",
        rules=MotionRules(max_from_vertical=setup.most),
    )
    path = plan_joints(toolpath, there, JointParameters(degree=1))

    def again():
        return assemble(
            path,
            there,
            planned_jobs.PROCESS,
            [planned_jobs.body(setup)],
            layer_height=planned_jobs.HEIGHT,
        )

    led, issues = again()
    assert not has_errors(issues)
    assert (
        nozzle_near(motion, cell, [pose], [size]) == 0.0 < nozzle_near(led, there, [pose], [size])
    )
    # one that is about all beads is refused by name
    there = dataclasses.replace(
        cell, shapes=CellShapes((box((400.0, 400.0, 400.0), pose, "lamp"),))
    )
    monkeypatch.setattr(sampled, "ROUNDS", 1)
    _, issues = again()
    assert any(issue.code == "RAPID_COLLISION" and "lamp" in issue.message for issue in issues)


def test_a_way_is_found_through_gaps_of_two_walls_and_is_short():
    """In the plane, where all is seen: two walls with a gap each, at opposite ends."""
    walls = [(3.0, (-1.0, 8.0)), (7.0, (2.0, 11.0))]

    def free(start, end):
        clear = np.ones(len(start), dtype=bool)
        for x, (low, high) in walls:
            across = (start[:, 0] - x) * (end[:, 0] - x) <= 0.0
            step = end[:, 0] - start[:, 0]
            y = start[:, 1] + (x - start[:, 0]) / np.where(step == 0.0, 1.0, step) * (
                end[:, 1] - start[:, 1]
            )
            clear &= ~(across & (y > low) & (y < high))
        return clear

    ranges = Ranges(np.zeros(2), np.full(2, 10.0), np.ones(2))
    start, end = np.array([1.0, 5.0]), np.array([9.0, 5.0])
    found = way_round(start, end, ranges, free, lambda place: np.ones(len(place), dtype=bool))
    whole = np.vstack([start, found, end])
    assert free(whole[:-1], whole[1:]).all()
    # by the axis that takes longest: 3 s up to the first gap, 6 s down to the second one, 3 s up again
    assert 12.0 <= ranges.lasts(whole[:-1], whole[1:]).sum() < 1.4 * 12.0
    closed = way_round(
        start,
        end,
        ranges,
        lambda a, b: (a[:, 0] - 5.0) * (b[:, 0] - 5.0) > 0.0,
        lambda p: p[:, 0] >= 0.0,
    )
    assert closed is None


def test_places_are_spread_evenly():
    places = spread_points(512, 6)
    assert ((places >= 0.0) & (places < 1.0)).all() and (
        places == spread_points(1024, 6)[:512]
    ).all()
    for axis in range(6):
        counts = np.histogram(places[:, axis], 8, (0.0, 1.0))[0]
        assert counts.min() > 0.7 * 64 and counts.max() < 1.2 * 64
