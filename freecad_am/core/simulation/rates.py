# SPDX-License-Identifier: LGPL-2.1-or-later
"""Speeds, accelerations and jerks of the axes along the beads of a motion, by differences over its points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..motion import Motion
from ..types import Array


@dataclass(frozen=True, eq=False)
class Rates:
    """Columns (n, axes) of the n rows of a motion, rad or mm per s, s^2 and s^3; NaN in rapid moves and where unreachable.

    speed: mean over the segment that ends at the row. acceleration: at the row, from the segment before it to that after it,
    NaN at both ends of a bead. jerk: from the row before to the row.
    """

    speed: Array
    acceleration: Array
    jerk: Array


def rates(motion: Motion) -> Rates:
    """The rates of a motion at the speed that is asked for."""
    within = motion.deposit & (motion.point > 0) & (motion.duration > 0.0)
    time = np.where(within, motion.duration, np.nan)[:, None]
    speed = np.diff(motion.joints, axis=0, prepend=motion.joints[:1]) / time
    # rows of a bead are consecutive and the first is NaN, so differences across its ends are NaN
    between = 0.5 * (time[:-1] + time[1:])
    acceleration, jerk = np.full_like(speed, np.nan), np.full_like(speed, np.nan)
    acceleration[:-1] = np.diff(speed, axis=0) / between
    jerk[1:-1] = np.diff(acceleration[:-1], axis=0) / (0.5 * (between[:-1] + between[1:]))
    return Rates(speed, acceleration, jerk)
