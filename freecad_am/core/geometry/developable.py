# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planes, cylinders and cones to grow on: their equidistant neighbours, and unrolling (Dai 2020,
2.1 and 2.2).

All coordinates are in the hub's own frame: its axis is Z, the base circle of radius R is
at z = 0, the apex of a cone at z = H (eq. 1). With tan(a) = R / H a point at (rho, theta,
z) is rho cos(a) + z sin(a) - R cos(a) away from the surface; since rho is never negative
this is only the nappe below the apex. A cylinder is the case a = 0, not a limit.

Unrolled, x runs around the hub and y up along it: with the distance s = (H - z) / cos(a)
from the apex, s0 the distance of the base circle and phi = (theta - middle) sin(a), x = s
sin(phi) and y = s0 - s cos(phi). Both maps are exact isometries; written from the base
circle, not from the apex, they keep their digits however slim the cone (ERRATA on section
2.2).
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
    """A cone of base radius `radius` mm at z = 0 that ends in its apex at z = `height` mm; infinite for a cylinder."""

    radius: float
    height: float = math.inf

    def __post_init__(self) -> None:
        if not (self.radius > 0.0 and self.height > 0.0):
            raise ValueError("radius and height of a base surface must be positive")

    @property
    def is_cylinder(self) -> bool:
        """Whether it has no apex."""
        return math.isinf(self.height)

    @property
    def taper(self) -> float:
        """Half the opening angle a at the apex, rad; 0 for a cylinder."""
        return 0.0 if self.is_cylinder else math.atan2(self.radius, self.height)

    def offset(self, distance: float) -> Developable:
        """The equidistant surface `distance` mm further out: R + d / cos(a), H + d / sin(a) (2.2 and 5).

        ValueError where the distance leads inwards past the axis.
        """
        a = self.taper
        height = math.inf if self.is_cylinder else self.height + distance / math.sin(a)
        return Developable(self.radius + distance / math.cos(a), height)

    def distance(self, points: Array) -> Array:
        """Return how far points are outside the surface, along its normal.

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
        """The radius, mm, that beads `distance` mm further out are bent by, around a part of an extent, mm."""
        return self.radius + distance

    def normals(self, points: Array) -> Array:
        """Return the outward normals at points, the same for all equidistant surfaces.

        Parameters
        ----------
        points : (..., 3) array
            Points in the frame of the surface, mm.

        Returns
        -------
        (..., 3) array
            Unit normals; on the axis, which has no radial direction, only the axial
            component.
        """
        a = self.taper
        rho = np.hypot(points[..., 0], points[..., 1])
        level = math.cos(a) / np.maximum(rho, 1e-300)
        return np.stack(
            [points[..., 0] * level, points[..., 1] * level, np.full_like(rho, math.sin(a))],
            axis=-1,
        )

    def distance_rate(self, position: Array, direction: Array) -> tuple[Array, Array]:
        """Return `distance` and its rate along vectors.

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
            Per unit of the vectors.
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
        """Way s0 from the apex to the base circle, mm."""
        return self.height / math.cos(self.taper)

    @property
    def flat_turn(self) -> float:
        """Angle (rad) of the sector that a whole turn becomes on the plane; 0 for a cylinder, whose turn is a length."""
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
            Azimuths from the middle, rad, which need not be within one turn.
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
        """Return azimuth and height of unrolled points.

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
        """Return the points of the surface at unrolled points: the inverse of `unroll`.

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


# ---- The platform plane and its parallels, with the interface of cylinders and cones
# (`developable`)


@dataclass(frozen=True)
class Plane:
    """The plane z = height, mm, of its frame."""

    height: float = 0.0

    def offset(self, distance: float) -> Plane:
        """The parallel plane `distance` mm further up."""
        return Plane(self.height + distance)

    def distance(self, points: Array) -> Array:
        """Return how far points are above the plane.

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
        """Return the approximate bend radius, mm, of beads of a part of an extent, mm."""
        return extent

    def unroll(self, points: Array, middle: float = 0.0) -> Array:
        """Return points (..., 3) seen from above, (..., 2) mm, whatever `middle`."""
        return points[..., :2].copy()
