# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is deposited against the part, by the issues and figures that planning it has found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..issues import WARNING, Issue
from ..process import spacing
from ..toolpath import Array, Toolpath
from .promise import Promise, issue_place, of_codes


def layers(toolpath: Toolpath, issues: Sequence[Issue], known: Sequence[Array] | None = None) -> Promise:
    """Of the distance between layers, (n,) for each but the first; what families allow of it they have said themselves."""
    what = "Layers lie one layer height apart"
    distances = [values for values in (spacing.between_layers(toolpath) if known is None else known) if len(values)]
    if not distances:
        return Promise(what, "there is one layer alone", None)
    height = toolpath.layer_height
    extremes = [(float(np.nanmin(values)), float(np.nanmax(values))) for values in distances]
    low, high = min(low for low, _ in extremes), max(high for _, high in extremes)
    worst = low if height - low > high - height else high
    wide = of_codes(issues, ("SPACING",), WARNING)
    how = "distance in space of each point to the layer below, against what the strategy allows"
    return Promise(what, how, not wide, worst, "mm", place=issue_place(wide))
