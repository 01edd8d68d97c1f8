# SPDX-License-Identifier: LGPL-2.1-or-later
"""An open mesh, as a scan of a worn face, that is covered with layers of beads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ...issues import InputError
from ...types import Array, Index
from ..mesh.triangle_mesh import Mesh
from .clad_faces import CladFaces
from .mesh_wall import MeshWall, mesh_wall
from .surface import dot

OF_SPACING = 0.5  # edges, of the bead spacing


def clad_mesh(points: Array, triangles: Index, spacing: float, back: bool, label: str) -> CladFaces:
    """All of a mesh of points (n, 3) and triangles (m, 3), for beads `spacing` mm apart, as one sheet: the smooth surface
    through its facets. Layers grow to the side that its triangles are counter-clockwise from; back: to the other.

    InputError NO_FACES for a closed mesh, and those of `mesh_wall`.
    """
    wall = mesh_wall(points, triangles, OF_SPACING * spacing, label, 0.0)
    if not len(wall.mesh.border_edges):
        raise InputError(
            "NO_FACES",
            label,
            "it is a closed mesh, which has no faces to choose; cut out of it what is to be covered "
            "(Mesh, Cutting), or take the file that it was made of",
        )
    front = _faces_as(points, triangles, wall)
    sheet = wall if front != back else replace(wall, triangles=wall.triangles[:, ::-1].copy())
    return CladFaces(label, (), (sheet,), (), wall.issues)


def _faces_as(points: Array, triangles: Index, wall: MeshWall) -> bool:
    """Whether a wall faces the way that most of the mesh does which it was made of."""
    given, made = Mesh(points, triangles), wall.mesh
    near = cKDTree(points[triangles].mean(axis=1)).query(
        wall.vertices[wall.triangles].mean(axis=1)
    )[1]
    units = given.area_vectors[near] / np.maximum(given.areas[near], 1e-300)[:, None]
    return float(dot(made.area_vectors, units).sum()) > 0.0
