# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fillings of less than the whole, measured by lengths, distances and rasters of their own."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import fill
from freecad_am.core.filling.sparse import Infill, gyroid_period
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.issues import InputError
from freecad_am.core.layers.surface import Slice, common_regions, mark_buried
from freecad_am.core.parameters.filled import DevelopableParameters

_spec = importlib.util.spec_from_file_location(
    "filling_shapes", Path(__file__).with_name("shapes.py")
)
shapes = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shapes)

S = 2.0
BEADS = Beads(S, 0.4, 1.0, chord_error=0.005)
PATTERNS = ["contours", "lines", "zigzag", "grid", "triangles", "honeycomb", "gyroid"]
STEP = 0.05


def cloud(curves, step=STEP):
    return np.vstack([shapes.dense(curve.points, curve.closed, step) for curve in curves])


def share(curves, low, high):
    """Length times spacing over the area of a window, by dense places."""
    found = 0.0
    for curve in curves:
        ends = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        at = shapes.dense(curve.points, curve.closed, STEP)
        way, middle = np.hypot(*np.diff(at, axis=0).T), 0.5 * (at[1:] + at[:-1])
        assert way.sum() == pytest.approx(np.hypot(*np.diff(ends, axis=0).T).sum(), rel=1e-9)
        found += way[((middle > low) & (middle < high)).all(axis=1)].sum()
    return found * S / float(np.prod(np.subtract(high, low)))


@pytest.mark.parametrize("density", [0.12, 0.3, 0.55])
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always
def test_length_times_spacing_is_the_share_asked_for(pattern, density):
    wide, tall = (120.0, 100.0) if pattern == "gyroid" and density > 0.2 else (240.0, 200.0)
    (region,) = regions(shapes.polygon((0, 0), (wide, 0), (wide, tall), (0, tall)))
    heights = (
        np.linspace(0.0, gyroid_period(S, density), 16, endpoint=False)
        if pattern == "gyroid"
        else [0.0]
    )
    walls, edge = (
        (0, 0.0) if pattern == "contours" else (2, 10.0)
    )  # contours lie along the window's sides
    measured = [
        share(
            fill(region, BEADS, pattern, 0.3, walls, 0.0, Infill(density, height, 0.3)),
            (edge, edge),
            (wide - edge, tall - edge),
        )
        for height in heights
    ]
    assert np.mean(measured) == pytest.approx(density, rel=0.05)


def test_the_gyroid_is_the_surface_itself_and_its_mean_length_is_right():
    """Its equation at every point, and the length of all sections by the coarea formula on a grid."""
    density, unit = 0.25, gyroid_period(S, 0.25) / (2.0 * np.pi)
    (region,) = regions(shapes.polygon((-40, -30), (40, -30), (40, 30), (-40, 30)))
    for height in (0.0, 1.3, 4.1, 7.7):
        curves = fill(region, BEADS, "gyroid", 0.9, 0, 0.0, Infill(density, height, 0.0))
        x, y = cloud(curves).T / unit
        z = height / unit
        value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        slope = np.hypot(
            np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x),
            np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y),
        )
        steep = slope > 0.2
        assert np.abs(value[steep] / slope[steep]).max() * unit < 2.0 * BEADS.chord_error
        assert steep.mean() > 0.95
    g = 2.0 * np.pi * (np.arange(160) + 0.5) / 160
    x, y, z = np.meshgrid(g, g, g, indexing="ij")
    value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    slope = np.hypot(
        np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x), np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y)
    )
    near = np.abs(value) < 0.1
    length = (
        (slope * near).mean() / 0.2 * (2.0 * np.pi) ** 2
    )  # in the mean of all heights, on a square of a period
    assert S * length / (2.0 * np.pi) ** 2 / unit == pytest.approx(density, rel=0.01)


def test_periods_and_that_honeycombs_never_cross():
    (region,) = regions([shapes.circle(60.0)])
    lines = fill(region, BEADS, "lines", 0.0, 0, 0.0, Infill(0.2))
    levels = np.unique(np.round([curve.points[:, 1].mean() for curve in lines], 6))
    assert np.diff(levels) == pytest.approx(np.full(len(levels) - 1, S / 0.2))
    for pattern, count in (("grid", 2), ("triangles", 3)):
        heading = [
            np.arctan2(*np.diff(c.points, axis=0)[0][::-1]) % np.pi
            for c in fill(region, BEADS, pattern, 0.0, 0, 0.0, Infill(0.2, angle=0.1))
        ]
        assert np.unique(np.round(heading, 6)) == pytest.approx(
            0.1 + np.pi / count * np.arange(count)
        )
    comb = fill(region, BEADS, "honeycomb", 0.0, 0, 0.0, Infill(0.3))
    trees = [cKDTree(shapes.dense(curve.points, False, STEP)) for curve in comb]
    nearest = [
        one.query(other.data)[0].min() for k, one in enumerate(trees) for other in trees[k + 1 :]
    ]
    assert min(nearest) == pytest.approx(S, abs=0.05), (
        "where lines share a side they lie beside one another"
    )
    turn = np.concatenate(
        [np.diff(np.unwrap(np.arctan2(*np.diff(c.points, axis=0).T[::-1]))) for c in comb]
    )
    assert np.abs(turn) == pytest.approx(np.pi / 3.0, abs=1e-6)


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("name", ["U", "wavy 2", "annulus"])
@pytest.mark.always
def test_walls_lie_at_the_spacing_and_nothing_is_outside(name, pattern):
    loops = shapes.SHAPES[name]
    (region,) = regions(loops)
    border = shapes.tree([(loop, True) for loop in loops], STEP)
    for walls in (0, 1, 3):
        curves = fill(region, BEADS, pattern, 0.5, walls, 0.0, Infill(0.3, 1.0, 0.2))
        points = cloud(curves, 0.2)
        assert shapes.inside(loops, points).all()
        assert border.query(points)[0].min() > 0.5 * S - 0.02
        if pattern == "contours":
            continue
        rings = [curve for curve in curves if curve.kind == "contour"]
        assert sorted({curve.ring for curve in rings}) == list(range(walls))
        for curve in rings:
            off = border.query(shapes.dense(curve.points, True, 0.5))[0]
            assert off == pytest.approx((curve.ring + 0.5) * S, abs=0.03)
        others = [curve for curve in curves if curve.kind not in ("contour", "closing")]
        if walls and others:  # they end on the inner edge of the last wall
            assert border.query(cloud(others, 0.2))[0].min() == pytest.approx(walls * S, abs=0.03)


def test_walls_without_end_are_contours_alone():
    (region,) = regions(shapes.SHAPES["wavy 1"])
    alone = fill(region, BEADS, "contours")
    for pattern in ("lines", "gyroid"):
        same = fill(region, BEADS, pattern, 0.4, np.inf, 0.0, Infill(0.2))
        assert all(np.array_equal(a.points, b.points) for a, b in zip(alone, same, strict=True))
    many = fill(regions(shapes.SHAPES["L"])[0], BEADS, "lines", 0.4, 500)
    assert {curve.kind for curve in many} <= {"contour", "closing"}


@pytest.mark.parametrize("walls", [2, 4])
@pytest.mark.parametrize("pattern", ["lines", "zigzag"])
def test_several_walls_and_lines_cover_the_whole(pattern, walls):
    for name in ("L", "comb"):
        loops = [0.5 * loop for loop in shapes.SHAPES[name]]
        (region,) = regions(loops)
        curves = fill(region, BEADS, pattern, 0.7, walls)
        grid, within = shapes.raster(loops, 0.4)
        from_border = shapes.tree([(loop, True) for loop in loops], STEP).query(grid)[0]
        away = shapes.tree([(curve.points, curve.closed) for curve in curves], STEP).query(grid)[0]
        reach = within & (from_border >= 0.5 * S)
        assert (away[reach] <= 0.5 * S + 1e-3).mean() >= 0.99
        assert away[reach].max() < 0.5 * (S + BEADS.gap) + 0.02
        assert ((away <= 0.5 * S) & ~within).sum() <= 0.001 * within.sum()


@pytest.mark.parametrize("pattern", ["lines", "zigzag", "gyroid", "contours"])
@pytest.mark.always("zigzag", "contours")
def test_tops_and_bottoms_are_filled_and_the_rest_is_not(pattern):
    """Over a step: what lies above the lower part is filled as a whole, and a spacing more."""
    wide = shapes.polygon((0, 0), (80, 0), (80, 40), (0, 40))
    (region,) = regions(wide)
    over = regions(shapes.polygon((0, 0), (40, 0), (40, 40), (0, 40)))
    buried = common_regions([(region,), over, (region,)])
    curves = fill(region, BEADS, pattern, 0.4, 1, 0.0, Infill(0.15, 2.0, 0.4, buried))
    grid, _ = shapes.raster(wide, 0.25)
    away = shapes.tree([(curve.points, curve.closed) for curve in curves], STEP).query(grid)[0]
    top = (grid[:, 0] > 40) & (grid[:, 0] < 79) & (grid[:, 1] > 1) & (grid[:, 1] < 39)
    assert (away[top] <= 0.5 * S + 1e-3).mean() >= 0.99 and away[top].max() < 0.5 * (
        S + BEADS.gap
    ) + 0.02
    rest = (grid[:, 0] > 4) & (grid[:, 0] < 36) & (grid[:, 1] > 4) & (grid[:, 1] < 36)
    assert (away[rest] <= 0.5 * S).mean() == pytest.approx(
        0.15, abs=0.1 if pattern == "contours" else 0.06
    )
    whole = fill(region, BEADS, pattern, 0.4, 1, 0.0, Infill(0.15, 2.0, 0.4, ()))
    away = shapes.tree([(curve.points, curve.closed) for curve in whole], STEP).query(grid)[0]
    inside = (grid > 1).all(axis=1) & (grid < (79, 39)).all(axis=1)
    assert (away[inside] <= 0.5 * S + 1e-3).mean() >= 0.99
    assert common_regions([(region,), (), (region,)]) == ()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.always("0", "1")
def test_any_region_many_holes_slits_and_tiny_ones(seed):
    """At random: nothing outside, nothing too short, twice the same."""
    rng = np.random.default_rng(seed)
    angle = 2.0 * np.pi * np.arange(40) / 40
    outer = (rng.uniform(18.0, 32.0, 40))[:, None] * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    holes = [
        shapes.circle(rng.uniform(0.3, 2.5), 24, rng.uniform(-11, 11, 2))[::-1] for _ in range(12)
    ]
    slit = np.array([[-13, 14.0], [13, 14.01], [13, 14.0], [-13, 13.99]])
    loops = [outer, *holes, slit]
    for size in (1.0, 0.08):  # the small one is about a bead wide
        for region in regions([size * loop for loop in loops]):
            pattern = PATTERNS[int(rng.integers(len(PATTERNS)))]
            infill = Infill(
                float(rng.uniform(0.05, 0.9)), float(rng.uniform(0, 9)), float(rng.uniform(0, 3))
            )
            walls = int(rng.integers(4))
            curves = fill(region, BEADS, pattern, 0.4, walls, 0.0, infill)
            again = fill(region, BEADS, pattern, 0.4, walls, 0.0, infill)
            assert all(
                np.array_equal(a.points, b.points) for a, b in zip(curves, again, strict=True)
            )
            for curve in curves:
                line = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
                assert (
                    np.isfinite(line).all()
                    and np.hypot(*np.diff(line, axis=0).T).sum() >= BEADS.shortest - 1e-9
                )
                if curve.kind != "centre":
                    assert region.contains(shapes.dense(line, False, 0.1)).all()


@pytest.mark.parametrize(
    "values,told",
    [
        (
            {"fill_density": 0.0},
            "strategy.fill_density: 0 % is out of range; give at least 1 % and at most 100 %",
        ),
        ({"fill_density": 1.2}, "strategy.fill_density: 120 % is out of range"),
        ({"walls": -1}, "strategy.walls: -1 is out of range; give at least 0"),
        ({"walls": 1.5}, "strategy.walls: 1.5 is not a whole number"),
        ({"solid_layers": -2}, "strategy.solid_layers: -2 is out of range; give at least 0"),
        (
            {"fill": "spiral", "fill_density": 0.3},
            "spiral always fills the whole region, not 30 %; use 100 %, or fill: contours, lines",
        ),
    ],
)
def test_bad_values_are_told(values, told):
    with pytest.raises(InputError) as refused:
        DevelopableParameters(**values)
    assert told in str(refused.value)


def test_layers_of_planes_know_what_is_over_and_under_them():
    """A stepped tower: steps are tops, its feet bottoms; told for each layer from rectangles alone."""
    wide = [
        40.0,
        40.0,
        40.0,
        40.0,
        25.0,
        25.0,
        25.0,
        25.0,
        60.0,
        60.0,
    ]  # of layers; those at 12 and 13 are missing below
    layers = [*range(8), 8, 9, 12, 13, 14]
    wide += [60.0, 60.0, 60.0]

    def one(number, width):
        return Slice(
            number, None, None, regions(shapes.polygon((0, 0), (width, 0), (width, 10), (0, 10)))
        )

    found = list(mark_buried(iter([one(*item) for item in zip(layers, wide, strict=True)]), 2))
    assert [layer.number for layer in found] == layers
    by_number = dict(zip(layers, wide, strict=True))
    for layer in found:
        beside = [by_number.get(layer.number + k, 0.0) for k in (-2, -1, 1, 2)]
        assert sum(part.area for part in layer.buried) == pytest.approx(10.0 * min(beside))
    assert all(layer.buried is None for layer in mark_buried(iter([one(0, 5.0)]), 0))
