# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall known by samples: bicubic splines through a grid of points.

For faces whose exact evaluation is slow, and for walls put together from several faces.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.spatial import cKDTree

from ...types import Array
from .surface import dot

WRAPPED = 6  # columns repeated on either side of a periodic table; the influence of a spline's end falls by 3.7 per knot
ITERATIONS = 30


class Tabulated:
    """The surface through points (n, m, 3), mm, at the rising parameters u (n,) and v (m,), n, m >= 4.

    A periodic table leaves out the column at v[0] + period. Below and above the table in u the wall goes on straight
    along its last derivative, so that a layer may pass the wall's end before it is trimmed; v of an open wall is kept
    inside.
    """

    def __init__(self, u: Array, v: Array, points: Array, period: float | None = None) -> None:
        if points.shape != (len(u), len(v), 3) or min(len(u), len(v)) < 4:
            raise ValueError("a table of points needs the shape (n, m, 3) with n, m >= 4")
        self._period = period
        self.u, self.v, self.points = u, v, points
        if period is not None:
            column = np.arange(-WRAPPED, len(v) + WRAPPED)
            v = v[column % len(v)] + period * (column // len(v))
            points = points[:, column % len(self.v)]
        self._splines = [RectBivariateSpline(u, v, points[..., k]) for k in range(3)]
        self._tree: cKDTree | None = None

    @property
    def period(self) -> float | None:
        """Period of v, None when the wall is open."""
        return self._period

    @property
    def rise_period(self) -> None:
        """None: the table ends."""
        return None

    def point(self, u: Array, v: Array) -> Array:
        """Points (..., 3)."""
        u, v, beyond = self._inside(u, v)
        point = self._evaluated(u, v, 0, 0)
        return point + beyond * self._evaluated(u, v, 1, 0) if beyond.any() else point

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Points and first derivatives."""
        u, v, beyond = self._inside(u, v)
        point, along, around = (self._evaluated(u, v, *order) for order in ((0, 0), (1, 0), (0, 1)))
        if beyond.any():
            point, around = point + beyond * along, around + beyond * self._evaluated(u, v, 1, 1)
        return point, along, around

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return (u, v) of the nearest points: Gauss-Newton from the nearest sample."""
        if self._tree is None:
            self._tree = cKDTree(self.points.reshape(-1, 3))
        row, column = np.divmod(self._tree.query(points)[1], len(self.v))
        u, v = self.u[row], self.v[column]
        for _ in range(ITERATIONS):
            feet, along, around = self.derivatives(u, v)
            gap = points - feet
            a, b, c = dot(along, along), dot(along, around), dot(around, around)
            p, q = dot(along, gap), dot(around, gap)
            determinant = np.maximum(a * c - b * b, 1e-300)
            du, dv = (c * p - b * q) / determinant, (a * q - b * p) / determinant
            u, v = u + du, v + dv
            if max(np.abs(du).max(initial=0.0), np.abs(dv).max(initial=0.0)) < 1e-13:
                break
        if self._period is not None:
            v = np.mod(v + 0.5 * self._period, self._period) - 0.5 * self._period
        return u, v

    def _inside(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return u and v inside the table and how far u is beyond it, (..., 1)."""
        u, v = np.broadcast_arrays(np.asarray(u, dtype=np.float64), np.asarray(v, dtype=np.float64))
        inside = np.clip(u, self.u[0], self.u[-1])
        if self._period is None:
            v = np.clip(v, self.v[0], self.v[-1])
        else:
            v = self.v[0] + np.mod(v - self.v[0], self._period)
        return inside, v, (u - inside)[..., None]

    def _evaluated(self, u: Array, v: Array, du: int, dv: int) -> Array:
        values: Array = np.stack(
            [spline.ev(u, v, dx=du, dy=dv) for spline in self._splines], axis=-1
        )
        return values
