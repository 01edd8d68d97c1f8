# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps between the speed of a phase at an end of a bead and the bead's speed, in steps: a move has
one speed.
"""

from __future__ import annotations

import numpy as np

from ..geometry.step_count import round_down, round_up
from ..types import Array

SHARE, STEPS = (
    0.1,
    20,
)  # of the faster speed that a step changes at most, and how many steps there may be
MIN_STEP = 0.5  # mm of a step


def ramp(length: float, start: float, end: float) -> Array:
    """Return the speeds (k,) of k equal parts of `length` mm, between the speeds at its start and
    its end.

    Each is the speed of a steady ramp in the middle of the part. Empty if the length is 0 or the
    speed does not change: a speed of 0 mm/s means that of the other end.
    """
    if length <= 0.0 or start == end or not start or not end:
        return np.zeros(0)
    change = abs(end - start) / max(start, end)
    count = max(1, min(round_up(change / SHARE), STEPS, round_down(length / MIN_STEP)))
    return np.asarray(start + (end - start) * (np.arange(count) + 0.5) / count)
