# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a wall grows on, asked by many points at once: a solid of exact faces, or one of triangles."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .mesh import Index
from .patch_wall import PatchWall
from .solid_mesh import Search, SolidMesh
from .surface import dot

Array = NDArray[np.float64]


class Ground(Protocol):
    """A solid."""

    facets: bool  # whether its pieces are flat facets of something round

    def signed(self, points: Array) -> Array:
        """Distances (k,) mm, negative inside."""

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """The nearest points of its boundary, outer unit normals, each (k, 3), and the smooth piece (k,) they lie on."""

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """Nearest points and normals, each (k, 3), on the pieces (k,) wherever these end."""


class ExactGround:
    """A solid whose faces make the closed sheet."""

    facets = False

    def __init__(self, sheet: PatchWall, edge: float) -> None:
        self.sheet = sheet
        self.search = SolidMesh(sheet.vertices, sheet.triangles).searched(edge)
        self.near = 0.2 * sheet.mesh.longest_edge

    def signed(self, points: Array) -> Array:
        """Distances; near the boundary the exact ones."""
        distance = self.search.signed(points)[0]
        near = np.flatnonzero(np.abs(distance) < self.near)
        if len(near):
            foot, normal, _ = self.sheet.located(points[near])
            exact = dot(points[near] - foot, normal)
            apart = np.linalg.norm(points[near] - foot, axis=1)
            plain = np.abs(np.abs(exact) - apart) < 1e-6  # not past an edge of the solid
            distance[near[plain]] = exact[plain]
        return distance

    def located(self, points: Array) -> tuple[Array, Array, Index]:
        """On the exact faces."""
        return self.sheet.located(points)

    def on(self, piece: Index, points: Array) -> tuple[Array, Array]:
        """On the faces' surfaces."""
        feet, normals = np.empty_like(points), np.empty_like(points)
        for k in np.unique(piece):
            patch = self.sheet.patches[k]
            mine = piece == k
            feet[mine], normals[mine] = patch.at(patch.inverse(points[mine]))
        return feet, normals


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
