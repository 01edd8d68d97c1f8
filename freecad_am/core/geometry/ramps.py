# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps along a path: limit the rate at which a quantity, such as squared speed, changes."""

import numpy as np

from ..types import Array
from .step_count import round_down, round_up


def limit_growth(ceiling: Array, growth: Array) -> Array:
    """Return the maximum values below a ceiling that change no faster than a limit.

    Parameters
    ----------
    ceiling : (n,) array
        Upper bounds.
    growth : (n,) array
        Permitted accumulated change from the start to each point; its differences limit the
        changes between neighbours.

    Returns
    -------
    (n,) array
        The values.

    Notes
    -----
    For squared speeds, `growth` is twice the acceleration times the path length.
    """
    rising = np.minimum.accumulate(ceiling - growth) + growth
    falling = np.minimum.accumulate((ceiling + growth)[::-1])[::-1] - growth
    lower: Array = np.minimum(rising, falling)
    return lower


# ---- Stepped ramps between the speed at a bead end and the speed of the bead: a move has one speed

SHARE, STEPS = (
    0.1,
    20,
)  # maximum change per step as a fraction of the faster speed; maximum number of steps
MIN_STEP = 0.5  # mm; minimum step length


def ramp(length: float, start: float, end: float) -> Array:
    """Return the speeds of equal parts of a ramp.

    Each speed is that of a linear ramp at the midpoint of the part.

    Parameters
    ----------
    length : float
        Length of the ramp, mm.
    start, end : float
        Speeds at the ends of the ramp, mm/s; 0 means the speed of the other end.

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
