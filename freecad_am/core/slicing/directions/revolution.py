# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes (Chalvin 2020, section 2.1), in components along radius, azimuth and axis.

A part of revolution looks the same from every azimuth, so directions are kept as (..., 3) components of the
moving frame (radial, tangential with rising azimuth, axial): one row stands for a whole circle.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...geometry.columns import columns
from ...types import Array, Index, Mask

SCAN = 48  # tilts tried before the first good one is refined
AT_ONCE, PARTS = (
    8,
    4,
)  # of these tried together, and parts that the place of the first good one is narrowed to at once


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
    return np.stack(
        [r * np.cos(from_middle), -r * np.sin(from_middle), np.full(len(azimuth), z)], axis=1
    )


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


def least_tilt_back(
    build: Array,
    low: Array,
    good: Callable[[Index, Array], Mask],
    within: float = 1e-14,
    about: Array | None = None,
    free: Mask | None = None,
) -> Array:
    """Smallest tilt-back (n,) rad, `low` (n,) or more, at which each row is good, to `within` rad; NaN where none is up to
    the axis.

    good(rows (k,), angles (k,)) -> (k,) bool tells whether the rows are good when tilted back by the angles. about: (n, 2)
    angles between which it is looked for first, NaN where nowhere. free: (n,) rows that are known to be good at `low`.
    """
    angle = low.copy()
    rows = np.arange(len(build)) if free is None else np.flatnonzero(~free)
    top = np.maximum(from_vertical(build[rows]), low[rows])
    bad, fine = low[rows].copy(), np.full(len(rows), np.nan)
    tried = low[rows, None]
    if about is not None:
        likely = np.where(
            np.isfinite(about[rows]), np.clip(about[rows], tried, top[:, None]), tried
        )
        tried = np.concatenate([tried, likely], axis=1)
    _narrow(rows, np.arange(len(rows)), tried, good, bad, fine)
    bad[np.isnan(fine)] = low[rows[np.isnan(fine)]]
    for first in range(0, SCAN, AT_ONCE):
        open_ = np.flatnonzero(np.isnan(fine))
        if len(open_) == 0:
            break
        step = np.arange(first + 1, first + AT_ONCE + 1) / SCAN
        start = low[rows[open_], None]
        _narrow(rows, open_, start + (top[open_, None] - start) * step, good, bad, fine)
    share = np.arange(1, PARTS) / PARTS
    while True:
        wide = np.flatnonzero(fine - bad > within)
        if not len(wide):
            break
        _narrow(
            rows, wide, bad[wide, None] + (fine[wide] - bad[wide])[:, None] * share, good, bad, fine
        )
    angle[rows] = fine
    return angle


def _narrow(
    rows: Index,
    some: Index,
    tried: Array,
    good: Callable[[Index, Array], Mask],
    bad: Array,
    fine: Array,
) -> None:
    """Bring the bounds of some rows, in place, to the first of the rising angles tried (k, s) that is good and to the last
    one before it."""
    ok = good(np.repeat(rows[some], tried.shape[1]), tried.ravel()).reshape(tried.shape)
    found = ok.any(axis=1)
    first = np.where(found, ok.argmax(axis=1), tried.shape[1])
    fine[some[found]] = tried[found, first[found]]
    later = np.flatnonzero(first > 0)
    bad[some[later]] = tried[later, first[later] - 1]
