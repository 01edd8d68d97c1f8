# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether the nozzle is clear of bodies and deposit at the points of beads, and halfway between them.

The nozzle is the frustum of `clearance`; its lowest part is left out, up to where its side is one nozzle diameter from the
deposit point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..collision.bodies import Bodies, of_bodies
from ..collision.frustum import Frustum, beside_tip
from ..collision.obstacles import Obstacles
from ..geometry.columns import columns
from ..geometry.surroundings import Body
from ..parameters.cell import NozzleParameters
from ..toolpath import Bead, Toolpath

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

COARSE = 0.2  # mm of height left out more over bodies: their triangles are off the true faces by half of that
CAP = 1e-9  # rad
GRAZED = 0.1  # mm of depth that is let pass halfway between points


@dataclass(frozen=True)
class Room:
    """Everything that decides whether an axis at a point is clear: points (n, 3) in the order of deposit."""

    points: Array
    bodies: Bodies
    deposit: Obstacles
    above_bodies: Frustum
    above_deposit: Frustum
    max_tilt: float

    def clear(self, at: Index, axis: Array) -> Mask:
        """Whether the axes (k, 3) at the points numbered `at` (k,) are clear and within the cap."""
        x, y, z = columns(axis)
        clear: Mask = np.arctan2(np.hypot(x, y), z) <= self.max_tilt + CAP
        rows = np.flatnonzero(clear)
        clear[rows] = ~self.bodies.touched(self.above_bodies, self.points[at[rows]], axis[rows])
        rows = np.flatnonzero(clear)
        clear[rows] = ~self.deposit.touched(self.above_deposit, self.points[at[rows]], axis[rows], at[rows] + 1)
        return clear


def left_out(nozzle: NozzleParameters) -> float:
    """Height (mm) over the tip plane at which the nozzle's side is one nozzle diameter from the deposit point."""
    return beside_tip(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)))


def room_of(toolpath: Toolpath, bodies: Sequence[Body], nozzle: NozzleParameters, max_tilt: float) -> Room:
    """The room of all points of a toolpath, in order, among bodies; max_tilt: rad."""
    points = np.concatenate([bead.points for _, _, bead in toolpath])
    ends = np.cumsum([len(bead) for _, _, bead in toolpath])
    second = np.setdiff1d(np.arange(1, len(points)), ends)
    a, k, low = 0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), left_out(nozzle)
    near_bodies = Frustum(a, k, low + COARSE, nozzle.length)
    return Room(
        points, of_bodies(bodies, points, near_bodies.reach),
        Obstacles(np.stack([points[second - 1], points[second]], axis=1), second),
        near_bodies, Frustum(a, k, low, nozzle.length), max_tilt,
    )


def halfway(beads: Sequence[Bead], tool: Array) -> tuple[Array, Array]:
    """Points and axes (n, 3) halfway from each point to the next of its bead; at the last of a bead its own."""
    points, axes, first = [], [], 0
    for bead in beads:
        mine = tool[first : first + len(bead)]
        first += len(bead)
        mean = mine[:-1] + mine[1:]
        points += [bead.outline.at(np.arange(len(bead) - 1), 0.5)[0], bead.points[-1:]]
        axes += [mean / np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), CAP), mine[-1:]]
    return np.concatenate(points), np.concatenate(axes)


def touched_between(room: Room, beads: Sequence[Bead], tool: Array, free: Mask) -> Mask:
    """The points (n,) that are free as the next of their bead is, and the nozzle touches halfway to it."""
    points, axes = halfway(beads, tool)
    both = free & np.r_[free[1:], False]
    both[np.cumsum([len(bead) for bead in beads]) - 1] = False
    slender = [
        dataclasses.replace(solid, radius=solid.radius - GRAZED * np.hypot(1.0, solid.slope), high=solid.high - GRAZED)
        for solid in (room.above_bodies, room.above_deposit)
    ]
    midway = dataclasses.replace(
        room, points=points, above_bodies=slender[0], above_deposit=slender[1], max_tilt=float(np.pi)
    )
    touched = np.zeros(len(points), dtype=bool)
    rows = np.flatnonzero(both)
    touched[rows] = ~midway.clear(rows, axes[rows])
    return touched


def halved(toolpath: Toolpath, between: Mask) -> Toolpath:
    """The toolpath with a point halfway after each of those marked (n,)."""
    marks = iter(np.split(between, np.cumsum([len(bead) for _, _, bead in toolpath])[:-1]))
    return dataclasses.replace(toolpath, layers=tuple(
        dataclasses.replace(layer, beads=tuple(
            bead.halved(np.flatnonzero(mark)) if mark.any() else bead for bead, mark in zip(layer.beads, marks)
        ))
        for layer in toolpath.layers
    ))
