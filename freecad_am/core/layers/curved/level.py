# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surface on which a field on a grid has one value, as triangles: each cube of nodes in six tetrahedra about one of its
diagonals, alike in all cubes, so that the triangles of neighbours meet (Kuhn's subdivision)."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from ...geometry.mesh.triangle_mesh import Mesh
from ...types import Array, Index, Mask

AT_END = 0.08  # share of an edge; a surface that crosses it nearer to an end crosses it there: no triangle is all sliver


def _tetrahedra() -> Index:
    """Return the corners (6, 4, 3) of the tetrahedra of a cube: the paths from (0, 0, 0) to (1,
    1, 1) along its edges.
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
    """The cubes of a field (nx, ny, nz) whose corners are all known, in the order of their least values."""

    def __init__(self, field: Array, origin: Array, step: float) -> None:
        self.field, self.origin, self.step = field.ravel(), origin, step
        self.shape = field.shape
        self._strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
        low, high = field[:-1, :-1, :-1], field[:-1, :-1, :-1]
        for corner in np.ndindex(2, 2, 2):
            corner_values = field[tuple(slice(c, n - 1 + c) for c, n in zip(corner, field.shape))]
            low, high = (
                np.minimum(low, corner_values),
                np.maximum(high, corner_values),
            )  # nan where any corner is not known
        known_cubes = np.argwhere(~np.isnan(low))
        self._first: Index = known_cubes @ self._strides
        low, high = low[tuple(known_cubes.T)], high[tuple(known_cubes.T)]
        order = np.argsort(low, kind="stable")
        self._first, self._low, self._high = self._first[order], low[order], high[order]

    def level(self, value: float) -> Mesh:
        """Return the surface where the field has the value; triangles are counter-clockwise seen
        from the higher side.
        """
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
        # every pair of a triangle begins on the same side: the higher one, except about a low corner
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
        """Orient triangles by `adjacent`, a node (n,) of each triangle's tetrahedron on the higher
        side where sign is 1.

        The slope of the field does not show the side at a ridge.
        """
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        node = self.origin + self.step * np.stack(np.unravel_index(adjacent, self.shape), axis=1)
        back = sign * (np.cross(b - a, c - a) * (node - a)).sum(axis=1) < 0.0
        faces[back] = faces[back][:, ::-1]
        return Mesh(vertices, faces)

    def sample(self, points: Array) -> tuple[Array, Array]:
        """Return values (n,) and slopes (n, 3) of the field at points (n, 3), from the eight nodes
        around each; NaN if any is unknown.
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
    """Return pairs (k, 3, 2) of nodes: the edges from the single corner on one side to the other
    three.
    """
    corners, is_single = corners[selected], is_single[selected]
    row = np.arange(len(corners))
    k = np.argmax(is_single, axis=1)
    return np.stack(
        [np.stack([corners[row, k], corners[row, (k + j) % 4]], axis=1) for j in (1, 2, 3)], axis=1
    )


def _double(corners: Index, high: Mask, selected: Mask) -> Index:
    """Return pairs (2 k, 3, 2): the four edges from two high corners to the two others, as two
    triangles.
    """
    corners, high = corners[selected], high[selected]
    row = np.arange(len(corners))[:, None]
    order = np.argsort(~high, axis=1, kind="stable")
    a, b, c, d = corners[row, order].T
    ac, ad, bd, bc = (np.stack(pair, axis=1) for pair in ((a, c), (a, d), (b, d), (b, c)))
    return np.concatenate([np.stack([ac, ad, bd], axis=1), np.stack([ac, bd, bc], axis=1)])
