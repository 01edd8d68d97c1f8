# SPDX-License-Identifier: LGPL-2.1-or-later
"""The planned rows that a text is compared with, and how a finding names its place."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Index, Mask

from ..core.issues import ERROR, Issue, Text
from ..core.motion import Motion

# what rounding in the computation itself may amount to: mm, and of unit vectors
COMPUTED_MM, COMPUTED_AXIS = 1e-6, 1e-9
PIECE = 4096  # moves that are looked at together: the poses of all of them at once would take all memory


class Planned:
    """The rows of the motion that a controller moves to, with the finding of a place."""

    def __init__(self, motion: Motion, rows: Index) -> None:
        self.rows, self.motion = rows, motion
        self.deposit, self.joints = motion.deposit[rows], motion.joints[rows]
        self.position, self.tool = motion.position[rows], motion.tool[rows]
        self.duration, self.speed = motion.duration[rows], motion.speed[rows]
        self.stops, self.halt = motion.stops[rows], motion.halt[rows]
        # moves that begin where another one ended: of beads, and of rapids
        moved = np.arange(len(rows)) > 0
        self.ends, self.rapids = (
            np.flatnonzero(self.deposit & moved),
            np.flatnonzero(~self.deposit & moved),
        )

    def issue(self, code: str, wrong: Mask, message: str) -> list[Issue]:
        """An error at the first wrong move, none when there is none; the message says how many there are."""
        if not wrong.any():
            return []
        count, first_row = int(wrong.sum()), int(np.argmax(wrong))
        return [
            Issue(
                ERROR,
                code,
                Text("{}; {} of {} moves", message, count, len(wrong)),
                *self.place(first_row),
            )
        ]

    def place(self, move: int) -> tuple[int, int, int]:
        """Layer, bead and point of a move; of the last one for what follows it."""
        row = self.rows[min(move, len(self.rows) - 1)]
        layer, bead, point = (
            int(column[row]) for column in (self.motion.layer, self.motion.bead, self.motion.point)
        )
        return layer, bead, point


def pieces(rows: Index) -> list[Index]:
    """Rows (n,) in pieces that are looked at one after the other."""
    return [rows[start : start + PIECE] for start in range(0, len(rows), PIECE)]
