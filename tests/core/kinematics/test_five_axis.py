# SPDX-License-Identifier: LGPL-2.1-or-later
"""Five-axis machines: PyKDL and the controller's formulas return the inverse solutions to the
torch."""

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.chain import Chain
from freecad_am.core.kinematics.inverse.five_axis import FiveAxis
from freecad_am.core.kinematics.machines import machine
from freecad_am.kdl import KdlArm, available

NAMES = ["table-xyzac", "table-xyzbc", "head-table-xyzbc", "head-xyzab"]


def random_poses(seed, n=300):
    rng = np.random.default_rng(seed)
    tools = rng.normal(size=(n, 3))
    return rng.uniform(-150, 150, (n, 3)), tools / np.linalg.norm(tools, axis=1)[:, None]


def station(seed):
    """A torch in an arbitrary pose."""
    rng = np.random.default_rng(seed)
    return frames.pose(
        frames.smallest_rotation(
            (0, 0, 1), np.array([0.1, -0.2, 0.97]) / np.linalg.norm([0.1, -0.2, 0.97])
        ),
        rng.uniform(-20, 20, 3),
    )


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("torch", [np.eye(4), station(1)], ids=["upright", "askew"])
def test_both_branches_hold_point_and_direction_at_the_torch(name, torch):
    """Both solutions bring point and direction to the torch."""
    model = machine.load(name)
    points, tools = random_poses(2)
    solutions = FiveAxis(model.chain).inverse(points, tools, torch)
    forward = KdlArm(model).forward if available() else model.chain.forward
    real = np.isfinite(solutions.axes).all(axis=(0, 2))
    assert real.all() if name != "head-xyzab" and torch is np.eye(4) else real.sum() > 100
    for branch in solutions.axes:
        flange = forward(branch[real])
        positions = np.einsum("nij,nj->ni", flange[:, :3, :3], points[real]) + flange[:, :3, 3]
        np.testing.assert_allclose(positions, np.tile(torch[:3, 3], (real.sum(), 1)), atol=1e-9)
        directions_at_torch = np.einsum("nij,nj->ni", flange[:, :3, :3], tools[real])
        np.testing.assert_allclose(
            directions_at_torch, np.tile(torch[:3, 2], (real.sum(), 1)), atol=1e-11
        )


def test_a_chain_turned_about_anyhow():
    """Joint frames in a file need not be parallel to each other."""
    # joint frames that are not parallel to each other, as in some files
    rng = np.random.default_rng(5)
    origins = frames.from_rpy(rng.uniform(-50, 50, (5, 3)), rng.uniform(-1, 1, (5, 3)))
    directions = np.array([[1, 0, 0], [0, 0, 1], [0, 1, 0], [0, 1, 0], [0, 0, 1]], float)
    chain = Chain(origins, directions, np.eye(4), np.array([True, False, True, True, False]))
    points, tools = random_poses(6)
    solutions = FiveAxis(chain).inverse(points, tools, station(7))
    real = np.isfinite(solutions.axes[0]).all(axis=1)
    assert real.sum() > 50
    for branch in solutions.axes:
        flange = chain.forward(branch[real])
        positions = np.einsum("nij,nj->ni", flange[:, :3, :3], points[real]) + flange[:, :3, 3]
        np.testing.assert_allclose(
            positions, np.tile(station(7)[:3, 3], (real.sum(), 1)), atol=1e-8
        )


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("axis", [0, 1])
def test_a_locked_axis_leaves_the_residual_it_says(name, axis):
    """With one axis locked, the reported residual is reached and is the least."""
    model = machine.load(name)
    five = FiveAxis(model.chain)
    points, tools = random_poses(8)
    locked = five.locked(axis, 0.3, tools, np.array([0.0, 0.0, 1.0]))
    turned = np.full((len(points), 2), 0.3)
    turned[:, 1 - axis] = locked.angle
    axes = five.place_points(turned, points, np.eye(4))
    flange = model.chain.forward(axes)
    np.testing.assert_allclose(
        np.einsum("nij,nj->ni", flange[:, :3, :3], points) + flange[:, :3, 3], 0.0, atol=1e-9
    )
    directions_at_torch = np.einsum("nij,nj->ni", flange[:, :3, :3], tools)
    np.testing.assert_allclose(np.cos(locked.residual), directions_at_torch[:, 2], atol=1e-12)
    # no step of the other axis reduces the residual
    for step in (-0.01, 0.01):
        stepped = turned.copy()
        stepped[:, 1 - axis] += step
        moved = model.chain.forward(five.place_points(stepped, points, np.eye(4)))
        assert (
            np.einsum("nij,nj->ni", moved[:, :3, :3], tools)[:, 2]
            <= directions_at_torch[:, 2] + 1e-12
        ).all()


def test_a_robot_is_none():
    with pytest.raises(ValueError, match="three axes that slide"):
        FiveAxis(machine.load("fanuc-arcmate120ic").chain)
