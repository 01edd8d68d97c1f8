# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads of few points, whose rotation could make whole turns between two of them, as executed."""

import numpy as np
import pytest

from freecad_am import kdl
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.toolpath import Bead, Layer, Toolpath

TURN, UP = 2.0 * np.pi, np.array([0.0, 0.0, 1.0])


def straight(start, end, count):
    """A bead of `count` points on a line, with an upright tool."""
    share = np.linspace(0.0, 1.0, count)
    points = start + share[:, None] * (end - start)
    up = np.tile(UP, (count, 1))
    return Bead(points, up, up, TURN * share, np.full(count, 10.0), False)


@pytest.mark.parametrize("seed", range(3))
def test_points_that_are_added_lie_between_their_neighbours(seed):
    """Added points are between their neighbours in rotation."""
    draw = np.random.default_rng(seed)
    beads = []
    for layer in range(3):
        ends = np.c_[draw.uniform(-60.0, 60.0, (6, 2)), np.full(6, 5.0 + layer)].reshape(3, 2, 3)
        beads += [straight(*pair, int(draw.integers(2, 4))) for pair in ends]
    toolpath = Toolpath(
        tuple(Layer((bead,)) for bead in beads), np.eye(4), 1.0, 1e-4, family="surface"
    )
    parameters = CellParameters(
        setup="tool-on-robot", deposition_point=(900.0, 0.0, 100.0, 0.0, 0.0, 0.0)
    )
    cell = cells.resolve(parameters, toolpath.frame, toolpath.family)
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert joint_path.feasible, joint_path.issues
    arm, added = kdl.KdlArm(cell.machine), 0
    for path, bead in zip(joint_path.beads, beads):
        flange = arm.forward(path.joints)
        added += len(flange) - len(bead)
        # the frame about the tool axis from point to point: the sum of rotations is no larger than
        # the rotation from end to end
        step = np.einsum("nji,njk->nik", flange[:-1, :3, :3], flange[1:, :3, :3])
        turned = np.arccos(np.clip(0.5 * (np.trace(step, axis1=1, axis2=2) - 1.0), -1.0, 1.0))
        point_indices = np.linalg.norm(path.bead.points[:, None] - bead.points, axis=2).argmin(
            axis=0
        )
        for a, b in zip(point_indices[:-1], point_indices[1:]):
            total_rotation = flange[a, :3, :3].T @ flange[b, :3, :3]
            total_angle = np.arccos(np.clip(0.5 * (np.trace(total_rotation) - 1.0), -1.0, 1.0))
            assert turned[a:b].sum() <= total_angle + 1e-3
    assert added > len(beads)
