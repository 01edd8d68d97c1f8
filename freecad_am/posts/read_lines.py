# SPDX-License-Identifier: LGPL-2.1-or-later
"""Record the lines of a program text from which a reader took its moves."""

from __future__ import annotations

from array import array

import numpy as np

from ..core.read_moves import TextLines
from ..core.types import Index


def floats() -> array[float]:
    """Return an empty column of numbers."""
    return array("d")


class Lines:
    """The lines of the moves read so far."""

    def __init__(self) -> None:
        self._files: dict[str, int] = {}
        self._file, self._line = array("l"), array("l")

    def add(self, where: str, times: int = 1) -> None:
        """Add `times` moves from the line `FILE line NUMBER`."""
        file, _, line = where.rpartition(" line ")
        self._file.extend([self._files.setdefault(file, len(self._files))] * times)
        self._line.extend([int(line)] * times)

    def extend(self, file: str, lines: Index) -> None:
        """Add moves.

        Parameters
        ----------
        file : str
            Name of the file with the moves.
        lines : (n,) array of int
            Lines of the moves.
        """
        self._file.extend([self._files.setdefault(file, len(self._files))] * len(lines))
        self._line.extend(lines.tolist())

    def read(self) -> TextLines:
        """Return the lines of all moves."""
        return TextLines(
            tuple(self._files),
            np.array(self._file, dtype=np.intp),
            np.array(self._line, dtype=np.intp),
        )
