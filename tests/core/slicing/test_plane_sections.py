# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections with planes compared with hulls of crossed edges, volumes and sums over slabs."""

from itertools import product

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.slicing.solids.plane_sections import PlaneCuts


def hull(points):
    """Vertices and outward triangles (counter-clockwise) of the convex hull of points."""
    convex_hull = ConvexHull(points)
    faces = convex_hull.simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * convex_hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return points, faces


def join_meshes(*solids):
    """Join several meshes into one."""
    counts = np.cumsum([0, *(len(points) for points, _ in solids)])
    faces = np.concatenate([faces + start for (_, faces), start in zip(solids, counts)])
    return np.concatenate([points for points, _ in solids]), faces


def make_box(low, high):
    return hull(np.array(list(product(*zip(low, high))), dtype=float))


def turn_inside_out(solid):
    return solid[0], solid[1][:, ::-1]


def measure_area(loops):
    """Signed enclosed area: each loop counts with its direction."""
    doubled = 0.0
    for loop in loops:
        (x, y), (next_x, next_y) = loop.T, np.roll(loop, -1, axis=0).T
        doubled += float((x * next_y - next_x * y).sum())
    return 0.5 * doubled


def measure_volume(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def measure_hull_section(points, height):
    """Section area of a convex hull, from all lines between a vertex below and one above."""
    low, high = points[points[:, 2] < height], points[points[:, 2] >= height]
    share = (height - low[:, None, 2]) / (high[None, :, 2] - low[:, None, 2])
    crossed = low[:, None, :2] + share[..., None] * (high[None, :, :2] - low[:, None, :2])
    return float(ConvexHull(crossed.reshape(-1, 2)).volume)


@pytest.mark.parametrize("seed", range(8))
def test_sections_of_random_hulls(seed):
    points, faces = hull(np.random.default_rng(seed).normal(size=(40, 3)) * (30.0, 20.0, 10.0))
    heights = np.linspace(points[:, 2].min(), points[:, 2].max(), 23)[1:-1]
    for height, loops in zip(heights, PlaneCuts(points, faces).loops(heights), strict=True):
        assert len(loops) == 1
        assert measure_area(loops) == pytest.approx(measure_hull_section(points, height), rel=1e-9)


def test_section_areas_integrate_to_the_volume():
    points, faces = hull(np.random.default_rng(3).normal(size=(60, 3)) * 20.0)
    edges = np.linspace(points[:, 2].min(), points[:, 2].max(), 4001)
    areas = [
        measure_area(loops)
        for loops in PlaneCuts(points, faces).loops(0.5 * (edges[1:] + edges[:-1]))
    ]
    assert np.sum(areas) * np.diff(edges)[0] == pytest.approx(
        measure_volume(points, faces), rel=1e-6
    )


def test_holes_and_islands_have_the_correct_direction():
    outer, void, island = (
        make_box((0, 0, 0), (30, 20, 10)),
        turn_inside_out(make_box((5, 5, 2), (25, 15, 8))),
        make_box((40, 0, 0), (50, 5, 10)),
    )
    (loops,) = PlaneCuts(*join_meshes(outer, void, island)).loops([5.0])
    assert sorted(round(measure_area([loop]), 9) for loop in loops) == [-200.0, 50.0, 600.0]


@pytest.mark.parametrize("height", [0.0, 5.0, 10.0, 15.0])
def test_faces_edges_and_vertices_in_the_plane(height):
    """A step has faces at 0, 5 and 15, a roof has its ridge at 10; cuts equal those just below."""
    lower, upper = make_box((0, 0, 0), (30, 20, 5)), make_box((0, 0, 5), (10, 20, 15))
    roof = hull(
        np.array(
            [[40, 0, 0], [60, 0, 0], [60, 10, 0], [40, 10, 0], [40, 5, 10], [60, 5, 10]],
            dtype=float,
        )
    )
    spike = hull(
        np.array([[70, 0, 5], [80, 0, 5], [75, 8, 5], [75, 3, 15], [75, 3, 0]], dtype=float)
    )
    solid = join_meshes(lower, upper, roof, spike)
    just_below = next(PlaneCuts(*solid).loops([height - 1e-9]))
    (loops,) = PlaneCuts(*solid).loops([height])
    assert measure_area(loops) == pytest.approx(measure_area(just_below), abs=1e-6)
    assert all(np.isfinite(loop).all() for loop in loops)


def test_loops_through_vertices_are_closed():
    """A hull of grid points, cut exactly through its vertices."""
    rng = np.random.default_rng(5)
    points = rng.integers(0, 4, size=(200, 3)).astype(float) * 5.0
    solid = hull(np.unique(points, axis=0))
    for height, loops in zip(
        (5.0, 10.0, 15.0), PlaneCuts(*solid).loops([5.0, 10.0, 15.0]), strict=True
    ):
        assert measure_area(loops) == pytest.approx(
            measure_hull_section(solid[0] - (0, 0, 1e-9), height - 2e-9), abs=1e-5
        )


def test_a_solid_that_touches_itself_along_an_edge():
    """Two bars share the vertices of an edge, so four triangles meet there."""
    points, faces = join_meshes(
        make_box((0, 0, 0), (10, 10, 20)), make_box((10, 10, 0), (20, 20, 20))
    )
    vertices, index = np.unique(points, axis=0, return_inverse=True)
    faces = np.ravel(index)[faces]
    assert len(vertices) == 14
    for loops in PlaneCuts(vertices, faces).loops([5.0, 10.0, 19.0]):
        assert measure_area(loops) == pytest.approx(200.0) and sum(len(loop) for loop in loops) >= 8


def test_block_size_does_not_change_sections(monkeypatch):
    from freecad_am.core.slicing.solids import plane_sections

    solid = hull(np.random.default_rng(9).normal(size=(80, 3)) * 20.0)
    heights = np.linspace(-20.0, 20.0, 50)
    areas = [measure_area(loops) for loops in PlaneCuts(*solid).loops(heights)]
    monkeypatch.setattr(plane_sections, "BLOCK_SIZE", 17)
    np.testing.assert_array_equal(
        [measure_area(loops) for loops in PlaneCuts(*solid).loops(heights)], areas
    )


def test_planes_that_miss_the_solid_give_no_loops():
    flat = (
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float),
        np.array([[0, 1, 2], [0, 2, 1]]),
    )
    assert list(PlaneCuts(*flat).loops([-1.0, 0.0, 1.0])) == [[], [], []]
    assert list(PlaneCuts(*make_box((0, 0, 0), (1, 1, 1))).loops([])) == []
