# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solve the eikonal equation in a solid on a grid: |grad u| = 1, u given at seeds.

The fast iterative method (Jeong and Whitaker 2008) updates complete fronts at once with Godunov's
upwind scheme. A second pass, band by band outwards, uses second-order differences where possible
(Sethian 1999, 4.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..types import Array, Index, Mask

MARGIN_NODES = (
    3  # nodes around the bounding box, for fields that are extrapolated beyond the surface
)
# in grid steps; offset of the node columns from round coordinates, so that no column coincides with
# an edge of the model
OFFSET_SHARE = np.array([0.0311457, 0.0213793, 0.0171353])


@dataclass(frozen=True, eq=False)
class Voxels:
    """Grid of nodes.

    origin: (3,) position of node (0, 0, 0), mm. step: distance between nodes, mm. solid: (nx, ny,
    nz) whether each node is inside.
    """

    origin: Array
    step: float
    solid: Mask

    @cached_property
    def nodes(self) -> Index:
        """Flat grid indices (n,) of the nodes inside."""
        inside: Index = np.flatnonzero(self.solid)
        return inside

    def places(self, nodes: Index) -> Array:
        """Return the positions of nodes.

        Parameters
        ----------
        nodes : (n,) int array
            Flat grid indices.

        Returns
        -------
        (n, 3) array
            Positions, mm.
        """
        positions: Array = self.origin + self.step * np.stack(
            np.unravel_index(nodes, self.solid.shape), axis=1
        )
        return positions

    def strides(self) -> tuple[int, int, int]:
        """Return the steps of the flat grid index along each axis.

        Returns
        -------
        tuple[int, int, int]
            Strides along x, y and z.
        """
        _, ny, nz = self.solid.shape
        return ny * nz, nz, 1


def voxels(vertices: Array, triangles: Index, step: float) -> Voxels:
    """Voxelise a closed mesh.

    A node is inside if the winding number of the mesh is at least 1. Overlapping bodies therefore
    count as one solid, and cavities are outside.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles, counter-clockwise seen from outside.
    step : float
        Distance between nodes, mm.

    Returns
    -------
    Voxels
        The grid.
    """
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    origin = low - (MARGIN_NODES + OFFSET_SHARE) * step
    shape = np.ceil((high - origin) / step).astype(np.intp) + 1 + MARGIN_NODES
    corners = (vertices[triangles] - origin) / step
    column, height, sense = _crossings(corners, shape)
    first_node = np.clip(np.ceil(height).astype(np.intp), 0, shape[2] - 1)
    change = np.bincount(
        column * shape[2] + first_node, weights=-sense, minlength=int(shape.prod())
    ).reshape(shape)
    return Voxels(origin, step, np.cumsum(change, axis=2) > 0.5)


def _crossings(corners: Array, shape: Index) -> tuple[Index, Array, Array]:
    """Intersect vertical columns of nodes with triangles (m, 3, 3), in grid steps.

    Returns the column indices, the heights in grid steps, and 1 where a column leaves the solid, -1
    where it enters.
    """
    low = np.maximum(np.ceil(corners[:, :, :2].min(axis=1)).astype(np.intp), 0)
    count = np.maximum(np.floor(corners[:, :, :2].max(axis=1)).astype(np.intp) - low + 1, 0)
    total = count[:, 0] * count[:, 1]
    triangle = np.repeat(np.arange(len(corners)), total)
    number = np.arange(len(triangle)) - np.repeat(np.cumsum(total) - total, total)
    node = low[triangle] + np.stack(
        [number // np.maximum(count[triangle, 1], 1), number % np.maximum(count[triangle, 1], 1)],
        axis=1,
    )
    offset = corners[triangle, :, :2] - node[:, None]
    next_offset = np.roll(offset, -1, axis=1)
    # doubled area of column and edge, exactly equal for both triangles at the edge
    area = np.roll(_side(offset, next_offset), -1, axis=1)
    sense = np.where((area >= 0.0).all(axis=1), 1.0, 0.0) - np.where(
        (area < 0.0).all(axis=1), 1.0, 0.0
    )
    hit = sense != 0.0
    triangle, node, area, sense = triangle[hit], node[hit], area[hit], sense[hit]
    total_area = area.sum(axis=1)
    flat = total_area == 0.0
    share = area / np.where(flat, 1.0, total_area)[:, None]
    height = np.where(
        flat, corners[triangle, :, 2].mean(axis=1), (share * corners[triangle, :, 2]).sum(axis=1)
    )
    return node[:, 0] * shape[1] + node[:, 1], height, np.where(flat, 0.0, sense)


def _side(start: Array, end: Array) -> Array:
    """Return the doubled signed area of the triangle origin, start, end (..., 2).

    Swapping start and end changes exactly the sign.
    """
    turned = (start[..., 0] > end[..., 0]) | (
        (start[..., 0] == end[..., 0]) & (start[..., 1] > end[..., 1])
    )
    a = np.where(turned[..., None], end, start)
    b = np.where(turned[..., None], start, end)
    area = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    side: Array = np.where(turned, -area, area)
    return side


CONVERGED = 1e-9  # in grid steps; a node whose distance decreases by less has converged
BAND = 0.5  # in grid steps; width of a band of distances whose nodes are updated together
ROUNDS = 3  # iterations per band


class Links(NamedTuple):
    """Nodes inside the solid, with consecutive indices.

    nodes: (n,) flat grid indices. neighbours: (6, n) indices of the neighbours behind and ahead
    along x, y and z; n if the neighbour is outside.
    """

    nodes: Index
    neighbours: Index

    def second_neighbours(self, side: int, nodes: Index) -> Index:
        """Return the second neighbours of nodes on one side.

        Parameters
        ----------
        side : int
            Row of `neighbours`: behind or ahead along x, y or z.
        nodes : (k,) array of int
            Indices of the nodes.

        Returns
        -------
        (k,) array of int
            Indices of the second neighbours; n where none exists.
        """
        column = np.append(self.neighbours[side], len(self.nodes))
        second: Index = column[column[nodes]]
        return second


def links(grid: Voxels) -> Links:
    """Find the neighbours of all nodes inside."""
    nodes = grid.nodes
    number = np.full(grid.solid.size + 1, len(nodes), dtype=np.intp)
    number[nodes] = np.arange(len(nodes))
    return Links(
        nodes,
        np.stack([number[nodes + sign * stride] for stride in grid.strides() for sign in (-1, 1)]),
    )


def arrival(linked: Links, step: float, seeds: Index, values: Array) -> Array:
    """Compute the distances of nodes from seeds through the solid.

    Parameters
    ----------
    linked : Links
        The n nodes inside and their neighbours.
    step : float
        Distance between nodes, mm.
    seeds : (k,) int array
        Nodes with known distances.
    values : (k,) array
        Distances of the seeds, mm.

    Returns
    -------
    (n,) array
        Distances, mm; infinite for nodes that no path reaches.

    Notes
    -----
    Solves norm(grad u) = 1 with Godunov's upwind scheme, then with second-order differences.
    """
    u = np.full(len(linked.nodes) + 1, np.inf)
    u[seeds] = values
    fixed = np.zeros(len(u), dtype=bool)
    fixed[seeds] = fixed[-1] = True
    active = _find_active(linked, seeds, fixed)
    while len(active):
        updated = _godunov(
            u[linked.neighbours[0::2, active]], u[linked.neighbours[1::2, active]], step
        )
        better = updated < u[active] - CONVERGED * step
        u[active[better]] = updated[better]
        active = _find_active(linked, active[better], fixed)
    return _refine_second_order(linked, step, u, fixed)[:-1]


def _find_active(linked: Links, nodes: Index, fixed: Mask) -> Index:
    """Return the neighbours of nodes, without fixed nodes."""
    marked = np.zeros(len(fixed), dtype=bool)
    marked[linked.neighbours[:, nodes]] = True
    active_nodes: Index = np.flatnonzero(marked & ~fixed)
    return active_nodes


def _godunov(behind: Array, ahead: Array, step: float) -> Array:
    """Return the Godunov update (k,) from values (3, k) of neighbours behind and ahead, per axis."""
    return _root(np.minimum(behind, ahead), np.full(behind.shape, step))


def _root(values: Array, steps: Array) -> Array:
    """Return the larger root u (k,) of sum ((u - v) / h)^2 = 1 over the values v (3, k) below u.

    h: steps (3, k).
    """
    order = np.argsort(values, axis=0, kind="stable")
    v, h = np.take_along_axis(values, order, axis=0), np.take_along_axis(steps, order, axis=0)
    root_value: Array = v[0] + h[0]
    weight = np.zeros(v.shape[1])
    first_moment = np.zeros(v.shape[1])
    second_moment = np.zeros(v.shape[1])
    # relative to the minimum value, because squares lose digits far from the seeds
    base = np.where(np.isfinite(v[0]), v[0], 0.0)
    for k in range(3):
        use = (root_value > v[k]) & np.isfinite(v[k])
        relative = np.where(use, v[k] - base, 0.0)
        share = np.where(use, h[k] ** -2, 0.0)
        weight = weight + share
        first_moment = first_moment + share * relative
        second_moment = second_moment + share * relative**2
        inside = first_moment**2 - weight * (second_moment - 1.0)
        root = base + (first_moment + np.sqrt(np.maximum(inside, 0.0))) / np.maximum(weight, 1e-300)
        root_value = np.where(use & (inside >= 0.0), root, root_value)
    return root_value


def _refine_second_order(linked: Links, step: float, u: Array, fixed: Mask) -> Array:
    """Refine the distances (n + 1,) with second-order differences, from the seeds outwards."""
    free = np.flatnonzero(~fixed & np.isfinite(u))
    order = free[np.argsort(u[free], kind="stable")]
    band = np.floor(u[order] / (BAND * step))
    sharp = u.copy()
    for block in np.split(order, np.flatnonzero(np.diff(band)) + 1):
        if not len(block):
            continue
        nearest, steps = _upwind(linked, step, u, sharp, block)
        for _ in range(ROUNDS):
            sharp[block] = _root(nearest, steps)
            nearest, steps = _upwind(linked, step, u, sharp, block)
    return sharp


def _upwind(
    linked: Links, step: float, first_order: Array, sharp: Array, nodes: Index
) -> tuple[Array, Array]:
    """Return the upwind values and steps along each axis, (3, k).

    The differences are of second order if the second neighbour is no farther from the seeds than
    the first. `first_order` determines the upwind neighbour.
    """
    values, steps = np.full((3, len(nodes)), np.inf), np.full((3, len(nodes)), step)
    for axis in range(3):
        sides = linked.neighbours[2 * axis : 2 * axis + 2, nodes]
        lower = np.argmin(first_order[sides], axis=0)
        first_node = sides[lower, np.arange(len(nodes))]
        second_node = np.where(
            lower == 0,
            linked.second_neighbours(2 * axis, nodes),
            linked.second_neighbours(2 * axis + 1, nodes),
        )
        upwind = first_order[first_node] < first_order[nodes]
        two = upwind & (first_order[second_node] <= first_order[first_node])
        a, b = sharp[first_node], np.where(two, sharp[second_node], 0.0)
        values[axis] = np.where(
            two, (4.0 * np.where(two, a, 0.0) - b) / 3.0, np.where(upwind, a, np.inf)
        )
        steps[axis] = np.where(two, 2.0 * step / 3.0, step)
    return values, steps
