# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers by distance through the solid from its start: each is on the one below, so that
nothing needs support.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...geometry.curves.plane_curve import doubled_area
from ...geometry.mesh.solid import Search, SolidMesh
from ...geometry.mesh.triangle_mesh import Mesh
from ...geometry.regions.region import Region, regions
from ...types import Array, Index, Mask
from ..charts.chart import Chart
from ..charts.flattening import align_to_x, flatten
from ..charts.parted import MAX_OVERLAP_SHARE, stretch_of
from ..margins import BORDER
from .carried_on import extrapolate, gradients
from .eikonal import Links, arrival, links
from .level import Cubes
from .voxels import Voxels, voxels

EXACT_STEPS = 2.5  # steps; nodes so near to the start know their distance from its triangles
DEEP = 3  # nodes; farther inside nothing asks how far the surface is
STRETCH = 0.15  # maximum stretch or squeeze of a piece; a piece with more is flattened in two
HALVINGS = 6
MARGIN = 2.0  # steps that pieces reach past where they are cut in two


class Piece(NamedTuple):
    """A part of a layer on its chart, and the deposited regions of its picture.

    stretch: the largest relative difference of lengths from those in the part.
    """

    chart: Chart
    regions: tuple[Region, ...]
    stretch: float


@dataclass(frozen=True, eq=False)
class GeodesicField:
    """The distance u mm through solids from their start.

    cubes: u on a grid. depth: depth inside the solids, mm, on the nodes of the same grid.
    gradient: the gradient of u, smoothed. top: the largest distance. unreached: share of the
    solids that no path reaches.
    """

    grid: Voxels
    cubes: Cubes
    depth: Cubes
    gradient: tuple[Cubes, Cubes, Cubes]
    top: float
    unreached: float

    def pieces(self, distance: float) -> Iterator[Piece]:
        """Yield the surface in the solid at a distance, mm, in pieces that can be flattened."""
        mesh = self.cubes.level(distance)
        if not len(mesh.faces):
            return
        inside = _replace_nan(self.depth.sample(mesh.vertices)[0], -self.grid.step)
        inside[np.unique(mesh.border_edges)] = -self.grid.step
        for component, vertex_numbers in _connected(mesh, inside > 0.0):
            yield from self._flattened(component, inside[vertex_numbers], HALVINGS)

    def onto(self, points: Array, distance: float) -> Array:
        """Points (n, 3) moved along the way through the solid to where u is the distance."""
        for _ in range(3):
            value, slope = self.cubes.sample(points)
            value, slope = _replace_nan(value, distance), _replace_nan(slope, 0.0)
            square = np.maximum((slope * slope).sum(axis=1), 0.25)
            points = points - ((value - distance) / square)[:, None] * slope
        return points

    def directions(self, points: Array) -> Array:
        """Return unit build directions (n, 3): the smoothed direction of the fastest growth of u."""
        direction = np.stack(
            [_replace_nan(component.sample(points)[0], 0.0) for component in self.gradient], axis=1
        )
        unit: Array = direction / np.maximum(
            np.linalg.norm(direction, axis=1, keepdims=True), 1e-300
        )
        return unit

    def _flattened(self, mesh: Mesh, inside: Array, halvings: int) -> Iterator[Piece]:
        flat = flatten(mesh)
        within = np.where((inside[mesh.faces] > 0.0).any(axis=1), mesh.areas, 0.0)
        stretch = stretch_of(flat, within)
        if stretch <= STRETCH or halvings == 0:
            chart = Chart(mesh, align_to_x(mesh, flat.points))
            loops = _loops(chart, inside)
            bounded_regions = regions(loops)
            bounded = 0.5 * sum(doubled_area(loop) for loop in loops)
            if halvings == 0 or abs(
                sum(region.area for region in bounded_regions) - bounded
            ) <= MAX_OVERLAP_SHARE * max(bounded, 0.0):
                if bounded_regions:
                    yield Piece(
                        chart,
                        tuple(region.simple(BORDER * self.grid.step) for region in bounded_regions),
                        stretch,
                    )
                return
        for half in _halves(mesh, inside, MARGIN * self.grid.step):
            for component, vertex_numbers in _connected(half.mesh, half.inside > 0.0):
                yield from self._flattened(component, half.inside[vertex_numbers], halvings - 1)


class _Half(NamedTuple):
    mesh: Mesh
    inside: Array


def field(
    solids: Sequence[SolidMesh], start: Array, step: float, through: bool = True
) -> GeodesicField:
    """Return the distance through solids, which may touch or overlap, from triangles (k, 3, 3)
    at their start.

    step: mm of the grid. through=False: straight distance. Raises ValueError if no node of
    the grid is near the start.
    """
    searches = [Search(solid, 2.0 * step) for solid in solids]
    first_vertex = np.cumsum([0, *(len(solid.vertices) for solid in solids)])
    all_triangles = np.vstack(
        [solid.triangles + begin for solid, begin in zip(solids, first_vertex)]
    )
    inner = voxels(np.vstack([solid.vertices for solid in solids]), all_triangles, step)
    grid = _add_border_nodes(inner, searches)
    linked = links(grid)
    seeds, values = _seeds(start, grid.places(linked.nodes), step)
    if not len(seeds):
        raise ValueError("no node of the grid is near the start")
    u = (
        arrival(linked, step, seeds, values)
        if through
        else _start_distances(start, grid.places(linked.nodes), step)
    )
    reached = np.isfinite(u)
    direction = _smooth_directions(linked, gradients(linked, np.where(reached, u, np.nan), step))
    carried = extrapolate(grid, linked, u)
    gradient_components = [
        Cubes(extrapolate(grid, linked, np.where(reached, solid, np.inf)), grid.origin, step)
        for solid in direction.T
    ]
    return GeodesicField(
        grid,
        Cubes(carried, grid.origin, step),
        Cubes(_depths(grid, inner.solid, searches, carried), grid.origin, step),
        (gradient_components[0], gradient_components[1], gradient_components[2]),
        float(u[reached].max()),
        float((~reached).mean()),
    )


def _seeds(start: Array, positions: Array, step: float) -> tuple[Index, Array]:
    """Return nodes near the start and their distances from it."""
    if not len(start):
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    low, high = (
        start.min(axis=(0, 1)) - EXACT_STEPS * step,
        start.max(axis=(0, 1)) + EXACT_STEPS * step,
    )
    nearby = np.flatnonzero(((positions > low) & (positions < high)).all(axis=1))
    if not len(nearby):
        return nearby, np.zeros(0)
    distance = _start_distances(start, positions[nearby], step)
    close = np.abs(distance) < EXACT_STEPS * step
    return nearby[close], distance[close]


def _start_distances(start: Array, positions: Array, step: float) -> Array:
    """Return distances (n,) mm from the start; near it, negative on the side away from the
    solid.
    """
    start_mesh = SolidMesh(start.reshape(-1, 3), np.arange(3 * len(start)).reshape(-1, 3))
    distance = -Search(start_mesh, 2.0 * step).signed(positions)[0]
    return np.where(np.abs(distance) < EXACT_STEPS * step, distance, np.abs(distance))


def _outside(searches: Sequence[Search], points: Array) -> Array:
    """Return distances (n,) mm outside all solids, negative inside one."""
    distances: Array = np.min([search.signed(points)[0] for search in searches], axis=0)
    return distances


def _add_border_nodes(grid: Voxels, searches: Sequence[Search]) -> Voxels:
    """Add the nodes less than half a step outside: corners in the paths are then, on average, at
    their true position.
    """
    wide = grid.solid.copy()
    for axis in range(3):
        wide |= np.roll(grid.solid, 1, axis) | np.roll(grid.solid, -1, axis)
    nodes = np.flatnonzero(wide & ~grid.solid)
    solid = grid.solid.ravel().copy()
    solid[nodes] = _outside(searches, grid.places(nodes)) < 0.5 * grid.step
    return Voxels(grid.origin, grid.step, solid.reshape(grid.solid.shape))


def _depths(grid: Voxels, wound: Mask, searches: Sequence[Search], carried: Array) -> Array:
    """Return the depths (nx, ny, nz) mm of nodes in the solids, negative outside.

    They are at most DEEP steps, and NaN where the field is not known. wound: nodes that the
    solids wind around, which are inside whatever side the nearest triangle shows where a
    solid cuts itself.
    """
    depth = np.where(np.isnan(carried), np.nan, DEEP * grid.step).ravel()
    inner = grid.solid.copy()
    for _ in range(DEEP):
        inner[1:-1, 1:-1, 1:-1] &= (
            inner[:-2, 1:-1, 1:-1]
            & inner[2:, 1:-1, 1:-1]
            & inner[1:-1, :-2, 1:-1]
            & inner[1:-1, 2:, 1:-1]
            & inner[1:-1, 1:-1, :-2]
            & inner[1:-1, 1:-1, 2:]
        )
    near_surface = np.flatnonzero(~np.isnan(depth) & ~inner.ravel())
    depths = -_outside(searches, grid.places(near_surface))
    depth[near_surface] = np.where(wound.ravel()[near_surface], np.abs(depths), depths)
    return depth.reshape(grid.solid.shape)


def _smooth_directions(linked: Links, direction: Array) -> Array:
    """Return unit directions (n, 3) of the nodes, averaged twice with their neighbours."""
    for _ in range(2):
        unit = direction / np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-300)
        padded = np.vstack([unit, np.zeros((1, 3))])
        direction = 2.0 * unit + padded[linked.neighbours].sum(axis=0)
    smoothed: Array = direction / np.maximum(
        np.linalg.norm(direction, axis=1, keepdims=True), 1e-300
    )
    return smoothed


def _connected(mesh: Mesh, inside: Mask) -> Iterator[tuple[Mesh, Index]]:
    """Yield the components of a mesh connected by vertices inside, each with its adjacent
    triangles and vertex numbers.
    """
    pairs = mesh.edges[inside[mesh.edges].all(axis=1)]
    n = len(inside)
    label = connected_components(
        coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n)), directed=False
    )[1]
    label = np.where(inside, label, -1)
    owner = label[mesh.faces].max(axis=1)
    for component in np.unique(owner[owner >= 0]):
        yield mesh.part(np.flatnonzero((label[mesh.faces] == component).any(axis=1)))


def _halves(mesh: Mesh, inside: Array, margin: float) -> Iterator[_Half]:
    """Yield a piece in two halves, across its longest side; both reach a little past the cut."""
    is_inside = inside > 0.0
    middle = mesh.vertices[is_inside].mean(axis=0)
    axis = np.linalg.svd(mesh.vertices[is_inside] - middle, full_matrices=False)[2][0]
    along = (mesh.vertices - middle) @ axis
    for sign in (-1.0, 1.0):
        side = np.minimum(inside, sign * along)
        faces = np.flatnonzero((sign * along > -margin)[mesh.faces].all(axis=1))
        half, vertex_numbers = mesh.part(faces)
        cut = side[vertex_numbers].copy()
        border = np.unique(half.border_edges)
        cut[border] = np.minimum(cut[border], -1e-6 * margin)
        yield _Half(half, cut)


def _loops(chart: Chart, inside: Array) -> tuple[Array, ...]:
    """The loops (k, 2) about the part of a chart that is inside."""
    flat = Mesh(np.column_stack([chart.flat, np.zeros(len(chart.flat))]), chart.mesh.faces)
    lines = flat.level_lines(inside, np.arange(len(flat.faces)))
    return tuple(line.points[::-1, :2] for line in lines if line.closed and len(line.points) > 2)


def _replace_nan(values: Array, instead: float) -> Array:
    filled: Array = np.where(np.isfinite(values), values, instead)
    return filled
