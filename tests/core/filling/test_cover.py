# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coverage with the default parameters of a job, measured on a raster: no wedges, no gaps, nothing
outside."""

import functools
import importlib.util
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.filling.adaptive_widths import BeadLaw, adapt_contours
from freecad_am.core.filling.centre import Beads, bare_parts
from freecad_am.core.filling.cover import measure_cover
from freecad_am.core.filling.fill import fill, open_places
from freecad_am.core.geometry.regions.region import join, regions
from freecad_am.core.geometry.regions.strip import Period, strips
from freecad_am.core.parameters.filled import DevelopableParameters

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)

DEFAULT = DevelopableParameters()
SPACING, GAP = DEFAULT.bead_spacing, DEFAULT.gap * DEFAULT.bead_spacing
BEADS = Beads(SPACING, GAP, DEFAULT.least_bead, DEFAULT.thin, chord_error=0.2 * DEFAULT.chord_error)
PITCH, STEP = 0.3, 0.1
PATTERN_ANGLES = [
    ("contours", 0.0),
    ("spiral", 0.0),
    ("lines", 0.0),
    ("lines", 0.52),
    ("lines", 1.57),
    ("zigzag", 0.0),
    ("zigzag", 0.8),
]
PATTERN_IDS = [f"{pattern} {angle}" for pattern, angle in PATTERN_ANGLES]


def make_star(seed):
    """Return a star-shaped polygon with random corners."""
    rng = np.random.default_rng(seed)
    angle = 2.0 * np.pi * (np.arange(9) + rng.uniform(-0.3, 0.3, 9)) / 9
    return [rng.uniform(16.0, 34.0, (9, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)]


REGIONS = {
    "rectangle": shapes.polygon((0, 0), (40, 0), (40, 16), (0, 16)),
    "L": shapes.polygon((0, 0), (50, 0), (50, 21), (24, 21), (24, 40), (0, 40)),
    "lens": shapes.blade(80.0, 22.0, 6.0),
    "ring": [shapes.circle(26.0), shapes.circle(11.3)[::-1]],
    "star 1": make_star(1),
    "star 2": make_star(2),
    "star 3": make_star(3),
}


def close_line(curve):
    return np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points


@functools.cache
def measure_region(name):
    """Return grid points of a region, a mask of points inside, their distance to the border (up to
    half a bead), and a mask of points that beads inside can reach."""
    grid, within = shapes.make_grid(REGIONS[name], PITCH)
    border = shapes.build_tree([(loop, True) for loop in REGIONS[name]], STEP)
    from_border = shapes.nearest_distance(border, grid, 0.5 * SPACING)
    reach = (
        shapes.nearest_distance(
            cKDTree(grid[within & (from_border >= 0.5 * SPACING)]), grid, 0.5 * SPACING
        )
        < 0.5 * SPACING - PITCH
    )
    return grid, within, from_border, reach


@pytest.mark.parametrize("pattern,angle", PATTERN_ANGLES, ids=PATTERN_IDS)
@pytest.mark.parametrize("name", REGIONS)
@pytest.mark.always
def test_beads_cover_99_percent_and_stay_inside(name, pattern, angle):
    (region,) = regions(REGIONS[name])
    curves = fill(region, BEADS, pattern, angle, DEFAULT.contour)
    grid, within, from_border, reach = measure_region(name)
    bead_distance = shapes.nearest_distance(
        shapes.build_tree([(curve.points, curve.closed) for curve in curves], STEP),
        grid,
        2.0 * SPACING,
    )
    covered = bead_distance <= 0.5 * SPACING + 1e-3
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert bead_distance[reach].max() < 0.5 * (SPACING + GAP) + 0.02, "no gap is wider than stated"
    assert not (covered & ~within & (from_border > 0.05)).any()
    assert open_places(region, curves, BEADS) == []
    for curve in curves:
        line = close_line(curve)
        assert np.hypot(*np.diff(line, axis=0).T).sum() >= DEFAULT.least_bead - 1e-9
        if curve.kind == "zigzag":  # no needless step
            assert np.hypot(*np.diff(line, axis=0).T).min() >= 2.0 * BEADS.chord_error


def test_lines_keep_their_spacing_from_the_outer_contour():
    for angle in (0.0, 0.5 * np.pi):
        curves = fill(regions(REGIONS["rectangle"])[0], BEADS, "lines", angle, True)
        across = np.array([-np.sin(angle), np.cos(angle)])
        level = np.sort(
            [(curve.points @ across).mean() for curve in curves if curve.kind == "line"]
        )
        extent = np.sort(REGIONS["rectangle"][0] @ across)[[0, -1]]
        assert level[0] - extent[0] == pytest.approx(1.5 * SPACING, rel=1e-3)
        assert extent[1] - level[-1] == pytest.approx(1.5 * SPACING, rel=1e-3)


def test_open_gaps_are_listed():
    """Without the middle beads the result lists their gaps, with widths."""
    (region,) = regions(REGIONS["star 1"])
    curves = [
        curve for curve in fill(region, BEADS, "lines", 0.52, True) if curve.kind != "closing"
    ][:-1]
    gaps = open_places(region, curves, BEADS)
    tree = shapes.build_tree([(curve.points, curve.closed) for curve in curves], 0.02)
    assert gaps
    for point, width in gaps:
        assert region.contains(point[None])[0] and width >= 0.99 * GAP
        assert tree.query(point)[0] > 0.5 * SPACING


@pytest.mark.parametrize("apex", [math.inf, 150.0])
@pytest.mark.parametrize(
    "pattern,angle", [("contours", 0.0), ("lines", 0.0), ("spiral", 0.0), ("zigzag", 1.57)]
)
@pytest.mark.always
def test_beads_cover_a_strip_around_a_hub(apex, pattern, angle):
    turn = 190.0
    period = Period(turn if math.isinf(apex) else turn / apex, apex)
    u = turn * (np.arange(400) / 400 - 0.5)
    lower_v, upper_v = (
        1.2 * np.sin(2.0 * np.pi * 3 * u / turn),
        23.0 + 0.8 * np.cos(2.0 * np.pi * 2 * u / turn),
    )
    lower, upper = np.stack([u, lower_v], axis=1), np.stack([u, upper_v], axis=1)[::-1]
    (strip,) = strips([(period.from_uv(lower), 1), (period.from_uv(upper), -1)], period)
    curves = fill(strip, BEADS, pattern, angle, DEFAULT.contour)
    assert open_places(strip, curves, BEADS) == []
    # half of the turn with a margin, in the plane
    half_range = 0.35 * turn

    def build_cloud(lines):
        cover = period.to_uv(np.vstack([shapes.densify(line, False, 0.1) for line in lines]))
        repeated = np.vstack([cover + np.array([k * turn, 0.0]) for k in (-1, 0, 1)])
        return cKDTree(
            period.from_uv(repeated[np.abs(repeated[:, 0]) < half_range + 4.0 * SPACING])
        )

    grid = np.stack(
        np.meshgrid(np.arange(-half_range, half_range, PITCH), np.arange(-5.0, 29.0, PITCH)),
        axis=-1,
    ).reshape(-1, 2)
    border = np.interp(grid[:, 0], u, lower_v), np.interp(grid[:, 0], u, upper_v)
    within, flat = (grid[:, 1] > border[0]) & (grid[:, 1] < border[1]), period.from_uv(grid)
    edge = build_cloud([period.from_uv(lower), period.from_uv(upper)])
    lines = [
        np.vstack([curve.points, period.move_turns(curve.points[:1], curve.turns)])
        if curve.closed
        else curve.points
        for curve in curves
    ]
    bead_distance, from_border = build_cloud(lines).query(flat)[0], edge.query(flat)[0]
    middle = np.abs(grid[:, 0]) < half_range - 2.0 * SPACING
    reach = (
        cKDTree(flat[within & (from_border >= 0.5 * SPACING)]).query(flat)[0]
        < 0.5 * SPACING - PITCH
    ) & middle
    covered = bead_distance <= 0.5 * SPACING + 0.02
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    outside = ~within & middle & (from_border > 0.1)
    for curve, line in zip(curves, lines, strict=True):  # compare each bead with its width
        widest = 1.0 if curve.share is None else curve.share.max()
        distances = build_cloud([line]).query(flat[outside])[0]
        assert (distances > 0.5 * SPACING * widest + 0.02).all()


@pytest.mark.parametrize("pattern,angle", PATTERN_ANGLES, ids=PATTERN_IDS)
@pytest.mark.parametrize("name", ["rectangle", "L", "ring", "star 2"])
@pytest.mark.always
def test_beads_wider_than_their_spacing_cover_and_stay_inside(name, pattern, angle):
    """Beads are 9.5 mm wide at a spacing of 6.5 mm; the check uses the width."""
    width, beads = 9.5, replace(BEADS, spacing=6.5, gap=1.3, width=9.5)
    loops = [1.6 * loop for loop in REGIONS[name]]
    (region,) = regions(loops)
    curves = fill(region, beads, pattern, angle, DEFAULT.contour)
    grid, within = shapes.make_grid(loops, PITCH)
    from_border = shapes.nearest_distance(
        shapes.build_tree([(loop, True) for loop in loops], STEP), grid, 0.5 * width
    )
    bead_distance = shapes.nearest_distance(
        shapes.build_tree([(curve.points, curve.closed) for curve in curves], STEP),
        grid,
        2.0 * width,
    )
    reach = (
        shapes.nearest_distance(
            cKDTree(grid[within & (from_border >= 0.5 * width)]), grid, 0.5 * width
        )
        < 0.5 * width - PITCH
    )
    single = [
        curve for curve in curves if curve.kind == "centre" and curve.ring == 0
    ]  # protrude, and are reported
    covered = bead_distance <= 0.5 * width + 1e-3
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert bead_distance[reach].max() < 0.5 * width + 0.02 or bead_distance[reach].max() < 0.5 * (
        width + beads.gap
    )
    assert single or (covered & ~within & (from_border > 0.05)).sum() <= 0.01 * within.sum()
    middle = shapes.build_tree(
        [(curve.points, curve.closed) for curve in curves if curve not in single], STEP
    )
    assert middle.query(shapes.densify(loops[0], True, STEP))[0].min() > 0.5 * width - 0.05
    assert open_places(region, curves, beads) == []


def test_narrow_slits_close_and_wide_ones_are_listed():
    """A slit crosses a rectangle at 40 deg; beads do not reach into the two sharp corners next to
    it."""
    t = math.tan(math.radians(40.0))

    def split_plate(slit):
        a, b = 20.0 - 10.0 / t, 20.0 + 10.0 / t
        left = shapes.polygon((-20, 0), (a - slit, 0), (b - slit, 20), (-20, 20))
        return left + shapes.polygon((a, 0), (60, 0), (60, 20), (b, 20))

    for slit in (0.0, 1e-6, 0.02):
        (joined,) = join(regions(split_plate(slit)), 0.05)
        assert len(joined.borders()) == 1 and joined.area == pytest.approx(
            1600.0, abs=0.3 + 20.0 * slit
        )
    pieces_of_plate = regions(split_plate(0.5))
    assert join(pieces_of_plate, 0.05) == pieces_of_plate and len(pieces_of_plate) == 2
    curves = [curve for region in pieces_of_plate for curve in fill(region, BEADS)]
    assert [gap for region in pieces_of_plate for gap in open_places(region, curves, BEADS)] == []
    gaps = [
        gap for region in join(pieces_of_plate, GAP) for gap in open_places(region, curves, BEADS)
    ]
    tree = shapes.build_tree([(curve.points, curve.closed) for curve in curves], 0.02)
    assert gaps  # one gap along the slit
    for gap, width in gaps:
        assert tree.query(gap)[0] > 0.5 * SPACING and width > GAP
    single = regions(REGIONS["L"])
    assert join(single, GAP) == single


def test_strips_with_beads_wider_than_their_spacing_stay_inside():
    period = Period(190.0)
    u = 190.0 * (np.arange(200) / 200 - 0.5)
    low, high = (
        np.stack([u, np.zeros(200)], axis=1),
        np.stack([u, np.full(200, 41.0)], axis=1)[::-1],
    )
    (strip,) = strips([(low, 1), (high, -1)], period)
    beads = replace(BEADS, spacing=6.5, gap=1.3, width=9.5)
    for pattern, angle, ring in (
        ("contours", 0.0, False),
        ("lines", 0.0, False),
        ("lines", 0.0, True),
        ("lines", 1.57, True),
    ):
        curves = fill(strip, beads, pattern, angle, ring)
        height = np.concatenate([curve.points[:, 1] for curve in curves])
        assert height.min() == pytest.approx(4.75, abs=0.02) and height.max() == pytest.approx(
            36.25, abs=0.02
        )
        assert open_places(strip, curves, beads) == []
        rows = np.unique(
            np.round([curve.points[:, 1].mean() for curve in curves if curve.turns], 2)
        )
        assert np.diff(rows).max() <= 6.6 or angle


@pytest.mark.parametrize("size", [(60.0, 43.0), (90.0, 63.0), (47.0, 31.0)])
def test_links_of_zigzags_stay_inside_their_contour(size):
    """Compare length times spacing with lines without links: links on the edge would half overlap
    the contour."""
    (region,) = regions(shapes.polygon((0, 0), (size[0], 0), size, (0, size[1])))
    curves = fill(region, BEADS, "zigzag", 0.0, 1)
    deposited = sum(
        np.hypot(*np.diff(close_line(curve), axis=0).T).sum() * SPACING for curve in curves
    )
    lines = sum(
        np.hypot(*np.diff(close_line(curve), axis=0).T).sum() * SPACING
        for curve in fill(region, BEADS, "lines", 0.0, 1)
    )
    ends = 2.0 * (size[1] - 2.0 * SPACING)  # mm of the contour's inner edge where lines end
    assert deposited - lines < 0.15 * SPACING * ends
    contour, corners = (
        curves[0],
        np.vstack([curve.points[1:-1] for curve in curves if curve.kind == "zigzag"]),
    )
    assert (
        shapes.build_tree([(contour.points, True)], STEP).query(corners)[0].min() > 0.85 * SPACING
    )


def make_ribs(thick, pitch=20.0, count=3, foot=0.0):
    """Return a lattice of ribs, with or without a foot that is wide enough for beads."""
    size = (count - 1) * pitch + thick
    holes = [
        np.array(
            [
                (x, y),
                (x, y + pitch - thick),
                (x + pitch - thick, y + pitch - thick),
                (x + pitch - thick, y),
            ]
        )
        for x in thick + pitch * np.arange(count - 1)
        for y in thick + pitch * np.arange(count - 1)
    ]
    outer = np.array([(0, -foot), (size, -foot), (size, size), (0, size)], dtype=float)
    return [outer, *holes]


@pytest.mark.parametrize(
    "loops,min_share",
    [
        (make_ribs(3.5), 0.99),
        (make_ribs(4.4), 0.95),
        (make_ribs(4.0, foot=15.0), 0.985),
        (
            shapes.polygon(
                (0, 0),
                (60, 0),
                (60, 12),
                (42, 12),
                (42, 40),
                (38, 40),
                (38, 12),
                (20, 12),
                (20, 40),
                (16, 40),
                (16, 12),
                (0, 12),
            ),
            0.99,
        ),
        (
            shapes.polygon(
                (0, 0),
                (30, 0),
                (30, 4),
                (17, 4),
                (17, 25),
                (30, 25),
                (30, 29),
                (0, 29),
                (0, 25),
                (13, 25),
                (13, 4),
                (0, 4),
            ),
            0.99,
        ),
    ],
    ids=["lattice 3.5", "lattice 4.4", "lattice on a foot", "fins", "I"],
)
@pytest.mark.parametrize("pattern", ["contours", "zigzag"])
def test_beads_fill_all_branches_of_thin_ribs(loops, min_share, pattern):
    """Shares of the whole section, because no bead fits with its nominal width; ribs of 4.4 mm have
    contours where they meet."""
    curves = [curve for region in regions(loops) for curve in fill(region, BEADS, pattern, 0.0, 1)]
    grid, within = shapes.make_grid(loops, PITCH)
    bead_distance = shapes.build_tree(
        [(curve.points, curve.closed) for curve in curves], STEP
    ).query(grid)[0]
    assert (within & (bead_distance <= 0.5 * SPACING)).sum() >= min_share * within.sum()
    assert bead_distance[within].max() < math.sqrt(0.5) * SPACING + 0.02  # in a corner of 90 deg


def test_a_bead_fills_a_tip_down_to_the_minimum_width():
    """The tip is 12 mm wide at x = 0 and ends at x = -40; beyond x0 it is below the minimum width."""
    blade = np.array([(0, 0), (20, 0), (20, 12), (0, 12), (-40, 6)], dtype=float)
    x0 = -40.0 + 40.0 * BEADS.narrowest * SPACING / 12.0
    for angle in (0.0, 0.3, 2.1, -1.2):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        (region,) = regions([(blade + [13.0, -7.0]) @ turn])
        curves = fill(region, BEADS)
        reached = min((curve.points @ turn.T - [13.0, -7.0])[:, 0].min() for curve in curves)
        assert -37.0 < reached < x0 + 0.1
        assert not bare_parts(
            region, curves, BEADS
        )  # the remaining tip is shorter than the bead width


@pytest.mark.parametrize("corner", [90.0, 60.0, 40.0])
def test_corners_get_no_separate_bead(corner):
    """A corner is not a rib: the part wide enough for a bead is shorter than a bead is wide."""
    half = math.tan(math.radians(0.5 * corner))
    (region,) = regions(shapes.polygon((0, 0), (60, -60 * half), (60, 60 * half)))
    reach = SPACING / 2 / math.sin(math.radians(0.5 * corner))
    curves = fill(region, BEADS)
    assert min(curve.points[:, 0].min() for curve in curves) == pytest.approx(reach, abs=1e-6)


@pytest.mark.parametrize("size", [0.35, 0.6, 0.95])
@pytest.mark.parametrize("sides", [12, 24, 240])
def test_a_round_island_narrower_than_a_bead_gets_a_dot_of_its_volume(size, sides):
    """The deposit along the dot, spacing x length x share, equals the island's area."""
    (region,) = regions([shapes.circle(0.5 * size * SPACING, sides, (3.0, -2.0))])
    (dot,) = fill(region, BEADS)
    length = float(np.hypot(*np.diff(dot.points, axis=0).T).sum())
    share = 1.0 if dot.share is None else float(dot.share[0])
    if region.area / (SPACING * BEADS.shortest) > BEADS.narrowest:
        assert SPACING * length * share == pytest.approx(region.area, rel=1e-9)
    assert length >= BEADS.shortest - 1e-9 and share >= BEADS.narrowest
    assert np.allclose(dot.points.mean(axis=0), [3.0, -2.0], atol=1e-6)
    cover = measure_cover(region, [dot], BEADS)
    if share > BEADS.narrowest:
        assert cover.missed < 0.1 * region.area and cover.outside < 0.1 * region.area


def test_a_round_island_below_the_minimum_width_is_listed():
    (region,) = regions([shapes.circle(0.4 * BEADS.narrowest * SPACING)])
    assert fill(region, BEADS) == ()
    ((bare_region, _),) = bare_parts(region, (), BEADS)
    assert bare_region.area == region.area


def test_a_long_neck_below_the_minimum_width_is_listed():
    """Its corners are close to the beads of the plates, but the beads do not reach its sides."""
    thin = 0.5 * BEADS.narrowest * SPACING
    low, high = 10.0 - 0.5 * thin, 10.0 + 0.5 * thin
    outline = [(0, 0), (20, 0), (20, low), (60, low), (60, 0), (80, 0)]
    outline += [(80, 20), (60, 20), (60, high), (20, high), (20, 20), (0, 20)]
    (region,) = regions([np.array(outline, dtype=float)])
    curves = adapt_contours(region, BEADS, BeadLaw(SPACING, SPACING, BEADS.narrowest, 1.5))
    ((neck, _),) = bare_parts(region, curves, BEADS)
    assert neck.area == pytest.approx(40.0 * thin, rel=0.05)


def test_extra_points_on_edges_do_not_change_beads():
    """A prism's section has extra points where triangles of its sides end, at other positions in
    each layer."""
    for share in (0.1, 0.3, 0.5, 0.7, 0.9):
        extra = (12.0 * share, 4.0 - 4.0 * share)
        loop = np.array([(0, -4), (12, 0), extra, (0, 4)], dtype=float)
        for shift in range(4):
            (region,) = regions([np.roll(loop, shift, axis=0)])
            region = region.simple(1e-4)
            assert len(region.borders()[0]) == 3
            curves = fill(region, replace(BEADS, spacing=5.0, gap=1.0))
            assert [curve.kind for curve in curves] == ["contour"]
