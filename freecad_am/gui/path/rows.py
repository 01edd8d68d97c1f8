# SPDX-License-Identifier: LGPL-2.1-or-later
"""A path as rows: the points of all its beads one after the other, and which rows belong to which bead and layer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from freecad_am.core.types import Array, Index

from ...core.geometry import tubes
from ...core.toolpath import Bead

# sections of tubes in all, and their sides by the number of sections: what a computer draws in software without stutter
SECTIONS, FINE, FINER = 50_000, 30_000, 12_000
PIECE = 4096  # rows of a piece, about


@dataclass(frozen=True, eq=False)
class Rows:
    """n points (n, 3) mm of m beads in order. starts: (m + 1,) first row of each bead, and n. layers: (m,) of each bead,
    rising. width: (n,) mm. read: gives the beads, asked for when more than lines is drawn or told. layer_height: mm of beads
    that know no height of their own, asked for when tubes are drawn. read_bead: gives one bead, where that is soon done."""

    points: Array
    starts: Index
    layers: Index
    width: Array
    read: Callable[[], Sequence[Bead]]
    layer_height: Callable[[], float]
    read_bead: Callable[[int], Bead] | None = None

    @classmethod
    def of(
        cls,
        beads: Sequence[Bead],
        layers: Sequence[int],
        width: float,
        layer_height: Callable[[], float],
    ) -> Rows:
        """`width` (mm) is that of beads that know none."""
        points = np.concatenate([*(bead.points for bead in beads), np.zeros((0, 3))])
        starts = np.concatenate([[0], np.cumsum([len(bead) for bead in beads], dtype=np.intp)])
        columns = [
            np.full(len(bead), width) if bead.width is None else bead.width for bead in beads
        ]
        return cls(
            points,
            starts,
            np.array(layers, dtype=np.intp),
            np.concatenate([*columns, np.zeros(0)]),
            lambda: beads,
            layer_height,
        )

    def __len__(self) -> int:
        return len(self.width)

    @cached_property
    def beads(self) -> tuple[Bead, ...]:
        """The m beads."""
        return tuple(self.read())

    def bead(self, index: int) -> Bead:
        """One of the beads. The first one that is told of is read alone; who asks for another looks through them."""
        if self.read_bead is None or "beads" in vars(self):
            return self.beads[index]
        alone = self._alone
        if not alone:
            alone[index] = self.read_bead(index)
        return alone[index] if index in alone else self.beads[index]

    @cached_property
    def _alone(self) -> dict[int, Bead]:
        return {}

    @cached_property
    def build(self) -> Array:
        """(n, 3) build directions."""
        return np.concatenate([*(bead.build for bead in self.beads), np.zeros((0, 3))])

    @property
    def layer_count(self) -> int:
        """Number of layers; there may be some without beads."""
        return int(self.layers[-1]) + 1 if len(self.layers) else 0

    def of_layers(self, first: int, last: int) -> tuple[int, int]:
        """First row of a layer, and the row after the last of another."""
        low, high = np.searchsorted(self.layers, [first, last + 1])
        return int(self.starts[low]), int(self.starts[high])

    def bead_of(self, row: int) -> int:
        """The bead that a row belongs to."""
        return min(int(np.searchsorted(self.starts, row, side="right")) - 1, len(self.layers) - 1)

    def counts(self, first: int, end: int) -> Index:
        """How many rows of each bead lie from `first` to before `end`."""
        low, high = np.searchsorted(self.starts, [first, end], side="right")
        return np.diff(np.unique(np.concatenate([[first], self.starts[low:high], [end]])))

    @cached_property
    def cuts(self) -> Index:
        """Rows at which the path is cut into pieces: where beads begin, and within long ones."""
        found = [0]
        for start, end in zip(self.starts, self.starts[1:], strict=False):
            if end - found[-1] > PIECE and start > found[-1]:
                found.append(int(start))
            found.extend(range(found[-1] + PIECE, int(end) - PIECE // 2, PIECE))
        return np.array([*found, len(self)] if len(self) > found[-1] else found, dtype=np.intp)

    # ---- tubes

    @cached_property
    def height(self) -> Array:
        """(n,) mm, as predicted, else that of a layer."""
        height = self.layer_height()
        columns = [
            np.full(len(bead), height) if bead.height is None else bead.height
            for bead in self.beads
        ]
        return np.concatenate([*columns, np.zeros(0)])

    @cached_property
    def frames(self) -> tubes.Frames:
        """Across each point."""
        closed = np.array([bead.closed for bead in self.beads], dtype=bool)
        return tubes.frames(self.points, self.build, self.starts, closed)

    @cached_property
    def sections(self) -> Index:
        """The rows that get a section of a tube."""
        return np.flatnonzero(
            tubes.select_sections(self.frames.turn, self.starts, -(-len(self) // SECTIONS))
        )

    @property
    def sides(self) -> int:
        """Of tubes, fewer where there are many."""
        count = len(self.sections)
        return 8 if count <= FINER else 6 if count <= FINE else 4

    def tube(self, first: int, end: int) -> tuple[tubes.Mesh, Index]:
        """Tubes from row `first` to before `end`, and the row of each of their sections."""
        low, high = np.searchsorted(self.sections, [first, end])
        rows = np.unique(np.concatenate([[first], self.sections[low:high], [end - 1]]))
        bead = np.searchsorted(self.starts, rows, side="right")
        ends = np.append(np.diff(bead) > 0, True)
        across = tubes.Frames(*(column[rows] for column in self.frames))
        return tubes.mesh(
            self.points[rows], across, self.width[rows], self.height[rows], ends, self.sides
        ), rows
