# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions: nesting, repair, and parallel curves against independently computed distances."""

import builtins

import numpy as np
import pytest
from shapely.geometry import LineString, MultiPolygon, Polygon
from shapely.ops import unary_union

from freecad_am.core.geometry.regions import region as module
from freecad_am.core.geometry.regions.region import measure_bands, mended, regions
from freecad_am.core.geometry.regions.several import intersect_regions, subtract_regions
from freecad_am.core.issues import InputError

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
HOLE = np.array([[2.0, 2.0], [2.0, 8.0], [8.0, 8.0], [8.0, 2.0]])


def distance_to_rings(rings, points):
    """Distance of points to rings, edge by edge."""
    best = np.full(len(points), np.inf)
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0)):
            t = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            best = np.minimum(best, np.hypot(*(points - a - t[:, None] * (b - a)).T))
    return best


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_islands_in_holes_are_regions_of_their_own(scale):
    island = 0.3 * (SQUARE - 5.0) + 5.0
    outer, inner = regions([island * scale, HOLE * scale, SQUARE * scale])
    assert [outer.area / scale**2, inner.area / scale**2] == pytest.approx([64.0, 9.0])
    assert [len(outer.borders()), len(inner.borders())] == [2, 1]
    assert outer.width / scale == pytest.approx(
        2.343, rel=0.006
    ) and inner.width / scale == pytest.approx(3.0, rel=0.006)
    assert outer.contains(scale * np.array([[1.0, 1.0], [5.0, 5.0], [11.0, 5.0]])).tolist() == [
        True,
        False,
        False,
    ]


def test_order_and_starts_do_not_depend_on_how_loops_come():
    """Order and start points do not depend on the input order of the loops."""
    loops = [SQUARE, HOLE, SQUARE + [20.0, 0.0], HOLE + [20.0, 0.0]]
    rings = [ring for region in regions(loops) for ring in region.borders()]
    rng = np.random.default_rng(0)
    for _ in range(10):
        mixed = [np.roll(loops[k], rng.integers(4), axis=0) for k in rng.permutation(4)]
        again = [ring for region in regions(mixed) for ring in region.borders()]
        assert all(np.array_equal(a, b) for a, b in zip(rings, again, strict=True))
    assert rings[0][0].tolist() == [0.0, 0.0]


def test_crossing_loops_are_mended_and_told():
    """Intersecting loops are repaired and reported."""
    bow = mended([np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0], [10.0, 10.0]])])
    assert sum(region.area for region in bow.regions) == pytest.approx(
        25.0
    ) and bow.changed == pytest.approx(25.0)
    assert "25 mm^2" in bow.issues()[0].message
    across = mended([SQUARE, HOLE + 5.0])
    assert sum(region.area for region in across.regions) == pytest.approx(
        91.0
    ) and across.changed == pytest.approx(27.0)
    sound = mended([np.repeat(SQUARE, 3, axis=0), HOLE])
    assert sound.changed == 0.0 and sound.issues() == ()


def test_slivers_are_dropped_and_told():
    """Slivers are dropped and reported."""
    repaired = mended([SQUARE, 0.01 * SQUARE + 20.0], least_area=0.1)
    assert len(repaired.regions) == 1 and repaired.dropped == pytest.approx(0.01)
    assert mended([]).regions == () and regions([SQUARE[::-1]]) == ()


@pytest.mark.parametrize("distance", [-12.0, -3.0, 4.0, 25.0])
def test_parallel_curves_are_at_the_distance(distance):
    a = 2.0 * np.pi * np.arange(500) / 500
    round_ = np.stack([np.cos(a), np.sin(a)], axis=1)
    loops = [round_ * (60 + 9 * np.sin(5 * a))[:, None], (round_ * 8 + [20, 5])[::-1]]
    (region,) = regions(loops)
    for offset_region in region.grown(distance, 0.01):
        for ring in offset_region.borders():
            middles = 0.5 * (ring + np.roll(ring, -1, axis=0))
            assert np.abs(distance_to_rings(loops, ring) - abs(distance)).max() < 1e-3
            off = distance_to_rings(loops, middles) - abs(distance)
            assert off.min() > -0.011 and off.max() < 1e-3
    assert region.grown(0.0, 0.01) == (region,)
    assert region.grown(-60.0, 0.01) == ()


def test_short_edges_have_the_bands_that_the_library_makes():
    """Edges of two points are drawn directly, because a library call for each takes too long."""
    rng = np.random.default_rng(3)
    edges = rng.uniform(-5.0, 5.0, (40, 2, 2))
    edges[7, 1] = edges[7, 0]  # a disc
    radii = rng.uniform(0.3, 1.5, len(edges))
    for edge, radius in zip(edges, radii):
        (band,) = module.along([(edge, False)], radius, 0.01)
        expected = LineString(edge).buffer(radius, module._quarter_segments(radius, 0.01))
        assert band.shape.symmetric_difference(expected).area < 1e-9
    bands = module.along([(edge, False) for edge in edges], radii, 0.01)
    expected = unary_union(
        [
            LineString(edge).buffer(radius, module._quarter_segments(radius, 0.01))
            for edge, radius in zip(edges, radii)
        ]
    )
    assert sum(band.area for band in bands) == pytest.approx(expected.area, abs=1e-6)


def test_without_the_library_a_filling_says_what_is_missing(monkeypatch):
    honest = builtins.__import__

    def refuse(name, *arguments, **options):
        if name.split(".")[0] == "shapely":
            raise ImportError(name)
        return honest(name, *arguments, **options)

    module.shapely.cache_clear()
    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(InputError, match="python3-shapely") as missing:
        regions([SQUARE])
    assert missing.value.code == "MISSING_LIBRARY"


def test_pieces_without_room_for_a_circle_are_left_out_and_no_others():
    """A square with round bites near its border has thousands of slivers that shrinking removes;
    only those may be dropped."""
    rng = np.random.default_rng(3)
    square = regions([40.0 * SQUARE])[0]
    discs = regions([SQUARE])[0].grown(1.0, 0.05)
    bites = [
        candidate
        for centre in rng.uniform(0.0, 390.0, (900, 2))
        for candidate in regions([discs[0].borders()[0] * 1.2 + centre])
    ]
    bitten = square.without(bites)
    for wide in (0.5, 2.0, 6.0):
        for error in (0.5, 0.001):
            wide_borders = [
                candidate.borders()[0]
                for candidate in bitten
                if candidate.grown(-0.5 * wide, error)
            ]
            kept_borders = [
                candidate.borders()[0]
                for candidate in square.without(bites, wide)
                if candidate.grown(-0.5 * wide, error)
            ]
            assert all(
                np.array_equal(a, b) for a, b in zip(wide_borders, kept_borders, strict=True)
            )
        assert len(wide_borders) < len(square.without(bites, wide)) < len(bitten)


def test_points_on_straight_borders_are_left_out_at_once(monkeypatch):
    """A square with thousands of points on its sides is reduced to four corners in a few passes."""
    side = np.stack([np.arange(3000) / 100.0, np.zeros(3000)], axis=1)
    turn, sides = np.array([[0.0, 1.0], [-1.0, 0.0]]), []
    for _ in range(4):
        sides.append(side)
        side = side @ turn + np.array([30.0, 0.0])
    looks = []
    real = module._every_other
    monkeypatch.setattr(module, "_every_other", lambda marked: looks.append(1) or real(marked))
    (square,) = regions([np.vstack(sides)])
    assert len(square.borders()[0]) == 4 and square.area == pytest.approx(900.0)
    assert len(looks) < 20


def squares(seed, count):
    """Squares of random sizes and places, as regions that may overlap."""
    rng = np.random.default_rng(seed)
    places, sizes = rng.uniform(0.0, 60.0, (count, 2)), rng.uniform(0.02, 0.6, count)
    return [regions([size * SQUARE + at])[0] for at, size in zip(places, sizes)]


def polygons_of(some):
    return [Polygon(one.borders()[0], one.borders()[1:]) for one in some]


def leftmost(polygon):
    return min(polygon.exterior.coords)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("counts", [(40, 60), (3, 60), (40, 2), (1, 1)])
def test_many_regions_are_subtracted_and_intersected_as_shapely_does_one_by_one(seed, counts):
    own, other = (squares(seed + 100 * k, count) for k, count in enumerate(counts))
    whole = unary_union(polygons_of(other))
    for found, wanted in (
        (subtract_regions(own, other), [one.difference(whole) for one in polygons_of(own)]),
        (intersect_regions(own, other), [one.intersection(whole) for one in polygons_of(own)]),
    ):
        parts = [
            part
            for each in wanted
            for part in sorted(
                (part for part in getattr(each, "geoms", [each]) if part.area > 1e-9),
                key=leftmost,
            )
        ]
        assert [one.area for one in found] == pytest.approx([part.area for part in parts], rel=1e-9)
        assert all(
            one.symmetric_difference(part).area < 1e-9
            for one, part in zip(polygons_of(found), parts, strict=True)
        )


@pytest.mark.parametrize(
    ("least_area", "least_extent"), [(0.0, 0.0), (0.5, 0.0), (0.0, 1.0), (0.3, 0.9)]
)
def test_small_pieces_are_dropped_by_the_area_and_extent_that_shapely_measures(
    least_area, least_extent
):
    """Bars cut a plate with holes into pieces of all sizes, some of them with holes."""
    plate = regions([4.0 * SQUARE, *(0.1 * HOLE + at for at in ([3.0, 3.0], [31.0, 12.0]))])[0]
    rng = np.random.default_rng(4)
    bars = [
        regions(
            [np.array([[at, -1.0], [at + wide, -1.0], [at + wide + 2.0, 41.0], [at + 2.0, 41.0]])]
        )[0]
        for at, wide in zip(rng.uniform(0.0, 40.0, 30), rng.uniform(0.01, 0.4, 30))
    ]
    left = polygons_of([plate])[0].difference(unary_union(polygons_of(bars)))
    assert isinstance(left, MultiPolygon)
    wanted = sorted(
        part.area
        for part in left.geoms
        if part.area > max(least_area, 1e-9)
        and np.hypot(*np.ptp(np.array(part.exterior.coords), axis=0)) >= least_extent
    )
    found = plate.without(bars, least_area=least_area, least_extent=least_extent)
    assert sorted(one.area for one in found) == pytest.approx(wanted, rel=1e-9)
    assert len(wanted) > 5


def test_bands_along_a_disc_leave_no_slivers_between_their_chords():
    """Rings a bead apart cover a disc but for the middle, of which no chord leaves a part open."""
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    (disc,) = regions([20.0 * circle])
    # with as many points as they need, so that their chords do not face each other
    rings = [(r * circle[:: max(1, int(20.0 / r))], True) for r in np.arange(19.0, 2.0, -2.0)]
    inside, area = measure_bands((disc,), rings, 1.0, 0.05)
    bare = np.pi * 2.0**2
    assert disc.area - inside == pytest.approx(bare, abs=4.0 * np.pi * 0.05)
    assert area == pytest.approx(inside, abs=40.0 * np.pi * 0.05)
    exact = unary_union([LineString([*ring, ring[0]]).buffer(1.0, 64) for ring, _ in rings])
    holes = [Polygon(hole).area for hole in exact.interiors]
    assert len(holes) > 10 and sum(holes) - max(holes) > 0.01  # slivers that count for nothing


def test_bands_along_curves_are_measured_as_shapely_does_but_for_narrow_gaps():
    """Two lines cross a plate and a third runs beside one: gaps wider than a few chord errors count."""
    (plate,) = regions([4.0 * SQUARE])
    lines = [
        np.array(points, dtype=float)
        for points in ([[2, 3], [38, 30]], [[2, 30], [38, 3]], [[2, 8.5], [38, 35.5]])
    ]
    inside, area = measure_bands((plate,), [(line, False) for line in lines], 2.0, 0.001)
    exact = unary_union([LineString(line).buffer(2.0, 64) for line in lines])
    assert area == pytest.approx(exact.area, rel=1e-4)
    assert inside == pytest.approx(exact.intersection(polygons_of([plate])[0]).area, rel=1e-4)
