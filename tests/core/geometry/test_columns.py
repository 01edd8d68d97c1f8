# SPDX-License-Identifier: LGPL-2.1-or-later
"""Column-wise vector operations agree with numpy to the last bit, so that a job has the same bytes
everywhere."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import crosses, lengths, sides


@pytest.mark.parametrize("count", [0, 1, 3, 20_000])
def test_lengths_are_those_of_numpy_to_the_last_bit(count):
    rng = np.random.default_rng(count)
    corners = rng.normal(size=(count, 3, 3)) * rng.choice([1e-4, 1.0, 300.0], size=(count, 1, 1))
    assert np.array_equal(lengths(corners[:, 0]), np.linalg.norm(corners[:, 0], axis=1))
    for following in (
        np.roll(corners, -1, axis=1) - corners,
        corners - np.roll(corners, -1, axis=1),
    ):
        assert np.array_equal(sides(corners), np.linalg.norm(following, axis=2))
    assert np.array_equal(
        sides(corners[::2]), np.linalg.norm((np.roll(corners, -1, axis=1) - corners)[::2], axis=2)
    )


@pytest.mark.parametrize("count", [0, 1, 3, 20_000])
def test_cross_products_are_those_of_numpy_to_the_last_bit(count):
    first_factors, second_factors = np.random.default_rng(count).normal(size=(2, count, 3))
    assert np.array_equal(
        crosses(first_factors, second_factors), np.cross(first_factors, second_factors)
    )
