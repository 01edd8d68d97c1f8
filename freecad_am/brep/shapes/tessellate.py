# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes as triangles: what the nozzle is kept clear of, and what is measured and cut by them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from freecad_am.core.types import Array, Index

from ...core.geometry.obstacles import Body
from ...core.issues import InputError
from ..kernel.process import in_kernel_process

DEFLECTION = 0.1  # mm, largest distance of the triangles from a curved face
WELDED = 1e-5  # mm; vertices of the tessellations of two faces
ANGLE = 0.35  # rad; of a turn from triangle to triangle in the first, coarse mesh


def body(source: Any, name: str) -> Body:
    """The triangles of a Part.Shape with faces, or of a Mesh.Mesh, in its coordinates; InputError 'NO_FACES'."""
    mesh = hasattr(source, "Topology")
    vertices, triangles = (
        _rows(*source.Topology) if mesh else in_kernel_process(triangles_of, source, DEFLECTION)
    )
    if not len(triangles):
        raise InputError(
            "NO_FACES",
            name,
            "it has no faces to keep the nozzle clear of; choose a solid or a mesh",
        )
    return Body(name, vertices, triangles)


def triangles_of(shape: Any, deflection: float) -> tuple[Array, Index]:
    """Points (n, 3) and triangles (m, 3) of a Part.Shape, within `deflection` mm."""
    return _rows(*shape.tessellate(deflection))


def _rows(points: Any, triangles: Any) -> tuple[Array, Index]:
    return np.array([tuple(point) for point in points], dtype=np.float64), np.array(
        triangles, dtype=np.int64
    )


class Tessellation(NamedTuple):
    """Vertices (n, 3), triangles (m, 3), the face (m,) of each; of each face, the parameters (k, 2) of its vertices."""

    vertices: Array
    triangles: Index
    owner: Index
    nodes: list[Array]


def tessellated(shape: Any, chord: float, angle: float = ANGLE) -> Tessellation:
    """Triangles within `chord` mm of the shape; vertices that faces share are one. Faces that the kernel makes no triangles
    of have none."""
    import MeshPart  # slow to import

    # all at once, so that shared edges are divided alike; coarser around than the faces' own call would have it
    MeshPart.meshFromShape(
        Shape=shape, LinearDeflection=chord, AngularDeflection=angle, Relative=False
    )
    points, corners, owner, nodes, count = [], [], [], [], 0
    for k, face in enumerate(shape.Faces):
        own, triangles = face.tessellate(chord) if divided(face) else ([], [])
        points.append(np.array([tuple(point) for point in own]).reshape(-1, 3))
        corners.append(np.array(triangles, dtype=np.intp).reshape(-1, 3) + count)
        owner.append(np.full(len(triangles), k, dtype=np.intp))
        nodes.append(np.array(face.getUVNodes() if triangles else [], dtype=float).reshape(-1, 2))
        count += len(own)
    return Tessellation(
        *welded(np.vstack(points), np.vstack(corners), np.concatenate(owner)), nodes
    )


def divided(face: Any) -> bool:
    """Whether the kernel has made triangles of a face when it made those of its shape. Asked for those of one alone that it
    has failed on, it may take minutes, which nothing ends, for a few that do not meet its neighbours'."""
    try:
        face.getUVNodes()
    except RuntimeError:
        return False
    return True


def welded(points: Array, triangles: Index, owner: Index) -> tuple[Array, Index, Index]:
    """Vertices closer than WELDED made one; triangles that lose a corner go."""
    tree = cKDTree(points)
    first = np.arange(len(points))
    pairs = tree.query_pairs(WELDED, output_type="ndarray")
    np.minimum.at(first, pairs.max(axis=1), pairs.min(axis=1))
    while (first[first] != first).any():
        first = first[first]
    kept, index = np.unique(first, return_inverse=True)
    triangles = np.ravel(index)[triangles]
    whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    triangles, owner = triangles[whole], owner[whole]
    used, index = np.unique(triangles, return_inverse=True)
    return points[kept][used], np.ravel(index).reshape(-1, 3).astype(np.intp), owner
