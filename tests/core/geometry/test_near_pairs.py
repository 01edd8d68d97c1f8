# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pairs of balls that may touch, against all distances, and the memory needed."""

import tracemalloc

import numpy as np
import pytest

from freecad_am.core.geometry.mesh import polygon
from freecad_am.core.geometry.mesh.polygon import near_pairs


@pytest.mark.parametrize("block", [5, 300, 2_000_000])
def test_all_pairs_that_may_touch_and_no_others(block, monkeypatch):
    monkeypatch.setattr(polygon, "BLOCK", block)
    rng = np.random.default_rng(1)
    middle, reach = rng.uniform(0.0, 10.0, (300, 3)), rng.uniform(0.01, 1.5, 300) ** 3
    pairs = np.concatenate(list(near_pairs(middle, reach)))
    distances = np.linalg.norm(middle[:, None] - middle[None], axis=2)
    expected = np.argwhere(np.triu(distances <= reach[:, None] + reach[None], 1))
    assert len(expected) > 300
    np.testing.assert_array_equal(pairs[np.lexsort(pairs.T[::-1])], expected)


def test_a_long_needle_does_not_make_neighbours_of_all_around():
    # 40,000 small triangles on a square of 20 mm, and one as long as its side: all pairs within its
    # length take 13 GB
    side = np.arange(200) * 0.1
    middle = np.stack([*np.meshgrid(side, side), np.zeros((200, 200))], axis=-1).reshape(-1, 3)
    reach = np.full(len(middle), 0.06)
    reach[0] = 20.0
    tracemalloc.start()
    count = sum(len(pairs) for pairs in near_pairs(middle, reach))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 2 * 199 * 200 + len(middle) / 2 < count < 3 * len(middle) + len(middle)
    assert peak < 100e6
