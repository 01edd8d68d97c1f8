# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base planes, cylinders and cones: equidistant surfaces and unrolling (Dai 2020, 2.1 and 2.2).

All coordinates are in the hub frame: Z is the axis, the base circle of radius R is at z = 0, and
the apex of a cone is at z = H (eq. 1). With tan(a) = R / H, the distance of a point (rho, theta, z)
from the surface is rho cos(a) + z sin(a) - R cos(a). Since rho is never negative, this describes
only the nappe below the apex. A cylinder is the case a = 0, not a limit.

In the unrolled plane x runs around the hub and y up along the surface. Let s = (H - z) / cos(a) be
the distance from the apex, s0 its value at the base circle, and phi = (theta - middle) sin(a). Then
x = s sin(phi) and y = s0 - s cos(phi). Unrolling and wrapping are exact isometries. The formulas
start from the base circle, not from the apex, and so keep full precision for slender cones (ERRATA
on section 2.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..types import Array
from .columns import columns
from .frames import TURN


@dataclass(frozen=True)
class Developable:
    """A cone with base radius `radius` at z = 0 and apex at z = `height` (inf: a cylinder), mm."""

    radius: float
    height: float = math.inf

    def __post_init__(self) -> None:
        if not (self.radius > 0.0 and self.height > 0.0):
            raise ValueError("radius and height of a base surface must be positive")

    @property
    def is_cylinder(self) -> bool:
        """Whether the surface has no apex."""
        return math.isinf(self.height)

    @property
    def taper(self) -> float:
        """Half opening angle a at the apex, rad; 0 for a cylinder."""
        return 0.0 if self.is_cylinder else math.atan2(self.radius, self.height)

    def offset(self, distance: float) -> Developable:
        """Return the surface `distance` mm outwards: R + d / cos(a), H + d / sin(a) (2.2 and 5).

        Raises ValueError if a negative distance passes the axis.
        """
        a = self.taper
        height = math.inf if self.is_cylinder else self.height + distance / math.sin(a)
        return Developable(self.radius + distance / math.cos(a), height)

    def distance(self, points: Array) -> Array:
        """Return the distances of points from the surface, along its normal.

        Parameters
        ----------
        points : (..., 3) array
            Points in the frame of the surface, mm.

        Returns
        -------
        (...) array
            mm; negative inside.
        """
        a = self.taper
        rho = np.hypot(points[..., 0], points[..., 1])
        height: Array = (rho - self.radius) * math.cos(a) + points[..., 2] * math.sin(a)
        return height

    def bend(self, distance: float, extent: float) -> float:
        """Return the bend radius, mm, of beads `distance` mm outwards; `extent` has no effect."""
        return self.radius + distance

    def normals(self, points: Array) -> Array:
        """Return the outward normals at points, which all equidistant surfaces share.

        Parameters
        ----------
        points : (..., 3) array
            Points in the frame of the surface, mm.

        Returns
        -------
        (..., 3) array
            Unit normals; only their axial component for points on the axis.
        """
        a = self.taper
        rho = np.hypot(points[..., 0], points[..., 1])
        level = math.cos(a) / np.maximum(rho, 1e-300)
        return np.stack(
            [points[..., 0] * level, points[..., 1] * level, np.full_like(rho, math.sin(a))],
            axis=-1,
        )

    def distance_rate(self, position: Array, direction: Array) -> tuple[Array, Array]:
        """Return `distance` and its derivative along vectors.

        Parameters
        ----------
        position : (3, n) array
            Components of points, mm.
        direction : (3, n) array
            Components of the vectors.

        Returns
        -------
        distance : (n,) array
            mm.
        rate : (n,) array
            Derivatives per unit of the vectors.
        """
        a = self.taper
        x, y, z = position
        rho = np.hypot(x, y)
        level = math.cos(a) / np.maximum(rho, 1e-300)
        height = (rho - self.radius) * math.cos(a) + z * math.sin(a)
        return height, x * level * direction[0] + y * level * direction[1] + math.sin(
            a
        ) * direction[2]

    @property
    def slant(self) -> float:
        """Distance s0 from the apex to the base circle along the surface, mm."""
        return self.height / math.cos(self.taper)

    @property
    def flat_turn(self) -> float:
        """Angle of the unrolled full turn about the apex, rad; 0 for a cylinder."""
        return TURN * math.sin(self.taper)

    def azimuth(self, points: Array) -> Array:
        """Return the azimuth of points.

        Parameters
        ----------
        points : (..., 3) array
            Points in the frame of the surface.

        Returns
        -------
        (...) array
            From -pi to pi, rad.
        """
        x, y = columns(points[..., :2])
        azimuth: Array = np.arctan2(y, x)
        return azimuth

    def unroll(self, points: Array, middle: float = 0.0) -> Array:
        """Unroll points of the surface.

        Parameters
        ----------
        points : (..., 3) array
            Points of the surface, mm.
        middle : float, optional
            Azimuth of x = 0, rad; the cut is half a turn from there.

        Returns
        -------
        (..., 2) array
            Points of the plane, mm.

        References
        ----------
        Dai 2020, section 2.2.
        """
        theta = np.remainder(self.azimuth(points) - middle + math.pi, TURN) - math.pi
        return self.unroll_at(theta, points[..., 2])

    def unroll_at(self, theta: Array, z: Array) -> Array:
        """Unroll points given by azimuth and height.

        Parameters
        ----------
        theta : (...) array
            Azimuths from the middle, rad, not limited to one turn.
        z : (...) array
            Heights, mm.

        Returns
        -------
        (..., 2) array
            Points of the plane, mm.
        """
        if self.is_cylinder:
            return np.stack([self.radius * theta, z], axis=-1)
        a = self.taper
        s, phi = (self.height - z) / math.cos(a), theta * math.sin(a)
        return np.stack(
            [s * np.sin(phi), z / math.cos(a) + 2.0 * s * np.sin(0.5 * phi) ** 2], axis=-1
        )

    def from_unrolled(self, flat: Array) -> tuple[Array, Array]:
        """Return the azimuths and heights of unrolled points.

        Parameters
        ----------
        flat : (..., 2) array
            Points of the plane, mm.

        Returns
        -------
        theta : (...) array
            Azimuths from the middle, rad.
        z : (...) array
            Heights, mm.
        """
        x, y = columns(flat)
        if self.is_cylinder:
            return x / self.radius, y.copy()
        a = self.taper
        to_apex = self.slant - y
        s = np.hypot(x, to_apex)
        lower = ((2.0 * self.slant - y) * y - x * x) / (
            self.slant + s
        )  # s0 - s without cancellation
        return np.arctan2(x, to_apex) / math.sin(a), lower * math.cos(a)

    def wrap(self, flat: Array, middle: float = 0.0) -> Array:
        """Wrap unrolled points onto the surface; the inverse of `unroll`.

        Parameters
        ----------
        flat : (..., 2) array
            Points of the plane, mm.
        middle : float, optional
            Azimuth of x = 0, rad.

        Returns
        -------
        (..., 3) array
            Points of the surface, mm.
        """
        theta, z = self.from_unrolled(flat)
        rho = self.radius if self.is_cylinder else (self.height - z) * math.tan(self.taper)
        angle = theta + middle
        return np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=-1)


# ---- The platform plane and parallel planes, with the interface of `Developable`


@dataclass(frozen=True)
class Plane:
    """The plane z = height, mm, in its frame."""

    height: float = 0.0

    def offset(self, distance: float) -> Plane:
        """Return the parallel plane `distance` mm higher."""
        return Plane(self.height + distance)

    def distance(self, points: Array) -> Array:
        """Return the heights of points above the plane.

        Parameters
        ----------
        points : (..., 3) array
            Points in the frame of the plane, mm.

        Returns
        -------
        (...) array
            mm; negative below.
        """
        above: Array = points[..., 2] - self.height
        return above

    def bend(self, distance: float, extent: float) -> float:
        """Return the approximate bend radius of beads, mm: the `extent` of the part, mm."""
        return extent

    def unroll(self, points: Array, middle: float = 0.0) -> Array:
        """Return the x and y (..., 2), mm, of points (..., 3); `middle` has no effect."""
        return points[..., :2].copy()
