# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance fields through a solid on a grid, their level surfaces and the flattened levels, against
other methods."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.mesh.refine import Edges
from freecad_am.core.geometry.mesh.triangle_mesh import Mesh
from freecad_am.core.layers.chart import Chart
from freecad_am.core.layers.eikonal import Voxels, arrival, links, voxels
from freecad_am.core.layers.geodesic import Cubes, extrapolate
from freecad_am.core.layers.parted_chart import align_to_x, flatten, measure_stretch

from .shapes import box, icosphere


@pytest.mark.parametrize("seed", range(5))
def test_nodes_of_a_turned_box_are_those_between_its_planes(seed):
    rng = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = (
        Rotation.random(random_state=seed).as_matrix(),
        rng.uniform(-300.0, 300.0, 3),
    )
    size = rng.uniform(3.0, 20.0, 3)
    grid = voxels(*box(size, pose), 0.7)
    local = (grid.places(np.arange(grid.solid.size)) - pose[:3, 3]) @ pose[:3, :3]
    inside = ((local > 0.0) & (local < size)).all(axis=1)
    assert (grid.solid.ravel() == inside).all()


def test_bodies_that_overlap_are_one_and_a_cavity_is_left_out():
    """Overlapping bodies are united, and a cavity is excluded."""
    vertices, faces = box([10.0, 10.0, 10.0])
    overlapping = voxels(
        np.vstack([vertices, vertices + 4.0]), np.vstack([faces, faces + len(vertices)]), 0.5
    )
    assert overlapping.solid.sum() * 0.5**3 == pytest.approx(2000.0 - 6.0**3, rel=0.02)
    hollow = voxels(
        np.vstack([vertices, 0.5 * vertices + 2.5]),
        np.vstack([faces, faces[:, ::-1] + len(vertices)]),
        0.5,
    )
    assert hollow.solid.sum() * 0.5**3 == pytest.approx(1000.0 - 125.0, rel=0.02)


def _ball(step=0.5, radius=10.0):
    return voxels(*icosphere(radius), step)


def test_distance_from_a_point_in_free_space():
    grid = _ball()
    linked = links(grid)
    nodes = grid.places(linked.nodes)
    exact = np.linalg.norm(nodes - [2.0, 1.0, -1.0], axis=1)
    seeds = np.flatnonzero(exact < 2.0)
    u = arrival(linked, grid.step, seeds, exact[seeds])
    assert np.abs(u - exact).max() < 0.35 * grid.step
    slope = (
        np.linalg.norm(np.stack(np.gradient(_on(grid, linked, u)), axis=-1), axis=-1) / grid.step
    )
    assert np.nanquantile(np.abs(slope - 1.0), 0.99) < 0.05


def _on(grid, linked, u):
    field = np.full(grid.solid.size, np.nan)
    field[linked.nodes] = u
    return field.reshape(grid.solid.shape)


@pytest.mark.parametrize("seed", range(3))
def test_in_a_maze_no_way_is_shorter_than_straight_or_longer_than_from_node_to_node(seed):
    """In a maze the distance is at least the straight line and at most the path along grid
    edges."""
    rng = np.random.default_rng(seed)
    solid = np.zeros((24, 20, 22), dtype=bool)
    solid[2:-2, 2:-2, 2:-2] = True
    for _ in range(12):
        a = rng.integers(2, 18, 3)
        solid[tuple(slice(k, k + n) for k, n in zip(a, rng.permutation([9, 7, 2])))] = False
    grid = Voxels(np.zeros(3), 1.0, solid)
    linked = links(grid)
    nodes = grid.places(linked.nodes)
    start = int(np.argmin(nodes.sum(axis=1)))
    u = arrival(linked, 1.0, np.array([start]), np.zeros(1))
    pairs = np.vstack(
        [np.stack([np.arange(len(nodes)), side], axis=1) for side in linked.neighbours]
    )
    pairs = pairs[pairs[:, 1] < len(nodes)]
    graph = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(nodes),) * 2)
    steps = dijkstra(graph.tocsr(), indices=start)
    assert (np.isfinite(u) == np.isfinite(steps)).all()
    reached = np.isfinite(u)
    assert (u[reached] >= np.linalg.norm(nodes - nodes[start], axis=1)[reached] - 1e-9).all()
    assert (u[reached] <= steps[reached] + 1e-9).all()


@pytest.mark.parametrize("seed", range(3))
def test_levels_are_closed_surfaces_of_the_right_area(seed):
    middle = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
    axis = np.arange(-14.0, 14.5, 0.7)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    cubes = Cubes(
        np.linalg.norm(np.stack([x, y, z], axis=-1) - middle, axis=-1), np.full(3, -14.0), 0.7
    )
    mesh = cubes.level(9.0)
    edges = Edges(mesh.faces)
    assert (edges.count == 2).all()
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    assert 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() == pytest.approx(
        4.0 * np.pi * 81.0, rel=0.01
    )
    assert (np.cross(b - a, c - a) * (a - middle)).sum() / 6.0 == pytest.approx(
        4.0 / 3.0 * np.pi * 729.0, rel=0.01
    )


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.always("0")
def test_levels_of_a_rough_field_have_one_side_everywhere(seed):
    """Where fronts meet, the field has ridges without a useful gradient. The level must still be
    oriented consistently: triangles traverse a shared edge in opposite directions, and the winding
    number is one for nodes above the level and zero below."""
    rng = np.random.default_rng(seed)
    field = ndimage.gaussian_filter(rng.normal(size=(24, 24, 24)), 0.8)
    field[[0, -1]] = field[:, [0, -1]] = field[
        :, :, [0, -1]
    ] = -1.0  # the level closes within the grid
    mesh = Cubes(field, np.zeros(3), 1.0).level(0.1)
    half_edges = np.vstack([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    assert len(np.unique(half_edges, axis=0)) == len(half_edges)
    for node in rng.integers(0, 24, size=(60, 3)):
        a, b, c = (mesh.vertices[mesh.faces[:, k]] - node for k in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        over = (np.cross(b, c) * a).sum(axis=1)
        under = (
            la * lb * lc
            + (a * b).sum(axis=1) * lc
            + (b * c).sum(axis=1) * la
            + (c * a).sum(axis=1) * lb
        )
        turns = 2.0 * np.arctan2(over, under).sum() / (4.0 * np.pi)
        assert turns == pytest.approx(-1.0 if field[tuple(node)] >= 0.1 else 0.0, abs=1e-6)


def test_a_field_is_carried_on_as_it_goes():
    """Extrapolation continues a linear field exactly."""
    grid = _ball()
    linked = links(grid)
    slope = np.array([0.3, -0.5, 0.8])
    field = extrapolate(grid, linked, grid.places(linked.nodes) @ slope)
    extended = np.flatnonzero(~np.isnan(field.ravel()))
    assert len(extended) > 1.3 * len(linked.nodes)
    assert np.abs(field.ravel()[extended] - grid.places(extended) @ slope).max() < 1e-9


def _sheet(wrap, width=30.0, height=20.0, edge=1.0, seed=0):
    """A mesh of a rectangle mapped onto a surface, and its flat image."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(0.0, width, edge), np.arange(0.0, height, edge), indexing="ij")
    flat = np.stack([x.ravel(), y.ravel()], axis=1) + rng.uniform(-0.3, 0.3, (x.size, 2)) * edge
    n, m = x.shape
    corner = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    faces = np.vstack(
        [
            np.stack([corner, corner + m, corner + m + 1], 1),
            np.stack([corner, corner + m + 1, corner + 1], 1),
        ]
    )
    return Mesh(wrap(flat), faces.astype(np.intp)), flat


def _cylinder(flat, radius=12.0):
    return np.stack(
        [radius * np.sin(flat[:, 0] / radius), flat[:, 1], radius * np.cos(flat[:, 0] / radius)],
        axis=1,
    )


def _sphere(flat, radius=25.0):
    u, v = flat.T / radius
    return radius * np.stack([np.sin(u) * np.cos(v), np.sin(v), np.cos(u) * np.cos(v)], axis=1)


def test_what_can_be_laid_flat_is_without_distortion():
    """A developable surface is flattened without distortion."""
    mesh, flat = _sheet(_cylinder)
    flattened = flatten(mesh)
    assert flattened.min_stretch.min() > 0.99 and flattened.max_stretch.max() < 1.01
    distances = np.linalg.norm(flattened.points[:, None] - flattened.points[::97], axis=2)
    true = np.linalg.norm(flat[:, None] - flat[::97], axis=2)
    assert np.abs(distances - true).max() < 0.05
    assert (measure_stretch(mesh, flattened.points)[0] > 0.0).all()  # no triangle is flipped


def test_what_cannot_is_stretched_no_more_than_it_must():
    """A sphere is stretched no more than necessary."""
    mesh, _ = _sheet(_sphere)
    flattened = flatten(mesh)
    half = 0.5 * np.hypot(30.0, 20.0) / 25.0  # angle from the middle to a corner
    assert flattened.min_stretch.min() > np.sin(
        half
    ) / half - 0.05 and flattened.max_stretch.max() < 1.05 * half / np.sin(half)


@pytest.mark.parametrize("surface", [_cylinder, _sphere])
def test_places_of_a_picture_come_back(surface):
    mesh, _ = _sheet(surface)
    chart = Chart(mesh, align_to_x(mesh, flatten(mesh).points))
    rng = np.random.default_rng(3)
    share = rng.dirichlet(np.ones(3), 2000)
    face = rng.integers(0, len(mesh.faces), 2000)
    flat = np.einsum("nk,nkc->nc", share, chart.flat[mesh.faces[face]])
    space = np.einsum("nk,nkc->nc", share, mesh.vertices[mesh.faces[face]])
    assert np.abs(chart.wrap(flat) - space).max() < 1e-9
    outside = chart.wrap(chart.flat[mesh.border_edges].mean(axis=1) + 0.0)
    assert np.isfinite(outside).all()
    assert np.isfinite(chart.wrap(np.array([[500.0, -300.0]]))).all()
