# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rows of a motion along an axis of time or of path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Array, Index, Integers, Mask

from .chart import Quantity
from .source import Source

TIME, PATH = "time", "path"
OVER = (TIME, PATH)
# units of time in s and of path in mm, largest first; a unit is taken when there are at least three of it
TIMES: tuple[tuple[float, str], ...] = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))
LENGTHS: tuple[tuple[float, str], ...] = ((1000.0, "m"), (1.0, "mm"))


@dataclass(frozen=True, eq=False)
class Rows:
    """k places along a job. index: (k,) the row of the motion each is about. x: (k,), never falling, in the unit of
    `quantity`. standing: (k,) bool, where the machine has stood at its row since the place before. borders: x of the
    beginnings of layers, and layers, their numbers."""

    index: Index
    x: Array
    standing: Mask
    layer: Integers
    quantity: Quantity
    borders: Array
    layers: Integers

    def at(self, values: Array) -> Array:
        """(k, ...) values (n, ...) of rows, such as where the axes are."""
        found: Array = values[self.index]
        return found

    def along(self, values: Array) -> Array:
        """(k, ...) values (n, ...) of the segments that end at the rows, such as speeds; 0 where it stands."""
        found = values[self.index]
        found[self.standing] = 0.0
        return found


def rows(source: Source, over: str = TIME, layers: tuple[int, int] | None = None) -> Rows:
    """The rows of layers, the last included, of all when left out. over: TIME, s of the job with its waits; or PATH, the way
    of the deposition point, rapid moves included."""
    motion, times = source.motion, source.times
    waits = times.leave > times.arrive
    index = np.repeat(np.arange(len(motion)), 1 + waits)
    standing = np.concatenate([np.zeros(min(1, len(index)), dtype=bool), np.diff(index) == 0])
    if over == TIME:
        x, units, total = (
            np.where(standing, times.leave[index], times.arrive[index]),
            TIMES,
            times.total,
        )
    else:
        way = np.cumsum(
            np.nan_to_num(
                np.linalg.norm(
                    np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1
                )
            )
        )
        x, units, total = way[index], LENGTHS, float(way[-1]) if len(way) else 0.0
    unit, name = next((size, name) for size, name in units if total >= 3.0 * size or size == 1.0)
    x = np.maximum.accumulate(x / unit)  # sums of times fall by rounding
    layer = motion.layer[index]
    if layers is not None:
        taken = (layer >= layers[0]) & (layer <= layers[1])
        index, x, standing, layer = index[taken], x[taken], standing[taken], layer[taken]
    starts = np.flatnonzero(np.diff(layer, prepend=-1))
    return Rows(index, x, standing, layer, Quantity(over, name), x[starts], layer[starts])
