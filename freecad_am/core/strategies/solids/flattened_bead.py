# SPDX-License-Identifier: LGPL-2.1-or-later
"""A flattened bead with its surface, and its normals spread along it where they turn too fast.

A curved layer through a solid bends as sharply as corners of its outline: one layer height from it, its normals turn by a
radian per layer height. Such normals may depart from the layer there. Normals of a hub, or of faces, may not.
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
from ...slicing.wall_directions import limit_turns, turn_rates
from ...types import Array

OF_NORMAL = 1.5  # a leaning torch may always turn this much faster than the normals
RATE_MARGIN = 0.98  # of the turn asked for, so that points added later keep to it too
LEAST_DEPARTURE = math.radians(0.1)  # a departure from the requested axis that counts


@dataclass(frozen=True, eq=False)
class Course:
    """A flattened bead (n, 2), and its surface; a closed one repeats its first point, or ends a period from it. spread: normals
    (n, 3) at its points that replace the normals of the surface.
    """

    flat: Array
    closed: bool
    surface: LayerSurface
    spread: Array | None = None

    def wrap_at(self, s: Array, arc: Array) -> tuple[Array, Array, Array, Array]:
        """Return the bead at positions along it.

        Parameters
        ----------
        s : (n,) array
            Positions, mm.
        arc : (m,) array
            Positions of the bead's points, mm.

        Returns
        -------
        flat : (n, 2) array
            Points on the plane, mm.
        points : (n, 3) array
            Points on the surface, mm.
        normals : (n, 3) array
            Unit normals.
        turn : (n,) array
            Angle of the plane's x from the first axis of the surface, rad.
        """
        flat = np.stack([np.interp(s, arc, column) for column in self.flat.T], axis=-1)
        points, normals, turn = self.surface.wrap(flat)
        if self.spread is not None:
            normals = unit(
                np.stack([np.interp(s, arc, column) for column in self.spread.T], axis=-1)
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


def limit(surface: LayerSurface, build: BuildDirectionParameters, normal_rate: float) -> float:
    """Return how fast the torch may turn on a bead.

    Parameters
    ----------
    surface : LayerSurface
        The layer surface.
    build : BuildDirectionParameters
        Build direction with the largest turn.
    normal_rate : float
        Turn of the bead's normals, rad/mm.

    Returns
    -------
    float
        rad/mm.
    """
    max_rate = build.turn(max(TURN_ON_HUBS, OF_NORMAL * normal_rate))
    return min(max_rate, build.turn()) if surface.bends_freely else max_rate


def evened(course: Course, arc: Array, build: BuildDirectionParameters, leaning: bool) -> Evened:
    """Spread the normals of a bead where they turn too fast.

    This takes as little length as possible. Normals that cannot be slowed enough stay.

    Parameters
    ----------
    course : Course
        The flattened bead with its surface.
    arc : (n,) array
        Positions of its points, mm.
    build : BuildDirectionParameters
        Build direction with the largest turn.
    leaning : bool
        Whether the torch also turns against the normals.

    Returns
    -------
    Evened
        The bead, the departure of its normals and the length concerned.
    """
    max_rate = build.turn() / (OF_NORMAL if leaning else 1.0)
    if not course.surface.bends_freely or max_rate == math.inf:
        return Evened(course, 0.0, 0.0)
    _, points, normals, _ = course.wrap_at(arc, arc)
    if turn_rates(points, normals).max() <= max_rate:
        return Evened(course, 0.0, 0.0)
    try:
        slower = limit_turns(points, normals, course.closed, RATE_MARGIN * max_rate)
    except InputError:
        return Evened(course, 0.0, 0.0)
    off = slower.departure > LEAST_DEPARTURE
    length = float(np.diff(arc)[off[1:] | off[:-1]].sum())
    return Evened(replace(course, spread=slower.directions), float(slower.departure.max()), length)
