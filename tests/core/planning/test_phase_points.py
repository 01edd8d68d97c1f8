# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points where starts and ends of beads begin or end, on a long straight bead of two points:
PyKDL's arm reaches them, with the conditioning of its Jacobian, within limits and speeds;
infeasible phases are detected."""

import numpy as np

from freecad_am import kdl
from freecad_am.core.issues import ERROR
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, BeadEnds, Layer, Toolpath
from tests.core.planning.test_random_cells import LENGTH
from tests.posts.planned_jobs import SETUPS

BEAD_LENGTH_MM, STEP = 400.0, 1e-6


def condition(arm, cell, joints):
    """The ratio of the singular values of the Jacobian of the tip of a tool on the robot, by
    differences."""

    def tip_at(values):
        return arm.forward(values[None])[0] @ cell.poses.carried

    tip, columns = tip_at(joints), []
    for axis in STEP * np.eye(6):
        up, down = tip_at(joints + axis), tip_at(joints - axis)
        turn, velocity = (
            (up - down)[:3, :3] @ tip[:3, :3].T / (2.0 * STEP),
            (up - down)[:3, 3] / (2.0 * STEP) / LENGTH,
        )
        columns.append([*velocity, turn[2, 1], turn[0, 2], turn[1, 0]])
    values = np.linalg.svd(np.array(columns), compute_uv=False)
    return values[-1] / values[0]


def planned(*ends):
    """The cell and the joint path of a straight bead with these ends."""
    up = np.broadcast_to([0.0, 0.0, 1.0], (2, 3))
    points = np.array([[-0.5 * BEAD_LENGTH_MM, 30.0, 0.0], [0.5 * BEAD_LENGTH_MM, 30.0, 0.0]])
    bead_ends = BeadEnds(*ends) if ends else None
    bead = Bead(points, up, up, np.array([0.0, 6.0]), np.full(2, 20.0), False, ends=bead_ends)
    path = Toolpath((Layer((bead,)),), np.eye(4), 2.0, 0.5, family="surface")
    cell = cells.resolve(SETUPS["fanuc tool-on-robot"].cell, np.eye(4), "developable")
    return cell, plan_joints(path, cell, JointParameters(degree=0))


def test_points_of_phases_have_the_condition_of_where_they_are():
    """Points of phases have the condition of their own position."""
    cell, path = planned(90.0, 5.0, 140.0, 60.0)
    assert path.feasible, path.issues
    (bead,) = path.beads
    assert len(bead.bead) - len(planned()[1].beads[0].bead) == 2
    arm = kdl.KdlArm(cell.machine)
    np.testing.assert_allclose(
        [condition(arm, cell, row) for row in bead.joints], bead.condition, atol=1e-7
    )
    stations = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.bead.points, axis=0), axis=1))]
    for border in (90.0, stations[-1] - 140.0):
        new = int(np.abs(stations - border).argmin())
        assert abs(stations[new] - border) < 0.02 and bead.condition[new] > 0.0
        between = np.interp(
            stations[new], stations[[new - 1, new + 1]], bead.condition[[new - 1, new + 1]]
        )
        assert (
            abs(bead.condition[new] - between) > 1e-6
        )  # interpolation between its neighbours would differ
    flange = arm.forward(bead.joints)
    tip = (cell.poses.mount @ np.linalg.inv(cell.poses.station) @ flange @ cell.poses.carried)[
        :, :3, 3
    ]
    np.testing.assert_allclose(tip, bead.bead.points, atol=1e-6)


def test_an_end_that_axes_cannot_follow_is_found():
    cell, path = planned(0.0, 0.0, 40.0, 20.0)
    assert path.feasible
    (bead,) = path.beads
    turned = np.abs(np.diff(bead.joints, axis=0))
    length = np.linalg.norm(np.diff(bead.bead.points, axis=0), axis=1)
    able = (cell.machine.max_speed / np.maximum(turned / length[:, None], 1e-12)).min(
        axis=1
    )  # mm/s on each segment
    late = 1.05 * able[-1]
    cell, path = planned(0.0, 0.0, 40.0, float(late))
    (issue,) = [issue for issue in path.issues if issue.level == ERROR]
    assert (
        issue.code == "SPEED" and f"lower the travel speed to {able[-1]:.2f} mm/s" in issue.message
    )
    assert planned(0.0, 0.0, 40.0, float(0.99 * able[-1]))[1].feasible
