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
        """The nearest points of its boundary, outer unit normals, each (k, 3), and the smooth piece (k,) they lie on."""

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """Nearest points and normals, each (k, 3), on the pieces (k,) wherever these end."""

    def sagitta(self, piece: Index) -> Array:
        """How far (k,) the pieces may lie off what they stand for, mm."""


class ExactGround:
    """A solid of exact faces: its triangles (within `chord` mm of it), the face (m,) of each, the faces as patches whose
    normals look outwards."""

    facets = False

    def __init__(
        self, solid: SolidMesh, face: Index, patches: tuple[Patch, ...], chord: float, edge: float
    ) -> None:
        self.face, self.patches, self.near = face, patches, 3.0 * chord
        self.search = solid.searched(edge)

    def signed(self, points: Array) -> Array:
        """Distances; near the boundary the exact ones."""
        distance, _, triangle = self.search.signed(points)
        near = np.flatnonzero(np.abs(distance) < self.near)
        if len(near):
            foot, normal = self.on(self.face[triangle[near]], points[near])
            exact = dot(points[near] - foot, normal)
            plain = np.abs(exact - distance[near]) < self.near  # not past an edge of the solid
            distance[near[plain]] = exact[plain]
        return distance

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """On the exact faces."""
        piece = self.face[self.search.signed(points)[2]]
        return *self.on(piece, points), piece

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """On the faces' surfaces."""
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(piece):
            patch, mine = self.patches[k], piece == k
            feet[mine], normals[mine] = patch.at(patch.inverse(points[mine]))
        return feet, normals

    def sagitta(self, piece: Index) -> Array:
        """None."""
        return np.zeros(len(piece))


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
        piece = self.search.signed(points)[2]
        return *self.on(piece, points), piece

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """On the planes of triangles."""
        normal = self.solid.units[piece]
        corner = self.solid.vertices[self.solid.triangles[piece, 0]]
        return points - dot(points - corner, normal)[:, None] * normal, normal

    def sagitta(self, piece: Index) -> Array:
        """By the turns between triangles."""
        return self.solid.sagitta[piece]


class PlaneGround:
    """What lies below z = `height` mm: a platform."""

    facets = False

    def __init__(self, height: float) -> None:
        self.height = height

    def signed(self, points: Array) -> Array:
        """Heights above it."""
        above: Array = points[:, 2] - self.height
        return above

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """Right under or over the points."""
        piece = np.zeros(len(points), dtype=np.intp)
        return *self.on(piece, points), piece

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """The same."""
        foot = points.copy()
        foot[:, 2] = self.height
        return foot, np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape)

    def sagitta(self, piece: Index) -> Array:
        """None."""
        return np.zeros(len(piece))


def distances(points: Array, ground: Ground, near: float) -> Array:
    """Distances (n,) of points from the ground, negative inside: exact for those nearer than `near` mm, of others the right
    sign and at most the true size.

    A distance changes by no more than one goes: of the points in a cube that is wholly farther than its size one is asked.
    """
    value, open_ = np.empty(len(points)), np.arange(len(points))
    size = float(np.ptp(points, axis=0).max(initial=0.0)) / 4.0
    while len(open_) and size > near:
        cube = np.floor((points[open_] - points.min(axis=0)) / size).astype(np.intp)
        _, one, of = np.unique(
            cube @ np.array([1, 1 << 20, 1 << 40]), return_index=True, return_inverse=True
        )
        asked = open_[one]
        found, of = ground.signed(points[asked]), np.ravel(of)
        away = np.linalg.norm(points[open_] - points[asked][of], axis=1)
        least = np.abs(found[of]) - away
        certain = least > near
        value[open_[certain]] = (np.sign(found[of]) * least)[certain]
        open_, size = open_[~certain], 0.5 * size
    value[open_] = ground.signed(points[open_])
    return value


def nearest(points: Array, ground: Ground, value: Array) -> tuple[int, float]:
    """Which point comes nearest to the boundary of the ground, and its distance, given those of `distances`."""
    order = np.argsort(np.abs(value), kind="stable")
    best, least = int(order[0]), np.inf
    for some in np.array_split(order, max(1, len(order) // 256)):
        if abs(float(value[some[0]])) > least:
            break
        exact = np.abs(ground.signed(points[some]))
        if exact.min() < least:
            best, least = int(some[np.argmin(exact)]), float(exact.min())
    return best, least
