# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of lines that are needed within a tolerance."""

from __future__ import annotations

import numpy as np

from ...types import Array, Mask
from .region import DIGITS, simplified

ASPECT = 1e-3  # slope of a curve of values, so that they count and their places do not


def select_significant(positions: Array, values: Array, tolerance: float) -> Mask:
    """Return which values (n,) at positions (n,), in order, are needed for linear interpolation
    within the tolerance.
    """
    positions, values = np.round(positions, DIGITS), np.round(values, DIGITS)
    stretch = float(np.ptp(values)) / (ASPECT * max(float(np.ptp(positions)), 1e-300))
    if not stretch > 0.0:
        return np.asarray(np.isin(np.arange(len(positions)), (0, len(positions) - 1)), dtype=bool)
    line = np.round(np.stack([positions * stretch, values], axis=1), DIGITS)
    return np.asarray(np.isin(line[:, 0], simplified(line, tolerance)[:, 0]), dtype=bool)
