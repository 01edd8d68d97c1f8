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
    """The corners (6, 4, 3) of the tetrahedra of a cube: the ways from (0, 0, 0) to (1, 1, 1) along its edges."""
    found = []
    for order in permutations(range(3)):
        corner, way = np.zeros(3, dtype=np.intp), []
        way.append(corner.copy())
        for axis in order:
            corner[axis] = 1
            way.append(corner.copy())
        found.append(np.array(way))
    return np.array(found)


TETRAHEDRA = _tetrahedra()


class Cubes:
    """The cubes of a field (nx, ny, nz) whose corners are all known, in the order of their least values."""

    def __init__(self, field: Array, origin: Array, step: float) -> None:
        self.field, self.origin, self.step = field.ravel(), origin, step
        self.shape = field.shape
        self._strides = np.array([field.shape[1] * field.shape[2], field.shape[2], 1])
        low, high = field[:-1, :-1, :-1], field[:-1, :-1, :-1]
        for corner in np.ndindex(2, 2, 2):
            one = field[tuple(slice(c, n - 1 + c) for c, n in zip(corner, field.shape))]
            low, high = np.minimum(low, one), np.maximum(high, one)  # nan where one is not known
        known = np.argwhere(~np.isnan(low))
        self._first: Index = known @ self._strides
        low, high = low[tuple(known.T)], high[tuple(known.T)]
        order = np.argsort(low, kind="stable")
        self._first, self._low, self._high = self._first[order], low[order], high[order]

    def level(self, value: float) -> Mesh:
        """The surface where the field has the value; triangles counter-clockwise as seen from where the field is higher."""
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
        # every pair of a triangle begins on the same side: that of the higher values, but for those about a low corner
        sign = np.repeat([1.0, -1.0, 1.0], [len(one) for one in kinds])
        edges, of = np.unique(np.sort(pairs.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
        return self._oriented(
            self._crossed(edges, value), of.reshape(-1, 3).astype(np.intp), pairs[:, 0, 0], sign
        )

    def _crossed(self, edges: Index, value: float) -> Array:
        a, b = self.field[edges[:, 0]], self.field[edges[:, 1]]
        share = np.clip((value - a) / np.where(b == a, 1.0, b - a), AT_END, 1.0 - AT_END)[:, None]
        one, other = (np.stack(np.unravel_index(edges[:, k], self.shape), axis=1) for k in (0, 1))
        at: Array = self.origin + self.step * (one + share * (other - one))
        return at

    def _oriented(self, vertices: Array, faces: Index, adjacent: Index, sign: Array) -> Mesh:
        """beside: a node (n,) of each triangle's tetrahedron, on the side of the higher values where sign is 1. The slope of
        the field does not tell the side where it has a ridge."""
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        node = self.origin + self.step * np.stack(np.unravel_index(adjacent, self.shape), axis=1)
        back = sign * (np.cross(b - a, c - a) * (node - a)).sum(axis=1) < 0.0
        faces[back] = faces[back][:, ::-1]
        return Mesh(vertices, faces)

    def sampled(self, points: Array) -> tuple[Array, Array]:
        """Values (n,) and slopes (n, 3) of the field at points (n, 3), from the eight nodes about each; nan where one of
        them is not known."""
        at = (points - self.origin) / self.step
        cell = np.clip(np.floor(at).astype(np.intp), 0, np.array(self.shape) - 2)
        t = at - cell
        first = cell @ self._strides
        value, slope = np.zeros(len(points)), np.zeros((len(points), 3))
        to, off = t.T, (1.0 - t).T
        for corner in np.ndindex(2, 2, 2):
            here = self.field[first + int(np.array(corner) @ self._strides)]
            x, y, z = (to[axis] if corner[axis] else off[axis] for axis in range(3))
            value += x * y * z * here
            for axis, rest in enumerate((y * z, x * z, x * y)):
                slope[:, axis] += (1.0 if corner[axis] else -1.0) * rest * here / self.step
        return value, slope


def _single(corners: Index, apart: Mask, which: Mask) -> Index:
    """Pairs (k, 3, 2) of nodes: the edges from the one corner that is on its own side to the other three."""
    corners, apart = corners[which], apart[which]
    row = np.arange(len(corners))
    k = np.argmax(apart, axis=1)
    return np.stack(
        [np.stack([corners[row, k], corners[row, (k + j) % 4]], axis=1) for j in (1, 2, 3)], axis=1
    )


def _double(corners: Index, high: Mask, which: Mask) -> Index:
    """Pairs (2 k, 3, 2): the four edges from two corners that are high to two that are not, as two triangles."""
    corners, high = corners[which], high[which]
    row = np.arange(len(corners))[:, None]
    order = np.argsort(~high, axis=1, kind="stable")
    a, b, c, d = corners[row, order].T
    ac, ad, bd, bc = (np.stack(pair, axis=1) for pair in ((a, c), (a, d), (b, d), (b, c)))
    return np.concatenate([np.stack([ac, ad, bd], axis=1), np.stack([ac, bd, bc], axis=1)])
