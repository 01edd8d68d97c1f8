# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines of the moves of a program in its text: for displays of both, not for read-back."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Integers

from . import catalogue

_NUMBER = re.compile(r"\d+")
_LOOP = re.compile(rb"for \w+=(\d+) to (\d+)")  # of VAL 3, about a single move


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of n moves, in the order of execution. files: names; file: (n,) index into them;
    line: (n,) from 0.
    """

    files: tuple[str, ...]
    file: Integers
    line: Integers

    def __len__(self) -> int:
        return len(self.line)

    def of(self, row: int) -> tuple[str, int]:
        """File and line of a move."""
        return self.files[self.file[row]], int(self.line[row])

    def move_at(self, name: str, line: int) -> int | None:
        """The move in a line of a file, the first one in a loop; between two moves the next one,
        after the last the last one. None for a file without moves.
        """
        moves_of_file = (
            np.flatnonzero(self.file == self.files.index(name))
            if name in self.files
            else np.zeros(0, np.int64)
        )
        if not len(moves_of_file):
            return None
        return int(
            moves_of_file[
                min(int(np.searchsorted(self.line[moves_of_file], line)), len(moves_of_file) - 1)
            ]
        )


def lines_of(post: str, files: dict[str, bytes]) -> Lines:
    """The lines of the moves of a program of ours. Parts of a program are run in the order of their
    numbers.
    """
    pattern = catalogue.load(post).MOVE_LINE
    names = tuple(
        sorted(files, key=lambda name: [int(number) for number in _NUMBER.findall(name)] + [0])
    )
    move_lines = [_moves(pattern, files[name]) for name in names]
    file = np.repeat(np.arange(len(names)), [len(lines) for lines in move_lines])
    return Lines(
        names, file, np.array([line for lines in move_lines for line in lines], dtype=np.int64)
    )


def _moves(pattern: re.Pattern[bytes], content: bytes) -> list[int]:
    """The line of each move of a file, as often as it is run."""
    move_lines: list[int] = []
    times = 1
    for number, line in enumerate(content.split(b"\n")):
        loop = _LOOP.search(line)
        if loop:
            times = int(loop[2]) - int(loop[1]) + 1
        elif pattern.match(line):
            move_lines += [number] * times
            times = 1
    return move_lines
