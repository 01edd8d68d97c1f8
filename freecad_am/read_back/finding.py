# SPDX-License-Identifier: LGPL-2.1-or-later
"""A finding about what a text does, with the row of its motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.issues import ERROR, Issue, Text
from ..core.motion import Motion
from ..core.read_moves import ReadMoves


class Finding(NamedTuple):
    """An issue, and the row of the motion that it is about; None where it is about no row."""

    issue: Issue
    row: int | None

    def line(self, motion: Motion, text: ReadMoves) -> tuple[str, int] | None:
        """File and line, from 1, of the move to the row, the motion being what the text drives; None where it is unknown."""
        if self.row is None or text.lines is None:
            return None
        # the first row of a bead repeats the end of the move before
        return text.lines.at(max(int(np.count_nonzero(motion.moves[: self.row + 1])) - 1, 0))


def error_at(code: str, message: Text, motion: Motion, row: int) -> Finding:
    """An error about a row of the motion."""
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
