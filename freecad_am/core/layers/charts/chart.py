# SPDX-License-Identifier: LGPL-2.1-or-later
"""A curved piece of a layer with its picture on the plane: places of the one brought to the other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.mesh.triangle_mesh import Mesh
from ...types import Array, Index, Mask

CELL = 1.5  # typical edges; side of the squares that triangles are sorted into
OUTSIDE = -1e-6  # least share of a corner for a place that is in a triangle


class Place(NamedTuple):
    """Where points are in a picture: the triangle (n,) and the shares (n, 3) of its corners, below 0 beside it."""

    triangle: Index
    share: Array


@dataclass(frozen=True, eq=False)
class Chart:
    """mesh: the piece, mm in the part. flat: (n, 2) mm, its vertices on the plane, triangles counter-clockwise."""

    mesh: Mesh
    flat: Array

    def wrap(self, points: Array) -> Array:
        """The places (n, 3) in the part of points (n, 2) of the picture; beside it the nearest triangle goes on."""
        return self.at(self.find(points))

    def at(self, place: Place) -> Array:
        """Where in the part (n, 3) places of the picture are."""
        wrapped: Array = np.einsum(
            "nk,nkc->nc", place.share, self.mesh.vertices[self.mesh.faces[place.triangle]]
        )
        return wrapped

    def heading(self, place: Place) -> Array:
        """The way (n, 3) in the part that the picture's x runs there, not of unit length."""
        corners, flat = (
            of[self.mesh.faces[place.triangle]] for of in (self.mesh.vertices, self.flat)
        )
        one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        way: Array = b[:, 1, None] * one - a[:, 1, None] * other
        return way

    def find(self, points: Array) -> Place:
        """The triangles of points (n, 2), and where in them."""
        square, here = self._squares.at(points)
        count = self._squares.count[square]
        of = np.repeat(np.arange(len(points)), count)
        at = (
            np.repeat(self._squares.first[square], count)
            + np.arange(len(of))
            - np.repeat(np.cumsum(count) - count, count)
        )
        triangle = self._squares.triangles[at]
        share = self._shares(triangle, points[of])
        inmost = share.min(axis=1)
        best = np.full(len(points), -np.inf)
        np.maximum.at(best, of, inmost)
        first = np.flatnonzero(inmost == best[of])[::-1]
        chosen = np.full(len(points), -1, dtype=np.intp)
        chosen[of[first]] = triangle[first]
        lost = np.flatnonzero((best < OUTSIDE) | ~here)
        if len(lost):
            chosen[lost] = self._nearest(points[lost])
        return Place(chosen, self._shares(chosen, points))

    def _shares(self, triangle: Index, points: Array) -> Array:
        a, b, c = (self.flat[self.mesh.faces[triangle, k]] for k in range(3))
        one, other, at = b - a, c - a, points - a
        whole = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
        whole = np.where(whole == 0.0, 1e-300, whole)
        to_b = (at[:, 0] * other[:, 1] - at[:, 1] * other[:, 0]) / whole
        to_c = (one[:, 0] * at[:, 1] - one[:, 1] * at[:, 0]) / whole
        return np.stack([1.0 - to_b - to_c, to_b, to_c], axis=1)

    def _nearest(self, points: Array) -> Index:
        """The triangles (n,) whose middles are nearest."""
        found: Index = self._middles.query(points)[1].astype(np.intp)
        return found

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(self.flat[self.mesh.faces].mean(axis=1))

    @cached_property
    def _squares(self) -> _Squares:
        corners = self.flat[self.mesh.faces]
        return _Squares(corners, CELL * self.mesh.typical_edge)


class _Squares:
    """Triangles (m, 3, 2) sorted into squares of a plane. triangles: (k,), those of each square in a row; first, count: (s,)
    where they begin and how many they are."""

    def __init__(self, corners: Array, size: float) -> None:
        self.low, self.size = corners.min(axis=(0, 1)), size
        low = ((corners.min(axis=1) - self.low) / size).astype(np.intp)
        high = ((corners.max(axis=1) - self.low) / size).astype(np.intp)
        self.shape = high.max(axis=0) + 1
        across = high - low + 1
        total = across[:, 0] * across[:, 1]
        of = np.repeat(np.arange(len(corners)), total)
        number = np.arange(len(of)) - np.repeat(np.cumsum(total) - total, total)
        square = (
            (low[of, 0] + number // across[of, 1]) * self.shape[1]
            + low[of, 1]
            + number % across[of, 1]
        )
        order = np.argsort(square, kind="stable")
        self.triangles = of[order]
        self.count = np.bincount(square, minlength=int(self.shape.prod()))
        self.first = np.cumsum(self.count) - self.count

    def at(self, points: Array) -> tuple[Index, Mask]:
        """The square (n,) of points (n, 2), and whether there is one with triangles; else any."""
        cell = np.floor((points - self.low) / self.size).astype(np.intp)
        here = ((cell >= 0) & (cell < self.shape)).all(axis=1)
        cell = np.clip(cell, 0, self.shape - 1)
        square = cell[:, 0] * self.shape[1] + cell[:, 1]
        return square, here & (self.count[square] > 0)
