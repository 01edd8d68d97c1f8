# SPDX-License-Identifier: LGPL-2.1-or-later
"""A guide curve from edges of a shape."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import Part

from ..core.issues import InputError
from ..core.types import Array
from .hub import SHARE
from .kernel.process import in_kernel_process
from .shapes.tessellate import fine
from .walls.start_edges import sampled
from .walls.wall import faces_by_name

MIN_EDGE_MM = 1e-3  # mm; shorter edges are none


def edges_of(shape: Any, names: Sequence[str], label: str) -> list[tuple[Array, Array]]:
    """Points and unit tangents (n, 3) of named edges of a shape; of every edge without names.
    Raises InputError UNKNOWN_EDGE, GUIDE_OPEN.
    """
    edges_by_name = {f"Edge{number + 1}": edge for number, edge in enumerate(shape.Edges)}
    wrong = [name for name in names if name not in edges_by_name]
    if wrong:
        raise InputError(
            "UNKNOWN_EDGE",
            label,
            "it has no {}; choose from Edge1 to Edge{}",
            ", ".join(wrong),
            len(edges_by_name),
        )
    if not names and shape.Faces:
        raise InputError(
            "GUIDE_OPEN",
            label,
            "it has {} edges, and a guide uses only some; choose them, as in edges: [Edge1]",
            len(edges_by_name),
        )
    edges = [edges_by_name[name] for name in dict.fromkeys(names)] or list(shape.Edges)
    return [_nodes(edge) for edge in edges if edge.Length > MIN_EDGE_MM]


def _nodes(edge: Any) -> tuple[Array, Array]:
    points, tangents = sampled(edge, max(edge.Length / 16.0, 0.1))
    distinct = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9]
    return points[distinct], tangents[distinct]


# ---- Faces below the first layer of a solid, as triangles


def triangles_of_faces(shape: Any, names: Sequence[str], label: str, chord_error: float) -> Array:
    """Triangles (k, 3, 3) of faces of a shape, all where none are named, with the chord error of
    solids. Raises InputError NO_WALL, UNKNOWN_FACE.
    """
    faces_of_names = faces_by_name(shape, names, label)
    selection = Part.makeCompound(
        [faces_of_names[name].copy(False) for name in dict.fromkeys(names or faces_of_names)]
    )
    tessellation = in_kernel_process(fine, selection, SHARE * chord_error)
    corners: Array = tessellation[0][tessellation[1]]
    return corners
