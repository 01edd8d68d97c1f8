# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interface between walls and slicing, and the analytic walls.

A wall is a map (u, v) -> point: layers rise with u, and v runs around the wall. Parameters are
arrays of a common shape (...); points and derivatives are (..., 3), mm. `period` is the period of
v, or None if the wall is open in v.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...types import Array
from ..columns import columns
from ..frames import TURN


class Surface(Protocol):
    """A parametric wall."""

    @property
    def period(self) -> float | None:
        """Period of v; None if the wall is open."""

    @property
    def rise_period(self) -> float | None:
        """Period of u if the wall also closes in u, else None.

        `inverse` returns u modulo this period.
        """

    def point(self, u: Array, v: Array) -> Array:
        """Evaluate points of the wall.

        Parameters
        ----------
        u, v : (...) array
            Parameters.

        Returns
        -------
        (..., 3) array
            mm.
        """

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Evaluate points and first derivatives.

        Parameters
        ----------
        u, v : (...) array
            Parameters.

        Returns
        -------
        point : (..., 3) array
            Points, mm.
        along, around : (..., 3) array
            Derivatives along u and v.
        """

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return the parameters of the wall points nearest to given points.

        Parameters
        ----------
        points : (n, 3) array
            Points, mm.

        Returns
        -------
        u, v : (n,) array
            Parameters; v is within one period from -period / 2 on.
        """


@dataclass(frozen=True)
class Torus:
    """Chalvin 2019, equation 1: bend radius R, tube radius r, mm.

    The tube's centreline starts at the origin along Z and bends about the line parallel to Y
    through (-R, 0, 0) (errata). u is the angle along the bend, v the angle around the tube, with v
    = 0 on the outside of the bend.
    """

    bend: float
    tube: float

    @property
    def period(self) -> float:
        """Period of v: a full turn."""
        return TURN

    @property
    def rise_period(self) -> float:
        """Period of u: a full turn."""
        return TURN

    def point(self, u: Array, v: Array) -> Array:
        """Return points (..., 3)."""
        reach = self.bend + self.tube * np.cos(v)
        return _stacked(reach * np.cos(u) - self.bend, self.tube * np.sin(v), reach * np.sin(u))

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return points and first derivatives."""
        u, v = np.asarray(u, order="C"), np.asarray(v, order="C")
        cu, su, cv, sv = np.cos(u), np.sin(u), self.tube * np.cos(v), self.tube * np.sin(v)
        reach = self.bend + cv
        return (
            _stacked(reach * cu - self.bend, sv, reach * su),
            _stacked(-reach * su, 0.0 * sv, reach * cu),
            _stacked(-sv * cu, cv, -sv * su),
        )

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return (u, v) of the nearest points, both from -pi to pi."""
        x, y, z = columns(points)
        x = x + self.bend
        return np.arctan2(z, x), np.arctan2(y, np.hypot(x, z) - self.bend)


@dataclass(frozen=True)
class Cone:
    """A cone about Z; u is the length along the side (mm), v the azimuth.

    radius: mm, at u = 0. slope: angle between side and Z, rad, positive for a flaring cone. 0 is
    the cylinder, +-pi/2 the plane Z = 0 outwards or inwards. Valid only where the radius is
    positive.
    """

    radius: float
    slope: float = 0.0

    @property
    def period(self) -> float:
        """Period of v: a full turn."""
        return TURN

    @property
    def rise_period(self) -> None:
        """None, because u is a length."""
        return None

    def point(self, u: Array, v: Array) -> Array:
        """Return points (..., 3)."""
        radius = self.radius + u * np.sin(self.slope)
        return _stacked(radius * np.cos(v), radius * np.sin(v), u * np.cos(self.slope))

    def derivatives(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return points and first derivatives."""
        out, up, v = np.sin(self.slope), np.cos(self.slope), np.asarray(v, order="C")
        cv, sv, radius = np.cos(v), np.sin(v), self.radius + u * out
        return (
            _stacked(radius * cv, radius * sv, u * up),
            _stacked(out * cv, out * sv, up + 0.0 * u),
            _stacked(-radius * sv, radius * cv, 0.0 * u),
        )

    def inverse(self, points: Array) -> tuple[Array, Array]:
        """Return (u, v) of the nearest points."""
        x, y, z = columns(points)
        out = np.hypot(x, y) - self.radius
        return out * np.sin(self.slope) + z * np.cos(self.slope), np.arctan2(y, x)


def cylinder(radius: float) -> Cone:
    """Return the cylinder about Z; u is the height."""
    return Cone(radius)


def normals(surface: Surface, u: Array, v: Array) -> Array:
    """Return unit normals of a wall.

    Parameters
    ----------
    surface : Surface
        The wall.
    u, v : (...) array
        Parameters.

    Returns
    -------
    (..., 3) array
        Unit normals along the cross product of the derivatives along u and v.
    """
    _, along, around = surface.derivatives(u, v)
    normal = np.cross(along, around)
    unit: Array = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return unit


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products of vectors.

    Parameters
    ----------
    a, b : (..., 3) array
        Vectors.

    Returns
    -------
    (...) array
        Products.
    """
    product: Array = np.einsum("...k,...k->...", a, b)
    return product


def _stacked(x: Array, y: Array, z: Array) -> Array:
    stacked: Array = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
    return stacked
