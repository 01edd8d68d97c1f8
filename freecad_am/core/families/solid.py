# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids filled in planes, curved layers, or layers along a guide."""

from __future__ import annotations

from typing import Any

from ..parameters.filled import PLANES, SolidParameters
from .developable import Developable
from .family import Family


class Solid(Family):
    """Solids on a plane, in layers of any kind but those around a hub."""

    kind = "solid"
    parameters = SolidParameters
    takes_meshes = True
    takes_faces = False
    selections = ("guide", "start_faces")
    fuses_solids = True
    chooses_layers = True
    modes = ("local", "layer", "fixed")
    mode_refusal = "{} is for walls; plane layers grow along their normal: use local or fixed"

    is_filled = True
    stacks_layers = True

    def kind_in_layers(self, layers: Any) -> str:
        """Return the kind of solids on a hub for the layers of that name."""
        return Developable.kind if layers == Developable.kind else self.kind

    def fits_scans(self, layers: str) -> bool:
        """Return whether layers are planes."""
        return layers == PLANES

    def describe_layers(self, layers: str) -> str:
        """Return the key and the name of the layers."""
        return f"layers: {layers}"
