# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a solid stands on something bent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part

PLANE = "Part::GeomPlane"
TOUCHING = 0.05  # mm
ACROSS = (0.2, 0.5, 0.8)  # of a face, either way
LOOKED = 8  # solids that are looked at, of many


def lies_on_bend(part: Any, ground: Any) -> bool:
    """Whether a face of a shape lies on a face of what carries it, another shape, that is not flat."""
    bent = [face for face in ground.Faces if face.Surface.TypeId != PLANE]
    return any(
        all(face.distToShape(Part.Vertex(place))[0] < TOUCHING for place in _within(own))
        for own in part.Faces
        if own.Surface.TypeId != PLANE
        for face in bent
        if face.BoundBox.intersect(own.BoundBox)
    )


def carrier(solids: Sequence[Any]) -> str:
    """The name of the largest of several solids, as `Solid1`, where most others, of LOOKED of them, lie on a face of it that
    is not flat; else ''."""
    sizes = [abs(solid.Volume) for solid in solids]
    largest = sizes.index(max(sizes))
    others = [solid for k, solid in enumerate(solids) if k != largest][:LOOKED]
    carried = sum(lies_on_bend(one, solids[largest]) for one in others)
    return f"Solid{largest + 1}" if carried > 0.5 * len(others) else ""


def _within(face: Any) -> list[Any]:
    """Places of a face, in its middle and about it, none of them beside it."""
    low_u, high_u, low_v, high_v = face.ParameterRange
    shares = [
        (low_u + u * (high_u - low_u), low_v + v * (high_v - low_v)) for u in ACROSS for v in ACROSS
    ]
    found = [face.valueAt(*at) for at in shares if face.isPartOfDomain(*at)]
    return found or [vertex.Point for vertex in face.Vertexes]
