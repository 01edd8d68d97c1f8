# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers by the way through the solid from where it stands: each lies on the one below, so that nothing needs support."""

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
from ..charts.flattening import flattened, turned
from ..charts.parted import OVERLAID, stretch_of
from ..margins import BORDER
from .carried_on import carried_on, gradients
from .eikonal import Links, arrival, links
from .level import Cubes
from .voxels import Voxels, voxels

EXACT_STEPS = 2.5  # steps; nodes so near to the start know their distance from its triangles
DEEP = 3  # nodes; farther inside nothing asks how far the surface is
STRETCH = 0.15  # most that a piece is stretched or squeezed; what would be more is laid flat in two
HALVINGS = 6
MARGIN = 2.0  # steps that pieces reach past where they are cut in two


class Piece(NamedTuple):
    """A part of a layer on its chart, and what of its picture is deposited; stretch: the largest share by which lengths
    differ from those in the part."""

    chart: Chart
    regions: tuple[Region, ...]
    stretch: float


@dataclass(frozen=True, eq=False)
class GeodesicField:
    """The distance u mm through solids from their start. cubes: u on a grid; depth: how deep inside them, mm, on the nodes
    of the same; way: its gradient, smoothed; top: the largest distance; unreached: share of the solids that no way
    leads to."""

    grid: Voxels
    cubes: Cubes
    depth: Cubes
    way: tuple[Cubes, Cubes, Cubes]
    top: float
    unreached: float

    def pieces(self, distance: float) -> Iterator[Piece]:
        """What of the solid lies at a distance, mm, in pieces that can be laid flat."""
        mesh = self.cubes.level(distance)
        if not len(mesh.faces):
            return
        inside = _filled(self.depth.sampled(mesh.vertices)[0], -self.grid.step)
        inside[np.unique(mesh.border_edges)] = -self.grid.step
        for part, own in _connected(mesh, inside > 0.0):
            yield from self._flattened(part, inside[own], HALVINGS)

    def onto(self, points: Array, distance: float) -> Array:
        """Points (n, 3) moved along the way through the solid to where u is the distance."""
        for _ in range(3):
            value, slope = self.cubes.sampled(points)
            value, slope = _filled(value, distance), _filled(slope, 0.0)
            square = np.maximum((slope * slope).sum(axis=1), 0.25)
            points = points - ((value - distance) / square)[:, None] * slope
        return points

    def directions(self, points: Array) -> Array:
        """Unit build directions (n, 3): the way u grows fastest, smoothed."""
        way = np.stack([_filled(one.sampled(points)[0], 0.0) for one in self.way], axis=1)
        unit: Array = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
        return unit

    def _flattened(self, mesh: Mesh, inside: Array, halvings: int) -> Iterator[Piece]:
        flat = flattened(mesh)
        within = np.where((inside[mesh.faces] > 0.0).any(axis=1), mesh.areas, 0.0)
        stretch = stretch_of(flat, within)
        if stretch <= STRETCH or halvings == 0:
            chart = Chart(mesh, turned(mesh, flat.points))
            loops = _loops(chart, inside)
            found = regions(loops)
            bounded = 0.5 * sum(doubled_area(loop) for loop in loops)
            if halvings == 0 or abs(sum(one.area for one in found) - bounded) <= OVERLAID * max(
                bounded, 0.0
            ):
                if found:
                    yield Piece(
                        chart, tuple(one.simple(BORDER * self.grid.step) for one in found), stretch
                    )
                return
        for half in _halves(mesh, inside, MARGIN * self.grid.step):
            for part, own in _connected(half.mesh, half.inside > 0.0):
                yield from self._flattened(part, half.inside[own], halvings - 1)


class _Half(NamedTuple):
    mesh: Mesh
    inside: Array


def field(
    solids: Sequence[SolidMesh], start: Array, step: float, through: bool = True
) -> GeodesicField:
    """The distance through solids, which may touch or overlap, from triangles (k, 3, 3) where they stand, on a grid of
    `step` mm; through=False: straight from there. ValueError where no node of the grid is near the start."""
    searches = [Search(one, 2.0 * step) for one in solids]
    first = np.cumsum([0, *(len(one.vertices) for one in solids)])
    whole = np.vstack([one.triangles + begin for one, begin in zip(solids, first)])
    inner = voxels(np.vstack([one.vertices for one in solids]), whole, step)
    grid = _rounded_up(inner, searches)
    linked = links(grid)
    seeds, values = _seeds(start, grid.places(linked.nodes), step)
    if not len(seeds):
        raise ValueError("no node of the grid is near the start")
    u = (
        arrival(linked, step, seeds, values)
        if through
        else _away(start, grid.places(linked.nodes), step)
    )
    reached = np.isfinite(u)
    way = _smoothed(linked, gradients(linked, np.where(reached, u, np.nan), step))
    carried = carried_on(grid, linked, u)
    ways = [
        Cubes(carried_on(grid, linked, np.where(reached, one, np.inf)), grid.origin, step)
        for one in way.T
    ]
    return GeodesicField(
        grid,
        Cubes(carried, grid.origin, step),
        Cubes(_depths(grid, inner.solid, searches, carried), grid.origin, step),
        (ways[0], ways[1], ways[2]),
        float(u[reached].max()),
        float((~reached).mean()),
    )


def _seeds(start: Array, places: Array, step: float) -> tuple[Index, Array]:
    """Nodes near the start and their distances from it."""
    if not len(start):
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    low, high = (
        start.min(axis=(0, 1)) - EXACT_STEPS * step,
        start.max(axis=(0, 1)) + EXACT_STEPS * step,
    )
    near = np.flatnonzero(((places > low) & (places < high)).all(axis=1))
    if not len(near):
        return near, np.zeros(0)
    away = _away(start, places[near], step)
    close = np.abs(away) < EXACT_STEPS * step
    return near[close], away[close]


def _away(start: Array, places: Array, step: float) -> Array:
    """How far (n,) mm places are from the start; near it, less than 0 on the side that is not the solid's."""
    chosen = SolidMesh(start.reshape(-1, 3), np.arange(3 * len(start)).reshape(-1, 3))
    away = -Search(chosen, 2.0 * step).signed(places)[0]
    return np.where(np.abs(away) < EXACT_STEPS * step, away, np.abs(away))


def _outside(searches: Sequence[Search], points: Array) -> Array:
    """How far (n,) mm points are outside of all solids, below 0 inside of one."""
    found: Array = np.min([search.signed(points)[0] for search in searches], axis=0)
    return found


def _rounded_up(grid: Voxels, searches: Sequence[Search]) -> Voxels:
    """The grid with the nodes that lie less than half a step outside: corners that ways lead round are then, on the whole,
    where they are, not up to a step farther in."""
    wide = grid.solid.copy()
    for axis in range(3):
        wide |= np.roll(grid.solid, 1, axis) | np.roll(grid.solid, -1, axis)
    nodes = np.flatnonzero(wide & ~grid.solid)
    solid = grid.solid.ravel().copy()
    solid[nodes] = _outside(searches, grid.places(nodes)) < 0.5 * grid.step
    return Voxels(grid.origin, grid.step, solid.reshape(grid.solid.shape))


def _depths(grid: Voxels, wound: Mask, searches: Sequence[Search], carried: Array) -> Array:
    """How deep (nx, ny, nz) mm nodes lie in the solids, below 0 outside; no more than DEEP steps is told, nan where the
    field is not known. wound: nodes that the solids go round, which are inside whatever side the nearest triangle shows
    them where a solid cuts itself."""
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
    asked = np.flatnonzero(~np.isnan(depth) & ~inner.ravel())
    found = -_outside(searches, grid.places(asked))
    depth[asked] = np.where(wound.ravel()[asked], np.abs(found), found)
    return depth.reshape(grid.solid.shape)


def _smoothed(linked: Links, way: Array) -> Array:
    """Directions (n, 3) of the nodes, each the mean of its own and its neighbours', of unit length, twice."""
    for _ in range(2):
        unit = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
        padded = np.vstack([unit, np.zeros((1, 3))])
        way = 2.0 * unit + padded[linked.neighbours].sum(axis=0)
    smoothed: Array = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
    return smoothed


def _connected(mesh: Mesh, inside: Mask) -> Iterator[tuple[Mesh, Index]]:
    """The pieces of a mesh that hang together by vertices inside, each with the triangles about it and its vertices here."""
    pairs = mesh.edges[inside[mesh.edges].all(axis=1)]
    n = len(inside)
    label = connected_components(
        coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n)), directed=False
    )[1]
    label = np.where(inside, label, -1)
    owner = label[mesh.faces].max(axis=1)
    for one in np.unique(owner[owner >= 0]):
        yield mesh.part(np.flatnonzero((label[mesh.faces] == one).any(axis=1)))


def _halves(mesh: Mesh, inside: Array, margin: float) -> Iterator[_Half]:
    """A piece in two, across its longest side; both reach a little past the cut."""
    kept = inside > 0.0
    middle = mesh.vertices[kept].mean(axis=0)
    axis = np.linalg.svd(mesh.vertices[kept] - middle, full_matrices=False)[2][0]
    along = (mesh.vertices - middle) @ axis
    for sign in (-1.0, 1.0):
        side = np.minimum(inside, sign * along)
        faces = np.flatnonzero((sign * along > -margin)[mesh.faces].all(axis=1))
        part, own = mesh.part(faces)
        cut = side[own].copy()
        border = np.unique(part.border_edges)
        cut[border] = np.minimum(cut[border], -1e-6 * margin)
        yield _Half(part, cut)


def _loops(chart: Chart, inside: Array) -> tuple[Array, ...]:
    """The loops (k, 2) about the part of a chart that is inside."""
    flat = Mesh(np.column_stack([chart.flat, np.zeros(len(chart.flat))]), chart.mesh.faces)
    lines = flat.level_lines(inside, np.arange(len(flat.faces)))
    return tuple(line.points[::-1, :2] for line in lines if line.closed and len(line.points) > 2)


def _filled(values: Array, instead: float) -> Array:
    found: Array = np.where(np.isfinite(values), values, instead)
    return found
