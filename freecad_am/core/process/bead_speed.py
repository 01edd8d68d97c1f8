# SPDX-License-Identifier: LGPL-2.1-or-later
"""Travel speeds along a bead: its local radius of curvature, and what a machine can follow of a speed that varies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.columns import columns

Array = NDArray[np.float64]

STRAIGHT = 1e-9  # rad of turn over the window; less is none


def radii(flat: Array, closed: bool, window: float) -> Array:
    """Local radius of curvature (n,) mm of a bead laid flat, points (n, 2), infinite where straight.

    The way's turn over `window` mm about each point, for a bead as wide as that feels no sharper bend: a corner counts as
    the arc of that length. A closed bead repeats its first point.
    """
    step = np.diff(flat, axis=0)
    length = np.linalg.norm(step, axis=1)
    s = np.r_[0.0, np.cumsum(length)]
    x, y = columns(step)
    heading = np.unwrap(np.arctan2(y, x))
    if closed:
        last = np.unwrap([heading[-1], heading[0]])[1] - heading[0]  # turn of a whole round
        rounds = max(1, int(np.ceil(window / s[-1])))
        turns = np.arange(-rounds, rounds + 1)
        knots = np.concatenate([s[:-1] + k * s[-1] for k in turns])
        values = np.concatenate([heading + k * last for k in turns])
    else:
        knots, values = s[:-1], heading
    # the heading as a step function of the way; its mean over half a window on either side tells the turn between
    total = np.r_[0.0, np.cumsum(values * np.diff(np.r_[knots, knots[-1] + length[-1]]))]
    ends = np.r_[knots, knots[-1] + length[-1]]
    low, high = np.maximum(s - window, ends[0]), np.minimum(s + window, ends[-1])
    before = (np.interp(s, ends, total) - np.interp(low, ends, total)) / np.maximum(s - low, 1e-12)
    after = (np.interp(high, ends, total) - np.interp(s, ends, total)) / np.maximum(high - s, 1e-12)
    apart = 0.5 * (high - low)
    at_end = (s - low < 1e-9) | (high - s < 1e-9)
    turn = np.where(at_end, 0.0, np.abs(after - before))
    if not closed and len(s) > 2:
        turn[[0, -1]] = turn[[1, -2]] * (apart[[0, -1]] / apart[[1, -2]])
    radius: Array = np.where(turn > STRAIGHT, apart / np.maximum(turn, STRAIGHT), np.inf)
    return radius


def followed(points: Array, speed: Array, closed: bool, acceleration: float) -> Array:
    """Speeds (n,) mm/s no higher than those asked that change by no more than `acceleration` mm/s^2 along points (n, k)."""
    s = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    square = speed * speed
    if closed:
        s = np.r_[s[:-1] - s[-1], s, s[1:] + s[-1]]
        square = np.r_[square[:-1], square, square[1:]]
    slope = 2.0 * acceleration * s
    rising = np.minimum.accumulate(square - slope) + slope
    falling = np.minimum.accumulate((square + slope)[::-1])[::-1] - slope
    limited = np.sqrt(np.minimum(rising, falling))
    n = len(points)
    kept: Array = limited[n - 1 : 2 * n - 1] if closed else limited
    return np.minimum(kept, speed)
