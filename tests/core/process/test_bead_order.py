# SPDX-License-Identifier: LGPL-2.1-or-later
"""Order of islands: the nearest next, against comparing all pairs."""

import numpy as np
import pytest

from freecad_am.core.process.bead_order import IslandOrder, StartPoints
from freecad_am.core.toolpath import Bead


@pytest.mark.parametrize("seed", range(4))
def test_starts_are_taken_as_by_comparing_all_pairs(seed):
    """On a grid, where many are equally near, and anywhere; the torch ends away from where it starts."""
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 12, (150, 3)).astype(float) if seed % 2 else rng.random((150, 3))
    ends = points + rng.integers(-1, 2, points.shape)
    starts, left, place = StartPoints(points), list(range(len(points))), None
    while left:
        away = [0.0 if place is None else np.linalg.norm(points[k] - place) for k in left]
        wanted = left.pop(int(np.argmin(away)))
        assert starts.take(place) == wanted
        place = ends[wanted]


def dash(at):
    points = np.array([at, at + [1.0, 0.0, 0.0]])
    up = np.tile([0.0, 0.0, 1.0], (2, 1))
    return Bead(points, up, up, np.array([0.0, 1.0]), np.full(2, 6.0), False)


@pytest.mark.parametrize("count", [1, 3, 40])
def test_islands_keep_the_order_of_the_layer_below(count):
    """Each goes where the nearest one below it went, of equally near ones the first."""
    rng = np.random.default_rng(count)
    below, above = (rng.integers(0, 9, (count, 3)).astype(float) for _ in range(2))
    order = IslandOrder(as_below=True)
    first = order.order_islands([dash(at) for at in below], [[k] for k in range(count)])
    assert [bead.points[0].tolist() for bead in first] == below.tolist()
    second = order.order_islands([dash(at) for at in above], [[k] for k in range(count)])
    wanted = sorted(
        range(count), key=lambda k: int(np.argmin(np.linalg.norm(below - above[k], axis=1)))
    )
    assert [bead.points[0].tolist() for bead in second] == above[wanted].tolist()
