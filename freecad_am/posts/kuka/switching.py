# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines right before moves that switch the deposit themselves: an output ahead of its position, or
the arc.
"""

from __future__ import annotations

from ...core.program import DepositOff, DepositOn, Program
from ..parts import switching
from . import arc

TRIGGER = "TRIGGER "  # with which its line begins


def ahead_of_moves(program: Program) -> dict[int, str]:
    """The lines in front of the last one of runs of moves, by the identity of the run."""
    if program.dry_run:
        return {}
    return {
        id(moves): "\n".join(lines)
        for moves, block in switching(program)
        if (lines := _lines(program, block))
    }


def leads(program: Program) -> dict[int, float]:
    """s ahead of its end at which the last one of runs of moves switches an output, by the identity
    of the run.
    """
    if program.dry_run:
        return {}
    return {
        id(moves): block.ahead for moves, block in switching(program) if block.ahead is not None
    }


def in_front(lines: str, word: str) -> str:
    """The word of a move, its settings in front of it, with such lines. A trigger comes last; calls
    of ArcTech come first, as settings after them override theirs.
    """
    if arc.CALL in lines:
        return f"{lines}|{word}"
    settings, bar, move = word.rpartition("|")
    return f"{settings}{bar}{lines}|{move}"


def _lines(program: Program, block: DepositOn | DepositOff) -> list[str]:
    if block.schedule is not None:
        return (
            arc.lighting(block.schedule)
            if isinstance(block, DepositOn)
            else arc.ending(block.schedule)
        )
    if block.ahead is None:
        return []
    early, switched = (
        -round(1000.0 * block.ahead),
        "TRUE" if isinstance(block, DepositOn) else "FALSE",
    )
    return [f"{TRIGGER}WHEN DISTANCE=1 DELAY={early} DO $OUT[{program.deposit_output}]={switched}"]
