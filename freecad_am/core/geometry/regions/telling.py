# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of lines that tell something."""

from __future__ import annotations

import numpy as np

from ...types import Array, Mask
from .region import DIGITS, simplified

FLAT = 1e-3  # slope of a curve of values, so that they count and their places do not


def telling(at: Array, values: Array, tolerance: float) -> Mask:
    """Which of values (n,) at places (n,), in order, are needed so that straight lines between them tell all within the
    tolerance."""
    at, values = np.round(at, DIGITS), np.round(values, DIGITS)
    stretch = float(np.ptp(values)) / (FLAT * max(float(np.ptp(at)), 1e-300))
    if not stretch > 0.0:
        return np.asarray(np.isin(np.arange(len(at)), (0, len(at) - 1)), dtype=bool)
    line = np.round(np.stack([at * stretch, values], axis=1), DIGITS)
    return np.asarray(np.isin(line[:, 0], simplified(line, tolerance)[:, 0]), dtype=bool)
