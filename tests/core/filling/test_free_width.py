# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads as wide as their room, measured on a raster swept by discs of their widths; starts that keep apart."""

import importlib.util
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.filling.centre import OVER, Beads
from freecad_am.core.filling.cover import measure_cover
from freecad_am.core.filling.even_widths import fit_beads, narrow_beads, share_widths
from freecad_am.core.filling.fill import fill
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.filled import DevelopableParameters

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)

S = 5.0
BEADS = Beads(S, 1.0, 2.0, chord_error=0.02)
STEP = 0.1


def adapted(region, pattern, least, most):
    beads, share = fit_beads(region, BEADS, least, most)
    return [*share_widths(region, fill(region, beads, pattern), beads, share, least, most)], share


def places(curves):
    """Dense places of beads and their widths there."""
    found = []
    for curve in curves:
        share = np.ones(len(curve.points)) if curve.share is None else curve.share
        ends = np.c_[curve.points, share]
        ends = np.vstack([ends, ends[:1]]) if curve.closed else ends
        for a, b in zip(ends, ends[1:]):
            t = np.linspace(0.0, 1.0, max(int(np.ceil(np.hypot(*(b - a)[:2]) / STEP)), 1) + 1)[
                :, None
            ]
            found.append(a + t * (b - a))
    rows = np.vstack(found)
    return rows[:, :2], S * rows[:, 2]


def swept(curves, grid):
    """Which places of a grid lie within half of a bead's width there, of any bead: the nearest may be a narrow one that does
    not reach a place which a wider one does."""
    covered = np.zeros(len(grid), dtype=bool)
    for curve in curves:
        covered |= swept_by(curve, grid)
    return covered


def swept_by(curve, grid):
    points, width = places([curve])
    covered = np.zeros(len(grid), dtype=bool)
    for low in np.arange(0.0, width.max() + 0.25, 0.25):
        some = (width >= low) & (width < low + 0.25)
        if some.any():
            away, which = cKDTree(points[some]).query(grid)
            covered |= away <= 0.5 * width[some][which] + 0.01
    return covered


def without_round_ends(curve):
    """A bead; an open one without what round ends add to its area."""
    if curve.closed:
        return curve
    shares = np.ones(len(curve.points)) if curve.share is None else curve.share
    points, shares = shapes.without_round_ends(curve.points, shares, 2.0 * BEADS.inset)
    return replace(curve, points=points, share=shares)


def bar(thick, length=90.0):
    return shapes.polygon((0, 0), (length, 0), (length, thick), (0, thick))


@pytest.mark.parametrize("pattern", ["contours", "connected", "spiral"])
@pytest.mark.parametrize("thick", [7.0, 8.5, 12.5, 17.0, 22.0, 23.4])
@pytest.mark.always
def test_bars_of_any_thickness_are_filled_evenly(thick, pattern):
    loops = bar(thick)
    (region,) = regions(loops)
    curves, share = adapted(region, pattern, 0.7, 1.4)
    count = round(thick / (share * S))
    assert share * S * count == pytest.approx(thick, rel=0.01) and 0.7 <= share <= 1.41
    grid = shapes.raster(loops, 0.25)[0] + np.array([0.1, 0.07])  # none of it on the border
    within = shapes.inside(loops, grid)
    covered = swept(curves, grid)
    half = 0.5 * share * S  # what a round bead that runs into a corner of the bar can reach of it
    away = np.maximum(np.abs(grid - (45.0, 0.5 * thick)) - (45.0 - half, 0.5 * thick - half), 0.0)
    reach = within & (np.hypot(*away.T) <= half)
    # the corners of contours inside stay open, and those beside the ends of a bead in the middle: none is as wide as the gap
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert (covered & ~within).sum() <= 0.01 * within.sum()
    if pattern == "contours":
        area = sum(
            (np.hypot(*np.diff(line, axis=0).T) * 0.5 * (wide[1:] + wide[:-1])).sum()
            for line, wide in (
                (
                    np.vstack([c.points, c.points[:1]]) if c.closed else c.points,
                    S * (np.r_[c.share, c.share[:1]] if c.closed else c.share),
                )
                for c in (c if c.share is not None else shares_of_one(c) for c in curves)
            )
        )
        assert area == pytest.approx(thick * 90.0, rel=0.08), "what is laid is what the bar takes"


def shares_of_one(curve):
    import dataclasses

    return dataclasses.replace(curve, share=np.ones(len(curve.points)))


def test_a_wedge_narrower_than_a_bead_is_as_wide_as_its_bead():
    (region,) = regions(shapes.polygon((0, 0), (80, 0), (80, 4.9), (0, 3.0)))
    (curve,) = adapted(region, "contours", 0.5, 1.5)[0]
    x, share = curve.points[:, 0], curve.share
    inner = (x > 4.0) & (x < 76.0)
    assert S * share[inner] == pytest.approx(3.0 + 1.9 * x[inner] / 80.0, rel=0.02)


def test_the_usual_range_changes_nothing():
    for name in ("comb", "wavy 1"):
        (region,) = regions(shapes.SHAPES[name])
        usual = fill(region, BEADS)
        curves, share = adapted(region, "contours", 1.0, 1.0)
        assert share == 1.0 and all(
            a is b or (np.array_equal(a.points, b.points) and b.share is None)
            for a, b in zip(usual, curves, strict=True)
        )
    # nothing within the range: the usual spacing, and gaps in the middle as wide as they are
    (region,) = regions(bar(8.0))
    curves, share = adapted(region, "contours", 0.95, 1.05)
    assert share == 1.0


@pytest.mark.parametrize("name", ["annulus", "blade", "wavy 2", "L"])
def test_spread_starts_keep_apart_and_aligned_ones_do_not(name):
    def starts(spread):
        found = {}
        for layer in range(6):
            beads = Beads(S, 1.0, 2.0, chord_error=0.02, spread=layer * OVER if spread else None)
            (region,) = regions(
                shapes.SHAPES[name][:1]
            )  # without holes there is one contour of each number, or few
            for curve in fill(region, beads):
                if curve.kind == "contour":
                    found.setdefault((layer, curve.ring), []).append(curve.points)
        return {key: rings[0] for key, rings in found.items() if len(rings) == 1}

    def share(a, b):
        """How far apart two starts are: along the first ring from its start to where the other's is next, of all of it."""
        at = shapes.dense(a, True, 0.1)
        near = np.argmin(np.hypot(*(at - b[0]).T)) / len(at)
        return min(near, 1.0 - near)

    def least(found):
        pairs = [
            (key, (key[0] + i, key[1] + j))
            for key in found
            for i, j in ((0, 1), (1, 0), (1, 1), (1, -1))
        ]
        return [share(found[a], found[b]) for a, b in pairs if b in found]

    assert max(least(starts(False))) < 0.12 or name in ("wavy 2", "L", "blade")
    apart = least(starts(True))
    # where contours differ in shape from the ones outside of them, so do the shares of their length
    assert (
        len(apart) > 8
        and np.median(apart) > 0.2
        and min(apart) > (0.02 if name in ("wavy 2", "L") else 0.08)
    )


@pytest.mark.parametrize(
    "given,told",
    [
        ((0.2, 1.4), "20 % is out of range; give at least 30 % and at most 200 %"),
        ((1.4, 0.7), "140 % to 70 % is not a range; give the smaller percentage first"),
        (
            (1.1, 1.4),
            "110 % to 140 % excludes 100 %, the usual width; extend the range to include 100 %",
        ),
        ((1.0,), "is not a range; give two percentages"),
        ((float("nan"), 1.2), "nan is not a number"),
    ],
)
def test_ranges_that_are_none_are_told(given, told):
    with pytest.raises(InputError, match="spacing_range") as refused:
        DevelopableParameters(spacing_range=given)
    assert told in str(refused.value)


@pytest.mark.parametrize("thick", [7.0, 12.5, 22.0])
def test_beads_cover_as_much_as_they_are_wide(thick):
    """Bars in beads wider or narrower than usual: against what discs of their widths sweep, of open beads less the lengths of
    their round ends."""
    loops = bar(thick, 50.0)
    (region,) = regions(loops)
    curves, share = adapted(region, "contours", 0.7, 1.4)
    grid = shapes.raster(loops, 0.25)[0] + np.array([0.1, 0.07])
    trimmed = [without_round_ends(curve) for curve in curves]
    within, swept_over = shapes.inside(loops, grid), swept(trimmed, grid)
    found = measure_cover(region, curves, BEADS)
    pixel, near = 0.25**2, 0.06 * 2.0 * (50.0 + thick)  # a quarter of a place along the border
    assert found.area == pytest.approx(region.area) and found.covered == pytest.approx(
        pixel * swept_over.sum(), abs=near
    )
    assert found.missed == pytest.approx(pixel * (within & ~swept_over).sum(), abs=near)
    assert found.outside == pytest.approx(pixel * (swept_over & ~within).sum(), abs=near)
    usual = measure_cover(region, [replace(curve, share=None) for curve in curves], BEADS)
    if abs(share - 1.0) > 0.1:
        assert abs(usual.missed - found.missed) + abs(usual.outside - found.outside) > 2.0 * near


def ring_loops(thickness, outer=40.0):
    angle = 2.0 * np.pi * np.arange(400) / 400
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return [outer * circle, (outer - thickness) * circle[::-1]]


@pytest.mark.parametrize("thickness", [4.4, 5.0, 6.0, 7.2])
@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_narrow_beads_lie_half_their_own_width_from_the_border(thickness, turn):
    """A wall of 1.1 to 1.8 beads gets two beads, each of half its thickness, in the middle of its half."""
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    (region,) = regions([loop @ rotation + [11.0, -7.0] for loop in ring_loops(thickness)])
    beads = Beads(4.0, 0.8, 2.0, chord_error=0.002, width=4.0)
    curves = narrow_beads(fill(region, beads), beads, 0.0, 0.3)
    assert len(curves) == 2
    radii = sorted(float(np.hypot(*(c.points - [11.0, -7.0]).T).mean()) for c in curves)
    assert radii == pytest.approx([40.0 - 0.75 * thickness, 40.0 - 0.25 * thickness], abs=0.02)
    for curve in curves:
        assert curve.share * 4.0 == pytest.approx(
            np.full(len(curve.points), thickness / 2), rel=0.02
        )
    cover = measure_cover(region, curves, beads)
    assert cover.missed < 0.01 * cover.area and cover.outside < 0.01 * cover.area


def test_narrow_lines_lie_half_their_own_width_from_the_border():
    (region,) = regions([np.array([(0, 0), (60, 0), (60, 6), (0, 6)], dtype=float)])
    beads = Beads(4.0, 0.8, 2.0, chord_error=0.002, width=4.0)
    curves = narrow_beads(fill(region, beads, "lines"), beads, 0.0, 0.3)
    heights = sorted(float(curve.points[:, 1].mean()) for curve in curves)
    assert heights == pytest.approx([1.5, 4.5], abs=0.02)


def test_a_round_bead_beside_a_neck_stays_round():
    """Two holes near each other: beads narrow in the neck between them, and neither kinks nor waves lead to it."""
    around = np.linspace(0.0, 2.0 * np.pi, 240, endpoint=False)
    circle = 10.0 * np.stack([np.cos(around), np.sin(around)], axis=1)
    holes = [circle[::-1] + (x, 0.0) for x in (-14.0, 14.0)]
    plate = np.array([(-40.0, -25.0), (40.0, -25.0), (40.0, 25.0), (-40.0, 25.0)])
    (region,) = regions([plate, *holes])
    curves = narrow_beads(fill(region, BEADS, "contours"), BEADS, 0.0, 0.3)
    rings = [
        curve
        for curve in curves
        if curve.share is not None and curve.ring == 0 and np.ptp(curve.points[:, 0]) < 40.0
    ]
    assert len(rings) == 2
    for ring in rings:
        assert ring.share.min() < 0.9
        way = np.diff(np.vstack([ring.points, ring.points[:2]]), axis=0)
        turns = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
        assert np.abs(np.diff(turns)).max() < 0.1  # rad between chords of 1 mm
