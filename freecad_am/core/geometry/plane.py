# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plane that parts stand on, and its parallels: with what is asked of cylinders and cones too (`developable`)."""

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
        """How far (...,) mm points (..., 3) are above it; negative below."""
        above: Array = points[..., 2] - self.height
        return above

    def bend(self, distance: float, extent: float) -> float:
        """The radius, mm, that beads of a part of an extent, mm, are about bent by."""
        return extent

    def flat(self, points: Array, middle: float = 0.0) -> Array:
        """Points (..., 3) seen from above, (..., 2) mm, whatever `middle`."""
        return points[..., :2].copy()
