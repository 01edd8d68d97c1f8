# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces below the first layer of a solid, as triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part

from ..core.types import Array
from .hub import SHARE
from .kernel.process import in_kernel_process
from .shapes.tessellate import fine
from .walls.wall import faces_by_name


def triangles_of_faces(shape: Any, names: Sequence[str], label: str, chord_error: float) -> Array:
    """Triangles (k, 3, 3) of faces of a shape, all where none are named, with the chord error of
    solids. InputError NO_WALL, UNKNOWN_FACE.
    """
    faces_of_names = faces_by_name(shape, names, label)
    selection = Part.makeCompound(
        [faces_of_names[name].copy(False) for name in dict.fromkeys(names or faces_of_names)]
    )
    tessellation = in_kernel_process(fine, selection, SHARE * chord_error)
    corners: Array = tessellation[0][tessellation[1]]
    return corners
