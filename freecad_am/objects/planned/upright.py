# SPDX-License-Identifier: LGPL-2.1-or-later
"""Remedies for a nozzle that no tilt clears: one build direction for a whole leaning wall, plane
layers for a solid in curved ones.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING

from ...core.issues import ERROR, NOTE, AmError, Issue, Text, has_errors
from ...core.parameters.filled import PLANES
from ...core.strategies.clearance.look import CLEARANCE
from ...core.toolpath import Toolpath
from ..families.given import Given
from ..work import progress
from .toolpaths import planned

if TYPE_CHECKING:
    from ...core.planning.other_cells import Fixed


def in_planes(inputs: Given, fit: Callable[[Toolpath], Toolpath] | None) -> Fixed | None:
    """A solid in curved layers that start at its base, planned in plane ones; None for others."""
    if not inputs.strategy.has_curved_layers or any(
        group.start is not None for group in inputs.wall.groups
    ):
        return None
    from ...core.planning.other_cells import Fixed

    flat = dataclasses.replace(inputs, strategy=dataclasses.replace(inputs.strategy, layers=PLANES))
    return Fixed(
        "`strategy.layers: planes`", lambda: planned(flat) if fit is None else planned(flat, fit)
    )


def try_remedy(toolpath: Toolpath, fixed: Fixed | None) -> Toolpath:
    """A toolpath on which the nozzle touches something, and nothing else is wrong, with a note on whether it does with fixed
    build directions, or plane layers, planned so; others as they are."""
    errors = {issue.code for issue in toolpath.issues if issue.level == ERROR}
    if fixed is None or errors != {CLEARANCE}:
        return toolpath
    from ...core.planning.remedies import NO_REMEDY, REMEDY

    progress.report(1.0, Text("searching for a change that clears the nozzle: {}", fixed.remedy))
    try:
        clear = not has_errors(list(fixed.make().issues))
    except AmError:  # what cannot be asked for is not a remedy
        clear = False
    note = (
        Issue(
            NOTE,
            REMEDY,
            Text(
                "with {} the nozzle is clear; the toolpath was planned with it, the joint path "
                "was not",
                fixed.remedy,
            ),
        )
        if (clear)
        else Issue(
            NOTE,
            NO_REMEDY,
            Text("the nozzle is not clear with {} either (tested)", fixed.remedy),
        )
    )
    return dataclasses.replace(toolpath, issues=(note, *toolpath.issues))
