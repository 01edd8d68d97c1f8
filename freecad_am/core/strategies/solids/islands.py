# SPDX-License-Identifier: LGPL-2.1-or-later
"""In which order the beads of a plane layer are laid: island by island, the nearest next, from inside out in each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...toolpath import Bead
from ...types import Array


def island_by_island(beads: Sequence[Bead], islands: Sequence[int], at: Array | None) -> list[int]:
    """The numbers of beads in the order of deposit. islands: which one each belongs to. at: (3,) mm, where the torch is;
    None: the first island comes first."""
    waiting: dict[int, list[int]] = {}
    for number, island in enumerate(islands):
        waiting.setdefault(island, []).append(number)
    rows = {island: sorted(some, key=lambda number: -beads[number].ring) for island, some in waiting.items()}
    left, order = list(rows), []
    while left:
        starts = np.array([beads[rows[island][0]].points[0] for island in left])
        nearest = 0 if at is None else int(np.argmin(np.linalg.norm(starts - at, axis=1)))
        order += rows[left.pop(nearest)]
        at = beads[order[-1]].points[-1]
    return order


def as_below(beads: Sequence[Bead], islands: Sequence[int], below: Array | None) -> tuple[list[int], Array]:
    """The numbers of beads in the order in which the islands under them were laid, so that all of them cool for as long as
    a layer takes; and the middles (k, 3) of the islands in that order. below: of the layer before, None for the first."""
    rows: dict[int, list[int]] = {}
    for number, island in enumerate(islands):
        rows.setdefault(island, []).append(number)
    middles = {island: np.vstack([beads[number].points for number in some]).mean(axis=0) for island, some in rows.items()}
    order = list(rows)
    if below is not None:
        order.sort(key=lambda island: int(np.argmin(np.linalg.norm(below - middles[island], axis=1))))
    found = [number for island in order for number in sorted(rows[island], key=lambda number: -beads[number].ring)]
    return found, np.array([middles[island] for island in order])
