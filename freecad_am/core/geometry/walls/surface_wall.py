# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on a substrate whose surface closes around the wall: surface, start and end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.spatial import cKDTree

from ...issues import Issue
from ...types import Array
from ..obstacles import Body
from .part_depths import PartDepths
from .surface import Cone, Surface, Torus, dot

# columns repeated on both sides of a periodic table: the influence of a spline's end decreases by a
# factor of 3.7 per knot
WRAPPED = 6
ITERATIONS = 30


class Tabulated:
    """The surface through points (n, m, 3), mm, at rising parameters u (n,) and v (m,), n, m >= 4.

    A periodic table omits the column at v[0] + period. In u the wall is extrapolated linearly, so
    that a layer may pass the end of the wall before it is trimmed. On an open wall, v is clipped to
    the table.
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
        """Period of v; None if the wall is open."""
        return self._period

    @property
    def rise_period(self) -> None:
        """None, because the table ends in u."""
        return None

    def point(self, u: Array, v: Array) -> Array:
        """Return points (..., 3)."""
        u, v, beyond = self._inside(u, v)
        point = self._evaluated(u, v, 0, 0)
        return point + beyond * self._evaluated(u, v, 1, 0) if beyond.any() else point

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return points and first derivatives."""
        u, v, beyond = self._inside(u, v)
        point, along, around = (self._evaluated(u, v, *order) for order in ((0, 0), (1, 0), (0, 1)))
        if beyond.any():
            point, around = point + beyond * along, around + beyond * self._evaluated(u, v, 1, 1)
        return point, along, around

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return (u, v) of the nearest points, by Gauss-Newton from the nearest sample."""
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
        """Return u and v inside the table, and the excess (..., 1) of u beyond the table."""
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


TORUS, CONE, TABLE = "torus", "cone", "table"


@dataclass(frozen=True, eq=False)
class SurfaceWall:
    """A wall in part coordinates, mm and rad.

    kind: TORUS with sizes (bend, tube), CONE with sizes (radius, slope), or TABLE with parameters u
    (n,) and v (m,) and the points table (n, m, 3). frame: (4, 4) pose of the surface frame in the
    part. end: u of the upper edge, up to which layers rise from the substrate. first: (m, 3) closed
    chain of points in part coordinates in which the wall leaves the substrate, first point not
    repeated. faces: names of the wall's faces. surroundings: the substrate, then fixtures. depths:
    distribution of the part about the wall. closes_around: whether a surface parameter closes
    around the wall. own: None, because a wall has no hub.
    """

    closes_around: ClassVar[Literal[True]] = True
    own: ClassVar[None] = None

    kind: str
    sizes: tuple[float, ...]
    frame: Array
    end: float
    first: Array
    u: Array | None = None
    v: Array | None = None
    table: Array | None = None
    period: float = 2.0 * np.pi
    label: str = "wall"
    faces: tuple[str, ...] = ()
    issues: tuple[Issue, ...] = ()
    surroundings: tuple[Body, ...] = ()
    depths: PartDepths | None = None

    def surface(self) -> Placed:
        """Return the surface of the wall in part coordinates, for slicing."""
        return Placed(
            own_surface(self.kind, self.sizes, self.u, self.v, self.table, self.period), self.frame
        )

    @property
    def symmetry_normal(self) -> Array | None:
        """Unit normal (3,) of the bend plane of a torus; None for other walls."""
        return np.array(self.frame[:3, 1]) if self.kind == TORUS else None


def own_surface(
    kind: str,
    sizes: tuple[float, ...],
    u: Array | None = None,
    v: Array | None = None,
    table: Array | None = None,
    period: float = 2.0 * np.pi,
) -> Surface:
    """Return the surface of a wall in the surface frame.

    Parameters
    ----------
    kind : str
        TORUS, CONE or TABLE, see `SurfaceWall`.
    sizes : tuple of float
        Sizes for the kind, mm and rad.
    u : (n,) array or None, optional
        Parameters of the table.
    v : (m,) array or None, optional
        Parameters of the table.
    table : (n, m, 3) array or None, optional
        Points of the table, mm.
    period : float, optional
        Period of v of the table.

    Returns
    -------
    Surface
        The surface.

    Raises
    ------
    ValueError
        For a TABLE without its arrays.
    """
    if kind == TORUS:
        return Torus(*sizes)
    if kind == CONE:
        return Cone(*sizes)
    if u is None or v is None or table is None:
        raise ValueError(f"a wall of the kind {kind} needs a table")
    return Tabulated(u, v, table, period)


@dataclass(frozen=True, eq=False)
class Placed:
    """A surface transformed by a rigid pose (4, 4)."""

    own: Surface
    frame: Array

    @property
    def period(self) -> float | None:
        """Period of v."""
        return self.own.period

    @property
    def rise_period(self) -> float | None:
        """Period of u, if any."""
        return self.own.rise_period

    def point(self, u: Array, v: Array) -> Array:
        """Return points (..., 3)."""
        points: Array = self.own.point(u, v) @ self.frame[:3, :3].T + self.frame[:3, 3]
        return points

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return points and first derivatives."""
        point, along, around = self.own.derivatives(u, v)
        turn = self.frame[:3, :3].T
        return point @ turn + self.frame[:3, 3], along @ turn, around @ turn

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return (u, v) of the nearest points of the wall."""
        return self.own.inverse((points - self.frame[:3, 3]) @ self.frame[:3, :3])
