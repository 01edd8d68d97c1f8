# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids known by a function of space: negative inside, with its gradient. Simple substrates and checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..types import Array


class Implicit(Protocol):
    """A solid."""

    def value(self, points: Array) -> tuple[Array, Array]:
        """Values (...,), negative inside, and gradients (..., 3) at points (..., 3)."""


@dataclass(frozen=True, eq=False)
class Round:
    """A cylinder, cone or sphere's distance from its surface (mm, along the radius), or a half space.

    Each kind has a constructor of its own.
    """

    origin: Array
    axis: Array
    radius: float
    slope: float
    along: float

    @classmethod
    def cylinder(cls, radius: float, origin: Array, axis: Array) -> Round:
        """The cylinder of the radius (mm) about the line through `origin` along `axis`."""
        return cls(np.asarray(origin, float), _unit(axis), radius, 0.0, 0.0)

    @classmethod
    def cone(cls, half_angle: float, apex: Array, axis: Array) -> Round:
        """The cone (rad) that opens from `apex` along `axis`; only where the axial coordinate is positive."""
        return cls(np.asarray(apex, float), _unit(axis), 0.0, float(np.tan(half_angle)), 0.0)

    @classmethod
    def sphere(cls, radius: float, centre: Array) -> Round:
        """The ball of the radius (mm)."""
        return cls(np.asarray(centre, float), np.array([0.0, 0.0, 1.0]), radius, 0.0, 1.0)

    def value(self, points: Array) -> tuple[Array, Array]:
        """Distance from the surface measured across the axis (from the centre, for a sphere), and its gradient."""
        local = points - self.origin
        height = local @ self.axis
        across = local - (1.0 - self.along) * height[..., None] * self.axis
        reach = np.linalg.norm(across, axis=-1)
        out = across / np.maximum(reach, 1e-300)[..., None]
        return reach - self.radius - self.slope * height, out - self.slope * self.axis


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """The half space below the plane through `origin` with the normal `normal`."""

    origin: Array
    normal: Array

    def value(self, points: Array) -> tuple[Array, Array]:
        """Distance from the plane and its gradient."""
        normal = _unit(self.normal)
        value: Array = (points - self.origin) @ normal
        return value, np.broadcast_to(normal, points.shape)


def _unit(vector: Array) -> Array:
    unit: Array = np.asarray(vector, float) / np.linalg.norm(vector)
    return unit
