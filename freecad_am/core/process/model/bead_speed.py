# SPDX-License-Identifier: LGPL-2.1-or-later
"""Travel speeds along a bead: its local radius of curvature, and what a machine can follow of a speed that varies."""

from __future__ import annotations

import numpy as np

from ...geometry.columns import columns, dots, lengths
from ...geometry.ramps import limit_growth
from ...types import Array

MIN_TURN_RAD = 1e-9  # rad of turn over the window; less is none


def radii(flat: Array, closed: bool, window: float) -> Array:
    """Local radius of curvature (n,) mm of a flattened bead, points (n, 2), infinite where straight.

    The path's turn over `window` mm about each point, for a bead as wide as that feels no sharper bend: a corner counts as
    the arc of that length. A closed bead repeats its first point.
    """
    step = np.diff(flat, axis=0)
    x, y = columns(step)
    heading = np.unwrap(np.arctan2(y, x))
    round_turn = (
        float(np.unwrap([heading[-1], heading[0]])[1] - heading[0]) if closed else None
    )  # turn of a whole round
    return _radii(np.linalg.norm(step, axis=1), heading, round_turn, window)


def side_radii(points: Array, build: Array, closed: bool, window: float) -> Array:
    """The same of a bead in space, points (n, 3): how it bends about its build directions (n, 3), to its sides."""
    step = np.diff(points, axis=0)
    incoming, outgoing, up = step[:-1], step[1:], build[1:-1]
    if closed:
        incoming, outgoing, up = (
            np.vstack([rows, closing_row[None]])
            for rows, closing_row in ((incoming, step[-1]), (outgoing, step[0]), (up, build[0]))
        )
    level = dots(incoming, outgoing) - dots(incoming, up) * dots(outgoing, up)
    turn = np.arctan2(dots(np.cross(incoming, outgoing), up), level)
    heading = np.r_[0.0, np.cumsum(turn[: len(step) - 1])]
    return _radii(lengths(step), heading, float(turn.sum()) if closed else None, window)


def _radii(length: Array, heading: Array, round_turn: float | None, window: float) -> Array:
    """The radii at the ends of segments of lengths (n-1,) at headings (n-1,); `round_turn` is the turn of a whole round of a
    closed bead.
    """
    closed = round_turn is not None
    s = np.r_[0.0, np.cumsum(length)]
    if round_turn is not None:
        rounds = max(1, int(np.ceil(window / s[-1])))
        turns = np.arange(-rounds, rounds + 1)
        knots = np.concatenate([s[:-1] + k * s[-1] for k in turns])
        values = np.concatenate([heading + k * round_turn for k in turns])
    else:
        knots, values = s[:-1], heading
    # the heading as a step function of arc length; its means over half a window on either side give the turn between
    total = np.r_[0.0, np.cumsum(values * np.diff(np.r_[knots, knots[-1] + length[-1]]))]
    ends = np.r_[knots, knots[-1] + length[-1]]
    low, high = np.maximum(s - window, ends[0]), np.minimum(s + window, ends[-1])
    mean_before = (np.interp(s, ends, total) - np.interp(low, ends, total)) / np.maximum(
        s - low, 1e-12
    )
    mean_after = (np.interp(high, ends, total) - np.interp(s, ends, total)) / np.maximum(
        high - s, 1e-12
    )
    spacing = 0.5 * (high - low)
    at_end = (s - low < 1e-9) | (high - s < 1e-9)
    turn = np.where(at_end, 0.0, np.abs(mean_after - mean_before))
    if not closed and len(s) > 2:
        turn[[0, -1]] = turn[[1, -2]] * (spacing[[0, -1]] / spacing[[1, -2]])
    radius: Array = np.where(turn > MIN_TURN_RAD, spacing / np.maximum(turn, MIN_TURN_RAD), np.inf)
    return radius


def limit_acceleration(points: Array, speed: Array, closed: bool, acceleration: float) -> Array:
    """Speeds (n,) mm/s no higher than those asked that change by no more than `acceleration` mm/s^2 along points (n, k)."""
    s = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    square = speed * speed
    if closed:
        s = np.r_[s[:-1] - s[-1], s, s[1:] + s[-1]]
        square = np.r_[square[:-1], square, square[1:]]
    limited = np.sqrt(limit_growth(square, 2.0 * acceleration * s))
    n = len(points)
    slowed: Array = limited[n - 1 : 2 * n - 1] if closed else limited
    return np.minimum(slowed, speed)
