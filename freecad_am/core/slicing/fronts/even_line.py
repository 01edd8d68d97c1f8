# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polylines spread evenly and rounded, and smooth curves through them."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ...types import Array


def resample(points: Array, closed: bool, count: int) -> Array:
    """Resample a polyline evenly: (count, 3) points of a closed one, (count + 1, 3) with both
    ends of an open one.
    """
    if closed and (points[0] != points[-1]).any():
        points = np.vstack([points, points[:1]])
    s = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    positions = np.linspace(0.0, s[-1], count + 1)
    resampled = np.column_stack([np.interp(positions, s, column) for column in points.T])
    return resampled[:-1] if closed else resampled


def smooth_points(points: Array, closed: bool, wide: float) -> Array:
    """Return means over neighbours with normal weights, standard deviation `wide` points; the
    ends of an open line stay.
    """
    reach = min(int(np.ceil(3.0 * wide)), len(points) - 1)
    share = np.exp(-0.5 * (np.arange(-reach, reach + 1) / max(wide, 1e-9)) ** 2)
    share /= share.sum()
    if closed:
        padded = np.vstack([points[-reach:], points, points[:reach]]) if reach else points
    else:
        start, end = points[:1], points[-1:]
        padded = np.vstack(
            [2.0 * start - points[reach:0:-1], points, 2.0 * end - points[-2 : -reach - 2 : -1]]
        )
    return np.column_stack([np.convolve(column, share, mode="valid") for column in padded.T])


def spline(points: Array, closed: bool) -> tuple[Array, Array]:
    """Parameters (n,) and derivatives (n, 3) of a smooth curve through points; a closed one repeats its first."""
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return w, CubicSpline(w, points, bc_type="periodic" if closed else "not-a-knot")(w, 1)
