# SPDX-License-Identifier: LGPL-2.1-or-later
"""A flattened bead with its surface; normals that turn too fast are spread along the bead.

A curved layer through a solid bends as sharply as the corners of the outline: at one layer height from a corner, its
normals turn by a radian per layer height. Such normals may deviate from the layer's normals. The normals of a hub or of
faces may not.
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

OF_NORMAL = 1.5  # ratio of the allowed turn rate of a leaning torch to the turn rate of the normals
RATE_MARGIN = 0.98  # fraction of the requested turn rate, so that points added later stay within it
LEAST_DEPARTURE = math.radians(0.1)  # minimum deviation from the requested axis that counts


@dataclass(frozen=True, eq=False)
class Course:
    """A flattened bead (n, 2) with its surface.

    A closed bead repeats its first point, or ends one period from it. spread: (n, 3) normals at the points that replace
    the surface normals, if any.
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
            Angle of the plane's x axis from the first axis of the surface, rad.
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
    """A bead whose normals are within the allowed turn rate.

    departure: maximum angle from the surface normals, rad. length: length with changed normals, mm.
    """

    course: Course
    departure: float
    length: float


def limit(surface: LayerSurface, build: BuildDirectionParameters, normal_rate: float) -> float:
    """Return the maximum turn rate of the torch on a bead.

    Parameters
    ----------
    surface : LayerSurface
        The layer surface.
    build : BuildDirectionParameters
        Build direction with the maximum turn rate.
    normal_rate : float
        Turn rate of the bead's normals, rad/mm.

    Returns
    -------
    float
        Turn rate, rad/mm.
    """
    max_rate = build.turn(max(TURN_ON_HUBS, OF_NORMAL * normal_rate))
    return min(max_rate, build.turn()) if surface.bends_freely else max_rate


def evened(course: Course, arc: Array, build: BuildDirectionParameters, leaning: bool) -> Evened:
    """Spread the normals of a bead where they turn too fast.

    The changed length is as short as possible. Normals that cannot be slowed enough stay.

    Parameters
    ----------
    course : Course
        The flattened bead with its surface.
    arc : (n,) array
        Positions of the bead's points, mm.
    build : BuildDirectionParameters
        Build direction with the maximum turn rate.
    leaning : bool
        Whether the torch also rotates relative to the normals.

    Returns
    -------
    Evened
        The bead, the deviation of its normals and the affected length.
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
