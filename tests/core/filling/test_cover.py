# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cover at the defaults of a job, measured on a raster by distances of its own: no wedges, no gaps, nothing outside."""

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
S, GAP = DEFAULT.bead_spacing, DEFAULT.gap * DEFAULT.bead_spacing
BEADS = Beads(S, GAP, DEFAULT.least_bead, DEFAULT.thin, chord_error=0.2 * DEFAULT.chord_error)
PITCH, STEP = 0.3, 0.1
WAYS = [
    ("contours", 0.0),
    ("spiral", 0.0),
    ("lines", 0.0),
    ("lines", 0.52),
    ("lines", 1.57),
    ("zigzag", 0.0),
    ("zigzag", 0.8),
]
IDS = [f"{pattern} {angle}" for pattern, angle in WAYS]


def star(seed):
    """A polygon with corners at random, seen all from its middle."""
    rng = np.random.default_rng(seed)
    angle = 2.0 * np.pi * (np.arange(9) + rng.uniform(-0.3, 0.3, 9)) / 9
    return [rng.uniform(16.0, 34.0, (9, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)]


REGIONS = {
    "rectangle": shapes.polygon((0, 0), (40, 0), (40, 16), (0, 16)),
    "L": shapes.polygon((0, 0), (50, 0), (50, 21), (24, 21), (24, 40), (0, 40)),
    "lens": shapes.blade(80.0, 22.0, 6.0),
    "ring": [shapes.circle(26.0), shapes.circle(11.3)[::-1]],
    "star 1": star(1),
    "star 2": star(2),
    "star 3": star(3),
}


def whole(curve):
    return np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points


@functools.cache
def ground(name):
    """Of a region: places of a grid, which of these are inside, how far they are from the border, up to half a bead, and
    what beads inside can reach: within half a bead of a place that is half a bead inside."""
    grid, within = shapes.raster(REGIONS[name], PITCH)
    border = shapes.tree([(loop, True) for loop in REGIONS[name]], STEP)
    from_border = shapes.distance(border, grid, 0.5 * S)
    reach = (
        shapes.distance(cKDTree(grid[within & (from_border >= 0.5 * S)]), grid, 0.5 * S)
        < 0.5 * S - PITCH
    )
    return grid, within, from_border, reach


@pytest.mark.parametrize("pattern,angle", WAYS, ids=IDS)
@pytest.mark.parametrize("name", REGIONS)
@pytest.mark.always
def test_at_least_99_percent_is_covered_and_no_bead_is_outside(name, pattern, angle):
    (region,) = regions(REGIONS[name])
    curves = fill(region, BEADS, pattern, angle, DEFAULT.contour)
    grid, within, from_border, reach = ground(name)
    away = shapes.distance(
        shapes.tree([(curve.points, curve.closed) for curve in curves], STEP), grid, 2.0 * S
    )
    covered = away <= 0.5 * S + 1e-3
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert away[reach].max() < 0.5 * (S + GAP) + 0.02, "no gap is wider than stated"
    assert not (covered & ~within & (from_border > 0.05)).any()
    assert open_places(region, curves, BEADS) == []
    for curve in curves:
        line = whole(curve)
        assert np.hypot(*np.diff(line, axis=0).T).sum() >= DEFAULT.least_bead - 1e-9
        if curve.kind == "zigzag":  # no step turns the travel for nothing
            assert np.hypot(*np.diff(line, axis=0).T).min() >= 2.0 * BEADS.chord_error


def test_lines_keep_their_spacing_from_the_contour_round_them():
    for angle in (0.0, 0.5 * np.pi):
        curves = fill(regions(REGIONS["rectangle"])[0], BEADS, "lines", angle, True)
        across = np.array([-np.sin(angle), np.cos(angle)])
        level = np.sort(
            [(curve.points @ across).mean() for curve in curves if curve.kind == "line"]
        )
        extent = np.sort(REGIONS["rectangle"][0] @ across)[[0, -1]]
        assert level[0] - extent[0] == pytest.approx(1.5 * S, rel=1e-3)
        assert extent[1] - level[-1] == pytest.approx(1.5 * S, rel=1e-3)


def test_a_gap_that_no_bead_closes_is_told():
    """Without the beads in the middle their places are told, with widths."""
    (region,) = regions(REGIONS["star 1"])
    curves = [
        curve for curve in fill(region, BEADS, "lines", 0.52, True) if curve.kind != "closing"
    ][:-1]
    found = open_places(region, curves, BEADS)
    tree = shapes.tree([(curve.points, curve.closed) for curve in curves], 0.02)
    assert found
    for place, width in found:
        assert region.contains(place[None])[0] and width >= 0.99 * GAP
        assert tree.query(place)[0] > 0.5 * S


@pytest.mark.parametrize("apex", [math.inf, 150.0])
@pytest.mark.parametrize(
    "pattern,angle", [("contours", 0.0), ("lines", 0.0), ("spiral", 0.0), ("zigzag", 1.57)]
)
@pytest.mark.always
def test_a_strip_round_a_hub_is_covered(apex, pattern, angle):
    turn = 190.0
    period = Period(turn if math.isinf(apex) else turn / apex, apex)
    u = turn * (np.arange(400) / 400 - 0.5)
    low, high = (
        1.2 * np.sin(2.0 * np.pi * 3 * u / turn),
        23.0 + 0.8 * np.cos(2.0 * np.pi * 2 * u / turn),
    )
    lower, upper = np.stack([u, low], axis=1), np.stack([u, high], axis=1)[::-1]
    (strip,) = strips([(period.from_uv(lower), 1), (period.from_uv(upper), -1)], period)
    curves = fill(strip, BEADS, pattern, angle, DEFAULT.contour)
    assert open_places(strip, curves, BEADS) == []
    # half of it and somewhat more, for what is beside; on the plane
    reach_of = 0.35 * turn

    def cloud(lines):
        cover = period.to_uv(np.vstack([shapes.dense(line, False, 0.1) for line in lines]))
        every = np.vstack([cover + np.array([k * turn, 0.0]) for k in (-1, 0, 1)])
        return cKDTree(period.from_uv(every[np.abs(every[:, 0]) < reach_of + 4.0 * S]))

    grid = np.stack(
        np.meshgrid(np.arange(-reach_of, reach_of, PITCH), np.arange(-5.0, 29.0, PITCH)), axis=-1
    ).reshape(-1, 2)
    border = np.interp(grid[:, 0], u, low), np.interp(grid[:, 0], u, high)
    within, flat = (grid[:, 1] > border[0]) & (grid[:, 1] < border[1]), period.from_uv(grid)
    edge = cloud([period.from_uv(lower), period.from_uv(upper)])
    lines = [
        np.vstack([curve.points, period.move_turns(curve.points[:1], curve.turns)])
        if curve.closed
        else curve.points
        for curve in curves
    ]
    away, from_border = cloud(lines).query(flat)[0], edge.query(flat)[0]
    middle = np.abs(grid[:, 0]) < reach_of - 2.0 * S
    reach = (
        cKDTree(flat[within & (from_border >= 0.5 * S)]).query(flat)[0] < 0.5 * S - PITCH
    ) & middle
    covered = away <= 0.5 * S + 0.02
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    outside = ~within & middle & (from_border > 0.1)
    for curve, line in zip(curves, lines, strict=True):  # each bead by its own width
        widest = 1.0 if curve.share is None else curve.share.max()
        distances = cloud([line]).query(flat[outside])[0]
        assert (distances > 0.5 * S * widest + 0.02).all()


@pytest.mark.parametrize("pattern,angle", WAYS, ids=IDS)
@pytest.mark.parametrize("name", ["rectangle", "L", "ring", "star 2"])
@pytest.mark.always
def test_beads_wider_than_their_spacing_cover_as_much_and_stay_inside(name, pattern, angle):
    """As laid: 9.5 mm wide at 6.5 mm, measured by the width."""
    width, beads = 9.5, replace(BEADS, spacing=6.5, gap=1.3, width=9.5)
    loops = [1.6 * loop for loop in REGIONS[name]]
    (region,) = regions(loops)
    curves = fill(region, beads, pattern, angle, DEFAULT.contour)
    grid, within = shapes.raster(loops, PITCH)
    from_border = shapes.distance(
        shapes.tree([(loop, True) for loop in loops], STEP), grid, 0.5 * width
    )
    away = shapes.distance(
        shapes.tree([(curve.points, curve.closed) for curve in curves], STEP), grid, 2.0 * width
    )
    reach = (
        shapes.distance(cKDTree(grid[within & (from_border >= 0.5 * width)]), grid, 0.5 * width)
        < 0.5 * width - PITCH
    )
    single = [
        curve for curve in curves if curve.kind == "centre" and curve.ring == 0
    ]  # stand out, and are told
    covered = away <= 0.5 * width + 1e-3
    assert (covered & reach).sum() >= 0.99 * reach.sum()
    assert away[reach].max() < 0.5 * width + 0.02 or away[reach].max() < 0.5 * (width + beads.gap)
    assert single or (covered & ~within & (from_border > 0.05)).sum() <= 0.01 * within.sum()
    middle = shapes.tree(
        [(curve.points, curve.closed) for curve in curves if curve not in single], STEP
    )
    assert middle.query(shapes.dense(loops[0], True, STEP))[0].min() > 0.5 * width - 0.05
    assert open_places(region, curves, beads) == []


def test_slits_are_closed_and_wedges_beside_them_told():
    """A slit across a rectangle at 40 deg: beads reach into neither of the sharp corners beside it."""
    t = math.tan(math.radians(40.0))

    def halves(slit):
        a, b = 20.0 - 10.0 / t, 20.0 + 10.0 / t
        left = shapes.polygon((-20, 0), (a - slit, 0), (b - slit, 20), (-20, 20))
        return left + shapes.polygon((a, 0), (60, 0), (60, 20), (b, 20))

    for slit in (0.0, 1e-6, 0.02):
        (whole,) = join(regions(halves(slit)), 0.05)
        assert len(whole.borders()) == 1 and whole.area == pytest.approx(
            1600.0, abs=0.3 + 20.0 * slit
        )
    apart = regions(halves(0.5))
    assert join(apart, 0.05) == apart and len(apart) == 2
    curves = [curve for region in apart for curve in fill(region, BEADS)]
    assert [place for region in apart for place in open_places(region, curves, BEADS)] == []
    told = [gap for region in join(apart, GAP) for gap in open_places(region, curves, BEADS)]
    tree = shapes.tree([(curve.points, curve.closed) for curve in curves], 0.02)
    assert told  # one place along the slit
    for place, width in told:
        assert tree.query(place)[0] > 0.5 * S and width > GAP
    single = regions(REGIONS["L"])
    assert join(single, GAP) == single


def test_strips_of_beads_wider_than_their_spacing_stay_inside():
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
def test_links_of_zigzags_lie_inside_of_their_contour(size):
    """What is laid, length times spacing, against the lines alone: links on the edge of the contour lay half on it."""
    (region,) = regions(shapes.polygon((0, 0), (size[0], 0), size, (0, size[1])))
    curves = fill(region, BEADS, "zigzag", 0.0, 1)
    laid = sum(np.hypot(*np.diff(whole(curve), axis=0).T).sum() * S for curve in curves)
    lines = sum(
        np.hypot(*np.diff(whole(curve), axis=0).T).sum() * S
        for curve in fill(region, BEADS, "lines", 0.0, 1)
    )
    ends = 2.0 * (size[1] - 2.0 * S)  # mm of the contour's inner edge that lines end on
    assert laid - lines < 0.15 * S * ends
    contour, corners = (
        curves[0],
        np.vstack([curve.points[1:-1] for curve in curves if curve.kind == "zigzag"]),
    )
    assert shapes.tree([(contour.points, True)], STEP).query(corners)[0].min() > 0.85 * S


def ribs(thick, pitch=20.0, count=3, foot=0.0):
    """A lattice of ribs, on a foot that beads fit into or without one."""
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
    "loops,least",
    [
        (ribs(3.5), 0.99),
        (ribs(4.4), 0.95),
        (ribs(4.0, foot=15.0), 0.985),
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
def test_ribs_thinner_than_a_bead_are_filled_in_all_their_branches(loops, least, pattern):
    """Of the whole section, as no bead has its usual room in ribs; ribs of 4.4 mm meet in places of their own contours."""
    curves = [curve for region in regions(loops) for curve in fill(region, BEADS, pattern, 0.0, 1)]
    grid, within = shapes.raster(loops, PITCH)
    away = shapes.tree([(curve.points, curve.closed) for curve in curves], STEP).query(grid)[0]
    assert (within & (away <= 0.5 * S)).sum() >= least * within.sum()
    assert away[within].max() < math.sqrt(0.5) * S + 0.02  # in a corner of 90 deg


def test_a_blade_that_runs_to_a_point_gets_a_bead_as_far_as_it_is_wider_than_the_narrowest():
    """12 mm wide at x = 0, nothing at x = -40: narrower than the narrowest bead beyond x0."""
    blade = np.array([(0, 0), (20, 0), (20, 12), (0, 12), (-40, 6)], dtype=float)
    x0 = -40.0 + 40.0 * BEADS.narrowest * S / 12.0
    for angle in (0.0, 0.3, 2.1, -1.2):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        (region,) = regions([(blade + [13.0, -7.0]) @ turn])
        curves = fill(region, BEADS)
        reached = min((curve.points @ turn.T - [13.0, -7.0])[:, 0].min() for curve in curves)
        assert -37.0 < reached < x0 + 0.1
        assert not bare_parts(region, curves, BEADS)  # the rest is shorter than a bead is wide


@pytest.mark.parametrize("corner", [90.0, 60.0, 40.0])
def test_corners_get_no_bead_of_their_own(corner):
    """They are no ribs: what is wider than the narrowest bead in them is shorter than a bead is wide."""
    half = math.tan(math.radians(0.5 * corner))
    (region,) = regions(shapes.polygon((0, 0), (60, -60 * half), (60, 60 * half)))
    reach = S / 2 / math.sin(math.radians(0.5 * corner))
    curves = fill(region, BEADS)
    assert min(curve.points[:, 0].min() for curve in curves) == pytest.approx(reach, abs=1e-6)


@pytest.mark.parametrize("size", [0.35, 0.6, 0.95])
@pytest.mark.parametrize("sides", [12, 24, 240])
def test_a_round_island_narrower_than_a_bead_gets_a_dot_of_its_volume(size, sides):
    """What is fed along the dot, spacing x length x share, is the island's area."""
    (region,) = regions([shapes.circle(0.5 * size * S, sides, (3.0, -2.0))])
    (dot,) = fill(region, BEADS)
    way = float(np.hypot(*np.diff(dot.points, axis=0).T).sum())
    share = 1.0 if dot.share is None else float(dot.share[0])
    if region.area / (S * BEADS.shortest) > BEADS.narrowest:
        assert S * way * share == pytest.approx(region.area, rel=1e-9)
    assert way >= BEADS.shortest - 1e-9 and share >= BEADS.narrowest
    assert np.allclose(dot.points.mean(axis=0), [3.0, -2.0], atol=1e-6)
    cover = measure_cover(region, [dot], BEADS)
    if share > BEADS.narrowest:
        assert cover.missed < 0.1 * region.area and cover.outside < 0.1 * region.area


def test_a_round_island_narrower_than_the_narrowest_bead_is_named():
    (region,) = regions([shapes.circle(0.4 * BEADS.narrowest * S)])
    assert fill(region, BEADS) == ()
    ((part, _),) = bare_parts(region, (), BEADS)
    assert part.area == region.area


def test_a_long_neck_between_plates_that_no_bead_fits_is_named():
    """Its corners are near the beads of the plates, but the beads do not reach its sides."""
    thin = 0.5 * BEADS.narrowest * S
    low, high = 10.0 - 0.5 * thin, 10.0 + 0.5 * thin
    outline = [(0, 0), (20, 0), (20, low), (60, low), (60, 0), (80, 0)]
    outline += [(80, 20), (60, 20), (60, high), (20, high), (20, 20), (0, 20)]
    (region,) = regions([np.array(outline, dtype=float)])
    curves = adapt_contours(region, BEADS, BeadLaw(S, S, BEADS.narrowest, 1.5))
    ((neck, _),) = bare_parts(region, curves, BEADS)
    assert neck.area == pytest.approx(40.0 * thin, rel=0.05)


def test_equal_sections_get_equal_beads_wherever_a_mesh_has_points_on_their_edges():
    """The section of a prism has a point more where a triangle of its side ends, elsewhere in each layer."""
    for share in (0.1, 0.3, 0.5, 0.7, 0.9):
        extra = (12.0 * share, 4.0 - 4.0 * share)
        loop = np.array([(0, -4), (12, 0), extra, (0, 4)], dtype=float)
        for first in range(4):
            (region,) = regions([np.roll(loop, first, axis=0)])
            region = region.simple(1e-4)
            assert len(region.borders()[0]) == 3
            curves = fill(region, replace(BEADS, spacing=5.0, gap=1.0))
            assert [curve.kind for curve in curves] == ["contour"]
