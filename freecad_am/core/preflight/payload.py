# SPDX-License-Identifier: LGPL-2.1-or-later
"""Payload check of the machine that carries the part."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..issues import Issue, Text, Word
from ..kinematics.cell import Cell
from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..simulation.payload import CODE, finished
from ..toolpath import Toolpath
from .promise import Promise, issue_place, number, select_issues

WHAT = "What carries the part carries its weight"


def payload_promises(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    issues: Sequence[Issue],
) -> list[Promise]:
    """Promise on the load of robot or positioner; empty if the part does not move, or is on a machine with
    rotary axes.
    """
    if not cell.carriers or not cell.machine.free:
        return []
    mass, text = finished(motion, cell, toolpath, process), select_issues(issues, (CODE,))
    weakest = min(cell.carriers, key=lambda carrier: carrier.payload.kg)
    weighed = Text(
        "deposit and closed substrate, at {} g/cm3 (process.density)",
        number(process.density),
    )
    untold = [carrier.title for carrier in cell.carriers if math.isinf(carrier.payload.kg)]
    if untold and not text:
        return [
            Promise(
                WHAT,
                Text("not checked: the file of {} states no payload; {}", untold[0], Word(weighed)),
                None,
                mass,
                "kg",
            )
        ]
    how = Text("{}, compared with the payload of {}", Word(weighed), weakest.title)
    if not math.isinf(weakest.payload.from_axis):
        how = Text(
            "{}, compared with the payload of {}, and its moment about the last axis, as it grows",
            Word(weighed),
            weakest.title,
        )
    return [Promise(WHAT, how, not text, mass, "kg", weakest.payload.kg, issue_place(text))]
