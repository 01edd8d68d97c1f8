# SPDX-License-Identifier: LGPL-2.1-or-later
"""How near each row of a motion is to what the machine cannot do; for its limits see `kinematics.limits`.

Rows with unreachable points have NaN joints, and NaN here too.
"""

from __future__ import annotations

import numpy as np

from ..types import Array, Integers, Mask


def speed_ratios(joints: Array, duration: Array, speed_limits: Array) -> Array:
    """(n, a) mean joint speed on the segment that ends at each row, as a share of the axis' maximum.

    joints: (n, a) rad or mm. duration: (n,) s of that segment; where it is 0 the ratio is 0, or
    infinite if an axis moves. speed_limits: (a,) rad/s or mm/s, infinite if not known.
    """
    moved = np.abs(np.diff(joints, axis=0, prepend=joints[:1]))
    lasts = duration[:, None] > 0.0
    speed = np.where(
        lasts, moved / np.where(lasts, duration[:, None], 1.0), np.where(moved > 0.0, np.inf, moved)
    )
    return np.divide(
        speed,
        speed_limits,
        out=np.zeros_like(speed),
        where=np.isfinite(speed_limits) | np.isnan(speed),
    )


def spread_to_deposit_rows(deposit: Mask, values: Array) -> Array:
    """(n,) the values (k,) of the k rows that deposit, such as the condition of a joint path's beads; NaN on the others."""
    all_rows = np.full(len(deposit), np.nan)
    all_rows[deposit] = values
    return all_rows


def from_next(deposit: Mask, point: Integers, values: Array) -> Array:
    """(n,) values of segments, where the first row of each bead, at which no segment ends, takes the
    value of the next row. deposit, point: (n,) as in a motion.
    """
    first_rows = np.flatnonzero(deposit & (point == 0))
    shifted = values.copy()
    shifted[first_rows] = values[np.minimum(first_rows + 1, len(values) - 1)]
    return shifted
