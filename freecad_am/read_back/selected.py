# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a text counts on that it does not tell: frames and tools by their numbers, and programs of the controller."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from freecad_am.core.types import Array

from ..core.issues import ERROR, WARNING, Issue, Text
from ..core.motion import Motion
from ..core.read_moves import ReadMoves
from .finding import Finding


def selection_findings(
    motion: Motion, text: ReadMoves, expected: tuple[int, int] | None
) -> list[Finding]:
    """FRAME_NUMBER where a text selects several frames or tools, of which only one is known, or others than a job; and
    OTHER_PROGRAM for each program that it calls and that was not given.

    Parameters
    ----------
    motion
        What the text drives.
    read
        The moves of the text.
    expected
        Numbers of the frame and of the tool of a job, None without one.
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
                "{} {:.0f} is selected after moves in {:.0f}: only one is known here, and all "
                "moves are simulated in it; use a program with a single one",
                kind,
                numbers[changed[0]],
                first_number,
            )
            yield _finding_at(ERROR, "FRAME_NUMBER", message, motion, int(rows[changed[0]]))
        elif number is not None and first_number != number:
            message = Text(
                "{} {:.0f} is selected, but the job has {}: moves are simulated with the cell's "
                "own; compare the two, and correct the program or the job",
                kind,
                first_number,
                number,
            )
            yield _finding_at(WARNING, "FRAME_NUMBER", message, motion, int(rows[numbered[0]]))


def _calls(motion: Motion, text: ReadMoves) -> Iterator[Finding]:
    """One finding of each name, at the first move behind the call."""
    rows = np.flatnonzero(motion.moves)
    first_calls: dict[str, int] = {}
    for event in text.events:
        if event.kind == "call":
            first_calls.setdefault(str(event.value[0]), event.row)
    for name, row in first_calls.items():
        message = Text(
            "the program calls {}, which is missing, so its motions and signals are not "
            "simulated; add its file, or check it on the controller",
            name,
        )
        yield _finding_at(
            WARNING, "OTHER_PROGRAM", message, motion, int(rows[min(row, len(rows) - 1)])
        )


def _finding_at(level: str, code: str, message: Text, motion: Motion, row: int) -> Finding:
    bead_point = int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row])
    return Finding(Issue(level, code, message, *bead_point), row)
