# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the nozzle clear of what is deposited already, and of the platform? For parts of revolution.

The paper tilts the build directions near a closing top back by the nozzle's angle (Chalvin 2020, section 6.1). Here the
nozzle is asked of `core/collision`, as it is on walls, against beads with their width and height. A bead stands along its
build direction: to tilt one back changes what the nozzle meets in those after it.

A full circle looks the same from each of its points, and an arc that is seen from all of them reaches as far to one side as
to the other: one place of the tip stands for all of a bead.
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

CHORD = 0.01  # mm; beads are looked at to this chord error, or their own where that is larger
CONVERGED = (
    0.01  # mm that the nozzle moves at most where directions are not settled to the last digit
)


@dataclass(frozen=True, eq=False)
class Deposit:
    """Points (k,) of all beads in the order of deposit, in the feature frame: radius, height mm, azimuth rad.

    build: (k, 3) the build directions asked for, along radius, azimuth and axis. moment: (k,) at which each is there.
    starts: (k,) where a bead begins. case: (k,) the number of the case by whose tilt-back each is tilted; between two of
    them it runs evenly. size: width and height of the beads, mm.
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
    """Where the nozzle is looked at, case by case: radius, height mm and azimuth rad (c,); the moment before which there is
    deposit, and the one from which it is of the layer being laid (c,)."""

    radius: Array
    height: Array
    azimuth: Array
    moment: Index
    own: Index

    def rows(self, index: Index) -> Tips:
        """Some of them."""
        return Tips(*(getattr(self, entry.name)[index] for entry in dataclasses.fields(self)))


@dataclass(frozen=True)
class Clearance:
    """The nozzle as it is looked at, larger than it is by what the deposit may be off, at tips above bodies. foot: mm, how
    far off it is about the bead being laid."""

    tips: Tips
    deposit: Deposit
    nozzle: Nozzle
    foot: float
    bodies: Bodies
    between: Tips | None = (
        None  # the points of the deposit, where the tips do not stand for all of it
    )

    def standing(self, build: Array, like: Scene | None = None) -> Scene:
        """All that there is, with beads that stand along directions (k, 3), in components, at the points of the deposit;
        like: the same with other directions."""
        own = self.deposit
        width, tall = own.size
        directions = _in_space(build, own.azimuth)
        beads = deposit.build_deposit(
            own.points,
            directions,
            width,
            tall,
            own.starts,
            own.moment,
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
        return ~among.touched(
            self.nozzle, tip, _in_space(tool, azimuth), tips.moment[rows], tips.own[rows]
        )


def of_nozzle(
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
    looked = depositing(
        0.5 * nozzle.diameter,
        float(np.tan(nozzle.half_angle)),
        nozzle.length,
        deposit.size[1],
        lean,
    )
    frame = np.eye(4)
    frame[2, 3] = platform.height
    plates = [disc(2.0 * platform.radius, frame)] if platform.radius > 0.0 else []
    bodies = build_bodies(plates, deposit.points, looked.reach)
    return Clearance(
        tips, deposit, looked.larger(chord_error + CONVERGED), looked.foot, bodies, between
    )


def around(
    radius: Array, turn: float, chord_error: float, least: int, one_side: bool
) -> tuple[Index, Array]:
    """Bead and azimuth (k,) of the points of arcs of radii (m,) over `turn` rad, as they are seen from any of them at the
    azimuth 0: to both sides, or to one alone; of full circles half of them.

    They are the points that a bead of that chord error (mm) and fewest points of a full turn has, so that it is cut into the
    same pieces.
    """
    full = turn >= 2.0 * np.pi
    counts = np.array([turn_segments(float(each), chord_error, turn, least) for each in radius])
    last = -(-counts // 2) if full and one_side else counts
    first = np.zeros_like(last) if full or one_side else -last
    sizes = last - first + 1
    bead = np.repeat(np.arange(len(radius)), sizes)
    place = np.arange(len(bead)) - np.repeat(np.cumsum(sizes) - sizes - first, sizes)
    return bead, turn * place / counts[bead]


def _place(radius: Array, azimuth: Array, height: Array) -> Array:
    return np.stack([radius * np.cos(azimuth), radius * np.sin(azimuth), height], axis=1)


def _in_space(direction: Array, azimuth: Array) -> Array:
    """Directions (n, 3) in the feature frame from their components along radius, azimuth and axis."""
    c, s = np.cos(azimuth), np.sin(azimuth)
    along, across, up = columns(direction)
    return np.stack([along * c - across * s, along * s + across * c, up], axis=1)
