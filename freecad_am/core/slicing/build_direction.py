# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes (Chalvin 2020, section 2.1), in components along radius, azimuth and axis.

A part of revolution looks the same from every azimuth, so directions are kept as (..., 3) components of the
moving frame (radial, tangential with rising azimuth, axial): one row stands for a whole circle.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..geometry.columns import columns
from ..geometry.profile import Array

SCAN = 48  # tilts tried before the first good one is refined
HALVINGS = 44  # from 90/48 deg to below 1e-12 rad


def local(tangents: Array) -> Array:
    """Tangent to the wall: (n, 3) from meridian tangents (n, 2)."""
    return np.stack([tangents[:, 0], np.zeros(len(tangents)), tangents[:, 1]], axis=1)


def fixed(count: int) -> Array:
    """The axis, (n, 3)."""
    return np.tile([0.0, 0.0, 1.0], (count, 1))


def layer_mean(tangent: Array, azimuth: Array, start: float, end: float) -> Array:
    """One direction for a whole open bead, the mean of its local ones: (n, 3) at the azimuths (n,).

    tangent: (2,) of the meridian; the bead spans start to end rad. Over a full turn the mean is along the axis.
    """
    half = 0.5 * (end - start)
    radial = tangent[0] * np.sin(half) / half
    mean = np.array([radial, tangent[1]])
    norm = np.linalg.norm(mean)
    if norm < 1e-9:
        return fixed(len(azimuth))
    from_middle = azimuth - 0.5 * (start + end)
    r, z = mean / norm
    return np.stack([r * np.cos(from_middle), -r * np.sin(from_middle), np.full(len(azimuth), z)], axis=1)


def held(build: Array, lead: float, tilt: float, rising: bool) -> Array:
    """Tool axes (n, 3) from build directions (n, 3): turned by `lead` forward along the bead, then by `tilt`
    towards the outside of the wall, rad. rising: the bead runs with rising azimuth.
    """
    if lead == 0.0 and tilt == 0.0:
        return build
    out = np.stack([build[:, 2], np.zeros(len(build)), -build[:, 0]], axis=1)
    out = out / np.linalg.norm(out, axis=1, keepdims=True)
    forward = np.cross(build, out) * (1.0 if rising else -1.0)
    leaning = np.cos(lead) * build + np.sin(lead) * forward
    return np.asarray(np.cos(tilt) * leaning + np.sin(tilt) * out)


def from_vertical(directions: Array) -> Array:
    """Angle (n,) rad between directions (n, 3) and the axis."""
    x, y, z = columns(directions)
    angle: Array = np.arctan2(np.hypot(x, y), z)
    return angle


def tilted_back(build: Array, angle: Array) -> Array:
    """Build directions (n, 3) turned by the angle (n,) rad towards the axis, at most onto it."""
    x, y, z = columns(build)
    level = np.hypot(x, y)
    left = np.maximum(np.arctan2(level, z) - angle, 0.0)
    along = build[:, :2] / np.where(level > 0.0, level, 1.0)[:, None]
    turned = np.column_stack([np.sin(left)[:, None] * along, np.cos(left)])
    return np.where((angle > 0.0)[:, None] & (level > 0.0)[:, None], turned, build)


def least_tilt_back(build: Array, low: Array, good: Callable[[NDArray[np.intp], Array], NDArray[np.bool_]]) -> Array:
    """Smallest tilt-back (n,) rad, `low` (n,) or more, at which each row is good; NaN where none is up to the axis.

    good(rows (k,), angles (k,)) -> (k,) bool tells whether the rows are good when tilted back by the angles.
    """
    angle = low.copy()
    rows = np.flatnonzero(~good(np.arange(len(build)), low))
    top = np.maximum(from_vertical(build[rows]), low[rows])
    bad, fine = low[rows].copy(), np.full(len(rows), np.nan)
    for step in range(1, SCAN + 1):
        open_ = np.flatnonzero(np.isnan(fine))
        if len(open_) == 0:
            break
        tried = low[rows[open_]] + (top[open_] - low[rows[open_]]) * (step / SCAN)
        ok = good(rows[open_], tried)
        fine[open_[ok]] = tried[ok]
        bad[open_[~ok]] = tried[~ok]
    known = np.flatnonzero(~np.isnan(fine))
    for _ in range(HALVINGS if len(known) else 0):
        middle = 0.5 * (bad[known] + fine[known])
        ok = good(rows[known], middle)
        fine[known] = np.where(ok, middle, fine[known])
        bad[known] = np.where(ok, bad[known], middle)
    angle[rows] = fine
    return angle
