# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts that differ only in their digits, read together: a program repeats the same line thousands
of times with other numbers. A match in one text is at the same position in all.
"""

from __future__ import annotations

from array import array
from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from ..core.read_moves import TextLines
from ..core.types import Array, Index


def floats() -> array[float]:
    """An empty column of numbers."""
    return array("d")


class Lines:
    """The lines of the moves that were read."""

    def __init__(self) -> None:
        self._files: dict[str, int] = {}
        self._file, self._line = array("l"), array("l")

    def add(self, where: str, times: int = 1) -> None:
        """Add `times` moves from the line `FILE line NUMBER`."""
        file, _, line = where.rpartition(" line ")
        self._file.extend([self._files.setdefault(file, len(self._files))] * times)
        self._line.extend([int(line)] * times)

    def extend(self, file: str, lines: Index) -> None:
        """Add moves from lines (n,) of a file."""
        self._file.extend([self._files.setdefault(file, len(self._files))] * len(lines))
        self._line.extend(lines.tolist())

    def read(self) -> TextLines:
        """The lines of all moves."""
        return TextLines(
            tuple(self._files),
            np.array(self._file, dtype=np.intp),
            np.array(self._line, dtype=np.intp),
        )


_DIGITS = str.maketrans("123456789", "000000000")
_EXACT = 15  # digits of a whole number that a float always holds


def shapes(texts: Sequence[str], between: str = "\n") -> dict[str, list[int]]:
    """The shapes of texts (digits replaced by 0), and the texts of each shape; no text contains
    `between`.
    """
    by_shape: defaultdict[str, list[int]] = defaultdict(list)
    if texts:
        for number, shape in enumerate(between.join(texts).translate(_DIGITS).split(between)):
            by_shape[shape].append(number)
    return by_shape


def numbers(texts: Sequence[str], shape: str, spans: Sequence[tuple[int, int]]) -> Array:
    """(n, k) the decimal numbers at k spans (begin, end) of texts (n,) of one shape."""
    words = [shape[begin:end] for begin, end in spans]
    counts = [word.count("0") for word in words]
    if max(counts) > _EXACT:
        return np.array([[float(text[begin:end]) for begin, end in spans] for text in texts])
    table = np.frombuffer("".join(texts).encode("latin-1"), dtype=np.uint8).reshape(
        len(texts), len(shape)
    )
    digit_columns = [
        position for begin, end in spans for position in range(begin, end) if shape[position] == "0"
    ]
    worth = [10**power for count in counts for power in range(count - 1, -1, -1)]
    digits = (table.T[digit_columns] - np.uint8(ord("0"))) * np.array(worth)[:, None]
    integers = np.add.reduceat(digits, np.cumsum([0, *counts[:-1]]))
    # one division of two whole numbers is rounded as the text itself would be
    divisor = [
        (-1.0 if "-" in word else 1.0) * 10.0 ** word.partition(".")[2].count("0") for word in words
    ]
    values: Array = integers.T / np.array(divisor)
    return values
