# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rounding errors do not affect the points, the start or the number of regions."""

import numpy as np
import pytest

from freecad_am.core.filling.zigzag import crossings
from freecad_am.core.geometry.regions.region import regions

SQUARE = np.array([[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]])
HAIR = 1e-13


def test_points_on_a_straight_border_and_spikes_are_left_out():
    noisy = np.array(
        [
            [HAIR, 30.0],
            [0.0, 12.0],
            [-HAIR, 0.0],
            [20.0, HAIR],
            [40.0, 0.0],
            [40.0, 30.0],
            [47.0, 30.0],
            [40.0, 30.0 + HAIR],
        ]
    )
    (plain,) = regions([noisy])[0].grown(-1.0, 0.01)
    assert plain.borders()[0] == pytest.approx(SQUARE + [[1, 1], [-1, 1], [-1, -1], [1, -1]])


@pytest.mark.parametrize("lean", [-HAIR, 0.0, HAIR])
def test_a_border_begins_at_the_same_corner(lean):
    leaning = SQUARE + np.array([[lean, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]])
    assert regions([leaning])[0].borders()[0][0] == pytest.approx([0.0, 0.0])


@pytest.mark.parametrize("width", [-1e-12, 0.0, 1e-12])
def test_pieces_that_hang_together_by_a_hair_are_two(width):
    """Two parts connected by less than the tolerance are two regions."""
    (square,) = regions([SQUARE])
    bar = np.array([[10.0, -1.0], [30.0, -1.0], [30.0, 30.0 - width], [10.0, 30.0 - width]])
    halves = square.without(regions([bar]), wide=1.0)
    assert [half.area for half in halves] == pytest.approx([300.0, 300.0])
    assert [len(half.borders()[0]) for half in halves] == [4, 4]


@pytest.mark.parametrize("off", [-1e-13, 0.0, 1e-13])
def test_a_line_along_a_border_has_the_same_ends(off):
    step = np.array([[0, 0], [40, 0], [40, 10], [20, 10 + off], [20, 20], [0, 20]], dtype=float)
    assert crossings([step], 10.0) == pytest.approx([0.0, 20.0])
