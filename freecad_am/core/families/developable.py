# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on a cylinder or cone."""

from __future__ import annotations

from ..parameters.filled import DevelopableParameters
from .family import Family


class Developable(Family):
    """Solids filled in layers around a hub."""

    kind = "developable"
    parameters = DevelopableParameters
    takes_meshes = True
    mode_refusal = "{} does not apply to solids on a hub, which grow along its normals; use local"

    is_filled = True
    cuts_into_substrate = True
