# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reason why a shape has no solids, and how to make one."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.geometry.formatting import place
from ...core.issues import InputError, Text

SEW = Text(
    "sew the faces (Part, Shape builder: Shell from faces, then Solid from shell), or export the "
    "part as a solid from CAD, as STEP rather than as IGES"
)


def no_solid(source: Any, label: str, remedy: str) -> InputError:
    """Return the error NO_SOLID for a Part.Shape or None. remedy: end of the message."""
    faces = [] if source is None or source.isNull() else list(source.Faces)
    if not faces:
        return InputError("NO_SOLID", label, "the object is not a solid; {}", remedy)
    if source.Shells and all(shell.isClosed() for shell in source.Shells):
        return InputError(
            "NO_SOLID",
            label,
            "the object has no solid, but {} closed shell(s) of {} face(s); convert the shells "
            "to solids (Part, Convert to solid), or {}",
            len(source.Shells),
            len(faces),
            remedy,
        )
    edge, face = _open_edge(faces)
    return InputError(
        "NO_SOLID",
        label,
        "the object has no solid, but {} open face(s): no face connects to the edge at {} of {}; "
        "{}, or {}",
        len(faces),
        edge,
        face,
        SEW,
        remedy,
    )


def _open_edge(faces: list[Any]) -> tuple[str, str]:
    """Return the midpoint of an edge that only one face uses, and the name of the face."""
    owners: dict[int, list[int]] = {}
    edges = {}
    for number, face in enumerate(faces, start=1):
        for edge in face.Edges:
            owners.setdefault(edge.hashCode(), []).append(number)
            edges[edge.hashCode()] = edge
    single = [
        code
        for code, face_numbers in owners.items()
        if len(face_numbers) == 1
        and not edges[code].Degenerated
        and not edges[code].isSeam(faces[face_numbers[0] - 1])
    ]
    if not single:
        return place(np.array(tuple(faces[0].BoundBox.Center))), "Face1"
    edge = edges[single[0]]
    middle = edge.valueAt(0.5 * (edge.FirstParameter + edge.LastParameter))
    return place(np.array(tuple(middle))), f"Face{owners[single[0]][0]}"
