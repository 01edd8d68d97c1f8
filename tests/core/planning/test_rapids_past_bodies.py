# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rapids and obstacles around the part: obstacles are detected, and avoided where possible."""

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import has_errors
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.simulation import rapid_contacts


def spike(centre, size, name):
    vertices = centre + size * np.array(
        [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float
    )
    return Body(name, vertices, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))


@pytest.fixture(scope="module")
def planned(sliced, cell_of):
    toolpath = sliced("sphere", 10.0)
    cell = cell_of(toolpath)
    return cell, plan_joints(toolpath, cell, JointParameters())


def collisions(motion, cell, path, bodies):
    """(layer, bead) of the beads whose preceding rapids touch an obstacle, by a check independent
    of planning."""
    contacts = rapid_contacts.looked_at(
        motion, [bead_path.bead for bead_path in path.beads], cell, bodies, 0.0, 0.0, 200_000
    )
    assert contacts.step == 0.5
    return {(int(motion.layer[row]), int(motion.bead[row])) for row in contacts.rows}


def travels_of(motion):
    """The rows that end a travel between two beads; approaches do not count."""
    rows = np.flatnonzero(~motion.deposit[1:] & ~motion.deposit[:-1]) + 1
    return rows[~np.append(motion.deposit[1:], False)[rows]]


def looks(motion, cell, row, count=400):
    """Tip and axis at many positions on the move to a row."""
    share = np.linspace(0, 1, count)[:, None]
    joints = motion.joints[row - 1] + share * (motion.joints[row] - motion.joints[row - 1])
    return cell.tip_in_part(cell.machine.chain.forward(joints))


def inside(point, tip, axis, nozzle):
    offset = point - tip
    x = (offset * axis).sum(axis=1)
    side = np.linalg.norm(offset - x[:, None] * axis, axis=1)
    return (
        (x > 0)
        & (x < nozzle.length)
        & (side < 0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * x)
    ).any()


def test_a_body_in_the_way_is_found_and_one_beside_it_is_not(planned):
    """An obstacle on the way is detected, and one next to it is not."""
    cell, joint_path = planned
    motion, issues = assemble(joint_path, cell, ProcessParameters())
    assert not issues
    travels = travels_of(motion)
    for row in travels[:4]:
        tip, axis = looks(motion, cell, row)
        centre = tip[200] + 30.0 * axis[200]
        body = spike(centre, 0.3, "clamp")
        detected = collisions(motion, cell, joint_path, [body])
        expected = {
            (int(motion.layer[k]), int(motion.bead[k]))
            for k in np.flatnonzero(~motion.deposit[1:]) + 1
            if any(inside(corner, *looks(motion, cell, k), cell.nozzle) for corner in body.vertices)
        }
        assert (int(motion.layer[row]), int(motion.bead[row])) in expected and detected == expected
        assert not collisions(motion, cell, joint_path, [spike(centre + [0, 0, 400], 0.3, "clamp")])


def test_the_tool_is_withdrawn_further_to_pass_a_body_or_it_says_so(planned):
    cell, joint_path = planned
    motion, _ = assemble(joint_path, cell, ProcessParameters())
    row = travels_of(motion)[0]
    tip, axis = looks(motion, cell, row)
    low = spike(tip[200] + 1.0 * axis[200], 0.2, "pin")
    passed, issues = assemble(joint_path, cell, ProcessParameters(), [low])
    assert not has_errors(issues) and [issue.code for issue in issues] == ["RAPID_LIFTED"]
    for k in travels_of(passed):
        assert not inside(low.vertices.mean(axis=0), *looks(passed, cell, k), cell.nozzle)
    # far higher than eight times the retract distance, but still avoided
    little = ProcessParameters(between_layers=BetweenLayersParameters(lift=0.5))
    motion, _ = assemble(joint_path, cell, little)
    tip, axis = looks(motion, cell, travels_of(motion)[0])
    stack = [spike(tip[200] + height * axis[200], 0.2, "stack") for height in range(1, 15)]
    passed, issues = assemble(joint_path, cell, little, stack)
    assert [issue.code for issue in issues] == ["RAPID_LIFTED"]
    rows = travels_of(passed)
    lifted = np.linalg.norm(passed.position[rows] - passed.position[rows + 1], axis=1)
    assert lifted.max() > 8.0 * 0.5 + 1.0
    for k in rows:
        for body in stack:
            assert not inside(body.vertices.mean(axis=0), *looks(passed, cell, k), cell.nozzle)
    # higher than the robot reaches
    wall = [spike(tip[200] + height * axis[200], 100.0, "wall") for height in range(15, 4000, 60)]
    _, issues = assemble(joint_path, cell, ProcessParameters(), wall)
    met = [issue for issue in issues if issue.code == "RAPID_COLLISION"]
    assert met and all("would hit " in issue.message and issue.layer is not None for issue in met)


def test_what_is_above_the_nozzle_counts_where_it_is_withdrawn_further_than_it_is_long(planned):
    """Obstacles above the nozzle count if the retract is longer than the nozzle."""
    cell, joint_path = planned
    lift = 1.5 * cell.nozzle.length
    high = ProcessParameters(between_layers=BetweenLayersParameters(lift=lift))
    motion, issues = assemble(joint_path, cell, high)
    assert not has_errors(issues)
    row = np.flatnonzero(motion.deposit[:-1] & ~motion.deposit[1:])[0]
    centre = motion.position[row] + (cell.nozzle.length + 0.25 * lift) * motion.tool[row]
    detected = collisions(motion, cell, joint_path, [spike(centre, 0.3, "beam")])
    assert (int(motion.layer[row + 1]), int(motion.bead[row + 1])) in detected
    # an obstacle next to the travel does not touch
    aside = np.cross(motion.tool[row], [1.0, 0.0, 0.0])
    assert not collisions(motion, cell, joint_path, [spike(centre + 3000.0 * aside, 0.3, "beam")])
