# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions of a part that would not be deposited, as far as known before planning a toolpath."""

from __future__ import annotations

from typing import Any

from ...core.issues import Issue
from ...core.parameters.process import ProcessParameters
from ...core.process.deposit import balance as deposit_balance
from ..fields import preferences
from ..stage import stage_of


def expected(value: Any, feature: Any = None) -> tuple[Issue, ...]:
    """Findings about the result of a feature (and its object, if given), with the beads of its
    toolpath, else with beads of a new one.
    """
    return deposit_balance.issues(deposit_balance.feature_balance(value, bead_width(feature)))


def bead_width(feature: Any = None) -> float:
    """Bead width of the toolpath of a feature, else of a new one, mm."""
    for following in () if feature is None else feature.InList:
        stage = stage_of(following)
        if stage is not None and stage.kind == "toolpath":
            return float(stage.parameters(following, ProcessParameters).bead_width)
    return float(preferences.process().get("bead_width", ProcessParameters().bead_width))
