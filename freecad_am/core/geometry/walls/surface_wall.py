# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall around a closed direction on a substrate: its surface, its start and its end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...issues import Issue
from ...types import Array
from ..obstacles import Body
from .part_depths import PartDepths
from .surface import Cone, Surface, Torus
from .tabulated import Tabulated

TORUS, CONE, TABLE = "torus", "cone", "table"


@dataclass(frozen=True, eq=False)
class SurfaceWall:
    """A wall in part coordinates, mm and rad.

    kind: TORUS with sizes (bend, tube), CONE with sizes (radius, slope), or TABLE with the
    parameters u (n,) and v (m,) and the points table (n, m, 3). frame: (4, 4) pose of the
    surface's own frame in the part. end: u of the upper edge; layers rise from the substrate
    to it. first: (m, 3) closed chain of points in part coordinates in which the wall leaves
    the substrate, the first not repeated. faces: names of the wall's faces. surroundings: the
    substrate, then fixtures. depths: how the part is distributed about the wall.
    """

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
        """The wall as slicing wants it, in part coordinates."""
        return Placed(
            own_surface(self.kind, self.sizes, self.u, self.v, self.table, self.period), self.frame
        )

    @property
    def symmetry_normal(self) -> Array | None:
        """Unit normal (3,) of the plane of the bend of a torus; other walls are not known to have such a plane."""
        return np.array(self.frame[:3, 1]) if self.kind == TORUS else None


def own_surface(
    kind: str,
    sizes: tuple[float, ...],
    u: Array | None = None,
    v: Array | None = None,
    table: Array | None = None,
    period: float = 2.0 * np.pi,
) -> Surface:
    """The surface of a kind in its own frame, see `SurfaceWall`."""
    if kind == TORUS:
        return Torus(*sizes)
    if kind == CONE:
        return Cone(*sizes)
    if u is None or v is None or table is None:
        raise ValueError(f"a wall of the kind {kind} needs a table")
    return Tabulated(u, v, table, period)


@dataclass(frozen=True, eq=False)
class Placed:
    """A surface moved by a rigid pose (4, 4)."""

    own: Surface
    frame: Array

    @property
    def period(self) -> float | None:
        """Period of v."""
        return self.own.period

    @property
    def rise_period(self) -> float | None:
        """Period of u, where it has one."""
        return self.own.rise_period

    def point(self, u: Array, v: Array) -> Array:
        """Points (..., 3)."""
        points: Array = self.own.point(u, v) @ self.frame[:3, :3].T + self.frame[:3, 3]
        return points

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Points and first derivatives."""
        point, along, around = self.own.derivatives(u, v)
        turn = self.frame[:3, :3].T
        return point @ turn + self.frame[:3, 3], along @ turn, around @ turn

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """(u, v) of the nearest points of the wall."""
        return self.own.inverse((points - self.frame[:3, 3]) @ self.frame[:3, :3])
