# SPDX-License-Identifier: LGPL-2.1-or-later
"""The platform plane and its parallels, with the interface of cylinders and cones
(`developable`).
"""

from __future__ import annotations

from dataclasses import dataclass

from ..types import Array


@dataclass(frozen=True)
class Plane:
    """The plane z = height, mm, of its frame."""

    height: float = 0.0

    def offset(self, distance: float) -> Plane:
        """The parallel plane `distance` mm further up."""
        return Plane(self.height + distance)

    def distance(self, points: Array) -> Array:
        """Return how far (...,) mm points (..., 3) are above the plane; negative below."""
        above: Array = points[..., 2] - self.height
        return above

    def bend(self, distance: float, extent: float) -> float:
        """Return the approximate bend radius, mm, of beads of a part of an extent, mm."""
        return extent

    def unroll(self, points: Array, middle: float = 0.0) -> Array:
        """Return points (..., 3) seen from above, (..., 2) mm, whatever `middle`."""
        return points[..., :2].copy()
