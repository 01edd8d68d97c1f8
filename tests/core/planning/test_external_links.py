# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans keep links and nozzle clear of the positioner: held against points within the boxes of its file."""

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

CLEAR = 10.0  # mm
SHORT = NozzleParameters(
    tool=(0.0, 0.0, 90.0, 0.0, 0.6, 0.0)
)  # the arm comes near to the table with it


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 10.0, chord_error=0.1), 10.0)


@pytest.fixture(scope="module")
def cell(hemisphere):
    return cell_for(hemisphere, nozzle=SHORT)


def off_rod(points, rod):
    """mm (n,), how far points are from a rod."""
    axis = (rod.end - rod.start) / rod.length
    along = (points - rod.start) @ axis
    out = np.linalg.norm(points - rod.start - along[:, None] * axis, axis=1) - rod.radius
    return np.hypot(np.maximum(out, 0.0), np.maximum(np.maximum(-along, along - rod.length), 0.0))


def nearest(cell, joints, rods):
    """mm, how far points within the positioner's boxes are from rods of the links, the least of all joints (k, axes); of
    points in balls that are farther than the least so far, none is nearer."""
    links, seen = cell.links(joints), cell.external_link_frames(joints)
    balls = []
    for points in bodies_of(POSITIONER):
        some = [points[k : k + 200] for k in range(0, len(points), 200)]
        middles = np.array([one.mean(axis=0) for one in some])
        balls.append(
            (
                some,
                middles,
                [np.linalg.norm(one - at, axis=1).max() for one, at in zip(some, middles)],
            )
        )
    least = np.inf
    for k in range(len(joints)):
        for body, (some, middles, radii) in enumerate(balls):
            for link in range(1, 7):
                to_link = np.linalg.inv(links[k, link]) @ seen[k, body]
                placed = middles @ to_link[:3, :3].T + to_link[:3, 3]
                for rod in rods[link]:
                    bound = off_rod(placed, rod) - radii
                    for ball in np.argsort(bound):
                        if bound[ball] > least:
                            break
                        inside = some[ball] @ to_link[:3, :3].T + to_link[:3, 3]
                        least = min(least, float(off_rod(inside, rod).min()))
    return least


def test_with_clearance_the_links_stay_off_a_positioner_that_they_touch_without(hemisphere, cell):
    rods = external_links.robot_cylinders(cell.robot.chain)
    plain = plan_joints(hemisphere, cell, JointParameters())
    assert plain.feasible and nearest(cell, plain.joints[::9], rods) < CLEAR
    kept = dataclasses.replace(cell, arm_clearance=CLEAR)
    path = plan_joints(hemisphere, kept, JointParameters(), cylinders=rods)
    assert path.feasible and nearest(cell, path.joints[::5], rods) > CLEAR - 0.5
    motion, rapids = assemble(
        path, kept, ProcessParameters(), hemisphere.surroundings, None, 10.0, rods
    )
    assert not rapids and nearest(cell, motion.joints[~motion.deposit][::7], rods) > CLEAR - 0.5


def turned(joints, count, axis, angle):
    """Joints (count, axes) on the way from some to the same with one axis turned by an angle."""
    found = np.tile(joints, (count, 1))
    found[:, axis] += np.linspace(0.0, angle, count)
    return found


def test_a_nozzle_driven_into_the_positioner_is_told_with_its_link_and_on_the_preflight(
    hemisphere, cell
):
    """The plan, with the table left as it is, and the arm lowered: the nozzle goes through the table."""
    path = plan_joints(hemisphere, cell, JointParameters())
    motion, _ = assemble(path, cell, ProcessParameters(), hemisphere.surroundings, None, 10.0)
    assert nozzle_obstacles.findings(motion, cell) == []
    rows = np.flatnonzero(motion.deposit)[-40:]
    lowered = turned(motion.joints[rows[0]], 40, 1, np.radians(14.0))
    joints = motion.joints.copy()
    joints[rows] = lowered
    wrong = dataclasses.replace(motion, joints=joints)
    told = nozzle_obstacles.findings(wrong, cell)
    seen = cell.external_link_frames(lowered)[:, 2]
    tip = cell.machine.chain.forward(lowered) @ cell.poses.carried
    at = (np.linalg.inv(seen) @ tip)[:, :3, 3]
    pieces = json.loads((MECHANISMS / f"{POSITIONER}.json").read_text(encoding="utf-8"))["bodies"][
        "joint_2"
    ]
    within = np.concatenate([points_within(piece) for piece in pieces])
    gap = np.linalg.norm(at[:, None] - within[None], axis=2).min(axis=1)
    assert (gap < STEP).any()  # it does go in
    assert {issue.code for issue in told} == {"CLEARANCE"}
    assert any("Yaskawa MotoPos D500 e2" in issue.message for issue in told)
    touches = arm_touches(wrong, ArmContact(cell, external_links.robot_cylinders(cell.robot.chain)))
    (row,) = clearance.external_links(wrong, cell, touches, True, told)
    assert row.ok is False and row.worst > 0 and (touches.link != NONE).any()
    assert "they touch Yaskawa MotoPos D500" in row.how


def test_what_is_not_known_of_the_shapes_is_said_on_the_preflight(hemisphere):
    far = cell_for(hemisphere)
    path = plan_joints(hemisphere, far, JointParameters())
    motion, _ = assemble(path, far, ProcessParameters(), hemisphere.surroundings, None, 10.0)
    touches = arm_touches(motion, ArmContact(far, external_links.robot_cylinders(far.robot.chain)))
    assert [one.ok for one in clearance.external_links(motion, far, touches, True, ())] == [True]
    # whether issues are about them is known by values, not by words: a name within a sentence, or another name, is none
    name = far.shapes.external_links[-1].name
    for message, ok in (
        (Text("the nozzle would meet {}", Text.joined(", ", ("post", name))), False),
        (f"the nozzle touches the cover of {name}", True),
        (Text("it meets {}", f"{name} cover"), True),
    ):
        issue = Issue(ERROR, "RAPID_COLLISION", message)
        assert [
            one.ok for one in clearance.external_links(motion, far, touches, True, (issue,))
        ] == [ok]
    (drawn,) = clearance.external_links(motion, far, touches, False, ())
    assert drawn.ok is None and drawn.how.startswith(
        "not checked in full, because the links of the robot are drawn from the kinematics only"
    )
    blank = dataclasses.replace(far, shapes=CellShapes())
    touches = arm_touches(motion, ArmContact(blank, [[] for _ in range(7)]))
    (none,) = clearance.external_links(motion, blank, touches, True, ())
    assert none.ok is None and "no file describes the shape of Yaskawa MotoPos D500" in none.how
