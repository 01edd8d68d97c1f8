# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of beads on faces."""

from __future__ import annotations

from ..parameters.filled import CladdingParameters
from .family import Family


class Cladding(Family):
    """Faces covered with layers."""

    kind = "cladding"
    parameters = CladdingParameters
    takes_meshes = True
    mode_refusal = "{} is for walls; cladding grows along the normals of its faces: use local"

    is_filled = True
    starts_on_base = True
    cuts_into_substrate = True
