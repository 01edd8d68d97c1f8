# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connected contours, measured by geometry of their own: one bead, nothing crosses, covered, inside, links at 45 deg."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import fill
from freecad_am.core.geometry.regions.region import regions

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)

S = 5.0
BEADS = Beads(S, 1.0, 2.0, chord_error=0.02)


def star(seed, corners=9):
    rng = np.random.default_rng(seed)
    angle = 2.0 * np.pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    return [
        rng.uniform(22.0, 44.0, (corners, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ]


def plate(seed):
    """A plate with holes at random places."""
    rng = np.random.default_rng(seed)
    places = np.array([[x, y] for x in (22.0, 62.0, 102.0) for y in (22.0, 58.0)]) + rng.uniform(
        -5.0, 5.0, (6, 2)
    )
    holes = [shapes.circle(rng.uniform(4.0, 9.0), 60, place)[::-1] for place in places]
    return [*shapes.polygon((0, 0), (124, 0), (124, 80), (0, 80)), *holes]


REGIONS = {
    **shapes.SHAPES,
    **{f"star {k}": star(k) for k in range(4)},
    **{f"plate {k}": plate(k) for k in range(3)},
}


def crossings(points):
    """Pairs of edges of a closed polyline, not neighbours, that cross: by signs of areas alone."""
    a, b = points, np.roll(points, -1, axis=0)
    n, found = len(a), 0
    for k in range(n - 2):
        other = np.arange(k + 2, n if k else n - 1)

        def side(p, q, r):
            return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (
                r[..., 0] - p[..., 0]
            )

        one = side(a[k], b[k], a[other]) * side(a[k], b[k], b[other]) < 0.0
        found += int(
            (one & (side(a[other], b[other], a[k]) * side(a[other], b[other], b[k]) < 0.0)).sum()
        )
    return found


@pytest.mark.parametrize("name", REGIONS)
@pytest.mark.always("circle", "annulus", "blade", "L", "comb", "star 0")
def test_one_bead_through_all_contours(name):
    loops = REGIONS[name]
    (region,) = regions(loops)
    (curve,) = fill(region, BEADS, "connected")
    assert curve.closed and curve.kind == "connected" and crossings(curve.points) == 0
    line = shapes.dense(curve.points, True, 0.1)
    assert shapes.inside(loops, line).all()
    border = shapes.tree([(loop, True) for loop in loops], 0.1)
    assert border.query(line)[0].min() > 0.5 * S - 0.05
    grid, within = shapes.raster(loops, 0.5)
    tree = shapes.tree([(curve.points, True)], 0.1)
    away = shapes.distance(tree, grid, S + BEADS.gap)
    reach = within & (shapes.distance(border, grid, 0.5 * S) >= 0.5 * S)
    assert (away[reach] <= 0.5 * S + 0.01).mean() >= 0.99
    assert away[reach].max() < 0.5 * S + BEADS.gap, "beside links about the gap allowed stays open"
    # every contour of the usual filling is there, but for its openings
    contours = [one for one in fill(region, BEADS) if one.kind == "contour"]
    for one in contours:
        at = shapes.dense(one.points, True, 0.1)
        lost = (shapes.distance(tree, at, 0.2) > 0.15).sum() * 0.1
        assert lost < 0.75 * len(at) * 0.1 or len(at) * 0.1 < 12.0 * S
    share = np.ones(len(curve.points)) if curve.share is None else curve.share
    assert share.min() >= 0.3 and share.max() == 1.0


def test_links_are_at_45_deg_and_every_second_contour_runs_the_other_way():
    (region,) = regions(shapes.polygon((0, 0), (100, 0), (100, 60), (0, 60)))
    for clockwise in (False, True):
        beads = Beads(S, 1.0, 2.0, clockwise=clockwise, chord_error=0.02)
        (curve,) = fill(region, beads, "connected")
        way = np.diff(np.vstack([curve.points, curve.points[:1]]), axis=0)
        size, heading = np.hypot(*way.T), np.degrees(np.arctan2(way[:, 1], way[:, 0])) % 90.0
        links = (np.abs(heading - 45.0) < 1.0) & (size > 0.5 * S)
        straight = (np.minimum(heading, 90.0 - heading) < 1e-6) & (size > 1.1 * S)
        assert links.sum() == 2 * 5 and size[links] == pytest.approx(np.sqrt(2.0) * S, rel=1e-6)
        senses = []
        for level in range(6):  # the lowest edge of each contour, 2.5, 7.5 ... mm up
            low = (
                straight
                & (np.abs(curve.points[:, 1] - (level + 0.5) * S) < 1e-6)
                & (np.abs(way[:, 1]) < 1e-6)
            )
            low &= curve.points[:, 1] < 30.0
            senses.append(np.sign(way[low, 0].sum()))
        assert senses == [(-1.0 if clockwise else 1.0) * (-1.0) ** level for level in range(6)]


def test_loops_share_the_gap_in_the_middle():
    """Six and a half beads across: what is left in the middle is half a bead wide, each side of the loop half of that."""
    (region,) = regions(shapes.polygon((0, 0), (120, 0), (120, 6.5 * S), (0, 6.5 * S)))
    (curve,) = fill(region, BEADS, "connected")
    assert curve.share is not None
    middle = np.abs(curve.points[:, 1] - 3.25 * S) < 0.2 * S
    assert (
        curve.share[middle].min() == pytest.approx(0.3, abs=0.05)
        and (curve.share[~middle] == 1.0).mean() > 0.8
    )


def test_regions_too_narrow_or_too_small_have_their_single_bead():
    (thin,) = regions(shapes.blade(100.0, 4.0))
    (curve,) = fill(thin, BEADS, "connected")
    assert curve.kind == "centre" and not curve.closed
    (small,) = regions([shapes.circle(4.0)])
    (curve,) = fill(small, BEADS, "connected")
    assert curve.closed and np.hypot(*curve.points.T) == pytest.approx(
        4.0**2 / (2.0 * 5.0), abs=0.03
    )
