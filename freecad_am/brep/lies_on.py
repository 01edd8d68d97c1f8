# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a curved face carries a solid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part

PLANE = "Part::GeomPlane"
TOUCHING = 0.05  # mm
ACROSS = (0.2, 0.5, 0.8)  # of a face, either way
MAX_TESTED_SOLIDS = 8  # solids that are tested


def lies_on_bend(part: Any, ground: Any) -> bool:
    """Whether a face of a shape rests on a curved face of its carrier, another shape."""
    bent = [face for face in ground.Faces if face.Surface.TypeId != PLANE]
    return any(
        all(
            face.distToShape(Part.Vertex(point))[0] < TOUCHING
            for point in _face_points(face_of_part)
        )
        for face_of_part in part.Faces
        if face_of_part.Surface.TypeId != PLANE
        for face in bent
        if face.BoundBox.intersect(face_of_part.BoundBox)
    )


def carrier(solids: Sequence[Any]) -> str:
    """The name of the largest of several solids, such as `Solid1`, if most of up to LOOKED others
    rest on one of its curved faces; else ''.
    """
    sizes = [abs(solid.Volume) for solid in solids]
    largest = sizes.index(max(sizes))
    other_solids = [solid for k, solid in enumerate(solids) if k != largest][:MAX_TESTED_SOLIDS]
    carried = sum(lies_on_bend(other_solid, solids[largest]) for other_solid in other_solids)
    return f"Solid{largest + 1}" if carried > 0.5 * len(other_solids) else ""


def _face_points(face: Any) -> list[Any]:
    """Points within a face, in its middle and around it."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    shares = [
        (low_u + u * (high_u - low_u), low_v + v * (high_v - low_v)) for u in ACROSS for v in ACROSS
    ]
    points = [face.valueAt(*uv) for uv in shares if face.isPartOfDomain(*uv)]
    return points or [vertex.Point for vertex in face.Vertexes]
