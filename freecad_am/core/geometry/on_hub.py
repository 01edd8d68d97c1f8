# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids that stand on cylinders and cones of a hub, as triangles, grouped by the surface they stand on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

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


class Seat(NamedTuple):
    """A base, and from where to where (mm along its axis) faces of it reach; infinite for one that is given."""

    base: Base
    low: float
    high: float


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
    middle = float(np.remainder(angle[k] + 0.5 * gaps[k] + 0.5 * TURN, TURN))
    return 0.0 if TURN - middle < 1e-9 else round(middle, 9)


def downwards(z: Array) -> bool:
    """Whether an axis (3,) points against the part's Z, or against its X or Y where it has no part along Z."""
    for component in (2, 0, 1):
        if abs(z[component]) > 1e-9:
            return bool(z[component] < 0.0)
    return False


def upright(origin: Array, z: Array) -> Array:
    """The frame (4, 4) with an origin and unit Z (3,); its X is the part's X seen along Z, or Y where X is along it."""
    x = np.eye(3)[0] - z[0] * z
    if np.linalg.norm(x) < 1e-6:
        x = np.eye(3)[1] - z[1] * z
    x /= np.linalg.norm(x)
    frame = np.eye(4)
    frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    frame[:3, 3] = origin
    return frame
