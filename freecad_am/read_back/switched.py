# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a text switches the deposit as a program can: nothing of a plan is asked."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from freecad_am.core.types import Array, Index

from ..core.issues import Text
from ..core.motion import Motion
from ..core.read_moves import Event, ReadMoves
from .finding import Finding, error_at
from .leads import timed

# s that a time in a text may be longer than that of its move: both are rounded to milliseconds
MOST_LONGER = 0.002


def switching_findings(motion: Motion, text: ReadMoves) -> list[Finding]:
    """The first DEPOSIT_SWITCH where it is switched on a second time, or is on where the program ends: an end of a bead is
    lost; and the first TRIGGER_LEAD where it is switched earlier than the move begins on which it is. motion: what the text
    drives."""
    first_findings: dict[str, Finding] = {}
    for finding in _findings(motion, text):
        first_findings.setdefault(finding.issue.code, finding)
    return list(first_findings.values())


def _findings(motion: Motion, text: ReadMoves) -> Iterator[Finding]:
    rows, on = np.flatnonzero(motion.moves), False
    for event in timed(text.events, motion.speed[rows]):
        if event.kind not in ("on", "off"):
            continue
        if on and event.kind == "on":
            message = Text("the deposit is switched on although it is already on")
            yield _finding("DEPOSIT_SWITCH", message, motion, rows, event.row)
        on = event.kind == "on"
        seconds = _time_of_its_move(event, motion.duration[rows])
        if seconds is not None:
            message = Text(
                "the last move before the switching point takes {:.3g} s, less than the lead of "
                "{:.3g} s; use a program.trigger.lead up to that time, a larger retract distance "
                "before switching on, or a larger strategy.chord_error before switching off",
                seconds,
                event.ahead,
            )
            yield _finding("TRIGGER_LEAD", message, motion, rows, event.row - 1)
    if on:
        message = Text("the deposit is still on at the end of the program")
        yield _finding("DEPOSIT_SWITCH", message, motion, rows, len(rows))


def _finding(code: str, message: Text, motion: Motion, rows: Index, move: int) -> Finding:
    """An error at a move; at the last one for what follows it."""
    return error_at(code, message, motion, int(rows[min(move, len(rows) - 1)]))


def _time_of_its_move(event: Event, seconds: Array) -> float | None:
    """s of the move that an event is on, where it comes before that begins. How long the first move takes nobody knows."""
    move = event.row - 1
    if (
        event.ahead is None
        or move < 1
        or not event.ahead > seconds[move] + event.digits + MOST_LONGER
    ):
        return None
    return float(seconds[move])
