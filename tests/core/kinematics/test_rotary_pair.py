# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two rotary axes: both solutions of the paper, branches, poles, unreachable directions, four
axes."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from freecad_am.core.kinematics.inverse import rotary_pair

X, Y, Z = np.eye(3)
PAIRS = [
    (X, Z),
    (Y, Z),
    (X, Y),
    (Z, X),
    (Y, X),
    (np.array([math.sqrt(0.5), 0.0, math.sqrt(0.5)]), Z),
]


def directions(seed, n=400):
    vectors = np.random.default_rng(seed).normal(size=(n, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def rotate(axis, angle, vectors):
    """Rotate vectors independently, by scipy."""
    return Rotation.from_rotvec(np.asarray(angle)[:, None] * axis).apply(vectors)


@pytest.mark.parametrize("first, second", PAIRS)
def test_both_branches_take_source_to_target(first, second):
    source, target = directions(1), directions(2)
    solutions = rotary_pair.solve_turns(first, second, source, target)
    real = np.isfinite(solutions.first_turn[0])
    for branch in range(2):
        met = rotate(
            first,
            solutions.first_turn[branch][real],
            rotate(second, solutions.second_turn[branch][real], source[real]),
        )
        np.testing.assert_allclose(met, target[real], atol=1e-12)
    difference = np.abs(
        np.exp(1j * solutions.first_turn[0]) - np.exp(1j * solutions.first_turn[1])
    ) + np.abs(np.exp(1j * solutions.second_turn[0]) - np.exp(1j * solutions.second_turn[1]))
    assert (difference[real] > 1e-6).all()
    # where no solution is returned, a fine search over the second axis never brings the source near
    # enough
    for k in np.flatnonzero(~real)[:20]:
        angles = np.linspace(-math.pi, math.pi, 20001)
        rotated = rotate(second, angles, np.tile(source[k], (len(angles), 1)))
        assert np.abs(rotated @ first - target[k] @ first).min() > 0.0
        assert (np.diff(np.sign(rotated @ first - target[k] @ first)) == 0).all()


def test_one_of_the_three_pairs_always_has_a_solution():
    # the paper's proof; no single pair of axes is sufficient for all directions
    source, target = directions(3), directions(4)
    real = [
        np.isfinite(rotary_pair.solve_turns(a, b, source, target).first_turn[0])
        for a, b in ((X, Z), (Y, Z), (X, Y))
    ]
    assert np.any(real, axis=0).all()
    assert not any(np.all(pair_has_solution) for pair_has_solution in real)


def test_solution_2_agrees_with_solution_1_where_the_target_is_vertical():
    source = directions(5)
    pair_solution = rotary_pair.solve_turns(X, Z, source, Z)
    vertical_solution = rotary_pair.by_vertical(source, Z)
    np.testing.assert_allclose(np.abs(vertical_solution.alpha_back), 0.0, atol=1e-15)
    gap = np.abs(
        np.exp(1j * pair_solution.first_turn) - np.exp(1j * vertical_solution.alpha)
    ) + np.abs(np.exp(1j * pair_solution.second_turn) - np.exp(1j * vertical_solution.gamma))
    np.testing.assert_allclose(
        gap.min(axis=0), 0.0, atol=1e-9
    )  # one branch is it; the other has -alpha


def test_solution_2_goes_from_any_direction_to_any_other():
    source, target = directions(6), directions(7)
    solutions = rotary_pair.by_vertical(source, target)
    up = rotate(X, solutions.alpha, rotate(Z, solutions.gamma, source))
    np.testing.assert_allclose(up, np.tile(Z, (len(source), 1)), atol=1e-12)
    np.testing.assert_allclose(
        rotate(Z, solutions.gamma_back, rotate(X, solutions.alpha_back, up)), target, atol=1e-12
    )


def test_poles_are_told():
    source = np.array([Z, -Z, X, [0.6, 0.0, 0.8]])
    solutions = rotary_pair.solve_turns(X, Z, source, Z)
    assert solutions.second_free.tolist() == [True, True, False, False]
    assert (solutions.second_turn[:, solutions.second_free] == 0.0).all()
    for branch in range(2):
        met = rotate(
            X, solutions.first_turn[branch], rotate(Z, solutions.second_turn[branch], source)
        )
        np.testing.assert_allclose(met, np.tile(Z, (4, 1)), atol=1e-12)
    assert rotary_pair.solve_turns(Z, X, source[3:], Z).first_free.tolist() == [True]


def test_a_hub_on_the_turning_axis_needs_one_tilt():
    # R = 60, H = 200: normals are 73.3 deg from the axis all around, so the tilt can be locked
    # without loss (ERRATA)
    theta = np.linspace(-3.0, 3.0, 50)
    a = math.atan2(60.0, 200.0)
    normal = np.stack(
        [math.cos(a) * np.cos(theta), math.cos(a) * np.sin(theta), np.full(50, math.sin(a))], axis=1
    )
    assert math.degrees(math.pi / 2 - a) == pytest.approx(73.3, abs=0.01)
    locked = rotary_pair.lock_first(X, Z, math.pi / 2 - a, normal, Z)
    np.testing.assert_allclose(locked.residual, 0.0, atol=1e-7)
    off = rotary_pair.lock_first(X, Z, math.radians(60.0), normal, Z)
    np.testing.assert_allclose(np.degrees(off.residual), 73.3 - 60.0, atol=0.01)
    np.testing.assert_allclose(off.angle, locked.angle, atol=1e-9)


@pytest.mark.parametrize("first, second", PAIRS)
def test_no_other_angle_of_the_axis_left_comes_nearer(first, second):
    """No other angle of the free axis comes nearer."""
    source, target = directions(8, 12), directions(9, 12)
    for k in range(len(source)):
        for locks, forward in (
            (
                rotary_pair.lock_first,
                lambda a, s: rotate(first, [0.4], rotate(second, [a], s)),
            ),
            (
                rotary_pair.lock_second,
                lambda a, s: rotate(first, [a], rotate(second, [0.4], s)),
            ),
        ):
            locked = locks(first, second, 0.4, source[k : k + 1], target[k : k + 1])

            def missed(a, forward=forward, k=k):
                return math.acos(
                    max(-1.0, min(1.0, float((forward(a, source[k : k + 1]) @ target[k])[0])))
                )

            assert missed(locked.angle[0]) == pytest.approx(locked.residual[0], abs=1e-6)
            best = min(
                minimize_scalar(missed, bounds=(low, low + 2.2), method="bounded").fun
                for low in (-3.2, -1.1, 1.0)
            )
            assert locked.residual[0] <= best + 1e-6


@pytest.mark.parametrize("locked", [0, 1])
@pytest.mark.parametrize("low, high", [(-math.pi, math.pi), (-0.7, 0.4)])
def test_no_place_of_the_locked_axis_leaves_less(locked, low, high):
    """No other value of the locked axis leaves a smaller residual."""
    rng = np.random.default_rng(11)
    lock = (rotary_pair.lock_first, rotary_pair.lock_second)[locked]
    for _ in range(12):
        axis_a, axis_b, target = (v / np.linalg.norm(v) for v in rng.normal(size=(3, 3)))
        source = rng.normal(size=(30, 3)) * [1.0, 1.0, 0.3] + 2.0 * rng.normal(size=3)
        source /= np.linalg.norm(source, axis=1)[:, None]

        def worst(*angles):
            """For each angle the largest residual over all directions."""
            repeated = np.repeat(angles, len(source))  # noqa: B023
            residuals = lock(axis_a, axis_b, repeated, np.tile(source, (len(angles), 1)), target)  # noqa: B023
            return residuals.residual.reshape(len(angles), -1).max(axis=1)

        best_angle = rotary_pair.minimise_residual(
            axis_a, axis_b, locked, source, target, low, high
        )
        assert low <= best_angle <= high
        grid_minimum = worst(*np.linspace(low, high, 1441)).min()
        assert worst(best_angle)[0] <= grid_minimum + 1e-9
