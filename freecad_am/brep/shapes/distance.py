# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exact distances of points from the faces of a shape, their place on it found by triangles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.geometry.mesh.solid import Search, SolidMesh
from ...core.issues import InputError
from ...core.types import Array, Index
from ..kernel.process import in_kernel_process
from .tessellate import divided

MIN_DEFLECTION_MM, SHARE = 0.02, 2e-4  # mm, and of the extent: deflection of the triangles
MAX_FOOT_GAP_DEFLECTIONS = 4.0  # deflections between the two feet of a point on a bent face, beyond which it is past the edge of the face,
TURNED = 0.1  # and this share of its distance: triangles are turned against the face


@dataclass(frozen=True, eq=False)
class Skin:
    """Triangles of a shape, vertices (n, 3) mm and corners (m, 3), within `deflection` mm; `exact`
    gives distances (k,) of points (k, 3), outside with a plus, and the unit normals (k, 3) along
    which they count.
    """

    vertices: Array
    triangles: Index
    deflection: float
    exact: Callable[[Array], tuple[Array, Array]]


def skin(shape: Any, label: str) -> Skin:
    """The faces of a Part.Shape, to measure from. Raises InputError NO_FACES."""
    if not shape.Faces:
        raise InputError(
            "NO_FACES", label, "it has no faces to compare points with; choose a solid or a surface"
        )
    deflection = max(MIN_DEFLECTION_MM, SHARE * shape.BoundBox.DiagonalLength)
    vertices, triangles, face = in_kernel_process(_by_face, shape, deflection)
    mesh = SolidMesh(vertices, triangles)
    search = mesh.searched(0.02 * float(np.ptp(vertices, axis=0).max()))
    closed = bool(shape.Solids)
    faces = shape.Faces

    def exact(queries: Array) -> tuple[Array, Array]:
        return _exact(queries, faces, face, mesh, search, deflection, closed)

    return Skin(vertices, triangles, deflection, exact)


def _by_face(shape: Any, deflection: float) -> tuple[Array, Index, Index]:
    """Vertices (n, 3), triangles (m, 3), and the number of the face (m,) of each."""
    points, corners = shape.tessellate(deflection)
    counts = [
        len(one_face.tessellate(deflection)[1]) if divided(one_face) else 0
        for one_face in shape.Faces
    ]
    face = np.repeat(np.arange(len(shape.Faces)), counts)
    return np.array([tuple(point) for point in points]), np.array(corners, dtype=np.intp), face


def _exact(
    points: Array,
    faces: list[Any],
    face: Index,
    mesh: SolidMesh,
    search: Search,
    deflection: float,
    closed: bool,
) -> tuple[Array, Array]:
    import FreeCAD

    rough, mesh_foot, triangle = search.signed(points)
    foot, normal = np.empty_like(points), np.empty_like(points)
    for k, point in enumerate(points.tolist()):
        nearest_face = faces[face[triangle[k]]]
        u, v = nearest_face.Surface.parameter(FreeCAD.Vector(*point))
        foot[k], normal[k] = (
            tuple(nearest_face.Surface.value(u, v)),
            tuple(nearest_face.normalAt(u, v)),
        )
    distance = ((points - foot) * normal).sum(axis=1)
    if closed:  # what is past the edge of its face is nearest to the edge
        flat = np.array([one.Surface.TypeId == "Part::GeomPlane" for one in faces])[face[triangle]]
        slack = np.where(flat, 1e-6, MAX_FOOT_GAP_DEFLECTIONS * deflection + TURNED * np.abs(rough))
        past = np.linalg.norm(foot - mesh_foot, axis=1) > slack
        offset = points[past] - mesh_foot[past]
        size = np.maximum(np.abs(rough[past]), 1e-12)[:, None]
        normal[past] = np.where(
            size > 1e-9, np.sign(rough[past])[:, None] * offset / size, mesh.units[triangle[past]]
        )
        distance[past] = rough[past]
    return distance, normal
