# SPDX-License-Identifier: LGPL-2.1-or-later
"""Thin walls on a substrate, from edges, or on the platform."""

from __future__ import annotations

from ..parameters.strategy import SurfaceParameters
from .family import NEEDED, Family


class Surface(Family):
    """A wall of one bead on an existing part."""

    kind = "surface"
    parameters = SurfaceParameters
    substrate = NEEDED
    takes_meshes = True
    takes_start_edges = True
    modes = ("local", "layer", "symmetry-plane", "fixed")

    follows_wall = True
    is_open_wall = True
    compares_spacings = True
    starts_on_base = True
    cuts_into_substrate = True

    def fits_scans(self, layers: str) -> bool:
        """Return True: walls have no other layers."""
        return True
