# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids that stand on cylinders and cones of a hub, as triangles, grouped by the surface they stand on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..issues import Issue
from .developable import TURN, Developable
from .surroundings import Body

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Base:
    """A cylinder or cone in the part: name: what messages call it; frame: (4, 4) pose of its own frame in part coordinates,
    Z its axis, towards the apex of a cone."""

    name: str
    surface: Developable
    frame: Array

    def inside(self, points: Array) -> Array:
        """Points (..., 3) of the part in the base's frame."""
        local: Array = (points - self.frame[:3, 3]) @ self.frame[:3, :3]
        return local

    def placed(self, points: Array) -> Array:
        """Points (..., 3) of the base's frame in the part."""
        part: Array = points @ self.frame[:3, :3].T + self.frame[:3, 3]
        return part

    def turned(self, vectors: Array) -> Array:
        """Vectors (..., 3) of the base's frame in the part."""
        part: Array = vectors @ self.frame[:3, :3].T
        return part


@dataclass(frozen=True)
class Group:
    """Solids on one base, in the order of their azimuths."""

    base: Base
    bodies: tuple[Body, ...]


@dataclass(frozen=True)
class SolidsOnHub:
    """What is to be deposited, group by group. surroundings: hub and fixtures. chord_error: mm within which the triangles
    stand for the solids."""

    label: str
    groups: tuple[Group, ...]
    chord_error: float
    surroundings: tuple[Body, ...] = ()
    issues: tuple[Issue, ...] = ()


def middle_azimuth(base: Base, points: Array) -> float:
    """Azimuth (rad, from 0 to a turn) of the middle of the sector that points (n, 3) of the part lie in: opposite to their
    widest gap."""
    local = base.inside(points)
    angle = np.sort(np.remainder(np.arctan2(local[:, 1], local[:, 0]), TURN))
    gaps = np.diff(angle, append=angle[0] + TURN)
    k = int(np.argmax(gaps))
    middle = angle[k] + 0.5 * gaps[k] + 0.5 * TURN
    return float(np.remainder(np.round(middle, 9), TURN))
