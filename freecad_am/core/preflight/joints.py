# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limits, reach, speeds and singularities along a motion, rapids included."""

from __future__ import annotations

import numpy as np

from ..kinematics.cell import Cell
from ..motion import Motion
from ..simulation.margins import speed_ratios
from ..simulation.watch import shown_margins
from ..types import Array
from .promise import PERCENT, Promise, row_place

ROUNDING = 1e-7  # deg or mm beyond a limit, and share of a speed, that are rounding
COMPUTED_MM = 1e-6  # mm by which two computations of one pose may differ


def promises(
    motion: Motion, cell: Cell, condition: Array, threshold: Array, digits: float = 0.0
) -> list[Promise]:
    """The promises about the joints of a motion. condition, threshold: (n,) of its rows, NaN where not known. digits: % of
    the largest speed of an axis that digits of a text take."""
    return [
        _limits(motion, cell),
        _reach(motion, cell),
        _speeds(motion, cell, PERCENT + digits),
        _singularities(motion, condition, threshold),
    ]


def _limits(motion: Motion, cell: Cell) -> Promise:
    what, how = (
        "Every axis stays within its limits",
        "every point of the motion, rapids included, against the machine file",
    )
    margins = shown_margins(cell, motion.joints)
    if not np.isfinite(margins).any():
        return Promise(what, "no axis has limits, or no point is reached", None)
    row, limit = np.unravel_index(int(np.nanargmin(margins)), margins.shape)
    worst = float(margins[row, limit])
    units = cell.machine.units
    return Promise(
        what,
        how,
        bool(worst >= -ROUNDING),
        worst,
        units[limit] if limit < len(units) else "deg",
        0.0,
        row_place(motion, int(row)),
        at_least=True,
        row=int(row),
    )


def _reach(motion: Motion, cell: Cell) -> Promise:
    what = "The joints bring the tool to every point"
    unreachable = np.flatnonzero(~motion.reachable)
    if len(unreachable):
        location = row_place(motion, int(unreachable[0]))
        return Promise(
            what,
            "closed-form inverse",
            False,
            float(len(unreachable)),
            "points",
            0.0,
            location,
            row=int(unreachable[0]),
        )
    deposited = np.flatnonzero(motion.deposit)
    distances = np.linalg.norm(
        cell.tip_at(motion.joints[deposited]) - motion.position[deposited], axis=1
    )
    row = int(deposited[int(distances.argmax())])
    how = "planned joints of the deposit driven through the joint-frame chain, which planning does not use"
    worst = float(distances.max())
    return Promise(
        what, how, worst <= COMPUTED_MM, worst, "mm", COMPUTED_MM, row_place(motion, row), row=row
    )


def _speeds(motion: Motion, cell: Cell, max_percent: float) -> Promise:
    what = "No axis is asked for more than its largest speed"
    if not np.isfinite(cell.machine.max_speed).any():
        return Promise(what, "the machine file gives no largest speeds", None)
    ratios = speed_ratios(motion.joints, motion.duration, cell.machine.max_speed).max(axis=1)
    if not np.isfinite(ratios).any():
        return Promise(what, "no point is reached", None)
    row = int(np.nanargmax(ratios))
    worst = PERCENT * float(ratios[row])
    how = "mean speed of each axis on each move, rapids included, against the machine file"
    return Promise(
        what,
        how,
        bool(worst <= max_percent * (1.0 + ROUNDING)),
        worst,
        "%",
        max_percent,
        row_place(motion, row),
        row=row,
    )


def _singularities(motion: Motion, condition: Array, threshold: Array) -> Promise:
    what = "The tool keeps away from singularities while it deposits"
    is_known = np.isfinite(condition) & np.isfinite(threshold)
    if not is_known.any():
        return Promise(what, "not known of this machine", None)
    spare = np.where(is_known, condition - threshold, np.inf)
    row = int(spare.argmin())
    how = "inverse condition number of the Jacobian at the points of the deposit, against the least one allowed"
    return Promise(
        what,
        how,
        bool(spare[row] >= -ROUNDING),
        float(condition[row]),
        "",
        float(threshold[row]),
        row_place(motion, row),
        at_least=True,
        row=row,
    )
