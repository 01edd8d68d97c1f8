# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jacobians and condition numbers against finite differences and LAPACK's singular values."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.kinematics import jacobian as jac
from freecad_am.core.kinematics.machines import machine

LENGTH = 1000.0


@pytest.fixture(params=["fanuc-arcmate120ic", "staubli-rx60bl", "kuka-kr16-2", "motoman-ar2010"])
def chain(request):
    return machine.load(request.param).chain


def joints_and_points(chain, count, seed=9):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-3, 3, (count, 6))
    return q, chain.forward(q)[:, :3, 3] + rng.uniform(-300, 300, (count, 3))


def carried(chain, q, points, moved):
    """Positions of `points`, fixed to the last link at `q`, when the joints are at `moved`, with
    the link's rotation there."""
    flange_before, flange_after = chain.forward(q), chain.forward(moved)
    local = np.linalg.solve(
        flange_before, np.concatenate((points, np.ones((len(points), 1))), axis=1)[..., None]
    )
    return (flange_after @ local)[:, :3, 0], flange_after[:, :3, :3]


def singular_values(jacobians, length=LENGTH):
    scaled = np.array(jacobians)
    scaled[:, :3] /= length
    return np.linalg.svd(scaled, compute_uv=False)


def test_columns_are_the_velocities_of_the_point_and_of_the_link(chain):
    """Columns are the velocities of the point and of the link."""
    q, points = joints_and_points(chain, 200)
    jacobians = jac.jacobian(chain, q, points)
    step = 1e-5
    for axis in range(6):
        change = step * np.eye(6)[axis]
        ahead, turned = carried(chain, q, points, q + change)
        behind, rotated_back = carried(chain, q, points, q - change)
        assert np.abs((ahead - behind) / (2 * step) - jacobians[:, :3, axis]).max() < 1e-4
        rotation = Rotation.from_matrix(turned @ rotated_back.transpose(0, 2, 1)).as_rotvec() / (
            2 * step
        )
        assert np.abs(rotation - jacobians[:, 3:, axis]).max() < 1e-7


def test_one_point_serves_all(chain):
    q, _ = joints_and_points(chain, 5)
    point = np.array((900.0, 100.0, 300.0))
    assert np.array_equal(
        jac.jacobian(chain, q, point), jac.jacobian(chain, q, np.tile(point, (5, 1)))
    )


@pytest.mark.parametrize("count", [1, 700, 3 * jac.BATCH_SIZE + 5])
def test_condition_is_the_ratio_of_singular_values(chain, count):
    jacobians = jac.jacobian(chain, *joints_and_points(chain, count))
    values = singular_values(jacobians)
    expected = values[:, -1] / values[:, 0]
    # computed from the squares of singular values: the error is the rounding unit divided by the
    # condition, or its root at zero
    error = np.abs(jac.condition(jacobians, LENGTH) - expected)
    assert (error * np.maximum(expected, 1e-7)).max() < 1e-14


def test_condition_knows_the_length(chain):
    jacobians = jac.jacobian(chain, *joints_and_points(chain, 50))
    for length in (1.0, 300.0):
        values = singular_values(jacobians, length)
        expected = values[:, -1] / values[:, 0]
        assert (
            np.abs(jac.condition(jacobians, length) - expected) * np.maximum(expected, 1e-7)
        ).max() < 1e-14


def test_condition_is_nought_at_a_singularity(chain):
    q, points = joints_and_points(chain, 50)
    q[:, 4] = 0.0
    jacobians = jac.jacobian(chain, q, points)
    assert jac.condition(jacobians, LENGTH).max() < 1e-7
    assert jac.condition_bound(jacobians, LENGTH).max() < 1e-7
    assert jac.manipulability(jacobians, LENGTH).max() < 1e-12


def test_bound_is_below_the_condition_and_near_it(chain):
    """The bound is below the condition and within a factor of six."""
    jacobians = jac.jacobian(chain, *joints_and_points(chain, 3000))
    values = singular_values(jacobians)
    bound, expected = jac.condition_bound(jacobians, LENGTH), values[:, -1] / values[:, 0]
    exact = 1.0 / np.sqrt((values**2).sum(axis=1) * (values**-2.0).sum(axis=1))
    # the rounding error of a nearly singular matrix is that of its inverse
    assert np.abs(bound / exact - 1.0).max() < 1e-15 * (1.0 / expected.min()) ** 2 + 1e-9
    assert (bound <= expected * (1.0 + 1e-6)).all()
    assert (expected <= 6.0 * bound * (1.0 + 1e-6)).all()


def test_rate_of_manipulability(chain):
    q, points = joints_and_points(chain, 300)
    rates = np.random.default_rng(2).standard_normal(q.shape)
    step = 1e-6
    measures = []
    for t in (-step, step):
        moved = q + t * rates
        jacobians = jac.jacobian(chain, moved, carried(chain, q, points, moved)[0])
        measures.append(np.prod(singular_values(jacobians), axis=1))
    expected = (measures[1] - measures[0]) / (2 * step)
    got = jac.manipulability_rate(jac.jacobian(chain, q, points), rates, LENGTH)
    assert np.abs(got - expected).max() < 1e-7


def test_rates_where_the_arm_is_singular_to_the_last_bit_are_not_numbers():
    flat = np.zeros((2, 6, 6))
    flat[1] = np.eye(6)
    rates = np.ones((2, 6))
    assert np.isnan(jac.manipulability_rate(flat, rates, LENGTH)).tolist() == [True, False]
    assert np.isnan(jac.condition_rate(flat, rates, LENGTH)).tolist() == [True, False]


def test_rate_is_the_derivative_along_the_joints(chain):
    q, points = joints_and_points(chain, 300)
    rates = np.random.default_rng(2).standard_normal(q.shape)
    step = 1e-6

    def condition_at(t):
        moved = q + t * rates
        values = singular_values(jac.jacobian(chain, moved, carried(chain, q, points, moved)[0]))
        return values[:, -1] / values[:, 0]

    expected = (condition_at(step) - condition_at(-step)) / (2 * step)
    # a difference is no derivative where the smallest two values coincide or almost vanish
    values = singular_values(jac.jacobian(chain, q, points))
    smooth = (
        (values[:, -1] > 1e-3)
        & (values[:, -2] > 1.05 * values[:, -1])
        & (values[:, 0] > 1.05 * values[:, 1])
    )
    assert smooth.sum() > 100
    got = jac.condition_rate(jac.jacobian(chain, q, points), rates, LENGTH)
    assert np.abs(got - expected)[smooth].max() < 1e-6
    assert np.isfinite(got).all()


def test_rate_about_the_tool_axis_is_that_of_a_point_held_in_space():
    """Like the tool rotation of a part on the robot: the point of the part at the deposition point
    does not move."""
    arm = machine.load("fanuc-arcmate120ic")
    q = np.random.default_rng(1).uniform(
        (-1, -0.5, -0.5, -1, 0.5, -1), (1, 0.5, 0.5, 1, 1.5, 1), (100, 6)
    )
    point = np.array((1045.747, -630.155, 1178.167))
    jacobians = jac.jacobian(arm.chain, q, point)
    axis = np.tile((0.0, 0.0, 0.0, 0.0, 0.0, 1.0), (100, 1))
    rates = np.linalg.solve(np.array(jacobians), axis[..., None])[..., 0]
    step = 1e-6
    conditions = [
        jac.condition(jac.jacobian(arm.chain, q + t * rates, point), LENGTH) for t in (-step, step)
    ]
    expected = (conditions[1] - conditions[0]) / (2 * step)
    assert (
        np.abs(jac.condition_rate(jacobians, rates, LENGTH) - expected).max()
        < 1e-5 * np.abs(expected).max()
    )


def test_manipulability(chain):
    jacobians = jac.jacobian(chain, *joints_and_points(chain, 500))
    expected = np.prod(singular_values(jacobians), axis=1)
    assert np.abs(jac.manipulability(jacobians, LENGTH) - expected).max() < 1e-12 * expected.max()


def test_unreachable_poses_are_nan_and_spoil_no_other():
    """Unreachable poses give NaN without affecting others."""
    arm = machine.load("fanuc-arcmate120ic")
    q, points = joints_and_points(arm.chain, 800)
    q[7] = np.nan
    for count in (20, 800):
        jacobians = jac.jacobian(arm.chain, q[:count], points[:count])
        reachable = np.delete(np.arange(count), 7)
        for measure in (jac.condition, jac.condition_bound, jac.manipulability):
            got = measure(jacobians, LENGTH)
            assert np.isnan(got[7])
            assert np.abs(got[reachable] - measure(jacobians[reachable], LENGTH)).max() < 1e-9
        for measure in (jac.condition_rate, jac.manipulability_rate):
            rate = measure(jacobians, np.ones((count, 6)), LENGTH)
            assert np.isnan(rate[7]) and np.isfinite(rate[reachable]).all()


def test_conditions_of_awkward_matrices():
    """Double, vanishing and widely spread singular values, in any rotation of the axes."""
    rng = np.random.default_rng(12)
    spectra = [
        (1, 1, 0.5, 0.2, 0.1, 0.1),
        (1, 1, 1, 1, 1, 1),
        (0, 0, 0, 0, 0, 1),
        (1, 2, 3, 4, 5, 0),
        (1e-12, 1, 1e3, 1e6, 1e6, 1e7),
        (0.5, 0.5, 0.5, 0.5, 0.5, 0.6),
        (0.5, 0.5000001, 1, 2, 3, 3.0000001),
    ]
    turns = np.concatenate((np.eye(6)[None], np.linalg.qr(rng.standard_normal((40, 6, 6)))[0]))
    for spectrum in spectra:
        squares = jac.condition(turns * np.sqrt(spectrum), 1.0) ** 2 * max(spectrum)
        assert np.abs(squares - min(spectrum)).max() <= 1e-9 * sum(spectrum)
