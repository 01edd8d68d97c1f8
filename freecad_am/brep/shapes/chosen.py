# SPDX-License-Identifier: LGPL-2.1-or-later
"""Some solids or faces of a shape as a shape of their own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part


def solids_of(shape: Any, numbers: Sequence[int]) -> Any:
    """The solids with these numbers, from 1, of a Part.Shape. IndexError for one that there is not."""
    chosen = [shape.Solids[number - 1] for number in numbers]
    return chosen[0] if len(chosen) == 1 else Part.makeCompound(chosen)


def owners_of(shape: Any, names: Sequence[str]) -> tuple[Any, tuple[str, ...]]:
    """The solids that some faces of a Part.Shape belong to, and those of the faces that belong to none; and what the faces
    are called there. The shape itself where a name is none of its faces."""
    faces = shape.Faces
    numbers = [int(name.removeprefix("Face")) for name in names]
    if not numbers or max(numbers) > len(faces):
        return shape, tuple(names)
    chosen = [faces[number - 1] for number in numbers]
    solids = [
        solid
        for solid in shape.Solids
        if any(one.isSame(face) for face in solid.Faces for one in chosen)
    ]
    held = [face for solid in solids for face in solid.Faces]
    own = [*solids, *(face for face in chosen if not any(face.isSame(one) for one in held))]
    made = own[0] if len(own) == 1 else Part.makeCompound(own)
    return made, tuple(
        next(f"Face{k + 1}" for k, one in enumerate(made.Faces) if one.isSame(face))
        for face in chosen
    )
