# SPDX-License-Identifier: LGPL-2.1-or-later
"""A solid as the nodes of a cubic grid inside it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...types import Array, Index, Mask

MARGIN_NODES = (
    3  # nodes about the solid's box, for fields that are carried on a little past its surface
)
# of a step; offset of the columns of nodes from round coordinates, so that they do not run along drawn edges
OFFSET_SHARE = np.array([0.0311457, 0.0213793, 0.0171353])


@dataclass(frozen=True, eq=False)
class Voxels:
    """origin: (3,) mm, the place of node (0, 0, 0). step: mm between nodes. solid: (nx, ny, nz), whether it is inside."""

    origin: Array
    step: float
    solid: Mask

    @cached_property
    def nodes(self) -> Index:
        """The nodes inside (n,), as numbers of the flat grid."""
        inside: Index = np.flatnonzero(self.solid)
        return inside

    def places(self, nodes: Index) -> Array:
        """Return the positions (n, 3) mm of nodes (n,) of the flat grid."""
        positions: Array = self.origin + self.step * np.stack(
            np.unravel_index(nodes, self.solid.shape), axis=1
        )
        return positions

    def strides(self) -> tuple[int, int, int]:
        """By how much the number of a node grows with each of its coordinates."""
        _, ny, nz = self.solid.shape
        return ny * nz, nz, 1


def voxels(vertices: Array, triangles: Index, step: float) -> Voxels:
    """Return the grid of a closed mesh: vertices (n, 3) mm, triangles (m, 3) counter-clockwise
    seen from outside.

    A node is inside where the mesh winds around it at least once: overlapping bodies are one,
    cavities are left out.
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
    """Return where vertical columns of nodes cross triangles (m, 3, 3) given in steps.

    Returns the column's number, the height in steps, and 1 where the column leaves the solid,
    -1 where it enters.
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
    # the column against each edge: twice the area, exactly the same for both triangles at the edge
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
    """Twice the area of the origin with edges from start to end (..., 2); exactly opposite for an edge turned round."""
    turned = (start[..., 0] > end[..., 0]) | (
        (start[..., 0] == end[..., 0]) & (start[..., 1] > end[..., 1])
    )
    a = np.where(turned[..., None], end, start)
    b = np.where(turned[..., None], start, end)
    area = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    side: Array = np.where(turned, -area, area)
    return side
