# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces on which the first layer of a solid lies, as triangles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import Part

from freecad_am.core.types import Array

from .hub import SHARE
from .kernel.process import in_kernel_process
from .shapes.fine_mesh import fine
from .walls.wall import faces_by_name


def triangles_of_faces(shape: Any, names: Sequence[str], label: str, chord_error: float) -> Array:
    """Triangles (k, 3, 3) of faces of a shape, all where none are named, as near to them as those of solids are. InputError
    NO_WALL, UNKNOWN_FACE."""
    known = faces_by_name(shape, names, label)
    chosen = Part.makeCompound([known[name].copy(False) for name in dict.fromkeys(names or known)])
    made = in_kernel_process(fine, chosen, SHARE * chord_error)
    corners: Array = made[0][made[1]]
    return corners
