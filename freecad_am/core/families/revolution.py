# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of parts of revolution, as closed beads or a spiral."""

from __future__ import annotations

from ..parameters.strategy import RevolutionParameters
from .family import NONE, ON_FEATURE, Family


class Revolution(Family):
    """A part of revolution, which grows on the platform."""

    kind = "revolution"
    parameters = RevolutionParameters
    substrate = NONE
    modes = ("local", "layer", "fixed")
    mode_refusal = "symmetry-plane is not for parts of revolution; use local, layer or fixed"

    has_axis = True
    mount = ON_FEATURE
    follows_wall = True
