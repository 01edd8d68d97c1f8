# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map of the free rotation against an external axis at one point, the others as they are planned there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...kinematics.cell import Cell
from ...toolpath import Bead
from ...types import Array
from ..task import Task
from .map import Columns, alone, planned_external


def across(beads: Sequence[Bead], cell: Cell, at: tuple[int, int], axis: int, values: Array) -> Columns:
    """One point of the beads, at (bead, point), with values (C,) rad or mm of one of the external axes, the others as they
    are planned there: a column of each."""
    bead, point = at
    count = len(values)
    external = np.tile(planned_external(beads[bead])[point], (count, 1))
    external[:, axis] = values
    position, tool, parameter = (
        np.repeat(getattr(beads[bead], name)[point : point + 1], count, axis=0) for name in ("points", "tool", "parameter")
    )
    return Columns(np.full(count, bead), np.full(count, point), alone(cell, position, tool, parameter, external))


def span(task: Task, bead: Bead, point: int, axis: int, count: int) -> Array:
    """(count,) values of an external axis over its range, or over a turn about where it is planned at a point, if that is
    less."""
    own = task.cell.robot.chain.axes + axis
    here = float(planned_external(bead)[point, axis])
    low, high = float(task.cell.limits.lower[own]), float(task.cell.limits.upper[own])
    if not task.cell.machine.chain.sliding[own]:
        low, high = max(low, here - np.pi), min(high, here + np.pi)
    return np.linspace(low, high, count)
