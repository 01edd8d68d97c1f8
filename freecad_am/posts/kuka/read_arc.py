# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads instructions of ArcTech: a linear move that stops, with the calls that belong to it in front and behind."""

from __future__ import annotations

import re
from dataclasses import dataclass

_DATA, _OF = re.compile(r"\b(WDAT(?:OFF)?)(\d+)\b"), r"\1@"
_MOVE = "the move"
# the lines of an instruction; @ is the number of its data
_ON_LINES = (
    "TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,WDAT@) DO ArcMainNG(#PreDefinition,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=ArcGetDelay(#GasPreflow,WDAT@)"
    " DO ArcMainNG(#GasPreflow,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=0 DO ArcMainNG(#ArcOnMoveStd,WDAT@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOnBeforeMoveStd,WDAT@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOnAfterMoveStd,WDAT@,WSEAM)",
)
_OFF_LINES = (
    "TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffBeforeOffStd,WDATOFF@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffMoveStd,WDATOFF@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOffBeforeMoveStd,WDATOFF@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOffAfterMoveStd,WDATOFF@,WSEAM)",
)


@dataclass
class ArcMove:
    """An instruction of ArcTech while it is read: its lines, the number of lines read, and the
    number of its data.
    """

    lines: tuple[str, ...] = ()
    lines_read: int = 0
    number: str = ""

    @property
    def is_open(self) -> bool:
        """Whether more of its lines are to come."""
        return bool(self.lines)

    def accept_move(self, straight: bool, rounded: bool) -> bool:
        """Whether a move is allowed here. Within an instruction it is a linear one that stops."""
        if not self.is_open:
            return True
        right = self.lines[self.lines_read] == _MOVE and straight and not rounded
        self.lines_read += 1
        return right

    def called(self, line: str) -> str | None:
        """'on' or 'off' with the last line of an instruction, '' with earlier lines; None for an
        unexpected line, or one that names other data than the lines before it.
        """
        numbers, template = {number for _, number in _DATA.findall(line)}, _DATA.sub(_OF, line)
        if not self.is_open:
            self.lines, self.lines_read, self.number = (
                (_ON_LINES if template == _ON_LINES[0] else _OFF_LINES),
                0,
                next(iter(numbers), ""),
            )
        if numbers != {self.number} or template != self.lines[self.lines_read]:
            return None
        self.lines_read += 1
        if self.lines_read < len(self.lines):
            return ""
        switched = "on" if self.lines is _ON_LINES else "off"
        self.lines = ()
        return switched


def is_arc_line(line: str) -> bool:
    """Whether a line belongs to an instruction of ArcTech."""
    return "ArcMainNG(" in line
