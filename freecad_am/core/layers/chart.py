# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chart of a curved piece of a layer: map points between the plane and the part."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeVar

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.developable import Plane
from ..geometry.mesh.triangle_mesh import Mesh
from ..geometry.on_hub import Base
from ..geometry.step_count import step_counts
from ..types import Array, Index, Mask
from .surface import Wrapped

PART = Base("the part", Plane(), np.eye(4))  # charts are in part coordinates
CELL = 1.5  # in typical edges; side of the squares of the search grid
OUTSIDE = -1e-6  # minimum barycentric coordinate of a point inside a triangle


class Place(NamedTuple):
    """Locations in a chart: triangles (n,) and barycentric coordinates (n, 3).

    A coordinate is negative outside the triangle.
    """

    triangle: Index
    share: Array


@dataclass(frozen=True, eq=False)
class Chart:
    """Piece of a layer and its flattening.

    Attributes
    ----------
    mesh : Mesh
        The piece in the part, mm.
    flat : (n, 2) array
        Vertices on the plane, mm; triangles are counter-clockwise.
    """

    mesh: Mesh
    flat: Array

    def wrap(self, points: Array) -> Array:
        """Map points of the chart into the part.

        Parameters
        ----------
        points : (n, 2) array
            Points on the plane, mm; outside the chart the nearest triangle is extended.

        Returns
        -------
        (n, 3) array
            Points in the part, mm.
        """
        return self.to_part(self.find(points))

    def to_part(self, location: Place) -> Array:
        """Map locations in the chart into the part.

        Parameters
        ----------
        location : Place
            Triangles and barycentric coordinates of n points.

        Returns
        -------
        (n, 3) array
            Points in the part, mm.
        """
        wrapped: Array = np.einsum(
            "nk,nkc->nc", location.share, self.mesh.vertices[self.mesh.faces[location.triangle]]
        )
        return wrapped

    def heading(self, location: Place) -> Array:
        """Return the direction in the part of the x axis of the chart.

        Parameters
        ----------
        location : Place
            Triangles and barycentric coordinates of n points.

        Returns
        -------
        (n, 3) array
            Vectors, not of unit length.
        """
        corners, flat = (
            values[self.mesh.faces[location.triangle]] for values in (self.mesh.vertices, self.flat)
        )
        edge_a, edge_b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
        heading: Array = b[:, 1, None] * edge_a - a[:, 1, None] * edge_b
        return heading

    def find(self, points: Array) -> Place:
        """Locate points of the plane in the chart.

        Parameters
        ----------
        points : (n, 2) array
            Points of the plane, mm.

        Returns
        -------
        Place
            Triangle and barycentric coordinates of each point; outside the chart the nearest
            triangle.
        """
        square, is_covered = self._squares.find_square(points)
        count = self._squares.count[square]
        point_number = np.repeat(np.arange(len(points)), count)
        index = (
            np.repeat(self._squares.first[square], count)
            + np.arange(len(point_number))
            - np.repeat(np.cumsum(count) - count, count)
        )
        triangle = self._squares.triangles[index]
        share = self._shares(triangle, points[point_number])
        inmost = share.min(axis=1)
        best = np.full(len(points), -np.inf)
        np.maximum.at(best, point_number, inmost)
        inmost_rows = np.flatnonzero(inmost == best[point_number])[::-1]
        best_triangle = np.full(len(points), -1, dtype=np.intp)
        best_triangle[point_number[inmost_rows]] = triangle[inmost_rows]
        uncovered = np.flatnonzero((best < OUTSIDE) | ~is_covered)
        if len(uncovered):
            best_triangle[uncovered] = self._nearest(points[uncovered])
        return Place(best_triangle, self._shares(best_triangle, points))

    def _shares(self, triangle: Index, points: Array) -> Array:
        a, b, c = (self.flat[self.mesh.faces[triangle, k]] for k in range(3))
        edge_a, edge_b, offset = b - a, c - a, points - a
        area = edge_a[:, 0] * edge_b[:, 1] - edge_a[:, 1] * edge_b[:, 0]
        area = np.where(area == 0.0, 1e-300, area)
        to_b = (offset[:, 0] * edge_b[:, 1] - offset[:, 1] * edge_b[:, 0]) / area
        to_c = (edge_a[:, 0] * offset[:, 1] - edge_a[:, 1] * offset[:, 0]) / area
        return np.stack([1.0 - to_b - to_c, to_b, to_c], axis=1)

    def _nearest(self, points: Array) -> Index:
        """Return the triangles (n,) with the nearest centroids."""
        triangles: Index = self._middles.query(points)[1].astype(np.intp)
        return triangles

    @cached_property
    def _middles(self) -> cKDTree:
        return cKDTree(self.flat[self.mesh.faces].mean(axis=1))

    @cached_property
    def _squares(self) -> _Squares:
        corners = self.flat[self.mesh.faces]
        return _Squares(corners, CELL * self.mesh.typical_edge)


class _Squares:
    """Search grid of triangles (m, 3, 2) on the plane.

    triangles: (k,) grouped by square. first, count: (s,) first index and number of the triangles of
    each square.
    """

    def __init__(self, corners: Array, size: float) -> None:
        self.low, self.size = corners.min(axis=(0, 1)), size
        low = ((corners.min(axis=1) - self.low) / size).astype(np.intp)
        high = ((corners.max(axis=1) - self.low) / size).astype(np.intp)
        self.shape = high.max(axis=0) + 1
        across = high - low + 1
        total = across[:, 0] * across[:, 1]
        triangle = np.repeat(np.arange(len(corners)), total)
        number = np.arange(len(triangle)) - np.repeat(np.cumsum(total) - total, total)
        square = (
            (low[triangle, 0] + number // across[triangle, 1]) * self.shape[1]
            + low[triangle, 1]
            + number % across[triangle, 1]
        )
        order = np.argsort(square, kind="stable")
        self.triangles = triangle[order]
        self.count = np.bincount(square, minlength=int(self.shape.prod()))
        self.first = np.cumsum(self.count) - self.count

    def find_square(self, points: Array) -> tuple[Index, Mask]:
        """Return the squares (n,) of points (n, 2), and whether these contain points and triangles.

        A point outside the grid gets the nearest square.
        """
        cell = np.floor((points - self.low) / self.size).astype(np.intp)
        is_inside = ((cell >= 0) & (cell < self.shape)).all(axis=1)
        cell = np.clip(cell, 0, self.shape - 1)
        square = cell[:, 0] * self.shape[1] + cell[:, 1]
        return square, is_inside & (self.count[square] > 0)


MIN_HORIZONTAL = (
    0.9  # maximum X component of a normal; above it, Y replaces X as reference direction
)

Same = TypeVar("Same", bound="OpenSurface")


class OpenSurface:
    """What layers have in common that do not close on the plane, in part coordinates."""

    @property
    def period(self) -> None:
        """None: the layer does not close; closed pieces are cut open."""
        return None

    @property
    def bends_freely(self) -> bool:
        """False: the layer bends as the faces do."""
        return False

    def heights(self, flat: Array) -> None:
        """Return None: the layer height is constant."""

    def for_sheet(self: Same, flat: Array, sheet: float) -> Same:
        """Return this surface, which does not overlap itself on the plane."""
        return self

    def plane_rotation(self, azimuth: float) -> float:
        """Return 0: the plane has only one orientation."""
        return 0.0

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """Return the part's X and Y projected onto the layer, see `chart.axes`."""
        return axes(normals)


@dataclass(frozen=True, eq=False)
class Charted(OpenSurface):
    """Layer on the chart of one of its pieces, a `LayerSurface`.

    Distances and angles on the plane equal those in the part up to the stretch of the chart.
    """

    chart: Chart

    @property
    @abstractmethod
    def look(self) -> float:
        """Sample distance along edges in the test for bending, mm."""

    @abstractmethod
    def in_part(self, location: Place) -> tuple[Array, Array]:
        """Map locations in the chart to bead points in the part.

        Parameters
        ----------
        location : Place
            Triangles and barycentric coordinates of n points.

        Returns
        -------
        points : (n, 3) array
            Points in the part, mm.
        normals : (n, 3) array
            Unit normals of the layer.
        """

    def unroll(self, points: Array) -> Array:
        """Return the nearest vertices of the chart, (n, 2), mm."""
        return self.chart.flat[np.asarray(self.chart.mesh.tree.query(points)[1], dtype=np.intp)]

    def wrap(self, flat: Array) -> Wrapped:
        """Map a curve of the chart to bead points in the part."""
        location = self.chart.find(flat)
        points, normals = self.in_part(location)
        axis_x, axis_y = self.axes(normals)
        x = self.chart.heading(location)
        return Wrapped(
            points,
            normals,
            -np.unwrap(np.arctan2((x * axis_y).sum(axis=1), (x * axis_x).sum(axis=1))),
        )

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return the number of pieces of each edge that keeps the chord error, mm."""

        def in_part(points: Array) -> Array:
            return self.in_part(self.chart.find(points))[0]

        return count_pieces(in_part, flat, self.look, chord_error)


def count_pieces(
    in_part: Callable[[Array], Array], flat: Array, look: float, chord_error: float
) -> Index:
    """Return the number of equal pieces of each edge of a wrapped polyline that keeps a chord error.

    Parameters
    ----------
    in_part : callable
        Maps points (k, 2) of the plane to points (k, 3) of the part, mm.
    flat : (n, 2) array
        The polyline on the plane, mm.
    look : float
        Distance between the points at which bending is measured, mm.
    chord_error : float
        Maximum distance between a piece and the surface, mm.

    Returns
    -------
    (n - 1,) array of int
        Numbers of pieces, at least 1.
    """
    edge = np.diff(flat, axis=0)
    length = np.linalg.norm(edge, axis=1)
    looks = step_counts(length, look, 2)
    edge_number = np.repeat(np.arange(len(edge)), looks + 1)
    share = (
        np.arange(len(edge_number)) - np.repeat(np.cumsum(looks + 1) - looks - 1, looks + 1)
    ) / looks[edge_number]
    points = in_part(flat[edge_number] + share[:, None] * edge[edge_number])
    inner = (
        np.flatnonzero(
            (edge_number[1:-1] == edge_number[:-2]) & (edge_number[1:-1] == edge_number[2:])
        )
        + 1
    )
    bend = np.linalg.norm(points[inner - 1] - 2.0 * points[inner] + points[inner + 1], axis=1) / 8.0
    max_bend = np.zeros(len(edge))
    np.maximum.at(max_bend, edge_number[inner], bend)
    count = np.maximum(np.ceil(looks * np.sqrt(max_bend / chord_error) - 1e-9), 1.0)
    return np.asarray(count.astype(np.intp))


def axes(normals: Array) -> tuple[Array, Array]:
    """Return the part's X and Y projected onto layers.

    Where a normal is nearly along X, the part's Y replaces X.

    Parameters
    ----------
    normals : (n, 3) array
        Unit normals.

    Returns
    -------
    x : (n, 3) array
        Unit vectors within the layer.
    left : (n, 3) array
        Unit vectors to the left of x.
    """
    steep: Array = np.abs(normals[:, :1]) < MIN_HORIZONTAL
    along = np.where(steep, np.eye(3)[0], np.eye(3)[1])
    axis_x = along - (along * normals).sum(axis=1)[:, None] * normals
    axis_x /= np.linalg.norm(axis_x, axis=1, keepdims=True)
    return axis_x, np.cross(normals, axis_x)
