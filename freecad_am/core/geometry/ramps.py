# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: what rises and falls no faster than something else lets it, such as squares of speeds."""

import numpy as np

from ..types import Array
from .step_count import round_down, round_up


def limit_growth(ceiling: Array, growth: Array) -> Array:
    """Return the largest values (n,) below a ceiling (n,) that change between neighbours by no
    more than `growth` (n,).

    For squares of speeds, the growth is twice the acceleration times the length along the
    path.
    """
    rising = np.minimum.accumulate(ceiling - growth) + growth
    falling = np.minimum.accumulate((ceiling + growth)[::-1])[::-1] - growth
    lower: Array = np.minimum(rising, falling)
    return lower


# ---- Ramps between the speed of a phase at an end of a bead and the bead's speed, in steps: a
# move has one speed

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
