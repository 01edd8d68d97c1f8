# SPDX-License-Identifier: LGPL-2.1-or-later
"""Extract solids or faces of a shape as a new shape, and compare shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part


def common_volume(shape: Any, other_shape: Any) -> float:
    """Return the common volume, mm3, of the solids of two Part.Shapes.

    The volume is 0 if the solids only touch, or if a shape has no solid.
    """
    if (
        not shape.Solids
        or not other_shape.Solids
        or not shape.BoundBox.intersect(other_shape.BoundBox)
    ):
        return 0.0
    volume = 0.0
    for own_solid in shape.Solids:
        for other_solid in other_shape.Solids:
            if own_solid.BoundBox.intersect(other_solid.BoundBox):
                volume += sum(abs(solid.Volume) for solid in own_solid.common(other_solid).Solids)
    return volume


def volume(shape: Any) -> float:
    """Return the volume of the solids of a Part.Shape, mm3."""
    return sum(abs(solid.Volume) for solid in shape.Solids)


def touching(shape: Any, other_shape: Any, tolerance: float) -> bool:
    """Whether the distance between two Part.Shapes is at most `tolerance` mm."""
    box = shape.BoundBox
    box.enlarge(tolerance)
    return bool(
        box.intersect(other_shape.BoundBox) and shape.distToShape(other_shape)[0] <= tolerance
    )


def solids_of(shape: Any, numbers: Sequence[int]) -> Any:
    """Return the solids of a Part.Shape with the given numbers, which start at 1.

    Raises IndexError for a missing number.
    """
    solids = [shape.Solids[number - 1] for number in numbers]
    return solids[0] if len(solids) == 1 else Part.makeCompound(solids)


def owners_of(shape: Any, names: Sequence[str]) -> tuple[Any, tuple[str, ...]]:
    """Return the solids that own the named faces, and the names of the faces in the result.

    The result also contains named faces without a solid. Return the shape itself if a name is not
    one of its faces.
    """
    faces = shape.Faces
    numbers = [int(name.removeprefix("Face")) for name in names]
    if not numbers or max(numbers) > len(faces):
        return shape, tuple(names)
    named_faces = [faces[number - 1] for number in numbers]
    solids = [
        solid
        for solid in shape.Solids
        if any(other_face.isSame(face) for face in solid.Faces for other_face in named_faces)
    ]
    solid_faces = [face for solid in solids for face in solid.Faces]
    members = [
        *solids,
        *(
            face
            for face in named_faces
            if not any(face.isSame(other_face) for other_face in solid_faces)
        ),
    ]
    result = members[0] if len(members) == 1 else Part.makeCompound(members)
    return result, tuple(
        next(f"Face{k + 1}" for k, other_face in enumerate(result.Faces) if other_face.isSame(face))
        for face in named_faces
    )
