# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell of a new job changed so that the job can be done in it."""

from __future__ import annotations

from typing import Any

from ..core.strategies.support import ABOVE_PLATFORM
from ..objects.fields import properties
from ..objects.planned import suited_cell
from ..objects.results.findings import issues_of
from .changes import change
from .steps import one_step, renew


def suit(cell: Any, *stages: Any) -> None:
    """Give a cell object the place, branch or positioner in which the job of a toolpath can be done, and renew the toolpath,
    first of the stages, and what follows; all is as it was where that serves, or nothing was found that does."""
    settings = cell.Proxy.value(cell)
    found = suited_cell.of_toolpath(stages[0])(settings)
    if found != settings:
        with one_step(cell.Document, f"Edit {cell.Label}"):
            properties.write(cell, found)
            for stage in (cell, *stages):
                renew(stage)


def put_on_platform(cell: Any, toolpath: Any) -> Any:
    """The toolpath object, of what stands on the platform where it began above it, over nothing."""
    if any(issue.code == ABOVE_PLATFORM for issue in issues_of(toolpath)):
        change(cell, mount="feature")
    return toolpath
