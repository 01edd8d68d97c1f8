# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of each small cube of space is filled. Cubes are kept in blocks of 8 x 8 x 8, only those with deposit: a single-bead
wall takes no room for the space it encloses.
"""

from __future__ import annotations

import numpy as np

from ...types import Array, Index

SIDE = 8  # cubes along a block
CUBES = SIDE**3
_MIDDLE = 1 << 20  # numbers of blocks along an axis, on either side of the origin


class Grid:
    """Cubes of an edge, mm, with a corner of one cube in the origin. filled: (blocks * CUBES,) shares of the cubes, by the indices
    of `indices_of`, which do not change.
    """

    def __init__(self, edge: float) -> None:
        self.edge = edge
        self.filled = np.zeros(0)
        self._keys = np.zeros(0, dtype=np.int64)  # of blocks, sorted
        self._slots = np.zeros(0, dtype=np.int64)  # where each block is
        self._corners = np.zeros(
            (0, 3), dtype=np.int64
        )  # the first cube of each block, by its slot

    def indices_of(self, cubes: Index, make: bool = True) -> Index:
        """Indices (n,) of cubes (n, 3), whole numbers along the axes; a missing block is made, or gives -1."""
        block = cubes >> 3
        within = cubes - (block << 3)
        key = (
            ((block[:, 0] + _MIDDLE) << 42)
            | ((block[:, 1] + _MIDDLE) << 21)
            | (block[:, 2] + _MIDDLE)
        )
        if make:
            self._make(key, block)
        if not len(self._keys):
            return np.full(len(cubes), -1, dtype=np.intp)
        slot_row = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        index = (
            self._slots[slot_row] * CUBES
            + (within[:, 0] * SIDE + within[:, 1]) * SIDE
            + within[:, 2]
        )
        indices: Index = index if make else np.where(self._keys[slot_row] == key, index, -1)
        return indices

    def _make(self, key: Index, block: Index) -> None:
        unique_keys, block_row = np.unique(key, return_index=True)
        new = ~np.isin(unique_keys, self._keys, assume_unique=True)
        if not new.any():
            return
        count = len(self._keys)
        self._corners = np.concatenate([self._corners, block[block_row[new]] << 3])
        self._slots = np.concatenate([self._slots, count + np.arange(int(new.sum()))])
        keys = np.concatenate([self._keys, unique_keys[new]])
        order = np.argsort(keys)
        self._keys, self._slots = keys[order], self._slots[order]
        self.filled = np.concatenate([self.filled, np.zeros(CUBES * int(new.sum()))])

    def centres(self, indices: Index) -> Array:
        """Middles (n, 3) mm of cubes at indices (n,)."""
        slot, within = np.divmod(indices, CUBES)
        local = np.stack([within // (SIDE * SIDE), within // SIDE % SIDE, within % SIDE], axis=1)
        centres_: Array = (self._corners[slot] + local + 0.5) * self.edge
        return centres_

    def fill_at(self, points: Array) -> Array:
        """How full the grid is (n,) at points (n, 3) mm, interpolated between the middles of cubes."""
        along = points / self.edge - 0.5
        low = np.floor(along).astype(np.int64)
        share = along - low
        total = np.zeros(len(points))
        for corner in np.ndindex(2, 2, 2):
            index = self.indices_of(low + np.array(corner), make=False)
            weight = np.where(corner, share, 1.0 - share).prod(axis=1)
            total += weight * np.where(index >= 0, self.filled[index], 0.0)
        return total

    @property
    def volume(self) -> float:
        """mm3 that are filled."""
        return float(self.filled.sum()) * self.edge**3
