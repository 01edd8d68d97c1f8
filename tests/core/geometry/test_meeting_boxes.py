# SPDX-License-Identifier: LGPL-2.1-or-later
"""Overlapping boxes, against a test of all pairs."""

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import meeting_boxes


@pytest.mark.parametrize("seed", range(6))
def test_boxes_that_meet_are_those_of_all_pairs(seed):
    rng = np.random.default_rng(seed)
    low = np.round(rng.uniform(0.0, [30.0, 8.0, 3.0], (60, 3)))  # some touch exactly
    high = low + rng.integers(1, 4, low.shape)
    neighbours = meeting_boxes(low, high)
    meets = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2)
    np.fill_diagonal(meets, False)
    assert meets.any() and len(neighbours) == len(low)
    for indices, expected in zip(neighbours, meets):
        assert indices.tolist() == np.flatnonzero(expected).tolist()


def test_a_single_box_meets_none():
    (indices,) = meeting_boxes(np.zeros((1, 3)), np.ones((1, 3)))
    assert not len(indices)
