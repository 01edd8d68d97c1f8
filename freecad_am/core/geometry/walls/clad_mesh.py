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

EDGE_SPACING_SHARE = 0.5  # edges, of the bead spacing


def clad_mesh(points: Array, triangles: Index, spacing: float, back: bool, label: str) -> CladFaces:
    """Return a mesh of points (n, 3) and triangles (m, 3) as one sheet for beads `spacing` mm
    apart.

    The sheet is the smooth surface through the facets. Layers grow on the side from which the
    triangles are counter-clockwise; `back` selects the other side.

    Raises InputError NO_FACES for a closed mesh, and the errors of `mesh_wall`.
    """
    wall = mesh_wall(points, triangles, EDGE_SPACING_SHARE * spacing, label, 0.0)
    if not len(wall.mesh.border_edges):
        raise InputError(
            "NO_FACES",
            label,
            "it is a closed mesh without selectable faces; cut out the surface to cover (Mesh, "
            "Cutting), or use the original CAD file",
        )
    front = _faces_as(points, triangles, wall)
    sheet = wall if front != back else replace(wall, triangles=wall.triangles[:, ::-1].copy())
    return CladFaces(label, (), (sheet,), (), wall.issues)


def _faces_as(points: Array, triangles: Index, wall: MeshWall) -> bool:
    """Return whether a wall faces the same way as most of its source mesh."""
    source, smooth = Mesh(points, triangles), wall.mesh
    nearest = cKDTree(points[triangles].mean(axis=1)).query(
        wall.vertices[wall.triangles].mean(axis=1)
    )[1]
    units = source.area_vectors[nearest] / np.maximum(source.areas[nearest], 1e-300)[:, None]
    return float(dot(smooth.area_vectors, units).sum()) > 0.0
