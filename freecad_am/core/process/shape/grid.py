# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of each small cube of space is filled. Cubes are kept in blocks of 8 x 8 x 8, those alone that something is in:
a wall of one bead takes no room for what it stands round."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index

SIDE = 8  # cubes along a block
CUBES = SIDE**3
_MIDDLE = 1 << 20  # numbers of blocks along an axis, on either side of the origin


class Grid:
    """Cubes of an edge, mm, one corner of one of them in the origin. filled: (blocks * CUBES,) shares of the cubes, by their
    places; places are those of `places`, and stay what they are."""

    def __init__(self, edge: float) -> None:
        self.edge = edge
        self.filled = np.zeros(0)
        self._keys = np.zeros(0, dtype=np.int64)  # of blocks, sorted
        self._slots = np.zeros(0, dtype=np.int64)  # where each block is
        self._corners = np.zeros(
            (0, 3), dtype=np.int64
        )  # the first cube of each block, by its slot

    def places(self, cubes: Index, make: bool = True) -> Index:
        """Places (n,) of cubes (n, 3), whole numbers along the axes; blocks that are not there are made, or are -1."""
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
        found = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
        place = (
            self._slots[found] * CUBES + (within[:, 0] * SIDE + within[:, 1]) * SIDE + within[:, 2]
        )
        there: Index = place if make else np.where(self._keys[found] == key, place, -1)
        return there

    def _make(self, key: Index, block: Index) -> None:
        wanted, first = np.unique(key, return_index=True)
        new = ~np.isin(wanted, self._keys, assume_unique=True)
        if not new.any():
            return
        count = len(self._keys)
        self._corners = np.concatenate([self._corners, block[first[new]] << 3])
        self._slots = np.concatenate([self._slots, count + np.arange(int(new.sum()))])
        keys = np.concatenate([self._keys, wanted[new]])
        order = np.argsort(keys)
        self._keys, self._slots = keys[order], self._slots[order]
        self.filled = np.concatenate([self.filled, np.zeros(CUBES * int(new.sum()))])

    def centres(self, places: Index) -> Array:
        """Middles (n, 3) mm of cubes at places (n,)."""
        slot, within = np.divmod(places, CUBES)
        own = np.stack([within // (SIDE * SIDE), within // SIDE % SIDE, within % SIDE], axis=1)
        found: Array = (self._corners[slot] + own + 0.5) * self.edge
        return found

    def at(self, points: Array) -> Array:
        """How full it is (n,) at points (n, 3) mm, between the middles of cubes in proportion."""
        along = points / self.edge - 0.5
        low = np.floor(along).astype(np.int64)
        share = along - low
        total = np.zeros(len(points))
        for corner in np.ndindex(2, 2, 2):
            place = self.places(low + np.array(corner), make=False)
            weight = np.where(corner, share, 1.0 - share).prod(axis=1)
            total += weight * np.where(place >= 0, self.filled[place], 0.0)
        return total

    @property
    def volume(self) -> float:
        """mm3 that are filled."""
        return float(self.filled.sum()) * self.edge**3
