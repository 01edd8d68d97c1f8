# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fills below 100 % density, measured by lengths, distances and rasters."""

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

SPACING = 2.0
BEADS = Beads(SPACING, 0.4, 1.0, chord_error=0.005)
PATTERNS = ["contours", "lines", "zigzag", "grid", "triangles", "honeycomb", "gyroid"]
STEP = 0.05


def stack_points(curves, step=STEP):
    return np.vstack([shapes.densify(curve.points, curve.closed, step) for curve in curves])


def measure_share(curves, low, high):
    """Length times spacing divided by the area of a window, from dense points."""
    length = 0.0
    for curve in curves:
        ends = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
        points = shapes.densify(curve.points, curve.closed, STEP)
        edge_lengths, middle = (
            np.hypot(*np.diff(points, axis=0).T),
            0.5 * (points[1:] + points[:-1]),
        )
        assert edge_lengths.sum() == pytest.approx(
            np.hypot(*np.diff(ends, axis=0).T).sum(), rel=1e-9
        )
        length += edge_lengths[((middle > low) & (middle < high)).all(axis=1)].sum()
    return length * SPACING / float(np.prod(np.subtract(high, low)))


@pytest.mark.parametrize("density", [0.12, 0.3, 0.55])
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.always
def test_length_times_spacing_equals_the_density(pattern, density):
    width, height_of_plate = (
        (120.0, 100.0) if pattern == "gyroid" and density > 0.2 else (240.0, 200.0)
    )
    (region,) = regions(
        shapes.polygon((0, 0), (width, 0), (width, height_of_plate), (0, height_of_plate))
    )
    heights = (
        np.linspace(0.0, gyroid_period(SPACING, density), 16, endpoint=False)
        if pattern == "gyroid"
        else [0.0]
    )
    walls, edge = (
        (0, 0.0) if pattern == "contours" else (2, 10.0)
    )  # contours run along the window's sides
    measured = [
        measure_share(
            fill(region, BEADS, pattern, 0.3, walls, 0.0, Infill(density, height, 0.3)),
            (edge, edge),
            (width - edge, height_of_plate - edge),
        )
        for height in heights
    ]
    assert np.mean(measured) == pytest.approx(density, rel=0.05)


def test_gyroid_lies_on_its_surface_and_has_the_mean_length():
    """Check the equation at every point, and the length of all sections against the coarea formula
    on a grid."""
    density, unit = 0.25, gyroid_period(SPACING, 0.25) / (2.0 * np.pi)
    (region,) = regions(shapes.polygon((-40, -30), (40, -30), (40, 30), (-40, 30)))
    for height in (0.0, 1.3, 4.1, 7.7):
        curves = fill(region, BEADS, "gyroid", 0.9, 0, 0.0, Infill(density, height, 0.0))
        x, y = stack_points(curves).T / unit
        z = height / unit
        value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        slope = np.hypot(
            np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x),
            np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y),
        )
        steep = slope > 0.2
        assert np.abs(value[steep] / slope[steep]).max() * unit < 2.0 * BEADS.chord_error
        assert steep.mean() > 0.95
    grid_axis = 2.0 * np.pi * (np.arange(160) + 0.5) / 160
    x, y, z = np.meshgrid(grid_axis, grid_axis, grid_axis, indexing="ij")
    value = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    slope = np.hypot(
        np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x), np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y)
    )
    is_near_surface = np.abs(value) < 0.1
    length = (
        (slope * is_near_surface).mean() / 0.2 * (2.0 * np.pi) ** 2
    )  # mean over all heights, per square of one period
    assert SPACING * length / (2.0 * np.pi) ** 2 / unit == pytest.approx(density, rel=0.01)


def test_patterns_have_their_period_and_honeycombs_never_cross():
    (region,) = regions([shapes.circle(60.0)])
    lines = fill(region, BEADS, "lines", 0.0, 0, 0.0, Infill(0.2))
    levels = np.unique(np.round([curve.points[:, 1].mean() for curve in lines], 6))
    assert np.diff(levels) == pytest.approx(np.full(len(levels) - 1, SPACING / 0.2))
    for pattern, count in (("grid", 2), ("triangles", 3)):
        heading = [
            np.arctan2(*np.diff(line.points, axis=0)[0][::-1]) % np.pi
            for line in fill(region, BEADS, pattern, 0.0, 0, 0.0, Infill(0.2, angle=0.1))
        ]
        assert np.unique(np.round(heading, 6)) == pytest.approx(
            0.1 + np.pi / count * np.arange(count)
        )
    honeycomb = fill(region, BEADS, "honeycomb", 0.0, 0, 0.0, Infill(0.3))
    trees = [cKDTree(shapes.densify(curve.points, False, STEP)) for curve in honeycomb]
    distances = [
        tree.query(other_tree.data)[0].min()
        for k, tree in enumerate(trees)
        for other_tree in trees[k + 1 :]
    ]
    assert min(distances) == pytest.approx(SPACING, abs=0.05), (
        "where lines share a side they lie beside one another"
    )
    turn = np.concatenate(
        [
            np.diff(np.unwrap(np.arctan2(*np.diff(line.points, axis=0).T[::-1])))
            for line in honeycomb
        ]
    )
    assert np.abs(turn) == pytest.approx(np.pi / 3.0, abs=1e-6)


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("name", ["U", "wavy 2", "annulus"])
@pytest.mark.always
def test_walls_keep_their_spacing_and_beads_stay_inside(name, pattern):
    loops = shapes.SHAPES[name]
    (region,) = regions(loops)
    border = shapes.build_tree([(loop, True) for loop in loops], STEP)
    for walls in (0, 1, 3):
        curves = fill(region, BEADS, pattern, 0.5, walls, 0.0, Infill(0.3, 1.0, 0.2))
        points = stack_points(curves, 0.2)
        assert shapes.are_inside(loops, points).all()
        assert border.query(points)[0].min() > 0.5 * SPACING - 0.02
        if pattern == "contours":
            continue
        rings = [curve for curve in curves if curve.kind == "contour"]
        assert sorted({curve.ring for curve in rings}) == list(range(walls))
        for curve in rings:
            border_distance = border.query(shapes.densify(curve.points, True, 0.5))[0]
            assert border_distance == pytest.approx((curve.ring + 0.5) * SPACING, abs=0.03)
        infill_curves = [curve for curve in curves if curve.kind not in ("contour", "closing")]
        if walls and infill_curves:  # the infill ends on the inner edge of the last wall
            assert border.query(stack_points(infill_curves, 0.2))[0].min() == pytest.approx(
                walls * SPACING, abs=0.03
            )


def test_unlimited_walls_equal_contours():
    (region,) = regions(shapes.SHAPES["wavy 1"])
    contours = fill(region, BEADS, "contours")
    for pattern in ("lines", "gyroid"):
        curves = fill(region, BEADS, pattern, 0.4, np.inf, 0.0, Infill(0.2))
        assert all(
            np.array_equal(a.points, b.points) for a, b in zip(contours, curves, strict=True)
        )
    walled = fill(regions(shapes.SHAPES["L"])[0], BEADS, "lines", 0.4, 500)
    assert {curve.kind for curve in walled} <= {"contour", "closing"}


@pytest.mark.parametrize("walls", [2, 4])
@pytest.mark.parametrize("pattern", ["lines", "zigzag"])
def test_several_walls_with_lines_cover_the_region(pattern, walls):
    for name in ("L", "comb"):
        loops = [0.5 * loop for loop in shapes.SHAPES[name]]
        (region,) = regions(loops)
        curves = fill(region, BEADS, pattern, 0.7, walls)
        grid, within = shapes.make_grid(loops, 0.4)
        from_border = shapes.build_tree([(loop, True) for loop in loops], STEP).query(grid)[0]
        bead_distance = shapes.build_tree(
            [(curve.points, curve.closed) for curve in curves], STEP
        ).query(grid)[0]
        reach = within & (from_border >= 0.5 * SPACING)
        assert (bead_distance[reach] <= 0.5 * SPACING + 1e-3).mean() >= 0.99
        assert bead_distance[reach].max() < 0.5 * (SPACING + BEADS.gap) + 0.02
        assert ((bead_distance <= 0.5 * SPACING) & ~within).sum() <= 0.001 * within.sum()


@pytest.mark.parametrize("pattern", ["lines", "zigzag", "gyroid", "contours"])
@pytest.mark.always("zigzag", "contours")
def test_tops_and_bottoms_are_solid_and_the_inside_is_sparse(pattern):
    """Above a step, the region over the lower part is solid, plus a margin of one spacing."""
    plate = shapes.polygon((0, 0), (80, 0), (80, 40), (0, 40))
    (region,) = regions(plate)
    upper = regions(shapes.polygon((0, 0), (40, 0), (40, 40), (0, 40)))
    buried = common_regions([(region,), upper, (region,)])
    curves = fill(region, BEADS, pattern, 0.4, 1, 0.0, Infill(0.15, 2.0, 0.4, buried))
    grid, _ = shapes.make_grid(plate, 0.25)
    bead_distance = shapes.build_tree(
        [(curve.points, curve.closed) for curve in curves], STEP
    ).query(grid)[0]
    is_top = (grid[:, 0] > 40) & (grid[:, 0] < 79) & (grid[:, 1] > 1) & (grid[:, 1] < 39)
    assert (bead_distance[is_top] <= 0.5 * SPACING + 1e-3).mean() >= 0.99 and bead_distance[
        is_top
    ].max() < 0.5 * (SPACING + BEADS.gap) + 0.02
    is_sparse = (grid[:, 0] > 4) & (grid[:, 0] < 36) & (grid[:, 1] > 4) & (grid[:, 1] < 36)
    assert (bead_distance[is_sparse] <= 0.5 * SPACING).mean() == pytest.approx(
        0.15, abs=0.1 if pattern == "contours" else 0.06
    )
    solid_curves = fill(region, BEADS, pattern, 0.4, 1, 0.0, Infill(0.15, 2.0, 0.4, ()))
    bead_distance = shapes.build_tree(
        [(curve.points, curve.closed) for curve in solid_curves], STEP
    ).query(grid)[0]
    is_inner = (grid > 1).all(axis=1) & (grid < (79, 39)).all(axis=1)
    assert (bead_distance[is_inner] <= 0.5 * SPACING + 1e-3).mean() >= 0.99
    assert common_regions([(region,), (), (region,)]) == ()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.always("0", "1")
def test_random_regions_with_holes_and_slits_are_filled(seed):
    """No bead is outside or too short, and a second run gives the same beads."""
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
    for size in (1.0, 0.08):  # the small region is about one bead wide
        for region in regions([size * loop for loop in loops]):
            pattern = PATTERNS[int(rng.integers(len(PATTERNS)))]
            infill = Infill(
                float(rng.uniform(0.05, 0.9)), float(rng.uniform(0, 9)), float(rng.uniform(0, 3))
            )
            walls = int(rng.integers(4))
            curves = fill(region, BEADS, pattern, 0.4, walls, 0.0, infill)
            repeated = fill(region, BEADS, pattern, 0.4, walls, 0.0, infill)
            assert all(
                np.array_equal(a.points, b.points) for a, b in zip(curves, repeated, strict=True)
            )
            for curve in curves:
                line = np.vstack([curve.points, curve.points[:1]]) if curve.closed else curve.points
                assert (
                    np.isfinite(line).all()
                    and np.hypot(*np.diff(line, axis=0).T).sum() >= BEADS.shortest - 1e-9
                )
                if curve.kind != "centre":
                    assert region.contains(shapes.densify(line, False, 0.1)).all()


@pytest.mark.parametrize(
    "values,message",
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
def test_bad_values_are_rejected(values, message):
    with pytest.raises(InputError) as caught:
        DevelopableParameters(**values)
    assert message in str(caught.value)


def test_planar_layers_find_their_buried_regions():
    """In a stepped tower steps are tops and feet are bottoms; the expected areas come from the
    rectangles."""
    widths = [
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
    ]  # of layers; layers 10 and 11 are missing
    layers = [*range(8), 8, 9, 12, 13, 14]
    widths += [60.0, 60.0, 60.0]

    def make_layer(number, width):
        return Slice(
            number, None, None, regions(shapes.polygon((0, 0), (width, 0), (width, 10), (0, 10)))
        )

    marked = list(
        mark_buried(
            iter([make_layer(*arguments) for arguments in zip(layers, widths, strict=True)]), 2
        )
    )
    assert [layer.number for layer in marked] == layers
    width_of_layer = dict(zip(layers, widths, strict=True))
    for layer in marked:
        neighbour_widths = [width_of_layer.get(layer.number + k, 0.0) for k in (-2, -1, 1, 2)]
        assert sum(region.area for region in layer.buried) == pytest.approx(
            10.0 * min(neighbour_widths)
        )
    assert all(layer.buried is None for layer in mark_buried(iter([make_layer(0, 5.0)]), 0))
