# SPDX-License-Identifier: LGPL-2.1-or-later
"""Deterministic, evenly spread points in a box of many dimensions."""

from __future__ import annotations

import numpy as np

from ..types import Array

_ROUNDS = 64  # iterations; each at least halves the error


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
    for _ in range(_ROUNDS):
        root = (1.0 + root) ** (1.0 / (dimensions + 1))
    steps = root ** -np.arange(1.0, dimensions + 1.0)
    points: Array = np.mod(0.5 + np.arange(count)[:, None] * steps, 1.0)
    return points
