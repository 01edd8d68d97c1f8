# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clearance of the nozzle from earlier deposit and from the platform, for parts of revolution.

The paper tilts the build directions near a closing top back by the nozzle's angle (Chalvin 2020, section 6.1). Here
`core/collision` decides, as on walls, against beads with their width and height. A bead extends along its build direction: a
tilt-back changes the obstacle for later beads.

A full circle looks the same from each of its points, and an arc seen from all its points reaches equally far to both sides:
one tip position represents a whole bead.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ...collision import deposit
from ...collision.bodies import Bodies, build_bodies
from ...collision.nozzle import Nozzle, depositing
from ...collision.obstacles import Obstacles
from ...collision.scene import Scene
from ...geometry.columns import columns
from ...geometry.curves.polyline import turn_segments
from ...geometry.obstacles import disc
from ...parameters.cell import NozzleParameters
from ...types import Array, Index, Mask
from .platform import Platform

CHORD = 0.01  # mm; chord error of beads in the check, or their own if larger
CONVERGED = (
    0.01  # mm that the nozzle moves at most where directions are not settled to the last digit
)


@dataclass(frozen=True, eq=False)
class Deposit:
    """Points (k,) of every bead in the order of deposit, in the feature frame: radius, height mm, azimuth rad.

    build: (k, 3) the requested build directions, along radius, azimuth and axis. moment: (k,) at which each is there. starts: (k,)
    where a bead begins. case: (k,) the number of the case whose tilt-back applies, interpolated between two cases. size: width
    and height of the beads, mm.
    """

    radius: Array
    height: Array
    azimuth: Array
    build: Array
    moment: Index
    starts: Mask
    case: Array
    size: tuple[float, float]

    @property
    def points(self) -> Array:
        """(k, 3) mm in the feature frame."""
        return _place(self.radius, self.azimuth, self.height)


@dataclass(frozen=True, eq=False)
class Tips:
    """Tip positions, case by case: radius, height mm and azimuth rad (c,); the moment before which deposit exists, and the moment
    from which it belongs to the current layer (c,).
    """

    radius: Array
    height: Array
    azimuth: Array
    moment: Index
    own_moment: Index

    def rows(self, index: Index) -> Tips:
        """The rows of an index."""
        return Tips(*(getattr(self, entry.name)[index] for entry in dataclasses.fields(self)))


@dataclass(frozen=True)
class Clearance:
    """The nozzle, enlarged by the tolerance of the deposit, at tips above bodies. foot: mm, the tolerance about the current bead."""

    tips: Tips
    deposit: Deposit
    nozzle: Nozzle
    foot: float
    bodies: Bodies
    between: Tips | None = None  # the points of the deposit, if the tips do not represent it

    def standing(self, build: Array, like: Scene | None = None) -> Scene:
        """The scene with beads along directions (k, 3), in components, at the points of the deposit; like: the scene with other
        directions.
        """
        deposit_ = self.deposit
        width, tall = deposit_.size
        directions = _in_space(build, deposit_.azimuth)
        beads = deposit.build_deposit(
            deposit_.points,
            directions,
            width,
            tall,
            deposit_.starts,
            deposit_.moment,
            foot=self.foot,
            like=like.deposit if like is not None and isinstance(like.deposit, Obstacles) else None,
        )
        return Scene(self.bodies, beads)

    def clear(self, among: Scene, case: Index, tool: Array) -> Mask:
        """Whether the nozzle is clear with tool axes (n, 3), in components, in the cases numbered (n,)."""
        return self._clear(among, self.tips, case, tool)

    def clear_between(self, among: Scene, tool: Array) -> Mask:
        """The same at the points between, with tool axes (k, 3)."""
        assert self.between is not None
        return self._clear(among, self.between, np.arange(len(tool)), tool)

    def _clear(self, among: Scene, tips: Tips, rows: Index, tool: Array) -> Mask:
        azimuth = tips.azimuth[rows]
        tip = _place(tips.radius[rows], azimuth, tips.height[rows])
        return ~among.find_touching(
            self.nozzle, tip, _in_space(tool, azimuth), tips.moment[rows], tips.own_moment[rows]
        )


def nozzle_clearance(
    nozzle: NozzleParameters,
    lean: float,
    platform: Platform,
    tips: Tips,
    deposit: Deposit,
    chord_error: float,
    between: Tips | None = None,
) -> Clearance:
    """The nozzle, leaning by `lean` rad off the build direction, over a platform and a deposit whose points leave their
    curves by `chord_error` mm at most."""
    nozzle_ = depositing(
        0.5 * nozzle.diameter,
        float(np.tan(nozzle.half_angle)),
        nozzle.length,
        deposit.size[1],
        lean,
    )
    frame = np.eye(4)
    frame[2, 3] = platform.height
    plates = [disc(2.0 * platform.radius, frame)] if platform.radius > 0.0 else []
    bodies = build_bodies(plates, deposit.points, nozzle_.reach)
    return Clearance(
        tips, deposit, nozzle_.larger(chord_error + CONVERGED), nozzle_.foot, bodies, between
    )


def arc_points(
    radius: Array, turn: float, chord_error: float, min_points: int, one_side: bool
) -> tuple[Index, Array]:
    """Bead and azimuth (k,) of the points of arcs of radii (m,) over `turn` rad, seen from any point at azimuth 0: to both sides,
    or to one side only; of full circles one half.

    The points of a bead of that chord error (mm) and fewest points of a full turn, so that the arc has the same segments.
    """
    full = turn >= 2.0 * np.pi
    counts = np.array(
        [turn_segments(float(radius_), chord_error, turn, min_points) for radius_ in radius]
    )
    end = -(-counts // 2) if full and one_side else counts
    start = np.zeros_like(end) if full or one_side else -end
    sizes = end - start + 1
    bead = np.repeat(np.arange(len(radius)), sizes)
    position = np.arange(len(bead)) - np.repeat(np.cumsum(sizes) - sizes - start, sizes)
    return bead, turn * position / counts[bead]


def _place(radius: Array, azimuth: Array, height: Array) -> Array:
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], axis=1)


def _in_space(direction: Array, azimuth: Array) -> Array:
    """Directions (n, 3) in the feature frame from their components along radius, azimuth and axis."""
    c, s = np.cos(azimuth), np.sin(azimuth)
    along, across, up = columns(direction)
    return np.stack([along * c - across * s, along * s + across * c, up], axis=1)
