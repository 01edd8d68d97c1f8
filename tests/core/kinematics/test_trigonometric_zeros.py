# SPDX-License-Identifier: LGPL-2.1-or-later
"""Isolated zeros of trigonometric polynomials: one per interval, none missing."""

import numpy as np
import pytest

from freecad_am.core.kinematics.inverse import trigonometric_zeros as trigonometric


def _coefficients_of(zeros, positive):
    """Coefficients (2 degree + 1, n): the product of sines of half the angle from zeros (2 k, n)
    and of positive factors."""
    count = len(zeros) + 2 * len(positive)
    nodes = trigonometric.angles(count + 2)[:, None]
    value = np.prod(np.sin(0.5 * (nodes - zeros[:, None])), axis=0)
    value *= np.prod(1.0 + 0.9 * np.cos(nodes - positive[:, None]), axis=0)
    rows = trigonometric.harmonics(count // 2, nodes[:, 0])
    weights = np.where(np.arange(count + 1) == 0, 1.0, 2.0) / len(nodes)
    return (rows * weights[:, None]) @ value


@pytest.mark.parametrize("degree", [4, 8])
def test_each_zero_is_in_a_step_of_its_own(degree):
    rng = np.random.default_rng(21)
    for real in range(0, 2 * degree + 1, 2):
        zeros = rng.uniform(0.0, 2.0 * np.pi, (real, 400))
        if real:  # pairs at all distances, down to where rounding no longer separates them
            zeros[1] = (zeros[0] + 10.0 ** rng.uniform(-9.0, 0.0, 400)) % (2.0 * np.pi)
        isolated = trigonometric.isolate_zeros(
            _coefficients_of(zeros, rng.uniform(0.0, 2.0 * np.pi, (degree - real // 2, 400)))
        )
        assert (~isolated.close).sum() > 150
        for number in np.flatnonzero(~isolated.close):
            low, high, guess = (
                column[isolated.number == number]
                for column in (isolated.low, isolated.high, isolated.guess)
            )
            assert len(low) == real and (low <= guess).all() and (guess <= high).all()
            # rounding of the coefficients moves the zeros of close pairs
            inside = (zeros[:, number] >= low[:, None] - 1e-6) & (
                zeros[:, number] <= high[:, None] + 1e-6
            )
            assert inside.any(axis=0).all() and inside.any(axis=1).all()
