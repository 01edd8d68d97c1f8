# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads that adapt their width to the available space, measured on a raster; starts that keep their
distance."""

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

SPACING = 5.0
BEADS = Beads(SPACING, 1.0, 2.0, chord_error=0.02)
STEP = 0.1


def fit_and_share(region, pattern, min_share, max_share):
    beads, share = fit_beads(region, BEADS, min_share, max_share)
    return [
        *share_widths(region, fill(region, beads, pattern), beads, share, min_share, max_share)
    ], share


def sample_widths(curves):
    """Dense points of beads and the bead widths there."""
    samples = []
    for curve in curves:
        share = np.ones(len(curve.points)) if curve.share is None else curve.share
        ends = np.c_[curve.points, share]
        ends = np.vstack([ends, ends[:1]]) if curve.closed else ends
        for a, b in zip(ends, ends[1:]):
            t = np.linspace(0.0, 1.0, max(int(np.ceil(np.hypot(*(b - a)[:2]) / STEP)), 1) + 1)[
                :, None
            ]
            samples.append(a + t * (b - a))
    rows = np.vstack(samples)
    return rows[:, :2], SPACING * rows[:, 2]


def sweep(curves, grid):
    """Mask of grid points within half a bead width of a bead; checks each bead, because the nearest
    one may be too narrow to reach a point."""
    covered = np.zeros(len(grid), dtype=bool)
    for curve in curves:
        covered |= sweep_bead(curve, grid)
    return covered


def sweep_bead(curve, grid):
    points, width = sample_widths([curve])
    covered = np.zeros(len(grid), dtype=bool)
    for band_start in np.arange(0.0, width.max() + 0.25, 0.25):
        in_band = (width >= band_start) & (width < band_start + 0.25)
        if in_band.any():
            distances, nearest = cKDTree(points[in_band]).query(grid)
            covered |= distances <= 0.5 * width[in_band][nearest] + 0.01
    return covered


def trim_round_ends(curve):
    """Return the bead; if it is open, without the length that round ends add."""
    if curve.closed:
        return curve
    shares = np.ones(len(curve.points)) if curve.share is None else curve.share
    points, shares = shapes.trim_round_ends(curve.points, shares, 2.0 * BEADS.inset)
    return replace(curve, points=points, share=shares)


def make_bar(thickness, length=90.0):
    return shapes.polygon((0, 0), (length, 0), (length, thickness), (0, thickness))


@pytest.mark.parametrize("pattern", ["contours", "connected", "spiral"])
@pytest.mark.parametrize("thickness", [7.0, 8.5, 12.5, 17.0, 22.0, 23.4])
@pytest.mark.always
def test_beads_share_bars_of_any_thickness_evenly(thickness, pattern):
    loops = make_bar(thickness)
    (region,) = regions(loops)
    curves, share = fit_and_share(region, pattern, 0.7, 1.4)
    count = round(thickness / (share * SPACING))
    assert share * SPACING * count == pytest.approx(thickness, rel=0.01) and 0.7 <= share <= 1.41
    grid = shapes.make_grid(loops, 0.25)[0] + np.array([0.1, 0.07])  # no grid point on the border
    within = shapes.are_inside(loops, grid)
    covered = sweep(curves, grid)
    half = 0.5 * share * SPACING  # reach of a round bead in a corner of the bar
    core_distance = np.maximum(
        np.abs(grid - (45.0, 0.5 * thickness)) - (45.0 - half, 0.5 * thickness - half), 0.0
    )
    reach = within & (np.hypot(*core_distance.T) <= half)
    # inner corners of contours stay open, also next to the ends of a middle bead: all smaller than the gap
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert (covered & ~within).sum() <= 0.01 * within.sum()
    if pattern == "contours":
        area = sum(
            (np.hypot(*np.diff(line, axis=0).T) * 0.5 * (widths[1:] + widths[:-1])).sum()
            for line, widths in (
                (
                    np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points,
                    SPACING
                    * (np.r_[curve.share, curve.share[:1]] if curve.closed else curve.share),
                )
                for curve in (
                    curve if curve.share is not None else add_unit_shares(curve) for curve in curves
                )
            )
        )
        assert area == pytest.approx(thickness * 90.0, rel=0.08), (
            "what is laid is what the bar takes"
        )


def add_unit_shares(curve):
    import dataclasses

    return dataclasses.replace(curve, share=np.ones(len(curve.points)))


def test_the_bead_of_a_narrow_wedge_is_as_wide_as_the_wedge():
    (region,) = regions(shapes.polygon((0, 0), (80, 0), (80, 4.9), (0, 3.0)))
    (curve,) = fit_and_share(region, "contours", 0.5, 1.5)[0]
    x, share = curve.points[:, 0], curve.share
    inner = (x > 4.0) & (x < 76.0)
    assert SPACING * share[inner] == pytest.approx(3.0 + 1.9 * x[inner] / 80.0, rel=0.02)


def test_the_nominal_range_changes_nothing():
    for name in ("comb", "wavy 1"):
        (region,) = regions(shapes.SHAPES[name])
        nominal = fill(region, BEADS)
        curves, share = fit_and_share(region, "contours", 1.0, 1.0)
        assert share == 1.0 and all(
            a is b or (np.array_equal(a.points, b.points) and b.share is None)
            for a, b in zip(nominal, curves, strict=True)
        )
    # no spacing of the range fits: nominal spacing, and the gap in the middle stays
    (region,) = regions(make_bar(8.0))
    curves, share = fit_and_share(region, "contours", 0.95, 1.05)
    assert share == 1.0


@pytest.mark.parametrize("name", ["annulus", "blade", "wavy 2", "L"])
def test_spread_starts_keep_their_distance(name):
    def list_starts(spread):
        rings_by_key = {}
        for layer in range(6):
            beads = Beads(
                SPACING, 1.0, 2.0, chord_error=0.02, spread=layer * OVER if spread else None
            )
            (region,) = regions(
                shapes.SHAPES[name][:1]
            )  # without holes most ring numbers have one contour
            for curve in fill(region, beads):
                if curve.kind == "contour":
                    rings_by_key.setdefault((layer, curve.ring), []).append(curve.points)
        return {key: rings[0] for key, rings in rings_by_key.items() if len(rings) == 1}

    def measure_offset(a, b):
        """Distance of two starts as a share of the first ring's length."""
        points = shapes.densify(a, True, 0.1)
        position = np.argmin(np.hypot(*(points - b[0]).T)) / len(points)
        return min(position, 1.0 - position)

    def list_offsets(rings_by_key):
        pairs = [
            (key, (key[0] + i, key[1] + j))
            for key in rings_by_key
            for i, j in ((0, 1), (1, 0), (1, 1), (1, -1))
        ]
        return [
            measure_offset(rings_by_key[a], rings_by_key[b]) for a, b in pairs if b in rings_by_key
        ]

    assert max(list_offsets(list_starts(False))) < 0.12 or name in ("wavy 2", "L", "blade")
    offsets = list_offsets(list_starts(True))
    # if a contour's shape differs from the outer one, so do the shares of its length
    assert (
        len(offsets) > 8
        and np.median(offsets) > 0.2
        and min(offsets) > (0.02 if name in ("wavy 2", "L") else 0.08)
    )


@pytest.mark.parametrize(
    "spacing_range,message",
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
def test_invalid_ranges_are_rejected(spacing_range, message):
    with pytest.raises(InputError, match="spacing_range") as caught:
        DevelopableParameters(spacing_range=spacing_range)
    assert message in str(caught.value)


@pytest.mark.parametrize("thickness", [7.0, 12.5, 22.0])
def test_beads_cover_their_width(thickness):
    """Bars with beads wider or narrower than nominal, compared with the area that discs of these
    widths sweep; round ends of open beads are trimmed."""
    loops = make_bar(thickness, 50.0)
    (region,) = regions(loops)
    curves, share = fit_and_share(region, "contours", 0.7, 1.4)
    grid = shapes.make_grid(loops, 0.25)[0] + np.array([0.1, 0.07])
    trimmed = [trim_round_ends(curve) for curve in curves]
    within, swept_over = shapes.are_inside(loops, grid), sweep(trimmed, grid)
    cover = measure_cover(region, curves, BEADS)
    pixel, tolerance = (
        0.25**2,
        0.06 * 2.0 * (50.0 + thickness),
    )  # a quarter of a grid cell along the border
    assert cover.area == pytest.approx(region.area) and cover.covered == pytest.approx(
        pixel * swept_over.sum(), abs=tolerance
    )
    assert cover.missed == pytest.approx(pixel * (within & ~swept_over).sum(), abs=tolerance)
    assert cover.outside == pytest.approx(pixel * (swept_over & ~within).sum(), abs=tolerance)
    nominal_cover = measure_cover(region, [replace(curve, share=None) for curve in curves], BEADS)
    if abs(share - 1.0) > 0.1:
        assert (
            abs(nominal_cover.missed - cover.missed) + abs(nominal_cover.outside - cover.outside)
            > 2.0 * tolerance
        )


def ring_loops(thickness, outer=40.0):
    angle = 2.0 * np.pi * np.arange(400) / 400
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return [outer * circle, (outer - thickness) * circle[::-1]]


@pytest.mark.parametrize("thickness", [4.4, 5.0, 6.0, 7.2])
@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_narrow_beads_keep_half_their_width_from_the_border(thickness, turn):
    """A wall of 1.1 to 1.8 beads gets two beads, each half as wide as the wall."""
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    (region,) = regions([loop @ rotation + [11.0, -7.0] for loop in ring_loops(thickness)])
    beads = Beads(4.0, 0.8, 2.0, chord_error=0.002, width=4.0)
    curves = narrow_beads(fill(region, beads), beads, 0.0, 0.3)
    assert len(curves) == 2
    radii = sorted(float(np.hypot(*(curve.points - [11.0, -7.0]).T).mean()) for curve in curves)
    assert radii == pytest.approx([40.0 - 0.75 * thickness, 40.0 - 0.25 * thickness], abs=0.02)
    for curve in curves:
        assert curve.share * 4.0 == pytest.approx(
            np.full(len(curve.points), thickness / 2), rel=0.02
        )
    cover = measure_cover(region, curves, beads)
    assert cover.missed < 0.01 * cover.area and cover.outside < 0.01 * cover.area


def test_narrow_lines_keep_half_their_width_from_the_border():
    (region,) = regions([np.array([(0, 0), (60, 0), (60, 6), (0, 6)], dtype=float)])
    beads = Beads(4.0, 0.8, 2.0, chord_error=0.002, width=4.0)
    curves = narrow_beads(fill(region, beads, "lines"), beads, 0.0, 0.3)
    heights = sorted(float(curve.points[:, 1].mean()) for curve in curves)
    assert heights == pytest.approx([1.5, 4.5], abs=0.02)


def test_a_round_bead_next_to_a_neck_stays_round():
    """Beads narrow in the neck between two holes, without kinks or waves next to it."""
    angles = np.linspace(0.0, 2.0 * np.pi, 240, endpoint=False)
    circle = 10.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
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
        edges = np.diff(np.vstack([ring.points, ring.points[:2]]), axis=0)
        turns = np.unwrap(np.arctan2(edges[:, 1], edges[:, 0]))
        assert np.abs(np.diff(turns)).max() < 0.1  # rad between chords of 1 mm
