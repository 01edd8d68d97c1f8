# SPDX-License-Identifier: LGPL-2.1-or-later
"""The work that plans a toolpath by all methods."""

from __future__ import annotations

from collections.abc import Callable

from ...core.planning.redundancy import curve as rotation_curve
from ...core.planning.redundancy.curve import Compared
from ...core.planning.task import Task
from ...objects.work import progress
from .draft import Source


def comparison_work(source: Source, task: Task) -> Callable[[], tuple[Compared, ...]]:
    """Return work that plans the beads of the toolpath, from their own seams, by all methods.

    With external axes it plans the beads of the joint path, which hold their positions.
    """
    beads = source.beads if source.cell.external else tuple(bead for _, _, bead in source.toolpath)
    return lambda: rotation_curve.compared(task, beads, source.places, progress.report)
