# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves to be laid as beads from edges of a shape, and the normals of faces that they lie on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from freecad_am.core.types import Array

from ..core.geometry.curves.bead_curves import BeadCurve
from ..core.geometry.formatting import place
from ..core.geometry.step_count import step_count
from ..core.issues import InputError

SHORTEST = 1e-4  # mm; shorter edges are none
ON_FACE = 0.01  # mm that a curve may be off the faces that it lies on
STEP = 2.0  # mm from point to point at most where normals are taken


def curves_of(
    shape: Any, edges: Sequence[str], faces: Sequence[str], chord_error: float, label: str
) -> list[BeadCurve]:
    """The chains that named edges form, all edges of the shape without names, as points within the chord error. faces: whose
    normals are the directions. InputError UNKNOWN_EDGE, UNKNOWN_FACE, NO_CURVES, OFF_FACE."""
    known = {f"Edge{number + 1}": edge for number, edge in enumerate(shape.Edges)}
    owned = {f"Face{number + 1}": face for number, face in enumerate(shape.Faces)}
    for names, there, kind in ((edges, known, "Edge"), (faces, owned, "Face")):
        wrong = [name for name in names if name not in there]
        if wrong:
            raise InputError(
                f"UNKNOWN_{kind.upper()}",
                label,
                "it has no {}, but {} {}(s); name others, from {}1 on",
                ", ".join(wrong),
                len(there),
                kind.lower(),
                kind,
            )
    chosen = [
        edge
        for edge in ([known[name] for name in dict.fromkeys(edges)] or shape.Edges)
        if edge.Length > SHORTEST
    ]
    if not chosen:
        raise InputError(
            "NO_CURVES", label, "it has no edges to lay as beads; choose edges, a wire or a sketch"
        )
    found = [_polyline(chain, chord_error, bool(faces)) for chain in Part.sortEdges(chosen)]
    owners = [owned[name] for name in faces]
    return [
        BeadCurve(points, _normals(points, owners, label) if owners else None) for points in found
    ]


def _polyline(chain: Sequence[Any], chord_error: float, dense: bool) -> Array:
    """Points (n, 3) of edges that follow one another."""
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
    whole = np.vstack([rows[0], *(points[1:] for points in rows[1:])])
    return np.asarray(whole[np.r_[True, np.linalg.norm(np.diff(whole, axis=0), axis=1) > SHORTEST]])


def _normals(points: Array, faces: Sequence[Any], label: str) -> Array:
    """Unit normals (n, 3) of the faces nearest to points. InputError OFF_FACE."""
    found = np.empty_like(points)
    for k, point in enumerate(points.tolist()):
        vertex = Part.Vertex(*point)
        apart = [face.distToShape(vertex)[0] for face in faces]
        nearest = int(np.argmin(apart))
        if apart[nearest] > ON_FACE:
            raise InputError(
                "OFF_FACE",
                label,
                "a curve is {:.3g} mm off the faces whose normals it is to have, at {}; choose the faces "
                "that it lies on, or give strategy.direction",
                apart[nearest],
                place(point),
            )
        face = faces[nearest]
        found[k] = tuple(face.normalAt(*face.Surface.parameter(FreeCAD.Vector(*point))))
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))
