# SPDX-License-Identifier: LGPL-2.1-or-later
"""Remaining shares of limits and used shares of joint speeds, against plain loops and closed
forms."""

import numpy as np

from freecad_am.core.kinematics.limits import margins
from freecad_am.core.simulation.achievable_feed import (
    from_next,
    speed_ratios,
    spread_to_deposit_rows,
)

LOWER, UPPER = np.array([-2.0, -np.inf, 0.5, -1.0]), np.array([2.0, np.inf, 1.5, 3.0])


def test_margin_is_one_in_the_middle_none_at_the_limits_and_less_beyond():
    """The margin is one in the middle of the range, zero at the limits and negative beyond."""
    middle = np.array([0.0, 7e5, 1.0, 1.0])
    rows = np.stack(
        [
            middle,
            np.where(np.isfinite(LOWER), LOWER, -7e5),
            np.where(np.isfinite(UPPER), UPPER, 0.0),
        ]
    )
    assert np.array_equal(margins(rows, LOWER, UPPER), [[1, 1, 1, 1], [0, 1, 0, 0], [0, 1, 0, 0]])
    beyond = margins(np.array([[2.5, 0.0, 0.0, -3.0]]), LOWER, UPPER)
    assert np.allclose(beyond, [[-0.25, 1.0, -1.0, -1.0]])


def test_margin_as_a_loop_finds_it():
    rng = np.random.default_rng(5)
    joints = rng.uniform(-3, 3, (200, 4))
    computed = margins(joints, LOWER, UPPER)
    for i, row in enumerate(joints):
        for axis, angle in enumerate(row):
            low, high = LOWER[axis], UPPER[axis]
            expected = (
                1.0 if np.isinf(low) else 1.0 - abs(angle - (low + high) / 2) / ((high - low) / 2)
            )
            assert abs(computed[i, axis] - expected) < 1e-12


def test_unreachable_rows_have_no_numbers():
    joints = np.zeros((3, 4))
    joints[1] = np.nan
    assert (
        np.isnan(margins(joints, LOWER, UPPER)[1]).all()
        and np.isfinite(margins(joints, LOWER, UPPER)[[0, 2]]).all()
    )
    ratios = speed_ratios(joints, np.ones(3), np.array([1.0, 1.0, np.inf, 2.0]))
    assert np.isnan(ratios[1:]).all() and (ratios[0] == 0.0).all()


def test_ratio_of_a_steady_turn_is_its_speed():
    """A constant rotation uses a constant share of its speed limit."""
    rng = np.random.default_rng(6)
    duration = np.concatenate([[0.0], rng.uniform(0.1, 2.0, 50)])
    speed, max_speed = np.array([0.3, -1.2, 4.0]), np.array([0.6, 0.4, np.inf])
    joints = np.cumsum(duration)[:, None] * speed
    ratios = speed_ratios(joints, duration, max_speed)
    assert (ratios[0] == 0.0).all() and np.allclose(ratios[1:], [0.5, 3.0, 0.0])


def test_no_time_is_no_speed_unless_an_axis_jumps():
    joints = np.array([[0.0, 0.0], [0.0, 1.0]])
    assert np.array_equal(speed_ratios(joints, np.zeros(2), np.ones(2)), [[0, 0], [0, np.inf]])


def test_values_of_beads_stand_on_the_rows_that_deposit():
    deposit = np.array([False, True, True, False, True, True])
    point = np.array([0, 0, 1, 0, 0, 1])
    spread = spread_to_deposit_rows(deposit, np.array([1.0, 2.0, 3.0, 4.0]))
    assert np.array_equal(spread, [np.nan, 1, 2, np.nan, 3, 4], equal_nan=True)
    assert np.array_equal(
        from_next(deposit, point, spread), [np.nan, 2, 2, np.nan, 4, 4], equal_nan=True
    )
