# SPDX-License-Identifier: LGPL-2.1-or-later
"""Listings of FANUC programs taken apart: instructions, moves that follow each other, and recorded positions."""

from __future__ import annotations

import dataclasses
import re
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.issues import Text
from ...core.types import Array, Index, Mask
from .records import Records, records_of, unreadable

_NO_LISTING = "it is not a listing with /PROG, /MN, /POS and /END in this order"
_TITLE = 1000  # bytes that hold the first line
# what a unit of a move says: duration s, speed mm/s, share
UNITS = ("sec", "msec", "mm/sec", "%")
_LINE = re.compile(r" *\d*:(.*?) *; *$")
_MOTION = re.compile(
    r" *\d*: *([JL]) P\[(\d+)(?::[^\]]*)?\] ?(\d*\.?\d+)(%|msec|sec|mm/sec) ?(?:(FINE)|CNT ?(\d+))"
    r"(?: +(TB [^;]*?))? *; *$"
)


class _Instruction(NamedTuple):
    """An instruction and the number of its line; or a run of moves, from `first_move` to the one
    after the last, and the option of the last one, if any.
    """

    number: int
    text: str
    first_move: int = 0
    end: int = 0


@dataclass
class _Moves:
    """All moves of a file in order (n,): their line numbers, positions, speeds with units, whether
    they are straight, and CNT, NaN for moves that stop.
    """

    line: Index
    point: Index
    value: Array
    unit: Index
    straight: Mask
    corner: Array


@dataclass
class Listing:
    """One file: its instructions, its moves, and its positions in the order of their numbers."""

    file: str
    instructions: list[_Instruction]
    moves: _Moves
    records: Records

    @cached_property
    def same_frames(self) -> bool:
        """Whether all positions are seen in the same frames."""
        return len(set(self.records.frames)) == 1

    def rows(self, points: Index) -> Index:
        """Rows of the positions numbered (k,), -1 for missing ones."""
        points_recorded = self.records.point
        if not len(points_recorded):
            return np.full(len(points), -1)
        candidates = np.minimum(np.searchsorted(points_recorded, points), len(points_recorded) - 1)
        return np.where(points_recorded[candidates] == points, candidates, -1)


def _text(content: bytes) -> str:
    return content.decode("latin-1").replace("\r\n", "\n")


def name_of(file: str, content: bytes) -> str:
    """The name of a program, upper case."""
    title = re.match(r"/PROG +(\w+)\s*$", _text(content[:_TITLE]).partition("\n")[0])
    if title is None:
        raise unreadable(file, _NO_LISTING)
    return title[1].upper()


def listing_of(file: str, content: bytes) -> Listing:
    """A file taken apart. InputError UNREADABLE_PROGRAM, naming file and line."""
    text = f"\n{_text(content)}\n"
    marks = [text.find(f"\n{section}\n") for section in ("/MN", "/POS", "/END")]
    if -1 in marks or marks != sorted(marks):
        raise unreadable(file, _NO_LISTING)
    # the records, by far the largest part, are not split into lines
    lines = text[1 : marks[1]].split("\n")
    start, positions = lines.index("/MN"), len(lines)
    instructions, moves = _instructions(file, lines[start + 1 :], start + 2)
    records = records_of(file, lines, text[marks[1] + len("\n/POS\n") : marks[2]], positions)
    return Listing(file, instructions, moves, records)


def _instructions(file: str, lines: list[str], number: int) -> tuple[list[_Instruction], _Moves]:
    """The instructions of lines, the first one numbered `number`, and all moves among them."""
    count = len(lines)
    moves = _Moves(
        np.arange(number, number + count),
        np.zeros(count, dtype=np.intp),
        np.zeros(count),
        np.zeros(count, dtype=np.intp),
        np.zeros(count, dtype=bool),
        np.full(count, np.nan),
    )
    moving, other_rows = np.zeros(count, dtype=bool), []
    options: dict[int, str] = {}  # of moves, by their rows
    for row, line in enumerate(lines):
        move = _MOTION.match(line)
        if move is None:
            other_rows.append(row)
            continue
        moving[row] = True
        moves.point[row], moves.value[row] = int(move[2]), float(move[3])
        moves.unit[row], moves.straight[row] = UNITS.index(move[4]), move[1] == "L"
        if move[6]:
            moves.corner[row] = float(move[6])
        if move[7]:
            options[row] = move[7]
    moves_before = np.cumsum(moving)  # how many moves there are up to a line
    instructions, moves_done = [], 0
    for row in [*sorted([*options, *(row for row in other_rows if lines[row].strip())]), count]:
        option = options.get(row, "")
        upto = row + bool(option)
        moved = int(moves_before[upto - 1]) if upto else 0
        if moved > moves_done:
            instructions.append(_Instruction(0, option, moves_done, moved))
            moves_done = moved
        if row < count and not option:
            statement = _LINE.match(lines[row])
            if statement is None:
                raise unreadable(
                    f"{file} line {number + row}",
                    Text("{!r} is not an instruction", lines[row].strip()),
                )
            instructions.append(_Instruction(number + row, statement[1].strip()))
    return instructions, _Moves(
        *(getattr(moves, entry.name)[moving] for entry in dataclasses.fields(moves))
    )
