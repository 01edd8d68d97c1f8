# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant distance from the start, measured through the solid.

Each layer lies on the layer below, so that no support is needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..geometry.curves.plane_curve import doubled_area
from ..geometry.mesh.solid import Search, SolidMesh
from ..geometry.mesh.triangle_mesh import Mesh
from ..geometry.regions.region import Region, regions
from ..types import Array, Index, Mask
from .chart import Chart
from .eikonal import Links, Voxels, arrival, links, voxels
from .margins import BORDER
from .parted_chart import MAX_OVERLAP_SHARE, align_to_x, flatten, stretch_of

AT_END = 0.08  # fraction of an edge; minimum distance of a crossing from its ends, to avoid slivers


def _tetrahedra() -> Index:
    """Return the corners (6, 4, 3) of the tetrahedra that divide a unit cube.

    Each tetrahedron is a path from (0, 0, 0) to (1, 1, 1) along the edges of the cube.
    """
    tetrahedra = []
    for order in permutations(range(3)):
        corner, path = np.zeros(3, dtype=np.intp), []
        path.append(corner.copy())
        for axis in order:
            corner[axis] = 1
            path.append(corner.copy())
        tetrahedra.append(np.array(path))
    return np.array(tetrahedra)


TETRAHEDRA = _tetrahedra()


class Cubes:
    """Cubes of a field (nx, ny, nz) with known values at all corners, ordered by minimum value."""

    def __init__(self, field: Array, origin: Array, step: float) -> None:
        self.field, self.origin, self.step = field.ravel(), origin, step
        self.shape = field.shape
        self._strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
        low, high = field[:-1, :-1, :-1], field[:-1, :-1, :-1]
        for corner in np.ndindex(2, 2, 2):
            corner_values = field[tuple(slice(c, n - 1 + c) for c, n in zip(corner, field.shape))]
            # NaN if any corner is unknown
            low, high = np.minimum(low, corner_values), np.maximum(high, corner_values)
        known_cubes = np.argwhere(~np.isnan(low))
        self._first: Index = known_cubes @ self._strides
        low, high = low[tuple(known_cubes.T)], high[tuple(known_cubes.T)]
        order = np.argsort(low, kind="stable")
        self._first, self._low, self._high = self._first[order], low[order], high[order]

    def level(self, value: float) -> Mesh:
        """Return the isosurface of a value, with triangles counter-clockwise from the higher side."""
        end = int(np.searchsorted(self._low, value, side="left"))
        cubes = self._first[:end][self._high[:end] >= value]
        corners = (cubes[:, None, None] + TETRAHEDRA @ self._strides).reshape(-1, 4)
        high = self.field[corners] >= value
        count = high.sum(axis=1)
        kinds = [
            _single(corners, high, count == 1),
            _single(corners, ~high, count == 3),
            _double(corners, high, count == 2),
        ]
        pairs = np.concatenate(kinds)
        # all pairs of a triangle begin on one side: the higher side, except around a single low
        # corner
        sign = np.repeat([1.0, -1.0, 1.0], [len(pairs_of_kind) for pairs_of_kind in kinds])
        edges, edge_index = np.unique(
            np.sort(pairs.reshape(-1, 2), axis=1), axis=0, return_inverse=True
        )
        return self._orient(
            self._edge_points(edges, value),
            edge_index.reshape(-1, 3).astype(np.intp),
            pairs[:, 0, 0],
            sign,
        )

    def _edge_points(self, edges: Index, value: float) -> Array:
        a, b = self.field[edges[:, 0]], self.field[edges[:, 1]]
        share = np.clip((value - a) / np.where(b == a, 1.0, b - a), AT_END, 1.0 - AT_END)[:, None]
        start_node, end_node = (
            np.stack(np.unravel_index(edges[:, k], self.shape), axis=1) for k in (0, 1)
        )
        points: Array = self.origin + self.step * (start_node + share * (end_node - start_node))
        return points

    def _orient(self, vertices: Array, faces: Index, adjacent: Index, sign: Array) -> Mesh:
        """Orient triangles counter-clockwise as seen from the higher side.

        adjacent: (n,) a node of the tetrahedron of each triangle, on the higher side if sign is 1.
        The gradient of the field would not determine the side at a ridge.
        """
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        node = self.origin + self.step * np.stack(np.unravel_index(adjacent, self.shape), axis=1)
        back = sign * (np.cross(b - a, c - a) * (node - a)).sum(axis=1) < 0.0
        faces[back] = faces[back][:, ::-1]
        return Mesh(vertices, faces)

    def sample(self, points: Array) -> tuple[Array, Array]:
        """Interpolate values and gradients of the field at points.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        value : (n,) array
            Trilinear interpolation of the eight surrounding nodes; NaN if any node is unknown.
        slope : (n, 3) array
            Gradients, per mm.
        """
        position = (points - self.origin) / self.step
        cell = np.clip(np.floor(position).astype(np.intp), 0, np.array(self.shape) - 2)
        t = position - cell
        first_node = cell @ self._strides
        value, slope = np.zeros(len(points)), np.zeros((len(points), 3))
        to, off = t.T, (1.0 - t).T
        for corner in np.ndindex(2, 2, 2):
            corner_value = self.field[first_node + int(np.array(corner) @ self._strides)]
            x, y, z = (to[axis] if corner[axis] else off[axis] for axis in range(3))
            value += x * y * z * corner_value
            for axis, slope_weight in enumerate((y * z, x * z, x * y)):
                slope[:, axis] += (
                    (1.0 if corner[axis] else -1.0) * slope_weight * corner_value / self.step
                )
        return value, slope


def _single(corners: Index, is_single: Mask, selected: Mask) -> Index:
    """Return node pairs (k, 3, 2): the edges from the single corner on one side to the other three."""
    corners, is_single = corners[selected], is_single[selected]
    row = np.arange(len(corners))
    k = np.argmax(is_single, axis=1)
    return np.stack(
        [np.stack([corners[row, k], corners[row, (k + j) % 4]], axis=1) for j in (1, 2, 3)], axis=1
    )


def _double(corners: Index, high: Mask, selected: Mask) -> Index:
    """Return node pairs (2 k, 3, 2): four edges from two high to two low corners, as two triangles."""
    corners, high = corners[selected], high[selected]
    row = np.arange(len(corners))[:, None]
    order = np.argsort(~high, axis=1, kind="stable")
    a, b, c, d = corners[row, order].T
    ac, ad, bd, bc = (np.stack(pair, axis=1) for pair in ((a, c), (a, d), (b, d), (b, c)))
    return np.concatenate([np.stack([ac, ad, bd], axis=1), np.stack([ac, bd, bc], axis=1)])


LAYERS = 2  # number of node layers beyond the surface


def extrapolate(grid: Voxels, linked: Links, values: Array) -> Array:
    """Extend a field by LAYERS of nodes beyond the solid.

    The value at a new node is the weighted mean of linear extrapolations from known neighbours.

    Parameters
    ----------
    grid : Voxels
        The grid.
    linked : Links
        The n nodes inside.
    values : (n,) array
        Values at the nodes; infinite where unknown.

    Returns
    -------
    (nx, ny, nz) array
        The field; NaN elsewhere.
    """
    field = np.full(grid.solid.size, np.nan)
    field[linked.nodes] = np.where(np.isfinite(values), values, np.nan)
    is_known = grid.solid.ravel() & np.isfinite(field)
    for _ in range(LAYERS):
        field, is_known = _add_layer(grid, field, is_known)
    return field.reshape(grid.solid.shape)


def _add_layer(grid: Voxels, field: Array, is_known: Mask) -> tuple[Array, Mask]:
    linked = links(Voxels(grid.origin, grid.step, is_known.reshape(grid.solid.shape)))
    slope = gradients(linked, field[linked.nodes], 1.0)
    total, count = np.zeros(field.size), np.zeros(field.size)
    strides = grid.strides()
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            for z in (-1, 0, 1):
                step = np.array([x, y, z])
                to = linked.nodes + int(step @ strides)
                new = (to >= 0) & (to < field.size)
                new[new] = ~is_known[to[new]]
                extrapolated = field[linked.nodes[new]] + slope[new] @ step
                weight = 1.0 / max(np.abs(step).sum(), 1) ** 2
                total += np.bincount(to[new], weights=weight * extrapolated, minlength=field.size)
                count += np.bincount(
                    to[new], minlength=field.size, weights=np.full(int(new.sum()), weight)
                )
    reached = count > 0.0
    field = field.copy()
    field[reached] = total[reached] / count[reached]
    return field, is_known | reached


def gradients(linked: Links, values: Array, step: float) -> Array:
    """Return the gradients of values at the nodes inside.

    The slope along an axis is the mean of the backward and forward differences, or the single known
    difference. A node without neighbours on this axis gets the mean slope of the adjacent nodes, or
    0.

    Parameters
    ----------
    linked : Links
        The n nodes inside and their neighbours.
    values : (n,) array
        Values at the nodes, NaN where unknown.
    step : float
        Distance from node to node, mm.

    Returns
    -------
    (n, 3) array
        Gradients, per mm.
    """
    padded = np.append(values, np.nan)
    slopes = np.zeros((len(values), 3))
    for axis in range(3):
        behind = values - padded[linked.neighbours[2 * axis]]
        ahead = padded[linked.neighbours[2 * axis + 1]] - values
        slopes[:, axis] = _mean(np.stack([behind, ahead])) / step
        lacking = np.flatnonzero(np.isnan(slopes[:, axis]))
        around = np.append(slopes[:, axis], np.nan)[linked.neighbours[:, lacking]]
        slopes[lacking, axis] = np.nan_to_num(_mean(around))
    return slopes


def _mean(values: Array) -> Array:
    """Return the mean (n,) of the known values (k, n); NaN where no value is known."""
    is_known = np.isfinite(values)
    count = is_known.sum(axis=0)
    mean: Array = np.where(
        count > 0, np.where(is_known, values, 0.0).sum(axis=0) / np.maximum(count, 1), np.nan
    )
    return mean


EXACT_STEPS = 2.5  # in grid steps; closer nodes get their distance from the start triangles
DEEP = 3  # in nodes; depth below which the distance to the surface is not needed
STRETCH = 0.15  # maximum stretch or compression of a piece; otherwise the piece is halved
HALVINGS = 6  # maximum number of successive halvings of a piece
MARGIN = 2.0  # in grid steps; length by which pieces extend beyond the cut between them


class Piece(NamedTuple):
    """Piece of a layer.

    chart: flattening of the piece. regions: regions to deposit on the plane, mm. stretch: maximum
    relative change of lengths by flattening.
    """

    chart: Chart
    regions: tuple[Region, ...]
    stretch: float


@dataclass(frozen=True, eq=False)
class GeodesicField:
    """Distance u from the start, measured through solids.

    Attributes
    ----------
    grid : Voxels
        Grid of the solids.
    cubes : Cubes
        u on the grid, mm.
    depth : Cubes
        Depth inside the solids on the grid, mm.
    gradient : tuple of Cubes
        Components of the smoothed direction of the gradient of u.
    top : float
        Maximum of u, mm.
    unreached : float
        Fraction of the solids that no path reaches.
    """

    grid: Voxels
    cubes: Cubes
    depth: Cubes
    gradient: tuple[Cubes, Cubes, Cubes]
    top: float
    unreached: float

    def pieces(self, distance: float) -> Iterator[Piece]:
        """Yield the isosurface of u at a distance, mm, in pieces that can be flattened."""
        mesh = self.cubes.level(distance)
        if not len(mesh.faces):
            return
        inside = _replace_nan(self.depth.sample(mesh.vertices)[0], -self.grid.step)
        inside[np.unique(mesh.border_edges)] = -self.grid.step
        for component, vertex_numbers in _connected(mesh, inside > 0.0):
            yield from self._flattened(component, inside[vertex_numbers], HALVINGS)

    def onto(self, points: Array, distance: float) -> Array:
        """Move points along the gradient of u to a distance.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.
        distance : float
            Distance u from the start, mm.

        Returns
        -------
        (n, 3) array
            Points at this distance after three Newton steps, mm.
        """
        for _ in range(3):
            value, slope = self.cubes.sample(points)
            value, slope = _replace_nan(value, distance), _replace_nan(slope, 0.0)
            square = np.maximum((slope * slope).sum(axis=1), 0.25)
            points = points - ((value - distance) / square)[:, None] * slope
        return points

    def directions(self, points: Array) -> Array:
        """Return build directions: the smoothed direction of the gradient of u.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        (n, 3) array
            Unit vectors.
        """
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
    """Compute the distance from the start through solids.

    Parameters
    ----------
    solids : sequence of SolidMesh
        The solids, which may touch or overlap.
    start : (k, 3, 3) array
        Triangles of the start, mm.
    step : float
        Distance between grid nodes, mm.
    through : bool, optional
        Whether the distance is measured through the solid; otherwise it is measured straight.

    Returns
    -------
    GeodesicField
        The field.

    Raises
    ------
    ValueError
        If no node of the grid is near the start.
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
    """Return the nodes near the start and their distances from the start, mm."""
    if not len(start):
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    low = start.min(axis=(0, 1)) - EXACT_STEPS * step
    high = start.max(axis=(0, 1)) + EXACT_STEPS * step
    nearby = np.flatnonzero(((positions > low) & (positions < high)).all(axis=1))
    if not len(nearby):
        return nearby, np.zeros(0)
    distance = _start_distances(start, positions[nearby], step)
    close = np.abs(distance) < EXACT_STEPS * step
    return nearby[close], distance[close]


def _start_distances(start: Array, positions: Array, step: float) -> Array:
    """Return distances (n,), mm, from the start.

    Near the start, distances are negative on the side away from the solid.
    """
    start_mesh = SolidMesh(start.reshape(-1, 3), np.arange(3 * len(start)).reshape(-1, 3))
    distance = -Search(start_mesh, 2.0 * step).signed(positions)[0]
    return np.where(np.abs(distance) < EXACT_STEPS * step, distance, np.abs(distance))


def _outside(searches: Sequence[Search], points: Array) -> Array:
    """Return signed distances (n,), mm, from the union of solids, negative inside."""
    distances: Array = np.min([search.signed(points)[0] for search in searches], axis=0)
    return distances


def _add_border_nodes(grid: Voxels, searches: Sequence[Search]) -> Voxels:
    """Add the nodes less than half a step outside the solids.

    The corners around which paths turn are then, on average, at their true position.
    """
    wide = grid.solid.copy()
    for axis in range(3):
        wide |= np.roll(grid.solid, 1, axis) | np.roll(grid.solid, -1, axis)
    nodes = np.flatnonzero(wide & ~grid.solid)
    solid = grid.solid.ravel().copy()
    solid[nodes] = _outside(searches, grid.places(nodes)) < 0.5 * grid.step
    return Voxels(grid.origin, grid.step, solid.reshape(grid.solid.shape))


def _depths(grid: Voxels, wound: Mask, searches: Sequence[Search], carried: Array) -> Array:
    """Return the depths (nx, ny, nz), mm, of nodes in the solids, negative outside.

    Depths are limited to DEEP steps and are NaN where the field is unknown. wound: nodes with a
    non-zero winding number. They are inside even if the nearest triangle shows its outside, as
    where a solid intersects itself.
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
    """Average the directions (n, 3) of nodes twice with their neighbours; return unit vectors."""
    for _ in range(2):
        unit = direction / np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-300)
        padded = np.vstack([unit, np.zeros((1, 3))])
        direction = 2.0 * unit + padded[linked.neighbours].sum(axis=0)
    smoothed: Array = direction / np.maximum(
        np.linalg.norm(direction, axis=1, keepdims=True), 1e-300
    )
    return smoothed


def _connected(mesh: Mesh, inside: Mask) -> Iterator[tuple[Mesh, Index]]:
    """Yield the components of a mesh that are connected by edges between vertices inside.

    Each component includes the adjacent triangles and comes with its vertex indices.
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
    """Halve a piece across its longest extent; both halves extend by `margin` mm beyond the cut."""
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
    """Return the loops (k, 2) around the region of a chart where `inside` is positive."""
    flat = Mesh(np.column_stack([chart.flat, np.zeros(len(chart.flat))]), chart.mesh.faces)
    lines = flat.level_lines(inside, np.arange(len(flat.faces)))
    return tuple(line.points[::-1, :2] for line in lines if line.closed and len(line.points) > 2)


def _replace_nan(values: Array, instead: float) -> Array:
    filled: Array = np.where(np.isfinite(values), values, instead)
    return filled
