# SPDX-License-Identifier: LGPL-2.1-or-later
"""Courses of two turning axes along a bead, from the two ways there are to turn each of its directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...geometry.angles import TURN
from ...types import Array


def continuous(turned: Array) -> list[Array]:
    """Two courses (n, 2) through the branches (2, n, 2), one begun on each, that go straight on through a pole."""
    step = np.diff(turned, axis=1)
    across = turned[::-1, 1:] - turned[:, :-1]
    stay, change = (np.abs(np.remainder(way + np.pi, TURN) - np.pi).sum(axis=(0, 2)) for way in (step, across))
    swaps = np.r_[0, np.cumsum(change < stay - 1e-6)] % 2
    rows = np.arange(turned.shape[1])
    return [np.unwrap(turned[(start + swaps) % 2, rows], axis=0) for start in range(2)]


def kept(angles: Array, free: NDArray[np.bool_]) -> Array:
    """Angles (2, n) with those that are free as they were before, or as they come to be where none was before."""
    known = np.flatnonzero(~free)
    if not len(known):
        return angles
    source = known[np.clip(np.searchsorted(known, np.arange(len(free)), side="right") - 1, 0, None)]
    return angles[:, source]
