# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contours of adaptive width: cover, place, volume and independence of pose, judged by shapely."""

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
WIDTH_STEP = (
    0.05  # of the width; strokes of a bead as wide as on average, so that their errors cancel
)
LAW = BeadLaw(WIDTH, WIDTH, 0.3, 1.5)
BEADS = Beads(WIDTH, 0.2 * WIDTH, 2.0, chord_error=0.02)


def region_of(shape):
    shape = orient(shape)
    loops = [np.array(ring.coords)[:-1] for ring in (shape.exterior, *shape.interiors)]
    return max(regions(loops), key=lambda region: region.area)


def swept(curve):
    """A bead as the union of short strokes as wide as it is there; its area is that of its volume."""
    points, shares = curve.closed_points()
    shares = np.ones(len(points)) if shares is None else shares
    if not curve.closed:
        points, shares = shapes.without_round_ends(points, shares, WIDTH)
    counts = np.maximum(1, (np.abs(np.diff(shares)) / WIDTH_STEP).astype(int))
    places = np.concatenate([k + np.arange(count) / count for k, count in enumerate(counts)])
    places = np.r_[places, len(points) - 1.0]
    number = np.arange(len(points))
    line = np.stack([np.interp(places, number, points[:, k]) for k in (0, 1)], axis=1)
    widths = WIDTH * np.interp(places, number, shares)
    means = 0.5 * (widths[1:] + widths[:-1])
    starts = np.flatnonzero(np.r_[True, np.abs(np.diff(means)) > 1e-9])
    ends = np.r_[starts[1:], len(means)]
    return unary_union(
        [LineString(line[a : b + 1]).buffer(0.5 * means[a], 8) for a, b in zip(starts, ends)]
    )


def faults(shape):
    """Shares of a shape that beads miss where the narrowest fits, deposit twice, and deposit outside."""
    return faults_of(shape, swept_beads(shape))


def swept_beads(shape):
    return [swept(curve) for curve in adapt_contours(region_of(shape), BEADS, LAW)]


@functools.lru_cache(maxsize=40)
def swept_random(seed):
    """A random shape and its beads: both tests of random shapes use them."""
    shape = random_shape(np.random.default_rng(seed))
    return shape, swept_beads(shape)


def faults_of(shape, beads):
    union = unary_union(beads)
    reach = 0.5 * LAW.narrowest * WIDTH + 0.02
    wide_enough = shape.buffer(-reach).buffer(reach)
    return (
        wide_enough.difference(union).area / shape.area,
        (sum(bead.area for bead in beads) - union.area) / shape.area,
        union.difference(shape.buffer(0.01)).area / shape.area,
    )


def wall(count, length=60.0):
    return box(0.0, 0.0, length, count * WIDTH)


@pytest.mark.parametrize("count", [0.5, 1.0, 1.3, 1.5, 1.7, 2.0, 2.2, 2.6, 3.1, 3.5, 4.0])
def test_walls_of_any_thickness_are_covered(count):
    missed, twice, outside = faults(wall(count))
    corners = 4 * (1.0 - 0.25 * math.pi) * WIDTH**2  # most that round beads leave in square corners
    assert missed * wall(count).area < corners
    assert twice < 0.003
    assert outside < 0.001


def test_a_wall_of_one_and_a_half_beads_gets_two_of_three_quarters():
    (ring,) = adapt_contours(region_of(wall(1.5)), BEADS, LAW)
    assert ring.closed
    assert ring.share == pytest.approx(0.75, abs=0.01)
    assert region_of(wall(1.5)).nearest(ring.points)[1] == pytest.approx(1.5, abs=0.01)


def test_a_taper_is_followed_to_where_it_is_narrower_than_the_narrowest():
    length, root = 57.0, 4.0
    fin = Polygon([(0.0, -0.5 * root), (length, 0.0), (0.0, 0.5 * root)])
    curves = adapt_contours(region_of(fin), BEADS, LAW)
    tip = max(float(curve.points[:, 0].max()) for curve in curves)
    narrow = length * (1.0 - LAW.narrowest * WIDTH / root)  # as wide as the narrowest there
    assert narrow - 1.5 < tip < narrow + 1.0


def polar(radius, angle):
    return Polygon(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]))


SHAPES = {
    "ring": Point(0, 0).buffer(30, 32).difference(Point(0, 0).buffer(20, 32)),
    "disc": Point(0, 0).buffer(13, 32),
    "bracket": Polygon([(0, 0), (60, 0), (60, 12), (14, 12), (14, 50), (0, 50)]),
    "taper": Polygon([(0, 0), (80, 6), (80, 8), (0, 14)]),
    "star": polar(np.tile([42.0, 17.0], 5), 0.2 * math.pi * np.arange(10) + 0.1),
    "teeth": Point(0, 0)
    .buffer(56, 40)
    .difference(
        polar(
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
def test_shapes_are_covered_once(name):
    missed, twice, outside = faults(SHAPES[name])
    assert missed < 0.025
    assert twice < 0.015
    assert outside < 0.005


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("turn, mirrored", [(17.0, False), (90.0, False), (211.0, True)])
def test_beads_move_with_the_shape(name, turn, mirrored):
    """The same faults, and the same length of beads of the same volume, in another pose."""

    def moved(shape):
        shape = affinity.scale(shape, xfact=-1.0, origin=(0, 0)) if mirrored else shape
        return affinity.translate(affinity.rotate(shape, turn, origin=(0, 0)), 123.4, -56.7)

    shape = SHAPES[name]
    here, there = (adapt_contours(region_of(each), BEADS, LAW) for each in (shape, moved(shape)))
    assert len(here) == len(there)
    covered = moved(unary_union([swept(curve) for curve in here]))
    covered_there = unary_union([swept(curve) for curve in there])
    assert covered.symmetric_difference(covered_there).area < 1e-3 * shape.area


def random_shape(rng):
    """Polygons, walls, wedges, strokes as of letters, plates with holes."""
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


def test_random_shapes_are_covered_and_beads_stay_inside():
    figures = np.array([faults_of(*swept_random(seed)) for seed in range(40)])
    assert (np.median(figures, axis=0) < (0.02, 0.02, 0.002)).all()
    assert (np.percentile(figures, 90, axis=0) < (0.035, 0.05, 0.005)).all()
    assert (figures.max(axis=0) < (0.06, 0.12, 0.01)).all()


def difference_when_moved(shape, beads, rng):
    """Share of a shape that beads cover in one of two poses alone, and how many beads more there are in the other."""
    angle, offset = rng.uniform(0.0, 360.0), rng.uniform(-200.0, 200.0, 2)

    def moved(part):
        return affinity.translate(affinity.rotate(part, angle, origin=(0, 0)), *offset)

    there = swept_beads(moved(shape))
    covered, covered_there = (unary_union(each).buffer(0) for each in (beads, there))
    apart = moved(covered).buffer(0).symmetric_difference(covered_there).area / shape.area
    return apart, abs(len(there) - len(beads))


def test_random_shapes_get_the_same_beads_in_any_pose():
    differences = np.array(
        [
            difference_when_moved(*swept_random(seed), np.random.default_rng(1000 + seed))
            for seed in range(24)
        ]
    )
    assert (differences[:, 1] == 0).all()
    assert np.median(differences[:, 0]) < 1e-3
    assert differences[:, 0].max() < 0.005


@pytest.mark.long
@pytest.mark.parametrize("thousand", range(10))
def test_thousands_of_random_shapes_are_covered_alike_in_five_poses(thousand):
    """The tails of 10,000 shapes: where strokes cross at a fork, one bead more or less is a matter of the last digit."""
    figures, differences = [], []
    for seed in range(1000 * thousand, 1000 * thousand + 1000):
        shape = random_shape(np.random.default_rng(seed))
        beads = swept_beads(shape)
        figures.append(faults_of(shape, beads))
        rng = np.random.default_rng(10**6 + seed)
        differences.append(
            np.max([difference_when_moved(shape, beads, rng) for _ in range(4)], axis=0)
        )
    assert (np.median(figures, axis=0) < (0.025, 0.03, 0.002)).all()
    assert (np.percentile(figures, 99, axis=0) < (0.08, 0.2, 0.02)).all()
    apart, more = np.array(differences).T
    assert np.mean(more > 0) < 0.01
    assert np.percentile(apart, 95) < 0.01


# two plates on a neck, and a plate with a wedge: beads slant across their spokes at the shoulders
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


def blade(half_angle, radius):
    """A blade: a wedge to a tip, an arc to a half width of 7 mm, then 50 mm that widen slowly."""
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
    """Sides of an axis are walked in opposite directions."""
    law = BeadLaw(5.0, 5.0, 0.3, 1.5)
    beads = Beads(5.0, 1.0, 2.0, chord_error=0.02)
    shape = blade(half_angle, radius)
    curves = adapt_contours(region_of(shape), beads, law)
    for curve in curves:
        if curve.closed:
            assert curve.points[:, 1].min() < 0.0 < curve.points[:, 1].max()
    mirrored = adapt_contours(
        region_of(affinity.scale(shape, 1.0, -1.0, origin=(0, 0))), beads, law
    )
    assert len(mirrored) == len(curves)


def test_spokes_reach_the_medial_axis():
    """The circle about the end of a spoke is empty and touches the border: by distances of shapely."""
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
    """A random shape with space for lines, their direction, and its beads: zigzags within two contours."""
    rng = np.random.default_rng(seed)
    shape = affinity.scale(random_shape(rng), 2.0, 2.0, origin=(0, 0))
    angle = rng.uniform(0.0, math.pi)
    return shape, angle, zigzags(shape, angle)


def zigzags(shape, angle):
    return adapt_lines(region_of(shape), BEADS, LAW, angle, 2, LONGEST_LINK)


def test_zigzags_cover_random_shapes_once_and_stay_inside():
    found = [random_plate(seed) for seed in range(100, 130)]
    figures = np.array(
        [faults_of(shape, [swept(curve) for curve in curves]) for shape, _, curves in found]
    )
    assert (np.median(figures, axis=0) < (0.0125, 0.0125, 0.001)).all()
    assert (np.percentile(figures, 90, axis=0) < (0.025, 0.05, 0.005)).all()
    assert any(curve.kind == "zigzag" for _, _, curves in found for curve in curves)


def test_zigzags_move_with_shape_and_direction():
    apart = []
    for seed in range(200, 212):
        shape, angle, curves = random_plate(seed)
        turn = np.random.default_rng(seed).uniform(0.0, 360.0)

        def moved(part, turn=turn):
            return affinity.translate(affinity.rotate(part, turn, origin=(0, 0)), 60.3, -211.7)

        there = zigzags(moved(shape), angle + math.radians(turn))
        covered, covered_there = (
            unary_union([swept(curve) for curve in each]).buffer(0) for each in (curves, there)
        )
        apart.append(moved(covered).symmetric_difference(covered_there).area / shape.area)
    assert np.median(apart) < 1e-3
    assert max(apart) < 0.02


@pytest.mark.parametrize("height", [41.3, 44.0, 46.5, 50.1])
def test_a_whole_number_of_equal_lines_fits_between_the_walls(height):
    """Lines share the space inside two walls evenly, and one zigzag links them all."""
    shape = box(0.0, 0.0, 70.0, height)
    curves = zigzags(shape, 0.0)
    (zigzag,) = [curve for curve in curves if curve.kind == "zigzag"]
    room = height - 4.0 * WIDTH
    count = round(room / WIDTH)
    shares = np.ones(len(zigzag.points)) if zigzag.share is None else zigzag.share
    assert shares == pytest.approx(room / (count * WIDTH), abs=0.005)
    levels = np.unique(np.round(zigzag.points[:, 1], 2))
    assert np.diff(levels) == pytest.approx(room / count, abs=0.02)
    missed, twice, outside = faults_of(shape, [swept(curve) for curve in curves])
    # round ends of lines and round outer corners of links
    corners = 4.0 * count * (1.0 - 0.25 * math.pi) * (0.5 * WIDTH) ** 2 / shape.area
    assert missed < corners + 0.002
    assert twice < corners + 0.002
    assert outside < 1e-4


@pytest.mark.parametrize("turn", [5.0, 17.0, 33.0, 60.0])
def test_links_at_slanted_walls_taper_into_acute_corners(turn):
    """Nearly all lines are linked, and links neither leave the space inside the walls nor repeat it."""
    shape = affinity.rotate(box(0.0, 0.0, 120.0, 80.0), turn, origin=(0, 0))
    curves = zigzags(shape, 0.0)
    linked = [curve for curve in curves if curve.kind == "zigzag"]
    low, high = shape.bounds[1], shape.bounds[3]
    assert len(linked) < 0.5 * (high - low) / WIDTH
    # round ends of lines protrude beyond their area
    inside = shape.buffer(-2.0 * WIDTH + ROUND_END * WIDTH + 0.05, join_style=2)
    outside = unary_union([swept(curve) for curve in linked]).difference(inside)
    assert outside.area < 0.001 * shape.area
    missed, twice, _ = faults_of(shape, [swept(curve) for curve in curves])
    assert missed < 0.012
    assert twice < 0.012


def test_a_line_passes_a_hole_that_enters_its_strip():
    """The line moves aside and narrows, so that it does not deposit on the wall of the hole."""
    hole = Point(40.0, 30.0).buffer(9.0, 64)
    shape = box(0.0, 0.0, 80.0, 60.0).difference(hole)
    curves = zigzags(shape, 0.0)
    lines = [swept(curve) for curve in curves if curve.kind == "zigzag"]
    nominal = fill(region_of(shape), BEADS, "zigzag", 0.0, 2)
    usual = [swept(curve) for curve in nominal if curve.kind == "zigzag"]
    wall = hole.buffer(2.0 * WIDTH)
    on_wall, usually = (
        sum(line.intersection(wall).area for line in each) for each in (lines, usual)
    )
    assert on_wall < 0.5 * usually
    missed, twice, _ = faults_of(shape, [swept(curve) for curve in curves])
    assert missed < 0.015
    assert twice < 0.01


@pytest.mark.parametrize("overlap", [0.0, 0.1, 0.25])
def test_lines_reach_into_their_walls_by_the_given_share(overlap):
    beads = Beads(WIDTH, 0.2 * WIDTH, 2.0, chord_error=0.02, overlap=overlap)
    curves = adapt_lines(region_of(box(0, 0, 80, 60)), beads, LAW, 0.0, 2, LONGEST_LINK)
    zigzag = unary_union([swept(curve) for curve in curves if curve.kind == "zigzag"])
    left, _, right, _ = zigzag.intersection(box(0, 12, 80, 48)).bounds  # links alone
    assert left == pytest.approx((2.0 - overlap) * WIDTH, abs=0.05)
    assert right == pytest.approx(80.0 - (2.0 - overlap) * WIDTH, abs=0.05)
    assert zigzag.bounds[1] == pytest.approx((2.0 - overlap) * WIDTH, abs=0.05)
    assert zigzag.bounds[3] == pytest.approx(60.0 - (2.0 - overlap) * WIDTH, abs=0.05)


def test_thin_places_inside_walls_are_filled_with_contours():
    curves = zigzags(box(0.0, 0.0, 90.0, 21.0), 0.7)
    assert {curve.kind for curve in curves} == {"contour", "centre"}


def test_lines_overlap_their_walls_as_neighbours_overlap_by_default():
    spacing, width = 4.0, 5.0
    beads = Beads(spacing, 0.2 * spacing, 2.0, chord_error=0.02, width=width)
    law = BeadLaw(width, spacing, 0.3, 1.5)
    room = 10 * spacing  # between the centrelines of the outermost lines
    inset = 0.5 * width + 2.0 * spacing
    shape = box(0.0, 0.0, 90.0, room + 2.0 * inset)
    curves = adapt_lines(region_of(shape), beads, law, 0.0, 2, LONGEST_LINK)
    (zigzag,) = [curve for curve in curves if curve.kind == "zigzag"]
    levels = np.unique(np.round(zigzag.points[:, 1], 2))
    assert levels == pytest.approx(inset + spacing * np.arange(11), abs=0.03)
    links = zigzag.points[1:-1, 0]  # as far from the last wall as lines next to it
    assert np.unique(np.round(links, 1)) == pytest.approx([inset, 90.0 - inset], abs=0.05)
