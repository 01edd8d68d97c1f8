# SPDX-License-Identifier: LGPL-2.1-or-later
"""The number of parts into which a length is cut.

Lengths equal except for their last bits, as two versions of a geometry kernel compute
them, have the same number of parts: without a tolerance a side of five steps would have
five or six.
"""

from __future__ import annotations

import math

import numpy as np

from ..types import Array, Index

TOLERANCE = 1e-9  # of a part, and of the number of parts


def step_count(length: float, step: float, min_count: int = 1) -> int:
    """Return the number of equal parts of a length.

    Parameters
    ----------
    length : float
        The length.
    step : float
        Longest part.
    min_count : int, optional
        Smallest number.

    Returns
    -------
    int
        The number; rounding errors do not add a part.
    """
    return max(min_count, round_up(length / step))


def step_counts(lengths: Array, steps: Array | float, min_count: int = 1) -> Index:
    """Return the number of equal parts of many lengths, as `step_count`.

    Parameters
    ----------
    lengths : (n,) array
        The lengths.
    steps : float or (n,) array
        Longest parts.
    min_count : int, optional
        Smallest number.

    Returns
    -------
    (n,) int array
        The numbers.
    """
    ratio = np.asarray(lengths, dtype=np.float64) / steps
    counts = np.ceil(ratio - TOLERANCE * np.maximum(np.abs(ratio), 1.0))
    return np.asarray(np.maximum(counts, min_count), dtype=np.intp)


def round_up(number: float) -> int:
    """The least whole number that is not below `number` by more than a rounding error."""
    return math.ceil(number - TOLERANCE * max(abs(number), 1.0))


def round_down(number: float) -> int:
    """The greatest whole number that is not above `number` by more than a rounding error."""
    return math.floor(number + TOLERANCE * max(abs(number), 1.0))


# ---- Circles as polylines within a chord error


def turn_segments(radius: float, chord_error: float, turn: float, min_full_turn: int) -> int:
    """Return the number of equal segments of an arc within a chord error.

    Parameters
    ----------
    radius : float
        Radius, mm.
    chord_error : float
        Chord error, mm.
    turn : float
        Extent of the arc, rad.
    min_full_turn : int
        Fewest segments of a full turn; a part of a turn has its share.

    Returns
    -------
    int
        The number, at least 2.

    Notes
    -----
    A segment of angle u leaves the circle by radius (1 - cos(u/2)), hence u <= 2 acos(1 -
    chord_error/radius).

    References
    ----------
    Chalvin 2020, section 2.1.
    """
    share = min(1.0, turn / (2.0 * math.pi))
    fewest = max(2, math.ceil(min_full_turn * share - 1e-9))
    if chord_error >= 2.0 * radius:
        return fewest
    # acos(1 - x) = 2 asin(sqrt(x / 2)), exact also where x is small
    step = 4.0 * math.asin(math.sqrt(0.5 * chord_error / radius))
    return step_count(turn, step, fewest)


def largest_step(acceleration: float, chord_error: float) -> float:
    """Largest parameter step on a curve whose second derivative stays below `acceleration` (mm per parameter^2)."""
    return float(np.sqrt(8.0 * chord_error / acceleration))
