# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads instructions of ArcTech: a linear move that stops, with the calls that belong to it in front and behind."""

from __future__ import annotations

import re
from dataclasses import dataclass

_DATA, _OF = re.compile(r"\b(WDAT(?:OFF)?)(\d+)\b"), r"\1@"
_MOVE = "the move"
# the lines of an instruction, @ being the number of its data
_ON = (
    "TRIGGER WHEN DISTANCE=1 DELAY=ArcGetDelay(#PreDefinition,WDAT@) DO ArcMainNG(#PreDefinition,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=ArcGetDelay(#GasPreflow,WDAT@)"
    " DO ArcMainNG(#GasPreflow,WDAT@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOn,WDAT@) DELAY=0 DO ArcMainNG(#ArcOnMoveStd,WDAT@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOnBeforeMoveStd,WDAT@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOnAfterMoveStd,WDAT@,WSEAM)",
)
_OFF = (
    "TRIGGER WHEN PATH=ArcGetPath(#ArcOffBefore,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffBeforeOffStd,WDATOFF@,WSEAM) PRIO=-1",
    "TRIGGER WHEN PATH=ArcGetPath(#OnTheFlyArcOff,WDATOFF@) DELAY=0 DO ArcMainNG(#ArcOffMoveStd,WDATOFF@,WSEAM) PRIO=-1",
    "ArcMainNG(#ArcOffBeforeMoveStd,WDATOFF@,WSEAM)",
    _MOVE,
    "ArcMainNG(#ArcOffAfterMoveStd,WDATOFF@,WSEAM)",
)


@dataclass
class ArcMove:
    """An instruction of ArcTech, as far as it was read: its lines, how many of them were, and the number of its data."""

    lines: tuple[str, ...] = ()
    read: int = 0
    number: str = ""

    @property
    def begun(self) -> bool:
        """Whether more of its lines are to come."""
        return bool(self.lines)

    def moved(self, straight: bool, rounded: bool) -> bool:
        """A move in the modules: whether it may stand here. In an instruction it is a linear one that stops."""
        if not self.begun:
            return True
        right = self.lines[self.read] == _MOVE and straight and not rounded
        self.read += 1
        return right

    def called(self, line: str) -> str | None:
        """'on' or 'off' with the last line of an instruction, '' with the others; None for a line that is none of those it
        has here, or that names other data than the ones before it."""
        numbers, template = {number for _, number in _DATA.findall(line)}, _DATA.sub(_OF, line)
        if not self.begun:
            self.lines, self.read, self.number = (
                (_ON if template == _ON[0] else _OFF),
                0,
                next(iter(numbers), ""),
            )
        if numbers != {self.number} or template != self.lines[self.read]:
            return None
        self.read += 1
        if self.read < len(self.lines):
            return ""
        switched = "on" if self.lines is _ON else "off"
        self.lines = ()
        return switched


def of_arc(line: str) -> bool:
    """Whether a line is of an instruction of ArcTech."""
    return "ArcMainNG(" in line
