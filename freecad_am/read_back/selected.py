# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check settings that a text refers to but does not contain: frame and tool numbers, and programs
on the controller.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.geometry import frames
from ..core.issues import ERROR, WARNING, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.read_moves import Event, ReadMoves
from ..core.types import Array, Index
from .events import timed


class Finding(NamedTuple):
    """An issue and its motion row; None if it has no row."""

    issue: Issue
    row: int | None

    def line(self, motion: Motion, text: ReadMoves) -> tuple[str, int] | None:
        """Return file and line (from 1) of the move to this row of the text's motion; None if
        unknown.
        """
        if self.row is None or text.lines is None:
            return None
        # the first row of a bead repeats the end of the previous move
        return text.lines.at(max(int(np.count_nonzero(motion.moves[: self.row + 1])) - 1, 0))


def error_at(code: str, message: Text, motion: Motion, row: int) -> Finding:
    """Return an error at a motion row."""
    return Finding(
        Issue(
            ERROR,
            code,
            message,
            int(motion.layer[row]),
            int(motion.bead[row]),
            int(motion.point[row]),
        ),
        row,
    )


def selection_findings(
    motion: Motion, text: ReadMoves, expected: tuple[int, int] | None
) -> list[Finding]:
    """Return FRAME_NUMBER if a text selects several frames or tools, or differs from the job.

    Only one frame and one tool can be simulated. Add OTHER_PROGRAM for each called program that is
    missing.

    Parameters
    ----------
    motion
        The motion of the text.
    text
        The moves of the text.
    expected
        Frame number and tool number of the job; None without a job.
    """
    return [*_numbers(motion, text, expected), *_calls(motion, text)]


def _numbers(
    motion: Motion, text: ReadMoves, expected: tuple[int, int] | None
) -> Iterator[Finding]:
    frame, tool = expected or (None, None)
    selections: list[tuple[Text, Array | None, int | None]] = [
        (Text("work frame"), text.user_frame, frame),
        (Text("tool"), text.tool_frame, tool),
    ]
    rows = np.flatnonzero(motion.moves)
    for kind, numbers, number in selections:
        numbered = (
            np.flatnonzero(~np.isnan(numbers)) if numbers is not None else np.zeros(0, np.intp)
        )
        if numbers is None or not len(numbered):
            continue
        first_number = numbers[numbered[0]]
        changed = numbered[numbers[numbered] != first_number]
        if len(changed):
            message = Text(
                "{0} {1:.0f} is selected after moves in {2:.0f}, but all moves are simulated in "
                "one selection; use a program with a single selection",
                kind,
                numbers[changed[0]],
                first_number,
            )
            yield _finding_at(ERROR, "FRAME_NUMBER", message, motion, int(rows[changed[0]]))
        elif number is not None and first_number != number:
            message = Text(
                "the program selects {} {:.0f}, but the job has {}, which the simulation uses; "
                "correct the number in the program or in the job",
                kind,
                first_number,
                number,
            )
            yield _finding_at(WARNING, "FRAME_NUMBER", message, motion, int(rows[numbered[0]]))


def _calls(motion: Motion, text: ReadMoves) -> Iterator[Finding]:
    """Yield one finding per called program, at the first move after the call."""
    rows = np.flatnonzero(motion.moves)
    first_calls: dict[str, int] = {}
    for event in text.events:
        if event.kind == "call":
            first_calls.setdefault(str(event.value[0]), event.row)
    for name, row in first_calls.items():
        message = Text(
            "the program calls {}, which is missing, so its motions and signals are not "
            "simulated; add the file of the called program, or check its motion on the controller",
            name,
        )
        yield _finding_at(
            WARNING, "OTHER_PROGRAM", message, motion, int(rows[min(row, len(rows) - 1)])
        )


def _finding_at(level: str, code: str, message: Text, motion: Motion, row: int) -> Finding:
    bead_point = int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row])
    return Finding(Issue(level, code, message, *bead_point), row)


# s; how much longer than its move a lead may be: the text rounds both times to milliseconds
MOST_LONGER = 0.002


def switching_findings(motion: Motion, text: ReadMoves) -> list[Finding]:
    """Return DEPOSIT_SWITCH if the deposit is switched on twice or stays on at the program end.

    In both cases the end of a bead is missing. Also return the first TRIGGER_LEAD if a switch comes
    before its move begins. motion: the motion of the text.
    """
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
            message = Text("the program switches the deposit on while the deposit is already on")
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
        message = Text("the program ends with the deposit still on")
        yield _finding("DEPOSIT_SWITCH", message, motion, rows, len(rows))


def _finding(code: str, message: Text, motion: Motion, rows: Index, move: int) -> Finding:
    """Return an error at a move, or at the last move for a later event."""
    return error_at(code, message, motion, int(rows[min(move, len(rows) - 1)]))


def _time_of_its_move(event: Event, seconds: Array) -> float | None:
    """Return the duration of the last move before an event, s, if the lead exceeds it; else None.

    The duration of the first move is unknown.
    """
    move = event.row - 1
    if (
        event.ahead is None
        or move < 1
        or not event.ahead > seconds[move] + event.digits + MOST_LONGER
    ):
        return None
    return float(seconds[move])


ROUNDED = 0.1  # mm; tolerance for rounding in the program and for joint motion between points


def into_platform(motion: Motion, cell: Cell) -> list[Finding]:
    """Return INTO_PLATFORM at the lowest point if the tip deposits below the platform within its
    edge.

    motion: the motion of the text. Unreachable rows are not checked.
    """
    rows = np.flatnonzero(motion.deposit & motion.reachable)
    to_platform = frames.inverse(cell.poses.mount)
    points = motion.position[rows] @ to_platform[:3, :3].T + to_platform[:3, 3]
    below = (points[:, 2] < -ROUNDED) & (
        np.hypot(points[:, 0], points[:, 1]) < 0.5 * cell.platform_diameter
    )
    if not below.any():
        return []
    low, count = int(np.where(below, points[:, 2], np.inf).argmin()), int(below.sum())
    text = Text(
        (
            "the nozzle deposits at 1 point below the platform, by {1:.3g} mm; correct the height of the point, or the platform of the cell"
        )
        if count == 1
        else (
            "the nozzle deposits at {0} points below the platform, here by {1:.3g} mm; correct the heights of these points, or the platform of the cell"
        ),
        count,
        -points[low, 2],
    )
    return [error_at("INTO_PLATFORM", text, motion, int(rows[low]))]
