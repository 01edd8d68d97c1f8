# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans keep links and nozzle clear of the positioner, checked against points within the boxes of
its file."""

import dataclasses
import json

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, Issue, Text
from freecad_am.core.kinematics.cell import CellShapes
from freecad_am.core.kinematics.external import MECHANISMS
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.kinematics.links.self_collision import NONE
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning import nozzle_obstacles
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.preflight import clearance
from freecad_am.core.simulation.watch import arm_touches
from tests.core.kinematics.test_external_links import STEP, bodies_of, points_within
from tests.core.planning.test_external_axes import POSITIONER, cell_for, levelled_to

CLEARANCE_MM = 10.0  # mm
SHORT_NOZZLE = NozzleParameters(
    tool=(0.0, 0.0, 90.0, 0.0, 0.6, 0.0)
)  # the arm comes near the table with it


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 10.0, chord_error=0.1), 10.0)


@pytest.fixture(scope="module")
def cell(hemisphere):
    return cell_for(hemisphere, nozzle=SHORT_NOZZLE)


def off_rod(points, rod):
    """Distances (n,) in mm of points from a capsule."""
    axis = (rod.end - rod.start) / rod.length
    along = (points - rod.start) @ axis
    out = np.linalg.norm(points - rod.start - along[:, None] * axis, axis=1) - rod.radius
    return np.hypot(np.maximum(out, 0.0), np.maximum(np.maximum(-along, along - rod.length), 0.0))


def nearest(cell, joints, rods):
    """Least distance (mm) over joint positions (k, axes) of points within the positioner's boxes
    from the capsules of the links. A group of points farther away than the current minimum is
    skipped."""
    links, frames_in_part = cell.links(joints), cell.external_link_frames(joints)
    balls = []
    for points in bodies_of(POSITIONER):
        groups = [points[k : k + 200] for k in range(0, len(points), 200)]
        middles = np.array([group.mean(axis=0) for group in groups])
        balls.append(
            (
                groups,
                middles,
                [
                    np.linalg.norm(group - centre, axis=1).max()
                    for group, centre in zip(groups, middles)
                ],
            )
        )
    minimum = np.inf
    for k in range(len(joints)):
        for body, (groups, middles, radii) in enumerate(balls):
            for link in range(1, 7):
                to_link = np.linalg.inv(links[k, link]) @ frames_in_part[k, body]
                placed = middles @ to_link[:3, :3].T + to_link[:3, 3]
                for rod in rods[link]:
                    bound = off_rod(placed, rod) - radii
                    for ball in np.argsort(bound):
                        if bound[ball] > minimum:
                            break
                        inside = groups[ball] @ to_link[:3, :3].T + to_link[:3, 3]
                        minimum = min(minimum, float(off_rod(inside, rod).min()))
    return minimum


def test_with_clearance_the_links_stay_off_a_positioner_that_they_touch_without(hemisphere, cell):
    """Links that touch a positioner keep clear of it with the key."""
    rods = external_links.robot_cylinders(cell.robot.chain)
    plain = plan_joints(hemisphere, cell, JointParameters())
    assert plain.feasible and nearest(cell, plain.joints[::9], rods) < CLEARANCE_MM
    cell_with_clearance = dataclasses.replace(cell, arm_clearance=CLEARANCE_MM)
    path = plan_joints(hemisphere, cell_with_clearance, JointParameters(), cylinders=rods)
    assert path.feasible and nearest(cell, path.joints[::5], rods) > CLEARANCE_MM - 0.5
    motion, rapids = assemble(
        path, cell_with_clearance, ProcessParameters(), hemisphere.surroundings, None, 10.0, rods
    )
    assert (
        not rapids and nearest(cell, motion.joints[~motion.deposit][::7], rods) > CLEARANCE_MM - 0.5
    )


def rotate_axis(joints, count, axis, angle):
    """Joint positions (count, axes) that rotate one axis by an angle."""
    repeated = np.tile(joints, (count, 1))
    repeated[:, axis] += np.linspace(0.0, angle, count)
    return repeated


def test_a_nozzle_driven_into_the_positioner_is_told_with_its_link_and_on_the_preflight(
    hemisphere, cell
):
    """With the table as planned and the arm lowered, the nozzle passes through the table."""
    path = plan_joints(hemisphere, cell, JointParameters())
    motion, _ = assemble(path, cell, ProcessParameters(), hemisphere.surroundings, None, 10.0)
    assert nozzle_obstacles.findings(motion, cell) == []
    rows = np.flatnonzero(motion.deposit)[-40:]
    lowered = rotate_axis(motion.joints[rows[0]], 40, 1, np.radians(14.0))
    joints = motion.joints.copy()
    joints[rows] = lowered
    wrong = dataclasses.replace(motion, joints=joints)
    findings = nozzle_obstacles.findings(wrong, cell)
    frames_of_table = cell.external_link_frames(lowered)[:, 2]
    tip = cell.machine.chain.forward(lowered) @ cell.poses.carried
    tips_in_table = (np.linalg.inv(frames_of_table) @ tip)[:, :3, 3]
    shapes = json.loads((MECHANISMS / f"{POSITIONER}.json").read_text(encoding="utf-8"))["bodies"][
        "joint_2"
    ]
    within = np.concatenate([points_within(shape) for shape in shapes])
    gap = np.linalg.norm(tips_in_table[:, None] - within[None], axis=2).min(axis=1)
    assert (gap < STEP).any()  # the nozzle does enter it
    assert {issue.code for issue in findings} == {"CLEARANCE"}
    assert any("Yaskawa MotoPos D500 e2" in issue.message for issue in findings)
    touches = arm_touches(wrong, ArmContact(cell, external_links.robot_cylinders(cell.robot.chain)))
    (row,) = clearance.external_links(wrong, cell, touches, True, findings)
    assert row.ok is False and row.worst > 0 and (touches.link != NONE).any()
    assert "they touch Yaskawa MotoPos D500" in row.how


def test_what_is_not_known_of_the_shapes_is_said_on_the_preflight(hemisphere):
    """The preflight states which shapes are unknown."""
    cell = cell_for(hemisphere)
    path = plan_joints(hemisphere, cell, JointParameters())
    motion, _ = assemble(path, cell, ProcessParameters(), hemisphere.surroundings, None, 10.0)
    touches = arm_touches(
        motion, ArmContact(cell, external_links.robot_cylinders(cell.robot.chain))
    )
    assert [
        promise.ok for promise in clearance.external_links(motion, cell, touches, True, ())
    ] == [True]
    # issues are matched by values, not by words: a name within a sentence, or a different name,
    # does not count
    name = cell.shapes.external_links[-1].name
    for message, ok in (
        (Text("the nozzle would meet {}", Text.joined(", ", ("post", name))), False),
        (f"the nozzle touches the cover of {name}", True),
        (Text("it meets {}", f"{name} cover"), True),
    ):
        issue = Issue(ERROR, "RAPID_COLLISION", message)
        assert [
            promise.ok
            for promise in clearance.external_links(motion, cell, touches, True, (issue,))
        ] == [ok]
    (drawn,) = clearance.external_links(motion, cell, touches, False, ())
    assert drawn.ok is None and drawn.how.startswith(
        "not checked in full, because the links of the robot are drawn from the kinematics only"
    )
    blank = dataclasses.replace(cell, shapes=CellShapes())
    touches = arm_touches(motion, ArmContact(blank, [[] for _ in range(7)]))
    (none,) = clearance.external_links(motion, blank, touches, True, ())
    assert none.ok is None and "no file describes the shape of Yaskawa MotoPos D500" in none.how
