# SPDX-License-Identifier: LGPL-2.1-or-later
"""Connected contours, measured independently: one bead without crossings covers the region, stays
inside and has links at 45 deg."""

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

SPACING = 5.0
BEADS = Beads(SPACING, 1.0, 2.0, chord_error=0.02)


def make_star(seed, corners=9):
    rng = np.random.default_rng(seed)
    angle = 2.0 * np.pi * (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) / corners
    return [
        rng.uniform(22.0, 44.0, (corners, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ]


def make_plate(seed):
    """Return a plate with holes at random positions."""
    rng = np.random.default_rng(seed)
    centres = np.array([[x, y] for x in (22.0, 62.0, 102.0) for y in (22.0, 58.0)]) + rng.uniform(
        -5.0, 5.0, (6, 2)
    )
    holes = [shapes.circle(rng.uniform(4.0, 9.0), 60, centre)[::-1] for centre in centres]
    return [*shapes.polygon((0, 0), (124, 0), (124, 80), (0, 80)), *holes]


REGIONS = {
    **shapes.SHAPES,
    **{f"star {k}": make_star(k) for k in range(4)},
    **{f"plate {k}": make_plate(k) for k in range(3)},
}


def count_crossings(points):
    """Count pairs of edges of a closed polyline that cross without being neighbours, by signs of
    areas."""
    a, b = points, np.roll(points, -1, axis=0)
    n, count = len(a), 0
    for k in range(n - 2):
        candidates = np.arange(k + 2, n if k else n - 1)

        def side(p, q, r):
            return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (
                r[..., 0] - p[..., 0]
            )

        is_crossed = side(a[k], b[k], a[candidates]) * side(a[k], b[k], b[candidates]) < 0.0
        count += int(
            (
                is_crossed
                & (
                    side(a[candidates], b[candidates], a[k])
                    * side(a[candidates], b[candidates], b[k])
                    < 0.0
                )
            ).sum()
        )
    return count


@pytest.mark.parametrize("name", REGIONS)
@pytest.mark.always("circle", "annulus", "blade", "L", "comb", "star 0")
def test_one_bead_through_all_contours(name):
    loops = REGIONS[name]
    (region,) = regions(loops)
    (curve,) = fill(region, BEADS, "connected")
    assert curve.closed and curve.kind == "connected" and count_crossings(curve.points) == 0
    line = shapes.densify(curve.points, True, 0.1)
    assert shapes.are_inside(loops, line).all()
    border = shapes.build_tree([(loop, True) for loop in loops], 0.1)
    assert border.query(line)[0].min() > 0.5 * SPACING - 0.05
    grid, within = shapes.make_grid(loops, 0.5)
    tree = shapes.build_tree([(curve.points, True)], 0.1)
    bead_distance = shapes.nearest_distance(tree, grid, SPACING + BEADS.gap)
    reach = within & (shapes.nearest_distance(border, grid, 0.5 * SPACING) >= 0.5 * SPACING)
    assert (bead_distance[reach] <= 0.5 * SPACING + 0.01).mean() >= 0.99
    assert bead_distance[reach].max() < 0.5 * SPACING + BEADS.gap, (
        "beside links about the gap allowed stays open"
    )
    # every contour of the plain fill exists, apart from its openings
    contours = [contour for contour in fill(region, BEADS) if contour.kind == "contour"]
    for contour in contours:
        contour_points = shapes.densify(contour.points, True, 0.1)
        open_length = (shapes.nearest_distance(tree, contour_points, 0.2) > 0.15).sum() * 0.1
        assert (
            open_length < 0.75 * len(contour_points) * 0.1
            or len(contour_points) * 0.1 < 12.0 * SPACING
        )
    share = np.ones(len(curve.points)) if curve.share is None else curve.share
    assert share.min() >= 0.3 and share.max() == 1.0


def test_links_are_at_45_deg_and_every_second_contour_runs_the_other_way():
    (region,) = regions(shapes.polygon((0, 0), (100, 0), (100, 60), (0, 60)))
    for clockwise in (False, True):
        beads = Beads(SPACING, 1.0, 2.0, clockwise=clockwise, chord_error=0.02)
        (curve,) = fill(region, beads, "connected")
        edges = np.diff(np.vstack([curve.points, curve.points[:1]]), axis=0)
        size, heading = np.hypot(*edges.T), np.degrees(np.arctan2(edges[:, 1], edges[:, 0])) % 90.0
        links = (np.abs(heading - 45.0) < 1.0) & (size > 0.5 * SPACING)
        straight = (np.minimum(heading, 90.0 - heading) < 1e-6) & (size > 1.1 * SPACING)
        assert links.sum() == 2 * 5 and size[links] == pytest.approx(
            np.sqrt(2.0) * SPACING, rel=1e-6
        )
        senses = []
        for level in range(6):  # the lowest edge of each contour, at 2.5, 7.5 ... mm
            is_lowest = (
                straight
                & (np.abs(curve.points[:, 1] - (level + 0.5) * SPACING) < 1e-6)
                & (np.abs(edges[:, 1]) < 1e-6)
            )
            is_lowest &= curve.points[:, 1] < 30.0
            senses.append(np.sign(edges[is_lowest, 0].sum()))
        assert senses == [(-1.0 if clockwise else 1.0) * (-1.0) ** level for level in range(6)]


def test_loops_share_the_gap_in_the_middle():
    """The region is 6.5 beads wide: the gap of half a bead is split between the two sides of the
    loop."""
    (region,) = regions(shapes.polygon((0, 0), (120, 0), (120, 6.5 * SPACING), (0, 6.5 * SPACING)))
    (curve,) = fill(region, BEADS, "connected")
    assert curve.share is not None
    middle = np.abs(curve.points[:, 1] - 3.25 * SPACING) < 0.2 * SPACING
    assert (
        curve.share[middle].min() == pytest.approx(0.3, abs=0.05)
        and (curve.share[~middle] == 1.0).mean() > 0.8
    )


def test_regions_too_narrow_for_contours_get_one_bead():
    (thin,) = regions(shapes.blade(100.0, 4.0))
    (curve,) = fill(thin, BEADS, "connected")
    assert curve.kind == "centre" and not curve.closed
    (small,) = regions([shapes.circle(4.0)])
    (curve,) = fill(small, BEADS, "connected")
    assert curve.closed and np.hypot(*curve.points.T) == pytest.approx(
        4.0**2 / (2.0 * 5.0), abs=0.03
    )
