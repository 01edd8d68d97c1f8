# SPDX-License-Identifier: LGPL-2.1-or-later
"""Number of parts into which a length is divided; points that divide a box evenly.

Two versions of a geometry kernel compute lengths that differ in the last bits. A tolerance makes
the number of parts equal; without the tolerance, a side of five steps could have five or six.
"""

from __future__ import annotations

import math

import numpy as np

from ..types import Array, Index

TOLERANCE = 1e-9  # parts; relative to the number of parts if greater than 1


def step_count(length: float, step: float, min_count: int = 1) -> int:
    """Return the number of equal parts for dividing a length.

    Parameters
    ----------
    length : float
        The length.
    step : float
        Maximum length of a part.
    min_count : int, optional
        Minimum number.

    Returns
    -------
    int
        Number of parts; rounding errors do not add a part.
    """
    return max(min_count, round_up(length / step))


def step_counts(lengths: Array, steps: Array | float, min_count: int = 1) -> Index:
    """Return the numbers of equal parts for dividing many lengths, as `step_count`.

    Parameters
    ----------
    lengths : (n,) array
        The lengths.
    steps : float or (n,) array
        Maximum lengths of parts.
    min_count : int, optional
        Minimum number.

    Returns
    -------
    (n,) int array
        Numbers of parts.
    """
    ratio = np.asarray(lengths, dtype=np.float64) / steps
    counts = np.ceil(ratio - TOLERANCE * np.maximum(np.abs(ratio), 1.0))
    return np.asarray(np.maximum(counts, min_count), dtype=np.intp)


def round_up(number: float) -> int:
    """Round up to an integer, except for rounding errors."""
    return math.ceil(number - TOLERANCE * max(abs(number), 1.0))


def round_down(number: float) -> int:
    """Round down to an integer, except for rounding errors."""
    return math.floor(number + TOLERANCE * max(abs(number), 1.0))


# ---- Circles as polylines within a chord error


def turn_segments(radius: float, chord_error: float, turn: float, min_full_turn: int) -> int:
    """Return the number of equal segments that approximate an arc within a chord error.

    Parameters
    ----------
    radius : float
        Radius, mm.
    chord_error : float
        Chord error, mm.
    turn : float
        Angle of the arc, rad.
    min_full_turn : int
        Minimum number of segments of a full turn; an arc has a proportional minimum.

    Returns
    -------
    int
        Number of segments, at least 2.

    Notes
    -----
    A segment of angle u deviates from the circle by radius (1 - cos(u/2)), hence u <= 2 acos(1 -
    chord_error/radius).

    References
    ----------
    Chalvin 2020, section 2.1.
    """
    share = min(1.0, turn / (2.0 * math.pi))
    fewest = max(2, math.ceil(min_full_turn * share - 1e-9))
    if chord_error >= 2.0 * radius:
        return fewest
    # acos(1 - x) = 2 asin(sqrt(x / 2)), accurate also for small x
    step = 4.0 * math.asin(math.sqrt(0.5 * chord_error / radius))
    return step_count(turn, step, fewest)


def largest_step(acceleration: float, chord_error: float) -> float:
    """Return the maximum parameter step within a chord error, mm.

    acceleration: upper bound of the curve's second derivative, mm per parameter^2.
    """
    return float(np.sqrt(8.0 * chord_error / acceleration))


# ---- Deterministic, evenly spread points in a box of many dimensions

HALVINGS = 64  # iterations; each at least halves the error


def spread_points(count: int, dimensions: int) -> Array:
    """Return points spread evenly over the unit cube.

    Parameters
    ----------
    count : int
        Number of points.
    dimensions : int
        Number of dimensions.

    Returns
    -------
    (count, dimensions) array
        Coordinates from 0 to 1; every leading subset is evenly spread too.

    Notes
    -----
    The steps are negative powers of the root of x^(dimensions + 1) = x + 1.

    References
    ----------
    Roberts 2018.
    """
    root = 1.0
    for _ in range(HALVINGS):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    steps = root ** -np.arange(1.0, dimensions + 1.0)
    points: Array = np.mod(0.5 + np.arange(count)[:, None] * steps, 1.0)
    return points
