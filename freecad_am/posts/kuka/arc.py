# SPDX-License-Identifier: LGPL-2.1-or-later
"""ArcTech: the arc is lit at the end of a linear move onto a bead, and ends with the bead's last move.

Both are written as what the inline forms ARCON and ARCOFF expand to, without the comments that let
the pendant edit them: it would rewrite them, with a speed of its own. Where the lines are from:
docs/posts/kuka.md.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.issues import InputError
from ...core.program import DepositOff, DepositOn, Moves, Program

CALL = "ArcMainNG("  # beginning of a line that calls ArcTech
SEAM = "WSEAM"  # data of the seam, common to all
WELD_DATA, END_DATA = "WDAT", "WDATOFF"  # weld data, by number


def after(block: DepositOn | DepositOff) -> str:
    """The line behind such a move."""
    if isinstance(block, DepositOn):
        return f"{CALL}#ArcOnAfterMoveStd,{WELD_DATA}{block.schedule},{SEAM})"
    return f"{CALL}#ArcOffAfterMoveStd,{END_DATA}{block.schedule},{SEAM})"


def names(program: Program) -> list[str]:
    """Names of the data and procedures of ArcTech that a program uses."""
    schedules = {
        block.schedule
        for block in program.blocks
        if isinstance(block, DepositOn) and block.schedule is not None
    }
    arc_names = ["ArcMainNG", "ArcGetPath", "ArcGetDelay", SEAM] if schedules else []
    return arc_names + [
        f"{kind}{number}" for number in sorted(schedules) for kind in (WELD_DATA, END_DATA)
    ]


def refuse_post_flow(program: Program) -> None:
    """Raises InputError SCHEDULE where a bead is to have a post-flow, which ArcTech has in its own data."""
    for block in program.blocks:
        if isinstance(block, DepositOff) and block.schedule is not None and block.lead > 0.0:
            raise InputError(
                "SCHEDULE",
                "process.lead_off",
                "ArcTech ends the arc with the last move of a bead and waits there for the "
                "crater time of its weld data; use lead_off 0 and set the crater time of {}, or "
                "another program.schedule.by",
                f"{END_DATA}{block.schedule}",
            )


def remarks(program: Program) -> Iterator[str]:
    """Requirements on the controller: the data, and their speed."""
    speeds: dict[int, list[float]] = {}
    number: int | None = None
    for block in program.blocks:
        if isinstance(block, DepositOn):
            number = block.schedule
        elif isinstance(block, Moves) and number is not None:
            speeds.setdefault(number, []).extend(
                (float(np.min(block.speed)), float(np.max(block.speed)))
            )
        elif isinstance(block, DepositOff):
            number = None
    if speeds:
        yield f"ArcTech: {SEAM} and the weld data are of a public data list"
    for number, weld_speeds in sorted(speeds.items()):
        slowest, fastest = 0.001 * min(weld_speeds), 0.001 * max(weld_speeds)
        speed = f"{fastest:.6f}" if fastest - slowest < 5e-7 else f"{slowest:.6f} to {fastest:.6f}"
        yield f"{WELD_DATA}{number}, {END_DATA}{number}: $VEL.CP is {speed} m/s"


def lighting(number: int) -> list[str]:
    """The lines in front of the move that lights the arc."""
    data, seam = f"{WELD_DATA}{number}", SEAM
    on_the_fly = f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,{data})"
    return [
        f"TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,{data}) DO {CALL}#PreDefinition,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=ArcGetDelay(#GasPreflow,{data}) DO {CALL}#GasPreflow,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=0 DO {CALL}#ArcOnMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOnBeforeMoveStd,{data},{seam})",
    ]


def ending(number: int) -> list[str]:
    """The lines in front of the move that ends it."""
    data, seam = f"{END_DATA}{number}", SEAM
    return [
        f"TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,{data}) DELAY=0 DO {CALL}#ArcOffBeforeOffStd,{data},{seam}) PRIO=-1",
        f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,{data}) DELAY=0 DO {CALL}#ArcOffMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOffBeforeMoveStd,{data},{seam})",
    ]
