# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges, sketches and tables of points, deposited as beads."""

from __future__ import annotations

from ..parameters.strategy import CurvesParameters
from .family import Family


class Curves(Family):
    """Curves that are beads themselves."""

    kind = "curves"
    parameters = CurvesParameters
    takes_curves = True
    modes = ("local", "fixed")
    mode_refusal = "{} is for walls; curves use their own directions or one fixed direction: use local or fixed"

    starts_on_base = True
    starts_anywhere = True
    cuts_into_substrate = True
