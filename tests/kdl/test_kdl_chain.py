# SPDX-License-Identifier: LGPL-2.1-or-later
"""PyKDL agrees with the kinematics of every machine."""

import numpy as np
import pytest

from freecad_am.core.kinematics.jacobian import jacobian
from freecad_am.core.kinematics.machines import machine
from freecad_am.kdl import SOLVERS, KdlArm, available
from tests.core.kinematics.arms import EXAMPLES

pytestmark = pytest.mark.skipif(not available(), reason="PyKDL is not installed")


@pytest.fixture(params=EXAMPLES)
def arm(request):
    return machine.load(request.param)


def joints(count, seed, axes=6):
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, axes))


def test_flange_poses_agree(arm):
    q = joints(100, 1, len(arm.axes))
    expected = KdlArm(arm).forward(q)
    assert np.abs(arm.chain.forward(q) - expected).max() < 1e-9
    if arm.opw is not None:
        assert np.abs(arm.opw.forward(q) - expected).max() < 1e-9


def test_joints_that_stand_still_for_a_while_are_seen_where_they_are():
    """Each row is independent of the rows before it."""
    arm = machine.load("fanuc-arcmate120ic")
    rng = np.random.default_rng(4)
    q = joints(60, 4)
    for row in range(1, 60):
        still = rng.random(6) < 0.7
        q[row, still] = q[row - 1, still]
    poses = KdlArm(arm).forward(q)
    assert np.array_equal(
        poses, np.concatenate([KdlArm(arm).forward(joints[None]) for joints in q])
    )
    assert np.abs(arm.chain.forward(q) - poses).max() < 1e-9


def test_jacobians_agree(arm):
    q = joints(100, 2, len(arm.axes))
    flange = arm.chain.forward(q)[:, :3, 3]
    assert np.abs(jacobian(arm.chain, q, flange) - KdlArm(arm).jacobian(q)).max() < 1e-9


@pytest.mark.parametrize("solver", SOLVERS)
def test_numeric_inverse_ends_in_the_closed_form(solver):
    """From a nearby seed, PyKDL's solvers find the configuration that the closed form names."""
    arm = machine.load("fanuc-arcmate120ic")
    rng = np.random.default_rng(3)
    q = rng.uniform((-1, -0.5, -0.5, -1, 0.5, -1), (1, 0.5, 0.5, 1, 1.5, 1), (20, 6))
    poses = arm.chain.forward(q)
    joints = KdlArm(arm).inverse(poses, q + rng.uniform(-0.03, 0.03, q.shape), solver, 1e-10)
    closed = arm.opw.inverse(poses)[arm.opw.branch_of(q), np.arange(len(q))]
    # PyKDL treats such a small rotation as none, and LMA stops by its own weighting of mm and rad
    assert np.abs(joints - closed).max() < (1e-6 if solver == "nr" else 1e-4)


def test_unknown_solver_is_refused():
    with pytest.raises(ValueError, match="nr, lma"):
        KdlArm(machine.load("fanuc-arcmate120ic")).solver("newton")
