# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tilt-backs are looked for: build directions, each for a whole bead or for a place of one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...types import Array, Index, Mask


@dataclass(frozen=True, eq=False)
class Cases:
    """One row per case to be judged: bead (k,), build direction (k, 3), running sense (k,). chained: all are along one bead,
    on which directions run evenly from one to the next."""

    bead: Index
    build: Array
    rising: Mask
    chained: bool = False

    def before(self, mask: Mask) -> Mask:
        """(k,) the cases of beads that are deposited before the beads of some cases, (k,) with at least one."""
        earlier: Mask = self.bead < self.bead[mask.argmax()]
        return earlier

    def together(self, angle: Array) -> Array:
        """The largest tilt-back (k,) of each bead's cases, or of each and its neighbours, so that interpolated ones are never too small;
        NaN if one has none.
        """
        if self.chained:
            larger: Array = np.maximum(
                angle, np.maximum(np.r_[angle[1:], 0.0], np.r_[0.0, angle[:-1]])
            )
            return larger
        is_first = np.diff(self.bead, prepend=-1) > 0
        worst: Array = np.maximum.reduceat(angle, np.flatnonzero(is_first))[np.cumsum(is_first) - 1]
        return worst
