# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours of adaptive width: coverage, position, volume and independence of pose, measured with
shapely."""

from __future__ import annotations

import functools
import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.polygon import orient
from shapely.ops import unary_union

from freecad_am.core.filling.adaptive_widths import BeadLaw, adapt_contours
from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import fill
from freecad_am.core.filling.zigzag import adapt_lines
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.geometry.regions.spokes import find_spokes

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)

WIDTH = 4.0  # mm
WIDTH_STEP = 0.05  # of the width; strokes have the bead's mean width, so their errors cancel
LAW = BeadLaw(WIDTH, WIDTH, 0.3, 1.5)
BEADS = Beads(WIDTH, 0.2 * WIDTH, 2.0, chord_error=0.02)


def region_of(shape):
    shape = orient(shape)
    loops = [np.array(ring.coords)[:-1] for ring in (shape.exterior, *shape.interiors)]
    return max(regions(loops), key=lambda region: region.area)


def sweep(curve):
    """Union of short strokes, each as wide as the bead; its area equals the bead's volume per
    height."""
    points, shares = curve.closed_points()
    shares = np.ones(len(points)) if shares is None else shares
    if not curve.closed:
        points, shares = shapes.trim_round_ends(points, shares, WIDTH)
    counts = np.maximum(1, (np.abs(np.diff(shares)) / WIDTH_STEP).astype(int))
    positions = np.concatenate([k + np.arange(count) / count for k, count in enumerate(counts)])
    positions = np.r_[positions, len(points) - 1.0]
    indices = np.arange(len(points))
    line = np.stack([np.interp(positions, indices, points[:, k]) for k in (0, 1)], axis=1)
    widths = WIDTH * np.interp(positions, indices, shares)
    means = 0.5 * (widths[1:] + widths[:-1])
    starts = np.flatnonzero(np.r_[True, np.abs(np.diff(means)) > 1e-9])
    ends = np.r_[starts[1:], len(means)]
    return unary_union(
        [LineString(line[a : b + 1]).buffer(0.5 * means[a], 8) for a, b in zip(starts, ends)]
    )


def find_faults(shape):
    """Shares of a shape that the beads miss although a bead fits, deposit twice, and deposit
    outside."""
    return measure_faults(shape, sweep_beads(shape))


def sweep_beads(shape):
    return [sweep(curve) for curve in adapt_contours(region_of(shape), BEADS, LAW)]


@functools.lru_cache(maxsize=40)
def sweep_random(seed):
    """Return a random shape and its swept beads; both tests of random shapes use this cache."""
    shape = random_shape(np.random.default_rng(seed))
    return shape, sweep_beads(shape)


def measure_faults(shape, beads):
    union = unary_union(beads)
    reach = 0.5 * LAW.narrowest * WIDTH + 0.02
    wide_enough = shape.buffer(-reach).buffer(reach)
    return (
        wide_enough.difference(union).area / shape.area,
        (sum(bead.area for bead in beads) - union.area) / shape.area,
        union.difference(shape.buffer(0.01)).area / shape.area,
    )


def make_wall(count, length=60.0):
    return box(0.0, 0.0, length, count * WIDTH)


@pytest.mark.parametrize("count", [0.5, 1.0, 1.3, 1.5, 1.7, 2.0, 2.2, 2.6, 3.1, 3.5, 4.0])
def test_beads_cover_walls_of_any_thickness(count):
    missed, twice, outside = find_faults(make_wall(count))
    corners = (
        4 * (1.0 - 0.25 * math.pi) * WIDTH**2
    )  # maximum that round beads leave open in square corners
    assert missed * make_wall(count).area < corners
    assert twice < 0.003
    assert outside < 0.001


def test_wall_of_one_and_a_half_beads_gets_two_narrow_beads():
    (ring,) = adapt_contours(region_of(make_wall(1.5)), BEADS, LAW)
    assert ring.closed
    assert ring.share == pytest.approx(0.75, abs=0.01)
    assert region_of(make_wall(1.5)).nearest(ring.points)[1] == pytest.approx(1.5, abs=0.01)


def test_beads_follow_a_taper_down_to_the_minimum_width():
    length, root = 57.0, 4.0
    fin = Polygon([(0.0, -0.5 * root), (length, 0.0), (0.0, 0.5 * root)])
    curves = adapt_contours(region_of(fin), BEADS, LAW)
    tip = max(float(curve.points[:, 0].max()) for curve in curves)
    narrow = length * (1.0 - LAW.narrowest * WIDTH / root)  # position of the minimum width
    assert narrow - 1.5 < tip < narrow + 1.0


def polar_polygon(radius, angle):
    return Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


SHAPES = {
    "ring": Point(0, 0).buffer(30, 32).difference(Point(0, 0).buffer(20, 32)),
    "disc": Point(0, 0).buffer(13, 32),
    "bracket": Polygon([(0, 0), (60, 0), (60, 12), (14, 12), (14, 50), (0, 50)]),
    "taper": Polygon([(0, 0), (80, 6), (80, 8), (0, 14)]),
    "star": polar_polygon(np.tile([42.0, 17.0], 5), 0.2 * math.pi * np.arange(10) + 0.1),
    "teeth": Point(0, 0)
    .buffer(56, 40)
    .difference(
        polar_polygon(
            np.tile([40.0, 40.0, 46.0, 46.0], 36),
            math.pi / 18 * np.add.outer(np.arange(36), [0.0, 0.25, 0.5, 0.75]).ravel(),
        )
    ),
    "four holes": box(0, 0, 40, 40).difference(
        unary_union([Point(x, y).buffer(5, 16) for x in (10, 30) for y in (10, 30)])
    ),
    "dumbbell": unary_union([box(0, 0, 20, 20), box(20, 7, 45, 12), box(45, 0, 65, 20)]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_beads_cover_shapes_once(name):
    missed, twice, outside = find_faults(SHAPES[name])
    assert missed < 0.025
    assert twice < 0.015
    assert outside < 0.005


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("turn, mirrored", [(17.0, False), (90.0, False), (211.0, True)])
def test_beads_move_with_the_shape(name, turn, mirrored):
    """In another pose the number of beads and the covered area stay the same."""

    def move(shape):
        shape = affinity.scale(shape, xfact=-1.0, origin=(0, 0)) if mirrored else shape
        return affinity.translate(affinity.rotate(shape, turn, origin=(0, 0)), 123.4, -56.7)

    shape = SHAPES[name]
    curves, moved_curves = (
        adapt_contours(region_of(pose_shape), BEADS, LAW) for pose_shape in (shape, move(shape))
    )
    assert len(curves) == len(moved_curves)
    covered = move(unary_union([sweep(curve) for curve in curves]))
    covered_moved = unary_union([sweep(curve) for curve in moved_curves])
    assert covered.symmetric_difference(covered_moved).area < 1e-3 * shape.area


def random_shape(rng):
    """Return a polygon, a wall, a wedge, strokes like letters, or a plate with holes."""
    kind = rng.integers(0, 5)
    if kind == 0:
        angle, radius = np.sort(rng.uniform(0, 2 * np.pi, 9)), rng.uniform(8, 40, 9)
        shape = Polygon(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))
    elif kind == 1:
        line = LineString(np.cumsum(rng.normal(0, 18, (3, 2)), axis=0))
        shape = line.buffer(rng.uniform(0.25, 2.0) * WIDTH, join_style=2, cap_style=2)
    elif kind == 2:
        length = rng.uniform(20, 80)
        ends = rng.uniform(0, 10), rng.uniform(10, 20), rng.uniform(2, 25)
        shape = Polygon([(0, 0), (length, ends[0]), (length, ends[1]), (0, ends[2])])
    elif kind == 3:
        shape = unary_union(
            [
                LineString(rng.uniform(0, 50, (2, 2))).buffer(
                    rng.uniform(0.4, 1.6) * WIDTH, cap_style=2
                )
                for _ in range(4)
            ]
        )
    else:
        holes = [Point(*rng.uniform(5, 60, 2)).buffer(rng.uniform(2, 8)) for _ in range(5)]
        shape = box(0, 0, 70, 50).difference(unary_union(holes))
    shape = shape.buffer(0)
    return max(getattr(shape, "geoms", [shape]), key=lambda part: part.area)


def test_beads_cover_random_shapes_and_stay_inside():
    figures = np.array([measure_faults(*sweep_random(seed)) for seed in range(40)])
    assert (np.median(figures, axis=0) < (0.02, 0.02, 0.002)).all()
    assert (np.percentile(figures, 90, axis=0) < (0.035, 0.05, 0.005)).all()
    assert (figures.max(axis=0) < (0.06, 0.12, 0.01)).all()


def compare_poses(shape, beads, rng):
    """Share of a shape that beads cover in only one of two poses, and the difference in the number
    of beads."""
    angle, offset = rng.uniform(0.0, 360.0), rng.uniform(-200.0, 200.0, 2)

    def move(geometry):
        return affinity.translate(affinity.rotate(geometry, angle, origin=(0, 0)), *offset)

    moved_beads = sweep_beads(move(shape))
    covered, covered_moved = (
        unary_union(pose_beads).buffer(0) for pose_beads in (beads, moved_beads)
    )
    difference = move(covered).buffer(0).symmetric_difference(covered_moved).area / shape.area
    return difference, abs(len(moved_beads) - len(beads))


def test_random_shapes_get_the_same_beads_in_any_pose():
    differences = np.array(
        [
            compare_poses(*sweep_random(seed), np.random.default_rng(1000 + seed))
            for seed in range(24)
        ]
    )
    assert (differences[:, 1] == 0).all()
    assert np.median(differences[:, 0]) < 1e-3
    assert differences[:, 0].max() < 0.005


@pytest.mark.long
@pytest.mark.parametrize("thousand", range(10))
def test_thousands_of_random_shapes_get_equal_beads_in_five_poses(thousand):
    """The limits cover 10,000 shapes: where strokes cross at a fork, rounding may add or remove one
    bead."""
    figures, differences = [], []
    for seed in range(1000 * thousand, 1000 * thousand + 1000):
        shape = random_shape(np.random.default_rng(seed))
        beads = sweep_beads(shape)
        figures.append(measure_faults(shape, beads))
        rng = np.random.default_rng(10**6 + seed)
        differences.append(np.max([compare_poses(shape, beads, rng) for _ in range(4)], axis=0))
    assert (np.median(figures, axis=0) < (0.025, 0.03, 0.002)).all()
    assert (np.percentile(figures, 99, axis=0) < (0.08, 0.2, 0.02)).all()
    area_difference, count_difference = np.array(differences).T
    assert np.mean(count_difference > 0) < 0.01
    assert np.percentile(area_difference, 95) < 0.01


# two plates on a neck, and a plate with a wedge: beads run obliquely across the spokes at the shoulders
SHOULDERS = {
    "dovetail": [
        (0, 0), (20.18, 0), (20.18, 3.45), (62.73, 4.54),
        (62.73, 17.47), (20.18, 18.56), (20.18, 20.18), (0, 20.18),
    ],
    "tang": [
        (0, 0), (41.26, 0), (41.26, 10.1), (73.99, 9.76),
        (73.99, 21.64), (41.26, 21.3), (41.26, 41.26), (0, 41.26),
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", SHOULDERS)
@pytest.mark.parametrize(("spacing", "narrowest"), [(5.0, 0.3), (3.7, 0.3), (5.0, 0.6)])
def test_no_bead_is_narrower_or_wider_than_allowed(name, spacing, narrowest):
    law = BeadLaw(5.0, spacing, narrowest, 1.5)
    beads = Beads(spacing, 0.2 * spacing, 2.0, chord_error=0.02, width=5.0)
    curves = adapt_contours(region_of(Polygon(SHOULDERS[name])), beads, law)
    shares = [curve.share for curve in curves if curve.share is not None]
    assert shares
    for share in shares:
        assert share.min() >= narrowest - 1e-9 and share.max() <= 1.5 + 1e-9


def make_blade(half_angle, radius):
    """Return a wedge with a tip, an arc to a half width of 7 mm, then 50 mm that widen slowly."""
    angle, slope = math.radians(half_angle), math.atan(0.02)
    turned = np.linspace(angle, slope, 24)
    arc = radius * np.stack([-np.sin(turned), np.cos(turned)], axis=1)
    arc += [0.0, 7.0] - arc[-1]
    start = arc[0]
    tip = start - start[1] / math.sin(angle) * np.array([math.cos(angle), math.sin(angle)])
    end = arc[-1] + 50.0 * np.array([1.0, 0.02])
    upper = np.vstack([tip, arc, end])
    return Polygon(np.vstack([upper, upper[:0:-1] * [1.0, -1.0]]))


@pytest.mark.parametrize("half_angle", [32.0, 33.0])
@pytest.mark.parametrize("radius", [8.0, 12.0])
def test_both_sides_of_a_blade_get_the_same_number_of_beads(half_angle, radius):
    """The algorithm walks along the two sides of an axis in opposite directions."""
    law = BeadLaw(5.0, 5.0, 0.3, 1.5)
    beads = Beads(5.0, 1.0, 2.0, chord_error=0.02)
    shape = make_blade(half_angle, radius)
    curves = adapt_contours(region_of(shape), beads, law)
    for curve in curves:
        if curve.closed:
            assert curve.points[:, 1].min() < 0.0 < curve.points[:, 1].max()
    mirrored = adapt_contours(
        region_of(affinity.scale(shape, 1.0, -1.0, origin=(0, 0))), beads, law
    )
    assert len(mirrored) == len(curves)


def test_spokes_reach_the_medial_axis():
    """By distances from shapely, the circle around the end of a spoke is empty and touches the
    border."""
    for seed in range(12):
        shape = random_shape(np.random.default_rng(seed))
        spokes = find_spokes(region_of(shape), 2.0, 0.04, 0.3, 1e3)
        border = shape.boundary
        distance = np.array([border.distance(Point(*point)) for point in spokes.middles])
        assert distance == pytest.approx(spokes.radii, abs=0.02 * WIDTH, rel=0.02)


# ---- Lines and zigzags of adaptive width

LONGEST_LINK = 3.0 * WIDTH
ROUND_END = 0.5 - 0.125 * math.pi  # widths by which a round end without extra area protrudes


def random_plate(seed):
    """Return a random shape, the direction of its lines, and its beads: zigzags inside two
    contours."""
    rng = np.random.default_rng(seed)
    shape = affinity.scale(random_shape(rng), 2.0, 2.0, origin=(0, 0))
    angle = rng.uniform(0.0, math.pi)
    return shape, angle, fill_with_zigzags(shape, angle)


def fill_with_zigzags(shape, angle):
    return adapt_lines(region_of(shape), BEADS, LAW, angle, 2, LONGEST_LINK)


def test_zigzags_cover_random_shapes_once_and_stay_inside():
    plates = [random_plate(seed) for seed in range(100, 130)]
    figures = np.array(
        [measure_faults(shape, [sweep(curve) for curve in curves]) for shape, _, curves in plates]
    )
    assert (np.median(figures, axis=0) < (0.0125, 0.0125, 0.001)).all()
    assert (np.percentile(figures, 90, axis=0) < (0.025, 0.05, 0.005)).all()
    assert any(curve.kind == "zigzag" for _, _, curves in plates for curve in curves)


def test_zigzags_move_with_shape_and_direction():
    differences = []
    for seed in range(200, 212):
        shape, angle, curves = random_plate(seed)
        turn = np.random.default_rng(seed).uniform(0.0, 360.0)

        def move(geometry, turn=turn):
            return affinity.translate(affinity.rotate(geometry, turn, origin=(0, 0)), 60.3, -211.7)

        moved_curves = fill_with_zigzags(move(shape), angle + math.radians(turn))
        covered, covered_moved = (
            unary_union([sweep(curve) for curve in pose_curves]).buffer(0)
            for pose_curves in (curves, moved_curves)
        )
        differences.append(move(covered).symmetric_difference(covered_moved).area / shape.area)
    assert np.median(differences) < 1e-3
    assert max(differences) < 0.02


@pytest.mark.parametrize("height", [41.3, 44.0, 46.5, 50.1])
def test_a_whole_number_of_equal_lines_fits_between_the_walls(height):
    """Lines share the space inside two walls equally, and one zigzag links them."""
    shape = box(0.0, 0.0, 70.0, height)
    curves = fill_with_zigzags(shape, 0.0)
    (zigzag,) = [curve for curve in curves if curve.kind == "zigzag"]
    inner_height = height - 4.0 * WIDTH
    count = round(inner_height / WIDTH)
    shares = np.ones(len(zigzag.points)) if zigzag.share is None else zigzag.share
    assert shares == pytest.approx(inner_height / (count * WIDTH), abs=0.005)
    levels = np.unique(np.round(zigzag.points[:, 1], 2))
    assert np.diff(levels) == pytest.approx(inner_height / count, abs=0.02)
    missed, twice, outside = measure_faults(shape, [sweep(curve) for curve in curves])
    # round ends of lines and round outer corners of links
    corners = 4.0 * count * (1.0 - 0.25 * math.pi) * (0.5 * WIDTH) ** 2 / shape.area
    assert missed < corners + 0.002
    assert twice < corners + 0.002
    assert outside < 1e-4


@pytest.mark.parametrize("turn", [5.0, 17.0, 33.0, 60.0])
def test_links_at_slanted_walls_taper_into_acute_corners(turn):
    """Nearly all lines are linked; links stay inside the walls and never cover the same area twice."""
    shape = affinity.rotate(box(0.0, 0.0, 120.0, 80.0), turn, origin=(0, 0))
    curves = fill_with_zigzags(shape, 0.0)
    linked = [curve for curve in curves if curve.kind == "zigzag"]
    low, high = shape.bounds[1], shape.bounds[3]
    assert len(linked) < 0.5 * (high - low) / WIDTH
    # round ends of lines protrude beyond their area
    inside = shape.buffer(-2.0 * WIDTH + ROUND_END * WIDTH + 0.05, join_style=2)
    outside = unary_union([sweep(curve) for curve in linked]).difference(inside)
    assert outside.area < 0.001 * shape.area
    missed, twice, _ = measure_faults(shape, [sweep(curve) for curve in curves])
    assert missed < 0.012
    assert twice < 0.012


def test_a_line_bends_around_a_hole_in_its_strip():
    """The line moves sideways and becomes narrower, so it does not deposit on the wall of the hole."""
    hole = Point(40.0, 30.0).buffer(9.0, 64)
    shape = box(0.0, 0.0, 80.0, 60.0).difference(hole)
    curves = fill_with_zigzags(shape, 0.0)
    lines = [sweep(curve) for curve in curves if curve.kind == "zigzag"]
    nominal = fill(region_of(shape), BEADS, "zigzag", 0.0, 2)
    nominal_lines = [sweep(curve) for curve in nominal if curve.kind == "zigzag"]
    make_wall = hole.buffer(2.0 * WIDTH)
    on_wall, nominal_on_wall = (
        sum(line.intersection(make_wall).area for line in swept_lines)
        for swept_lines in (lines, nominal_lines)
    )
    assert on_wall < 0.5 * nominal_on_wall
    missed, twice, _ = measure_faults(shape, [sweep(curve) for curve in curves])
    assert missed < 0.015
    assert twice < 0.01


@pytest.mark.parametrize("overlap", [0.0, 0.1, 0.25])
def test_lines_overlap_their_walls_by_the_chosen_share(overlap):
    beads = Beads(WIDTH, 0.2 * WIDTH, 2.0, chord_error=0.02, overlap=overlap)
    curves = adapt_lines(region_of(box(0, 0, 80, 60)), beads, LAW, 0.0, 2, LONGEST_LINK)
    zigzag = unary_union([sweep(curve) for curve in curves if curve.kind == "zigzag"])
    low_x, _, high_x, _ = zigzag.intersection(box(0, 12, 80, 48)).bounds  # only links
    assert low_x == pytest.approx((2.0 - overlap) * WIDTH, abs=0.05)
    assert high_x == pytest.approx(80.0 - (2.0 - overlap) * WIDTH, abs=0.05)
    assert zigzag.bounds[1] == pytest.approx((2.0 - overlap) * WIDTH, abs=0.05)
    assert zigzag.bounds[3] == pytest.approx(60.0 - (2.0 - overlap) * WIDTH, abs=0.05)


def test_contours_fill_thin_regions_inside_walls():
    curves = fill_with_zigzags(box(0.0, 0.0, 90.0, 21.0), 0.7)
    assert {curve.kind for curve in curves} == {"contour", "centre"}


def test_lines_overlap_walls_and_neighbours_equally_by_default():
    spacing, width = 4.0, 5.0
    beads = Beads(spacing, 0.2 * spacing, 2.0, chord_error=0.02, width=width)
    law = BeadLaw(width, spacing, 0.3, 1.5)
    inner_height = 10 * spacing  # between the centrelines of the outermost lines
    inset = 0.5 * width + 2.0 * spacing
    shape = box(0.0, 0.0, 90.0, inner_height + 2.0 * inset)
    curves = adapt_lines(region_of(shape), beads, law, 0.0, 2, LONGEST_LINK)
    (zigzag,) = [curve for curve in curves if curve.kind == "zigzag"]
    levels = np.unique(np.round(zigzag.points[:, 1], 2))
    assert levels == pytest.approx(inset + spacing * np.arange(11), abs=0.03)
    links = zigzag.points[1:-1, 0]  # same distance from the last wall as adjacent lines
    assert np.unique(np.round(links, 1)) == pytest.approx([inset, 90.0 - inset], abs=0.05)
