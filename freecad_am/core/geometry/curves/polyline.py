# SPDX-License-Identifier: LGPL-2.1-or-later
"""Circles as polylines within a chord error."""

from __future__ import annotations

import math

import numpy as np

from ..step_count import step_count


def turn_segments(radius: float, chord_error: float, turn: float, min_full_turn: int) -> int:
    """Return the number of equal segments for an arc of `turn` rad that keeps within the chord
    error (mm).

    A segment of angle u leaves the circle by radius (1 - cos(u/2)), hence u <= 2 acos(1 -
    chord_error/radius) (Chalvin 2020, section 2.1). `min_full_turn` is the fewest segments of
    a full turn; a part of a turn has its share.
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
