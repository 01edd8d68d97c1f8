# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves from shape edges: beads with the normals of adjacent faces, and guide curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from ..core.geometry.curves.bead_curves import BeadCurve
from ..core.geometry.formatting import place
from ..core.geometry.step_count import step_count
from ..core.issues import InputError
from ..core.types import Array
from .hub import SHARE
from .kernel.process import in_kernel_process
from .shapes.tessellate import fine
from .walls.patch_wall import sampled
from .walls.wall import faces_by_name

MIN_EDGE_MM = 1e-4  # mm; shorter edges are ignored
ON_FACE = 0.01  # mm; maximum distance of a curve from its faces
STEP = 2.0  # mm; maximum point spacing on curves with face normals


def curves_of(
    shape: Any, edges: Sequence[str], faces: Sequence[str], chord_error: float, label: str
) -> list[BeadCurve]:
    """Return the chains of the named edges as curves of points within the chord error (mm).

    Without edge names, use all edges of the shape. faces: names of faces whose normals are the
    directions. Raises InputError UNKNOWN_EDGE, UNKNOWN_FACE, NO_CURVES, OFF_FACE.
    """
    edges_by_name = {f"Edge{number + 1}": edge for number, edge in enumerate(shape.Edges)}
    faces_by_name = {f"Face{number + 1}": face for number, face in enumerate(shape.Faces)}
    for names, available, kind in ((edges, edges_by_name, "Edge"), (faces, faces_by_name, "Face")):
        wrong = [name for name in names if name not in available]
        if wrong:
            raise InputError(
                f"UNKNOWN_{kind.upper()}",
                label,
                "the object has no {}, only {} {}(s), numbered from {}1; correct the name",
                ", ".join(wrong),
                len(available),
                kind.lower(),
                kind,
            )
    selected_edges = [
        edge
        for edge in ([edges_by_name[name] for name in dict.fromkeys(edges)] or shape.Edges)
        if edge.Length > MIN_EDGE_MM
    ]
    if not selected_edges:
        raise InputError(
            "NO_CURVES",
            label,
            "the object has no edges to deposit as beads; choose edges, a wire or a sketch",
        )
    polylines = [
        _polyline(chain, chord_error, bool(faces)) for chain in Part.sortEdges(selected_edges)
    ]
    owners = [faces_by_name[name] for name in faces]
    return [
        BeadCurve(points, _normals(points, owners, label) if owners else None)
        for points in polylines
    ]


def _polyline(chain: Sequence[Any], chord_error: float, dense: bool) -> Array:
    """Return the points (n, 3) of consecutive edges."""
    rows = []
    for edge in chain:
        points = np.array([tuple(point) for point in edge.discretize(Deflection=chord_error)])
        if dense and len(points) < edge.Length / STEP + 1.0:
            points = np.array(
                [tuple(point) for point in edge.discretize(step_count(edge.Length, STEP) + 1)]
            )
        rows.append(points)
    for k, points in enumerate(rows):
        if k == 0 and len(rows) > 1:
            ends = np.vstack([rows[1][0], rows[1][-1]])
            turned = min(np.linalg.norm(ends - points[0], axis=1)) < min(
                np.linalg.norm(ends - points[-1], axis=1)
            )
        else:
            turned = k > 0 and np.linalg.norm(points[-1] - rows[k - 1][-1]) < np.linalg.norm(
                points[0] - rows[k - 1][-1]
            )
        rows[k] = points[::-1] if turned else points
    chain_points = np.vstack([rows[0], *(points[1:] for points in rows[1:])])
    return np.asarray(
        chain_points[
            np.r_[True, np.linalg.norm(np.diff(chain_points, axis=0), axis=1) > MIN_EDGE_MM]
        ]
    )


def _normals(points: Array, faces: Sequence[Any], label: str) -> Array:
    """Return unit normals (n, 3) of the nearest face at each point. Raises InputError OFF_FACE."""
    normals = np.empty_like(points)
    for k, point in enumerate(points.tolist()):
        vertex = Part.Vertex(*point)
        distances = [face.distToShape(vertex)[0] for face in faces]
        nearest = int(np.argmin(distances))
        if distances[nearest] > ON_FACE:
            raise InputError(
                "OFF_FACE",
                label,
                "a curve is {:.3g} mm off the selected faces, at {}; choose the faces that carry "
                "the curve, or set strategy.direction",
                distances[nearest],
                place(point),
            )
        face = faces[nearest]
        normals[k] = tuple(face.normalAt(*face.Surface.parameter(FreeCAD.Vector(*point))))
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


# ---- Guide curve from shape edges

MIN_GUIDE_EDGE_MM = 1e-3  # mm; shorter edges are ignored


def edges_of(shape: Any, names: Sequence[str], label: str) -> list[tuple[Array, Array]]:
    """Return points and unit tangents (n, 3) of the named edges, or of all edges without names.

    Raises InputError UNKNOWN_EDGE; GUIDE_OPEN for a shape with faces and no edge names.
    """
    edges_by_name = {f"Edge{number + 1}": edge for number, edge in enumerate(shape.Edges)}
    wrong = [name for name in names if name not in edges_by_name]
    if wrong:
        raise InputError(
            "UNKNOWN_EDGE",
            label,
            "the shape has no {}; choose an edge from Edge1 to Edge{}",
            ", ".join(wrong),
            len(edges_by_name),
        )
    if not names and shape.Faces:
        raise InputError(
            "GUIDE_OPEN",
            label,
            "the shape has {} edges, but a guide uses only some of them; name these edges, as in "
            "edges: [Edge1]",
            len(edges_by_name),
        )
    edges = [edges_by_name[name] for name in dict.fromkeys(names)] or list(shape.Edges)
    return [_nodes(edge) for edge in edges if edge.Length > MIN_GUIDE_EDGE_MM]


def _nodes(edge: Any) -> tuple[Array, Array]:
    points, tangents = sampled(edge, max(edge.Length / 16.0, 0.1))
    distinct = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9]
    return points[distinct], tangents[distinct]


# ---- Triangles of the faces below the first layer of a solid


def triangles_of_faces(shape: Any, names: Sequence[str], label: str, chord_error: float) -> Array:
    """Return the triangles (k, 3, 3) of the named faces, or of all faces without names.

    chord_error: chord error of the solids, mm. Raises InputError NO_WALL, UNKNOWN_FACE.
    """
    faces_of_names = faces_by_name(shape, names, label)
    selection = Part.makeCompound(
        [faces_of_names[name].copy(False) for name in dict.fromkeys(names or faces_of_names)]
    )
    tessellation = in_kernel_process(fine, selection, SHARE * chord_error)
    corners: Array = tessellation[0][tessellation[1]]
    return corners
