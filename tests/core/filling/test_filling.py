# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spacing, coverage, gaps, direction, start and links of fills, from independent distances."""

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
SHAPES, densify, are_inside, make_grid, build_tree, nearest_distance = (
    shapes.SHAPES,
    shapes.densify,
    shapes.are_inside,
    shapes.make_grid,
    shapes.build_tree,
    shapes.nearest_distance,
)

SPACING, GAP, PITCH = 5.0, 2.0, 0.4
BEADS = Beads(SPACING, GAP, 0.0)
STEP = 0.05


def test_every_pattern_has_a_function():
    assert set(ON_BORDERS) == {name for name in FILLS if FILLS[name].follows_border}
    assert set(ON_BORDERS) | set(IN_FRAMES) == set(FILLS)
    assert not set(ON_BORDERS) & set(IN_FRAMES)


def fill_shape(name, pattern, beads=BEADS, **options):
    (region,) = regions(SHAPES[name])
    return fill(region, beads, pattern, **options)


@functools.cache
def measure_shape(name):
    """Return a shape's border, grid points, a mask of points inside, and a mask of points that
    beads inside can reach."""
    border = build_tree([(loop, True) for loop in SHAPES[name]], STEP)
    grid, within = make_grid(SHAPES[name], PITCH)
    core = within & (nearest_distance(border, grid, 0.5 * SPACING) >= 0.5 * SPACING)
    return (
        border,
        grid,
        within,
        nearest_distance(build_tree([(grid[core], False)], 1e9), grid, 0.5 * SPACING)
        < 0.5 * SPACING - PITCH,
    )


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always
def test_beads_cover_shapes_without_gaps_and_stay_inside(name, pattern):
    loops = SHAPES[name]
    gap = 1.0  # the allowed gap limits the open area
    curves = fill_shape(name, pattern, Beads(SPACING, gap, 0.0), angle=0.4, walls=1)
    border, grid, within, reach = measure_shape(name)
    beads = build_tree([(curve.points, curve.closed) for curve in curves], STEP)
    # no centreline is closer to the border than half a bead, apart from the chord error
    points = np.vstack([densify(curve.points, curve.closed, 0.3) for curve in curves])
    assert are_inside(loops, points).all()
    assert (
        nearest_distance(border, points, SPACING).min()
        > 0.5 * SPACING - 2.0 * BEADS.chord_error - 1e-3
    )
    bead_distance = nearest_distance(beads, grid, SPACING)
    assert ((bead_distance <= 0.5 * SPACING) & ~within).sum() < 0.01 * within.sum()
    # bead points are up to STEP apart, and grid rows may fall between two of them
    covered = bead_distance <= np.hypot(0.5 * SPACING, 0.5 * STEP)
    assert (covered & reach).sum() > 0.99 * reach.sum()
    # an uncovered circle of the gap's diameter would have its centre half a gap away from all beads
    assert bead_distance[reach].max() < 0.5 * SPACING + 0.5 * gap + PITCH


@pytest.mark.parametrize("name", SHAPES)
def test_neighbouring_contours_keep_their_spacing(name):
    curves = [curve for curve in fill_shape(name, "contours") if curve.kind == "contour"]
    border = build_tree([(loop, True) for loop in SHAPES[name]], 0.02)
    for curve in curves:
        assert curve.closed
        # contour k is k + 1/2 spacings from the border: parallel to the border, not to the previous contour
        border_distance = border.query(densify(curve.points, True, 0.5))[0]
        assert np.abs(border_distance - (curve.ring + 0.5) * SPACING).max() < 0.01 * SPACING
    for ring in range(1, 1 + max(curve.ring for curve in curves)):
        outer = build_tree(
            [(curve.points, True) for curve in curves if curve.ring == ring - 1], 0.02
        )
        for curve in (curve for curve in curves if curve.ring == ring):
            assert (
                np.abs(outer.query(densify(curve.points, True, 0.5))[0] - SPACING).max()
                < 0.01 * SPACING
            )


def test_contours_cover_all_except_the_medial_axis():
    loops = SHAPES["annulus"]
    curves = [curve for curve in fill_shape("annulus", "contours") if curve.kind == "contour"]
    grid, within = make_grid(loops, 0.25)
    off_axis = within & (np.abs(np.hypot(*grid.T) - 38.8) > 0.5 * SPACING)
    bead_distance = build_tree([(curve.points, True) for curve in curves], STEP).query(grid)[0]
    assert (bead_distance[off_axis] <= 0.5 * SPACING + 0.02).mean() > 0.99


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_lines_are_parallel_and_keep_their_spacing(angle):
    curves = [curve for curve in fill_shape("wavy 1", "lines", angle=angle) if curve.kind == "line"]
    along, across = (
        np.array([np.cos(angle), np.sin(angle)]),
        np.array([-np.sin(angle), np.cos(angle)]),
    )
    heights = np.array([curve.points @ across for curve in curves])
    assert np.ptp(heights, axis=1).max() < 1e-9
    levels = np.unique(heights.mean(axis=1).round(6))
    gaps = np.diff(levels)
    assert (
        (np.abs(gaps - SPACING) < 0.01 * SPACING).sum() >= len(gaps) - 2
    ) and gaps.max() < SPACING + GAP
    extent = np.vstack(SHAPES["wavy 1"]) @ across
    assert levels[0] - extent.min() == pytest.approx(0.5 * SPACING, abs=0.02)
    assert extent.max() - levels[-1] == pytest.approx(0.5 * SPACING, abs=0.02)
    senses = [np.sign((curve.points[-1] - curve.points[0]) @ along) for curve in curves]
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
        assert (gaps > 0.0).all() and gaps.max(initial=0.0) < 1.002 * SPACING + 1e-5
        assert levels[0] < 1e-5 and breadth - levels[-1] < 1e-5
        assert (gaps < 0.99 * SPACING - 1e-5).sum() <= 2, "what is left over is in one place"


@pytest.mark.parametrize("name", ["circle", "comb", "wavy 2"])
def test_zigzags_link_lines_by_short_steps(name):
    curves = [curve for curve in fill_shape(name, "zigzag") if curve.kind == "zigzag"]
    lines = [curve for curve in fill_shape(name, "lines") if curve.kind == "line"]
    assert 0 < len(curves) < 0.6 * len(lines)
    for curve in curves:
        step = np.diff(curve.points, axis=0)
        is_level = np.abs(step[:, 1]) < 1e-9
        lengths = np.hypot(*step.T)
        ends = np.flatnonzero(is_level & (lengths > 1e-9))
        for a, b in zip(ends, ends[1:]):
            assert lengths[a + 1 : b].sum() < 3.0 * SPACING + 1e-9
    length = sum(np.hypot(*np.diff(line.points, axis=0).T).sum() for line in lines)
    steps = np.vstack([np.diff(curve.points, axis=0) for curve in curves])
    along = np.abs(steps[np.abs(steps[:, 1]) < 1e-9, 0]).sum()
    assert along == pytest.approx(length, rel=0.02)


def test_a_spiral_runs_from_the_border_to_the_middle():
    spirals = [curve for curve in fill_shape("circle", "spiral") if curve.kind == "spiral"]
    (spiral,) = spirals
    assert not spiral.closed
    radius = np.hypot(*spiral.points.T)
    assert radius[0] == pytest.approx(34.5, abs=0.03) and radius.min() < 5.0
    assert (np.diff(radius) < 0.05).all(), "it never goes out again"
    assert np.hypot(*np.diff(densify(spiral.points, False, 0.5), axis=0).T).max() <= 0.5 + 1e-9
    # where the legs of the U split, each gets its own spiral
    assert len([curve for curve in fill_shape("U", "spiral") if curve.kind == "spiral"]) >= 1


@pytest.mark.parametrize("clockwise", [False, True])
def test_contours_keep_direction_and_start(clockwise):
    beads = Beads(SPACING, GAP, 0.0, clockwise=clockwise, start=(100.0, 0.0))
    for curve in fill_shape("annulus", "contours", beads):
        x, y = curve.points.T
        assert ((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() < 0) == clockwise
        assert np.degrees(np.arctan2(y[0], x[0])) == pytest.approx(0.0, abs=1.5), (
            "starts are lined up"
        )
    up = Beads(SPACING, GAP, 0.0, start=0.5 * np.pi)
    for curve in fill_shape("annulus", "contours", up):
        assert curve.points[0, 1] == pytest.approx(curve.points[:, 1].max(), abs=1e-6)


def test_thin_regions_and_necks_get_centre_beads():
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
        with pytest.raises(InfeasibleError) as caught:
            fill(shape, Beads(SPACING, GAP, 0.0, thin="refuse"))
        assert caught.value.code == "THIN_REGION"


@pytest.mark.parametrize("pattern", PATTERNS)
def test_short_gap_closing_beads_grow_to_the_minimum_length(pattern):
    min_length = 12.0
    curves = fill_shape("wavy 1", pattern, Beads(SPACING, GAP, min_length), walls=1)
    lines = [
        np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        for curve in curves
    ]
    lengths = [np.hypot(*np.diff(line, axis=0).T).sum() for line in lines]
    assert min(lengths) >= min_length - 1e-9
    _, grid, _, reach = measure_shape("wavy 1")
    bead_distance = nearest_distance(
        build_tree([(curve.points, curve.closed) for curve in curves], STEP), grid, SPACING
    )
    assert bead_distance[reach].max() < 0.5 * (SPACING + GAP) + PITCH


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always("connected", "contours", "lines", "spiral", "gyroid")
def test_scale_and_repetition_do_not_change_fills(pattern):
    loops = SHAPES["blade"]
    curves = fill_shape("blade", pattern)
    (region,) = regions([loop.copy() for loop in loops])
    assert all(
        np.array_equal(a.points, b.points) for a, b in zip(curves, fill(region, BEADS, pattern))
    )
    length = sum(np.hypot(*np.diff(curve.points, axis=0).T).sum() for curve in curves)
    for scale in (1e-3, 1e4):
        (large,) = regions([loop * scale for loop in loops])
        scaled = fill(large, Beads(SPACING * scale, GAP * scale, 0.0), pattern)
        scaled_length = sum(np.hypot(*np.diff(curve.points, axis=0).T).sum() for curve in scaled)
        assert scaled_length / scale == pytest.approx(length, rel=0.01)


def test_unknown_patterns_are_rejected():
    with pytest.raises(InputError, match="unknown pattern 'fractal'"):
        fill_shape("circle", "fractal")


def test_frames_without_inner_regions_get_no_lines():
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
def test_slivers_thinner_than_the_chord_error_are_filled_quickly(loops, closed):
    """Sections through triangles along a rim leave slivers; the search for their middle used to
    sample as finely as they are thin."""
    (region,) = regions(loops)
    start_time = time.process_time()
    curves = fill(region, Beads(5.0, 1.0, 2.0, chord_error=0.02))
    assert time.process_time() - start_time < 0.5 and curves[0].closed == closed
    border = np.vstack(loops)
    line = np.vstack([shapes.densify(curve.points, curve.closed, 0.5) for curve in curves])
    border_distance = shapes.nearest_distance(
        shapes.build_tree([(loop, True) for loop in loops], 0.05), line, 1.0
    )
    assert border_distance.max() < 0.03  # the beads follow the sliver from end to end
    assert (
        shapes.nearest_distance(shapes.build_tree([(line, False)], 0.05), border, 10.0).max() < 2.6
    )


def list_motions(count=6):
    """Rotations, moves and mirror images of the plane: (matrix (2, 2), shift (2,))."""
    for k in range(count):
        angle = np.radians(23.0) * k
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        yield turn @ np.diag([-1.0 if k % 2 else 1.0, 1.0]), np.array([37.3, -12.1]) * k


@pytest.mark.parametrize("pattern", ["contours", "lines"])
def test_a_moved_section_gets_the_same_beads(pattern):
    """The bar of a bracket's foot is exactly five beads wide; rounding once decided by the pose
    whether its middle got a bead."""
    legs = [[45, -25], [45, 25], [31, 25], [31, -25]]
    mirrored_legs = [[-x, y] for x, y in legs[::-1]]
    bar = np.array([[-75, -45], [75, -45], [75, -25], *legs, *mirrored_legs, [-75, -25]], float)
    expected = None
    for motion, shift in list_motions():
        loop = bar @ motion.T + shift
        (region,) = regions([loop[::-1] if np.linalg.det(motion) < 0.0 else loop])
        walls = {"walls": 3} if pattern == "lines" else {}
        angle = np.arctan2(motion[1, 0], motion[0, 0])
        curves = fill(region, Beads(4.0, 0.8, 0.05), pattern, angle=angle, **walls)
        if pattern == "lines":
            curves = [curve for curve in curves if curve.kind == "contour"]
        lines = [np.vstack([c.points, c.points[:1]]) if c.closed else c.points for c in curves]
        total = sum(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines)
        if expected is None:
            expected = (len(curves), total)
        assert len(curves) == expected[0] and total == pytest.approx(expected[1], abs=0.5)


@pytest.mark.parametrize("pattern", ["lines", "zigzag", "honeycomb"])
@pytest.mark.parametrize("overlap", [None, 0.0, 0.15, 0.5])
def test_patterns_overlap_their_walls_by_the_overlap(pattern, overlap):
    """In a disc every distance to the border is known; beads are wider than their spacing."""
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
    wall = 0.5 * width + spacing  # depth of the second wall's centreline
    reach = 0.5 * spacing if overlap is None else (0.5 - overlap) * width
    assert depth.min() == pytest.approx(wall + reach, abs=0.03)
