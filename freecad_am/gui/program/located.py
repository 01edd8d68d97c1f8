# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which line of a program takes the tool to which point of the path, and the other way round."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ...core.motion import Motion
from ...posts.lines import Lines, lines_of
from ..path import dock as path_dock
from ..texts.translation import tr


@dataclass(frozen=True)
class Located:
    """The moves of a program's text, in the order of its rows. rows: (n,) of the motion, to which they lead."""

    motion: Motion
    rows: Any
    lines: Lines

    @classmethod
    def of(cls, post: str, files: dict[str, bytes], motion: Motion) -> Located | None:
        """Of a program as it runs; None where its lines are not one for each move."""
        lines, rows = lines_of(post, files), np.flatnonzero(motion.moves)
        return cls(motion, rows, lines) if len(lines) == len(rows) else None

    def row_at(self, name: str, line: int) -> int | None:
        """The row of the motion that a line of a file, from 0, leads to; None in a file without moves."""
        move = self.lines.move_at(name, line)
        return None if move is None else int(self.rows[move])

    def line_at(self, layer: int, bead: int, position: Array) -> tuple[str, int] | None:
        """File and line, from 0, that lay the point of a bead that is nearest to a position (3,), mm; None where the program
        has none of it."""
        motion, rows = self.motion, self.rows
        mine = np.flatnonzero(
            motion.deposit[rows] & (motion.layer[rows] == layer) & (motion.bead[rows] == bead)
        )
        if not len(mine):
            return None
        away = np.linalg.norm(motion.position[rows[mine]] - position, axis=1)
        return self.lines.of(int(mine[int(away.argmin())]))

    def text_at(self, row: int) -> str:
        """A row of the motion in words."""
        motion = self.motion
        place = tr("layer {} bead {}").format(int(motion.layer[row]), int(motion.bead[row]))
        if not motion.deposit[row]:
            return tr("{}: on the approach").format(place)
        return tr("{} point {}").format(place, int(motion.point[row]))

    def show(self, path: Any, row: int) -> None:
        """Show the joint path in the 3D view up to a row; of a rapid, up to the bead that it leads to."""
        motion, shown = self.motion, path.ViewObject.Proxy.rows
        layer, bead = int(motion.layer[row]), int(motion.bead[row])
        beads = [] if shown is None else np.flatnonzero(shown.layers == layer)
        if bead >= len(beads):
            return
        start, end = shown.starts[beads[bead]], shown.starts[beads[bead] + 1]
        away = np.linalg.norm(shown.points[start:end] - motion.position[row], axis=1)
        path_dock.go_to(path, layer, bead, int(away.argmin()) if motion.deposit[row] else 0)
