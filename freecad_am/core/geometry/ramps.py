# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: what rises and falls no faster than something else lets it, such as squares of speeds."""

import numpy as np

from ..types import Array
from .step_count import round_down, round_up


def limit_growth(ceiling: Array, growth: Array) -> Array:
    """Return the largest values below a ceiling that change no faster than a limit.

    Parameters
    ----------
    ceiling : (n,) array
        Upper bounds.
    growth : (n,) array
        Accumulated change allowed from the start to each point; its differences limit
        neighbours.

    Returns
    -------
    (n,) array
        The values.

    Notes
    -----
    For squares of speeds, the growth is twice the acceleration times the length along the path.
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
    """Return the speeds of equal parts of a ramp.

    Each is the speed of a steady ramp in the middle of the part.

    Parameters
    ----------
    length : float
        Length of the ramp, mm.
    start, end : float
        Speeds at its ends, mm/s; 0 means that of the other end.

    Returns
    -------
    (k,) array
        Speeds, mm/s; empty if the length is 0 or the speed does not change.
    """
    if length <= 0.0 or start == end or not start or not end:
        return np.zeros(0)
    change = abs(end - start) / max(start, end)
    count = max(1, min(round_up(change / SHARE), STEPS, round_down(length / MIN_STEP)))
    return np.asarray(start + (end - start) * (np.arange(count) + 0.5) / count)
