# SPDX-License-Identifier: LGPL-2.1-or-later
"""ArcTech: the arc is lit at the end of a linear move onto a bead, and ends with the bead's last move.

Both are written as what the inline forms ARCON and ARCOFF expand to, without the comments that let the pendant edit them: it
would write them anew, with a speed of its own. Where the lines are from: docs/posts/kuka.md.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.issues import InputError
from ...core.program import DepositOff, DepositOn, Moves, Program

CALL = "ArcMainNG("  # with which a line begins that calls ArcTech
SEAM = "WSEAM"  # data of the seam, of all of them
ON, OFF = "WDAT", "WDATOFF"  # weld data, by number


def after(block: DepositOn | DepositOff) -> str:
    """The line behind such a move."""
    if isinstance(block, DepositOn):
        return f"{CALL}#ArcOnAfterMoveStd,{ON}{block.schedule},{SEAM})"
    return f"{CALL}#ArcOffAfterMoveStd,{OFF}{block.schedule},{SEAM})"


def names(program: Program) -> list[str]:
    """Names of the data and procedures of ArcTech that a program uses."""
    schedules = {
        block.schedule
        for block in program.blocks
        if isinstance(block, DepositOn) and block.schedule is not None
    }
    own = ["ArcMainNG", "ArcGetPath", "ArcGetDelay", SEAM] if schedules else []
    return own + [f"{kind}{number}" for number in sorted(schedules) for kind in (ON, OFF)]


def refuse_post_flow(program: Program) -> None:
    """Raises InputError SCHEDULE where a bead is to have a post-flow, which ArcTech has in its own data."""
    for block in program.blocks:
        if isinstance(block, DepositOff) and block.schedule is not None and block.lead > 0.0:
            raise InputError(
                "SCHEDULE",
                "process.lead_off",
                "ArcTech ends the arc with the last move of a bead and stays there for the "
                "crater time of its weld data; use lead_off 0 and set the crater time of {}, or another "
                "program.schedule.by",
                f"{OFF}{block.schedule}",
            )


def remarks(program: Program) -> Iterator[str]:
    """What must be on the controller: the data, and the speed that goes with it."""
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
    for number, found in sorted(speeds.items()):
        least, most = 0.001 * min(found), 0.001 * max(found)
        speed = f"{most:.6f}" if most - least < 5e-7 else f"{least:.6f} to {most:.6f}"
        yield f"{ON}{number}, {OFF}{number}: $VEL.CP is {speed} m/s"


def lighting(number: int) -> list[str]:
    """The lines in front of the move that lights the arc."""
    data, seam = f"{ON}{number}", SEAM
    on_the_fly = f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,{data})"
    return [
        f"TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,{data}) DO {CALL}#PreDefinition,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=ArcGetDelay(#GasPreflow,{data}) DO {CALL}#GasPreflow,{data},{seam}) PRIO=-1",
        f"{on_the_fly} DELAY=0 DO {CALL}#ArcOnMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOnBeforeMoveStd,{data},{seam})",
    ]


def ending(number: int) -> list[str]:
    """The lines in front of the move that ends it."""
    data, seam = f"{OFF}{number}", SEAM
    return [
        f"TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,{data}) DELAY=0 DO {CALL}#ArcOffBeforeOffStd,{data},{seam}) PRIO=-1",
        f"TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,{data}) DELAY=0 DO {CALL}#ArcOffMoveStd,{data},{seam}) PRIO=-1",
        f"{CALL}#ArcOffBeforeMoveStd,{data},{seam})",
    ]
