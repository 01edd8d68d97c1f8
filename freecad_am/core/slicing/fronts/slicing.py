# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common inputs of all layers of a wall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.patch_wall import PatchWall
from ...types import Array
from .rims import Rims


@dataclass(frozen=True)
class Smoothing:
    """band: largest departure of the local distance, as a share of the height. limit: rad/mm, turn within the wall that
    fronts are to stay below where the band allows."""

    band: float
    limit: float


@dataclass(frozen=True, eq=False)
class Slicing:
    """A wall, its rims, the layer height in mm, and how fronts are smoothed, if they are."""

    wall: PatchWall
    rims: Rims
    height: float
    smoothing: Smoothing | None = None

    @property
    def widest(self) -> float:
        """Heights that layers may be apart."""
        return 1.0 if self.smoothing is None else 1.0 + self.smoothing.band

    def left_of(self, curve: SpaceCurve) -> tuple[Array, Array]:
        """Points (n, 3) in the middle of a curve's arcs, and vectors (n, 3) within the wall to its left there."""
        points, slope, _ = curve.at(curve.w[:-1] + 0.5 * curve.span)
        return points, np.cross(self.wall.project(points)[1], slope)
