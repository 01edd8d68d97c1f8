# SPDX-License-Identifier: LGPL-2.1-or-later
"""A bead laid flat with the surface it lies on, and its normals spread along it where they turn too fast.

A curved layer through a solid bends as sharply as ways lead round a corner: one layer height from it, its normals turn by a
radian per layer height. They may depart from the layer there. Those of a hub, or of faces, may not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...geometry.frames import unit
from ...issues import InputError
from ...layers.surface import LayerSurface
from ...parameters.build_direction import TURN_ON_HUBS, BuildDirectionParameters
from ...slicing.directions.wall import limit_turns, turn_rates
from ...types import Array

OF_NORMAL = 1.5  # a torch that leans may turn faster than the normals by that, whatever is asked
WITHIN = 0.98  # of the turn asked for, so that points added later keep to it too
LEAST_DEPARTURE = math.radians(0.1)  # a departure from what is asked that counts


@dataclass(frozen=True, eq=False)
class Course:
    """A bead laid flat (n, 2), and its surface; a closed one repeats its first point, or ends a period from it.
    spread: normals (n, 3) at its points that stand for those of the surface."""

    flat: Array
    closed: bool
    surface: LayerSurface
    spread: Array | None = None

    def at(self, s: Array, way: Array) -> tuple[Array, Array, Array, Array]:
        """Flat places (n, 2), points (n, 3), normals (n, 3) and the angle phi (n,) of the way round on the plane."""
        flat = np.stack([np.interp(s, way, column) for column in self.flat.T], axis=-1)
        points, normals, turn = self.surface.wrap(flat)
        if self.spread is not None:
            normals = unit(
                np.stack([np.interp(s, way, column) for column in self.spread.T], axis=-1)
            )
        if self.closed:
            points[-1], normals[-1] = points[0], normals[0]
        return flat, points, normals, turn


class Evened(NamedTuple):
    """The bead with normals that turn no faster than asked, by how much (rad) they depart from the surface's at most, and
    over how much of the length (mm)."""

    course: Course
    departure: float
    length: float


def limit(surface: LayerSurface, build: BuildDirectionParameters, own: float) -> float:
    """How fast (rad/mm) the torch may turn on a bead whose normals turn by `own` rad/mm."""
    most = build.turn(max(TURN_ON_HUBS, OF_NORMAL * own))
    return min(most, build.turn()) if surface.bends_freely else most


def evened(course: Course, way: Array, build: BuildDirectionParameters, leaning: bool) -> Evened:
    """The bead with its normals spread where the surface lets them and they turn too fast, over as little of it as that
    takes. leaning: whether the torch is to turn against them besides. Normals that cannot be made to turn so slowly stay."""
    most = build.turn() / (OF_NORMAL if leaning else 1.0)
    if not course.surface.bends_freely or most == math.inf:
        return Evened(course, 0.0, 0.0)
    _, points, normals, _ = course.at(way, way)
    if turn_rates(points, normals).max() <= most:
        return Evened(course, 0.0, 0.0)
    try:
        found = limit_turns(points, normals, course.closed, WITHIN * most)
    except InputError:
        return Evened(course, 0.0, 0.0)
    off = found.departure > LEAST_DEPARTURE
    length = float(np.diff(way)[off[1:] | off[:-1]].sum())
    return Evened(replace(course, spread=found.directions), float(found.departure.max()), length)
