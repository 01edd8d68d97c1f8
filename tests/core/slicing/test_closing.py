# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closing beads fill gaps between fronts that meet: each point inside the wall's edges is within
0.6 layer heights of a bead."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.columns import HalfSpace
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.slicing.fronts.rims import local_distances
from tests.core.patch_walls import ball, samples, sheet, tube

FLOOR = HalfSpace(np.array([0.0, 0.0, -5.0]), np.array([0.1, 0.3, 1.0]))
SILL = HalfSpace(np.zeros(3), np.array([0.0, 1.0, 0.0]))
LEANING = HalfSpace(np.array([0.0, 2.0, 0.0]), np.array([0.3, 1.0, 0.0]))


class SlabEnds:
    """Everything outside a slab given by (point, normal) of both sides; fronts start on both sides."""

    def __init__(self, low, up, high, down):
        self.sides = (
            HalfSpace(np.array(low), np.array(up)),
            HalfSpace(np.array(high), np.array(down)),
        )

    def value(self, points):
        (lower, up), (upper, down) = (side.value(points) for side in self.sides)
        nearer = lower < upper
        return np.where(nearer, lower, upper), np.where(nearer[..., None], up, down)


def largest_distance(wall, curves, clearance=0.0):
    """Largest distance from the wall and its rims to a bead, for points farther than `clearance`
    from the wall's end."""
    on_rims = np.vstack([np.empty((0, 3)), *(rim.points for rim in wall.rims)])
    on_rims = on_rims[~wall.behind[cKDTree(wall.vertices).query(on_rims)[1]]]
    points = np.vstack([samples(wall), on_rims])
    ends = [rim.points for rim in wall.rims if rim.end]
    if ends:
        points = points[cKDTree(np.vstack(ends)).query(points)[0] > clearance]
    return (
        cKDTree(np.vstack([curve.at(curve.refined(30))[0] for curve in curves]))
        .query(points)[0]
        .max()
    )


def flatten_layers(layers):
    return [curve for layer in layers for curve in layer]


CASES = {
    "a cap": (lambda: ball(FLOOR, 1500), 2.6, 0.0),
    "a slanted meeting": (
        lambda: ball(SlabEnds([0, 0, -12.0], [0.1, 0.3, 1], [0, 3.0, 14], [0.3, 0.1, -1]), 3000),
        1.6,
        0.0,
    ),
    "a meeting head on": (
        lambda: tube(SlabEnds([0, 0, 0.0], [0, 0, 1], [0, 0, 14.8], [0, 0, -1]), 20.0, 1.0, 10.0),
        2.0,
        0.0,
    ),
    "about holes": (
        lambda: sheet(SILL, [(2.0, 20.0, 9.0), (-15.0, 25.0, 6.0), (17.0, 37.0, 5.0)]),
        1.7,
        1.7,
    ),
    "about wide openings": (
        lambda: sheet(SILL, [(-12.0, 15.0, 11.0), (14.0, 24.0, 13.0)], step=0.8),
        2.3,
        2.3,
    ),
    "by a leaning side": (lambda: sheet(LEANING, [(4.0, 20.0, 6.0)]), 2.1, 2.1),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.always("a cap", "a meeting head on", "about holes", "by a leaning side")
def test_gaps_are_closed(case):
    make, height, clearance = CASES[case]
    wall = make()
    slicing = fronts.slice_layers(wall, height)
    closing = flatten_layers(slicing.closing)
    assert closing
    assert largest_distance(wall, flatten_layers(slicing.fronts), clearance) > 0.6 * height
    assert (
        largest_distance(wall, flatten_layers(slicing.fronts) + closing, clearance) < 0.6 * height
    )
    for index, gaps in enumerate(slicing.closing):
        for curve in gaps:  # on the wall, above the layer below, and not a stub
            points = curve.at(curve.refined(5))[0]
            assert np.linalg.norm(wall.project(points)[0] - points, axis=1).max() < 0.01 * height
            spacing = local_distances(curve, slicing.fronts[index - 1], 5)
            assert spacing.min() > 0.3 * height and spacing.max() < 1.01 * height
            assert curve.length > 0.4 * height


def test_fronts_from_both_ends_of_a_tube_need_one_closing_ring():
    wall = tube(SlabEnds([0, 0, 0.0], [0, 0, 1], [0, 0, 14.8], [0, 0, -1]), 20.0, 1.0, 10.0)
    slicing = fronts.slice_layers(wall, 2.0)
    assert [len(layer) for layer in slicing.fronts] == [2, 2, 2, 2]
    (ring,) = flatten_layers(slicing.closing)
    assert ring.closed and len(slicing.closing) == 5
    assert ring.at(ring.refined(5))[0][:, 2] == pytest.approx(7.4, abs=0.02)
    assert ring.length == pytest.approx(20.0 * np.pi, rel=1e-3)


def test_close_beads_need_no_closing_beads():
    slanted = HalfSpace(np.zeros(3), np.array([0.2, 0.1, 1.0]))
    assert not flatten_layers(fronts.slice_layers(tube(slanted, 20.0, 2.0, low=-10.0), 3.0).closing)
    assert not flatten_layers(
        fronts.slice_layers(ball(FLOOR, 4000), 1.15).closing
    )  # the last circle is 0.5 heights wide
