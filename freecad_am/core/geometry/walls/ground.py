# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a wall grows on, asked by many points at once: a solid of exact faces, or one of triangles."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ...types import Array, Index
from ..mesh.solid import SolidMesh
from .patch import Patch
from .surface import dot


class Ground(Protocol):
    """A solid."""

    facets: bool  # whether its pieces are flat facets of something round

    def signed(self, points: Array) -> Array:
        """Distances (k,) mm, negative inside."""

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Nearest points of the boundary, outer unit normals, each (k, 3), and the smooth piece (k,)
        of each.
        """

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Nearest points and normals, each (k, 3), on the pieces (k,) wherever these end."""

    def sagitta(self, piece_numbers: Index) -> Array:
        """Maximum distance (k,) of the pieces from the surface that they approximate, mm."""


class ExactGround:
    """A solid of exact faces.

    Its triangles (within `chord` mm), the face (m,) of each, and the faces as patches with
    outward normals.
    """

    facets = False

    def __init__(
        self, solid: SolidMesh, face: Index, patches: tuple[Patch, ...], chord: float, edge: float
    ) -> None:
        self.face, self.patches, self.near = face, patches, 3.0 * chord
        self.search = solid.searched(edge)

    def signed(self, points: Array) -> Array:
        """Distances; exact ones near the boundary."""
        distance, _, triangle = self.search.signed(points)
        near_points = np.flatnonzero(np.abs(distance) < self.near)
        if len(near_points):
            foot, normal = self.on(self.face[triangle[near_points]], points[near_points])
            exact = dot(points[near_points] - foot, normal)
            plain = (
                np.abs(exact - distance[near_points]) < self.near
            )  # not past an edge of the solid
            distance[near_points[plain]] = exact[plain]
        return distance

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """On the exact faces."""
        piece_numbers = self.face[self.search.signed(points)[2]]
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """On the faces' surfaces."""
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(piece_numbers):
            patch, on_patch = self.patches[k], piece_numbers == k
            feet[on_patch], normals[on_patch] = patch.at(patch.inverse(points[on_patch]))
        return feet, normals

    def sagitta(self, piece_numbers: Index) -> Array:
        """Zero."""
        return np.zeros(len(piece_numbers))


class FacetGround:
    """A solid of triangles."""

    facets = True

    def __init__(self, solid: SolidMesh, edge: float) -> None:
        self.solid, self.search = solid, solid.searched(edge)

    def signed(self, points: Array) -> Array:
        """Distances to the triangles."""
        return self.search.signed(points)[0]

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """On the planes of the nearest triangles."""
        piece_numbers = self.search.signed(points)[2]
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """On the planes of triangles."""
        normal = self.solid.units[piece_numbers]
        corner = self.solid.vertices[self.solid.triangles[piece_numbers, 0]]
        return points - dot(points - corner, normal)[:, None] * normal, normal

    def sagitta(self, piece_numbers: Index) -> Array:
        """From the turns between triangles."""
        return self.solid.sagitta[piece_numbers]


class PlaneGround:
    """The half space below z = `height` mm: a platform."""

    facets = False

    def __init__(self, height: float) -> None:
        self.height = height

    def signed(self, points: Array) -> Array:
        """Heights above it."""
        above: Array = points[:, 2] - self.height
        return above

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Vertically under or over the points."""
        piece_numbers = np.zeros(len(points), dtype=np.intp)
        return *self.on(piece_numbers, points), piece_numbers

    def on(self, piece_numbers: Index, points: Array) -> tuple[Array, Array]:
        """Vertically under or over the points."""
        foot = points.copy()
        foot[:, 2] = self.height
        return foot, np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape)

    def sagitta(self, piece_numbers: Index) -> Array:
        """Zero."""
        return np.zeros(len(piece_numbers))


def distances(points: Array, ground: Ground, near_distance: float) -> Array:
    """Return the distances (n,) of points from the ground, negative inside.

    They are exact for points nearer than `near_distance` mm; others have the right sign and
    at most the true size. A distance changes by no more than the distance travelled, so one
    point is enough in a cube that is wholly farther than its size.
    """
    value, open_ = np.empty(len(points)), np.arange(len(points))
    size = float(np.ptp(points, axis=0).max(initial=0.0)) / 4.0
    while len(open_) and size > near_distance:
        cube = np.floor((points[open_] - points.min(axis=0)) / size).astype(np.intp)
        _, representative, cube_of_point = np.unique(
            cube @ np.array([1, 1 << 20, 1 << 40]), return_index=True, return_inverse=True
        )
        probes = open_[representative]
        probe_values, cube_of_point = ground.signed(points[probes]), np.ravel(cube_of_point)
        offset = np.linalg.norm(points[open_] - points[probes][cube_of_point], axis=1)
        bound = np.abs(probe_values[cube_of_point]) - offset
        certain = bound > near_distance
        value[open_[certain]] = (np.sign(probe_values[cube_of_point]) * bound)[certain]
        open_, size = open_[~certain], 0.5 * size
    value[open_] = ground.signed(points[open_])
    return value


def nearest_point(points: Array, ground: Ground, value: Array) -> tuple[int, float]:
    """Return the point nearest to the boundary of the ground, and its distance, given the values
    of `distances`.
    """
    order = np.argsort(np.abs(value), kind="stable")
    best, min_distance = int(order[0]), np.inf
    for block in np.array_split(order, max(1, len(order) // 256)):
        if abs(float(value[block[0]])) > min_distance:
            break
        exact = np.abs(ground.signed(points[block]))
        if exact.min() < min_distance:
            best, min_distance = int(block[np.argmin(exact)]), float(exact.min())
    return best, min_distance
