# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges of faces on the platform, where a wall without a substrate starts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import Part

from ...core.geometry.walls.contact import TOUCH_MM
from ..shapes.tessellate import DEFLECTION, triangles_of

SAMPLES = 9
DIGITS = 3  # decimals of mm; edges of unsewn faces are closer


def standing_edges(faces: Sequence[Any], lowest: float) -> list[Any]:
    """Edges of faces that are within TOUCH of the plane Z = `lowest` mm, through the faces' lowest
    point, and that bound only one face.
    """
    edges_by_key: dict[tuple[float, ...], list[Any]] = {}
    for face in faces:
        for edge in face.Edges:
            if edge.Degenerated or edge.isSeam(face):
                continue
            points = np.array(
                [tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, SAMPLES)]
            )
            if points[:, 2].max() < lowest + TOUCH_MM:
                key = np.round([*points[SAMPLES // 2], edge.Length], DIGITS) + 0.0
                edges_by_key.setdefault(tuple(key.tolist()), []).append(edge)
    return [edges[0] for edges in edges_by_key.values() if len(edges) == 1]


def stand(faces: Sequence[Any]) -> bool:
    """Whether faces have such edges."""
    vertices, _ = triangles_of(Part.Compound([face.copy(False) for face in faces]), DEFLECTION)
    return len(vertices) > 0 and bool(standing_edges(faces, float(vertices[:, 2].min())))
