# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fillings measured: spacing, cover, gaps, sense, start, links; by distances of their own."""

import functools
import importlib.util
import time
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import IN_FRAMES, ON_BORDERS, PATTERNS, fill
from freecad_am.core.filling.sparse import Frame, Infill, levels_between, rows
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.issues import InfeasibleError, InputError
from freecad_am.core.parameters.filled import FILLS

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)
SHAPES, dense, inside, raster, tree, distance = (
    shapes.SHAPES,
    shapes.dense,
    shapes.inside,
    shapes.raster,
    shapes.tree,
    shapes.distance,
)

S, GAP, PITCH = 5.0, 2.0, 0.4
BEADS = Beads(S, GAP, 0.0)
STEP = 0.05


def test_every_pattern_has_a_function():
    assert set(ON_BORDERS) == {name for name in FILLS if FILLS[name].follows_border}
    assert set(ON_BORDERS) | set(IN_FRAMES) == set(FILLS)
    assert not set(ON_BORDERS) & set(IN_FRAMES)


def filled(name, pattern, beads=BEADS, **options):
    (region,) = regions(SHAPES[name])
    return fill(region, beads, pattern, **options)


@functools.cache
def ground(name):
    """Of a shape: its border, places of a grid, which of these are inside, and which beads inside can reach: those within
    half a bead of a place that is half a bead inside."""
    border = tree([(loop, True) for loop in SHAPES[name]], STEP)
    grid, within = raster(SHAPES[name], PITCH)
    core = within & (distance(border, grid, 0.5 * S) >= 0.5 * S)
    return (
        border,
        grid,
        within,
        distance(tree([(grid[core], False)], 1e9), grid, 0.5 * S) < 0.5 * S - PITCH,
    )


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always
def test_cover_gaps_and_nothing_outside(name, pattern):
    loops = SHAPES[name]
    gap = 1.0  # the gap allowed decides how much stays open
    curves = filled(name, pattern, Beads(S, gap, 0.0), angle=0.4, walls=1)
    border, grid, within, reach = ground(name)
    beads = tree([(curve.points, curve.closed) for curve in curves], STEP)
    # no middle of a bead nearer to the border than half a bead, minus the chord error
    points = np.vstack([dense(curve.points, curve.closed, 0.3) for curve in curves])
    assert inside(loops, points).all()
    assert distance(border, points, S).min() > 0.5 * S - 2.0 * BEADS.chord_error - 1e-3
    away = distance(beads, grid, S)
    assert ((away <= 0.5 * S) & ~within).sum() < 0.01 * within.sum()
    # the beads are points up to a STEP apart, and rows of the grid lie just between two of them
    covered = away <= np.hypot(0.5 * S, 0.5 * STEP)
    assert (covered & reach).sum() > 0.99 * reach.sum()
    # an open circle of the gap's diameter would have a middle that is half of it away from all beads
    assert away[reach].max() < 0.5 * S + 0.5 * gap + PITCH


@pytest.mark.parametrize("name", SHAPES)
def test_contours_are_a_spacing_apart(name):
    curves = [curve for curve in filled(name, "contours") if curve.kind == "contour"]
    border = tree([(loop, True) for loop in SHAPES[name]], 0.02)
    for curve in curves:
        assert curve.closed
        # every place of contour k is k + 1/2 spacings from the border: parallel to it, not to the one before
        away = border.query(dense(curve.points, True, 0.5))[0]
        assert np.abs(away - (curve.ring + 0.5) * S).max() < 0.01 * S
    for ring in range(1, 1 + max(curve.ring for curve in curves)):
        outer = tree([(curve.points, True) for curve in curves if curve.ring == ring - 1], 0.02)
        for curve in (curve for curve in curves if curve.ring == ring):
            assert np.abs(outer.query(dense(curve.points, True, 0.5))[0] - S).max() < 0.01 * S


def test_contours_cover_all_but_medial_axis_and_corners():
    loops = SHAPES["annulus"]
    curves = [curve for curve in filled("annulus", "contours") if curve.kind == "contour"]
    grid, within = raster(loops, 0.25)
    off_axis = within & (np.abs(np.hypot(*grid.T) - 38.8) > 0.5 * S)
    away = tree([(curve.points, True) for curve in curves], STEP).query(grid)[0]
    assert (away[off_axis] <= 0.5 * S + 0.02).mean() > 0.99


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_lines_are_parallel_and_a_spacing_apart(angle):
    curves = [curve for curve in filled("wavy 1", "lines", angle=angle) if curve.kind == "line"]
    way, across = (
        np.array([np.cos(angle), np.sin(angle)]),
        np.array([-np.sin(angle), np.cos(angle)]),
    )
    heights = np.array([curve.points @ across for curve in curves])
    assert np.ptp(heights, axis=1).max() < 1e-9
    levels = np.unique(heights.mean(axis=1).round(6))
    gaps = np.diff(levels)
    assert ((np.abs(gaps - S) < 0.01 * S).sum() >= len(gaps) - 2) and gaps.max() < S + GAP
    extent = np.vstack(SHAPES["wavy 1"]) @ across
    assert levels[0] - extent.min() == pytest.approx(0.5 * S, abs=0.02)
    assert extent.max() - levels[-1] == pytest.approx(0.5 * S, abs=0.02)
    senses = [np.sign((curve.points[-1] - curve.points[0]) @ way) for curve in curves]
    assert {1.0, -1.0} == set(senses)


def test_levels_of_lines():
    assert levels_between(0.0, 19.9, BEADS) == pytest.approx(
        [0, 4.975, 9.95, 14.925, 19.9], abs=1e-5
    )
    assert levels_between(0.0, 20.02, BEADS) == pytest.approx(
        [0, 5.005, 10.01, 15.015, 20.02], abs=1e-5
    )
    assert levels_between(0.0, 20.1, BEADS) == pytest.approx(
        [0, 5, 10, 12.55, 15.1, 20.1], abs=1e-5
    )
    assert levels_between(0.0, 21.0, BEADS) == pytest.approx([0, 5, 10, 13, 16, 21], abs=1e-5)
    assert levels_between(0.0, 19.0, BEADS) == pytest.approx([0, 5, 9.5, 14, 19], abs=1e-5)
    assert levels_between(3.0, 3.0, BEADS) == pytest.approx([3.0])
    for breadth in np.random.default_rng(3).uniform(0.0, 80.0, 300):
        levels = levels_between(0.0, breadth, BEADS)
        gaps = np.diff(levels)
        assert (gaps > 0.0).all() and gaps.max(initial=0.0) < 1.002 * S + 1e-5
        assert levels[0] < 1e-5 and breadth - levels[-1] < 1e-5
        assert (gaps < 0.99 * S - 1e-5).sum() <= 2, "what is left over is in one place"


@pytest.mark.parametrize("name", ["circle", "comb", "wavy 2"])
def test_zigzags_link_lines_inside_and_shortly(name):
    curves = [curve for curve in filled(name, "zigzag") if curve.kind == "zigzag"]
    lines = [curve for curve in filled(name, "lines") if curve.kind == "line"]
    assert 0 < len(curves) < 0.6 * len(lines)
    for curve in curves:
        step = np.diff(curve.points, axis=0)
        level = np.abs(step[:, 1]) < 1e-9
        run = np.hypot(*step.T)
        ends = np.flatnonzero(level & (run > 1e-9))
        for a, b in zip(ends, ends[1:]):
            assert run[a + 1 : b].sum() < 3.0 * S + 1e-9
    length = sum(np.hypot(*np.diff(line.points, axis=0).T).sum() for line in lines)
    steps = np.vstack([np.diff(curve.points, axis=0) for curve in curves])
    along = np.abs(steps[np.abs(steps[:, 1]) < 1e-9, 0]).sum()
    assert along == pytest.approx(length, rel=0.02)


def test_a_spiral_is_one_curve_from_the_border_to_the_middle():
    spirals = [curve for curve in filled("circle", "spiral") if curve.kind == "spiral"]
    (spiral,) = spirals
    assert not spiral.closed
    radius = np.hypot(*spiral.points.T)
    assert radius[0] == pytest.approx(34.5, abs=0.03) and radius.min() < 5.0
    assert (np.diff(radius) < 0.05).all(), "it never goes out again"
    assert np.hypot(*np.diff(dense(spiral.points, False, 0.5), axis=0).T).max() <= 0.5 + 1e-9
    # where the U's legs part, each has its own
    assert len([curve for curve in filled("U", "spiral") if curve.kind == "spiral"]) >= 1


@pytest.mark.parametrize("clockwise", [False, True])
def test_sense_and_start(clockwise):
    beads = Beads(S, GAP, 0.0, clockwise=clockwise, start=(100.0, 0.0))
    for curve in filled("annulus", "contours", beads):
        x, y = curve.points.T
        assert ((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() < 0) == clockwise
        assert np.degrees(np.arctan2(y[0], x[0])) == pytest.approx(0.0, abs=1.5), (
            "starts are lined up"
        )
    up = Beads(S, GAP, 0.0, start=0.5 * np.pi)
    for curve in filled("annulus", "contours", up):
        assert curve.points[0, 1] == pytest.approx(curve.points[:, 1].max(), abs=1e-6)


def test_thin_regions_and_necks():
    (thin,) = regions(shapes.blade(100.0, 4.0))
    (curve,) = fill(thin, BEADS)
    assert curve.kind == "centre" and not curve.closed
    assert np.ptp(curve.points[:, 0]) > 70.0
    neck = shapes.polygon(
        (0, 0),
        (40, 0),
        (40, 18),
        (60, 18),
        (60, 0),
        (100, 0),
        (100, 40),
        (60, 40),
        (60, 21),
        (40, 21),
        (40, 40),
        (0, 40),
    )
    (region,) = regions(neck)
    (bridge,) = [
        curve
        for curve in fill(region, BEADS)
        if curve.kind == "centre" and 45.0 < curve.points[:, 0].mean() < 55.0
    ]
    assert np.abs(bridge.points[:, 1] - 19.5).max() < 0.2
    for shape in (thin, region):
        with pytest.raises(InfeasibleError) as refused:
            fill(shape, Beads(S, GAP, 0.0, thin="refuse"))
        assert refused.value.code == "THIN_REGION"


@pytest.mark.parametrize("pattern", PATTERNS)
def test_short_beads_that_close_gaps_go_on_until_they_are_long_enough(pattern):
    least = 12.0
    curves = filled("wavy 1", pattern, Beads(S, GAP, least), walls=1)
    lines = [
        np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        for curve in curves
    ]
    lengths = [np.hypot(*np.diff(line, axis=0).T).sum() for line in lines]
    assert min(lengths) >= least - 1e-9
    _, grid, _, reach = ground("wavy 1")
    away = distance(tree([(curve.points, curve.closed) for curve in curves], STEP), grid, S)
    assert away[reach].max() < 0.5 * (S + GAP) + PITCH


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always("connected", "contours", "lines", "spiral", "gyroid")
def test_scale_changes_nothing_and_neither_does_doing_it_again(pattern):
    loops = SHAPES["blade"]
    one = filled("blade", pattern)
    (region,) = regions([loop.copy() for loop in loops])
    assert all(
        np.array_equal(a.points, b.points) for a, b in zip(one, fill(region, BEADS, pattern))
    )
    mine = sum(np.hypot(*np.diff(c.points, axis=0).T).sum() for c in one)
    for scale in (1e-3, 1e4):
        (large,) = regions([loop * scale for loop in loops])
        scaled = fill(large, Beads(S * scale, GAP * scale, 0.0), pattern)
        theirs = sum(np.hypot(*np.diff(c.points, axis=0).T).sum() for c in scaled)
        assert theirs / scale == pytest.approx(mine, rel=0.01)


def test_unknown_patterns_are_refused():
    with pytest.raises(InputError, match="unknown pattern 'fractal'"):
        filled("circle", "fractal")


def test_no_lines_where_they_have_room_but_nothing_to_run_through():
    (region,) = regions(SHAPES["circle"])
    assert rows(Frame([], (region,), (), []), BEADS, 0.3) == []


@pytest.mark.parametrize(
    ("loops", "closed"),
    [
        ([np.array([[0.0, 0.0], [30.0, 0.0], [12.0, 4e-4]])], False),
        (
            [
                np.array(
                    [
                        [0.0, 0.0],
                        [30.0, 0.0],
                        [30.0, 0.003],
                        [40.0, 20.0],
                        [29.997, 0.003],
                        [0.0, 0.003],
                    ]
                )
            ],
            False,
        ),
        ([shapes.circle(40.0, 720), shapes.circle(39.997, 720)[::-1]], True),
    ],
    ids=["needle", "hook", "ring"],
)
def test_slivers_thinner_than_the_chord_error_take_no_time(loops, closed):
    """What triangles leave of a section along a rim: their middle was searched for by places as near as they are thin."""
    (region,) = regions(loops)
    began = time.process_time()
    curves = fill(region, Beads(5.0, 1.0, 2.0, chord_error=0.02))
    assert time.process_time() - began < 0.5 and curves[0].closed == closed
    border = np.vstack(loops)
    line = np.vstack([shapes.dense(curve.points, curve.closed, 0.5) for curve in curves])
    away = shapes.distance(shapes.tree([(loop, True) for loop in loops], 0.05), line, 1.0)
    assert away.max() < 0.03  # the beads run along it, from one end of it to the other
    assert shapes.distance(shapes.tree([(line, False)], 0.05), border, 10.0).max() < 2.6


def _motions(count=6):
    """Turns, moves and mirror images of the plane: (matrix (2, 2), shift (2,))."""
    for k in range(count):
        angle = np.radians(23.0) * k
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        yield turn @ np.diag([-1.0 if k % 2 else 1.0, 1.0]), np.array([37.3, -12.1]) * k


@pytest.mark.parametrize("pattern", ["contours", "lines"])
def test_a_moved_section_has_the_same_beads(pattern):
    """The foot of a bracket, whose bar is exactly five beads wide: in its middle rounding left a bead there and back, or
    none, as it was turned."""
    legs = [[45, -25], [45, 25], [31, 25], [31, -25]]
    left = [[-x, y] for x, y in legs[::-1]]
    bar = np.array([[-75, -45], [75, -45], [75, -25], *legs, *left, [-75, -25]], float)
    wanted = None
    for turn, shift in _motions():
        loop = bar @ turn.T + shift
        (region,) = regions([loop[::-1] if np.linalg.det(turn) < 0.0 else loop])
        walls = {"walls": 3} if pattern == "lines" else {}
        angle = np.arctan2(turn[1, 0], turn[0, 0])
        curves = fill(region, Beads(4.0, 0.8, 0.05), pattern, angle=angle, **walls)
        if pattern == "lines":
            curves = [curve for curve in curves if curve.kind == "contour"]
        lines = [np.vstack([c.points, c.points[:1]]) if c.closed else c.points for c in curves]
        total = sum(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines)
        if wanted is None:
            wanted = (len(curves), total)
        assert len(curves) == wanted[0] and total == pytest.approx(wanted[1], abs=0.5)


@pytest.mark.parametrize("pattern", ["lines", "zigzag", "honeycomb"])
@pytest.mark.parametrize("overlap", [None, 0.0, 0.15, 0.5])
def test_patterns_reach_into_their_walls_by_the_overlap(pattern, overlap):
    """In a disc, where the distance of a point from the border is known, with beads wider than their spacing."""
    radius, spacing, width = 60.0, 5.0, 6.0
    (region,) = regions([shapes.circle(radius, 720)])
    beads = Beads(spacing, 0.2 * spacing, 0.0, chord_error=0.005, width=width, overlap=overlap)
    infill = Infill(0.4) if pattern == "honeycomb" else Infill()
    curves = [
        curve
        for curve in fill(region, beads, pattern, angle=0.4, walls=2, infill=infill)
        if curve.kind not in ("contour", "closing", "centre")
    ]
    depth = radius - np.hypot(*np.vstack([curve.points for curve in curves]).T)
    wall = 0.5 * width + spacing  # depth of the middle of the second wall
    reach = 0.5 * spacing if overlap is None else (0.5 - overlap) * width
    assert depth.min() == pytest.approx(wall + reach, abs=0.03)
