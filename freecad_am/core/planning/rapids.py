# SPDX-License-Identifier: LGPL-2.1-or-later
"""Looks whether the nozzle stays clear of deposit, platform and bodies on the rapid moves between beads.

While depositing, clearance is settled before the joints are planned. A rapid runs straight in the joints, so where the
nozzle goes is known only now: it is driven through in small steps, against everything deposited by then, and against the
triangles of the bodies around the part.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from ..collision.bodies import of_bodies
from ..collision.frustum import Frustum
from ..collision.obstacles import Obstacles
from ..geometry.surroundings import Body
from ..issues import ERROR, Issue
from ..kinematics.cell import Cell
from ..motion import Motion

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

# largest turn of an axis between two looks, rad, and way of one that slides, mm; between neighbouring obstacle points, mm
STEP = np.radians(5.0)
SLIDE = 5.0
GRAIN = 1.5
PLATFORM_GRAIN = 4.0
# how deep a point must be inside the nozzle to count: beads are followed to their chord error, mm
TOUCH = 0.05
# the same for bodies, whose triangles are as far from their true faces
BODY_TOUCH = 0.1


def collisions(
    motion: Motion, cell: Cell, among: Collection[tuple[int, int]] | None = None, bodies: Sequence[Body] = ()
) -> list[Issue]:
    """An issue for every travel between two beads on which the nozzle would meet deposit, platform or bodies.

    Only the travels to the beads `among` (layer, bead) are looked at, where they are given.

    The withdrawal and the way down run along the tool axis, through room the nozzle itself keeps clear; their upper
    ends belong to the travel and are looked at. Where they are longer than the nozzle, its end enters further room: that
    is looked at too.
    """
    travels = np.flatnonzero(~motion.deposit[1:] & ~motion.deposit[:-1]) + 1
    # the way down onto a start is the last rapid row before the deposit: not a travel
    down = np.append(motion.deposit[1:], False)
    travels = travels[~down[travels]]
    if among is not None:
        chosen = [(int(motion.layer[row]), int(motion.bead[row])) in among for row in travels]
        travels = travels[np.array(chosen, dtype=bool)]
    travels = travels[~np.isnan(motion.joints[travels - 1] + motion.joints[travels]).any(axis=1)]
    length = cell.nozzle.length
    met = _met([_way(motion, cell, row) for row in travels], travels, motion, cell, bodies, TOUCH)
    lifts = [lift for lift in _long_lifts(motion, length) if among is None or lift[2:] in among]
    ends = [_along(motion, start, height) for start, height, _, _ in lifts]
    met_above = _met(ends, np.array([lift[0] for lift in lifts], dtype=np.intp), motion, cell, bodies, length - SLIDE)
    places = [(int(motion.layer[row]), int(motion.bead[row])) for row in travels[met]]
    places += [lift[2:] for lift, hit in zip(lifts, met_above, strict=True) if hit]
    what = ", ".join(["the deposit", *(body.name for body in bodies)]) + " or the platform"
    return [
        Issue(
            ERROR, "RAPID_COLLISION",
            f"on its way from the bead before the nozzle would meet {what}; raise process.between_layers.lift",
            layer, bead,
        )
        for layer, bead in dict.fromkeys(places)
    ]


def _met(
    ways: Sequence[tuple[Array, Array]], rows: Index, motion: Motion, cell: Cell, bodies: Sequence[Body], low: float
) -> Mask:
    """Whether the nozzle above the height `low` meets anything on each of the ways."""
    if not ways:
        return np.zeros(0, dtype=bool)
    hit: Mask = _hits_deposit(ways, rows, motion, cell, low) | _hits_bodies(ways, bodies, cell, low)
    return hit


def _long_lifts(motion: Motion, length: float) -> list[tuple[int, float, int, int]]:
    """The ways from beads up and down onto them that are longer than `length`: row of the deposit, height, layer, bead."""
    laid, joints = motion.deposit, motion.joints
    found = []
    for bead_row, lifted in (
        *((row, row + 1) for row in np.flatnonzero(laid[:-1] & ~laid[1:])),
        *((row, row - 2) for row in np.flatnonzero(~laid[:-1] & laid[1:]) + 1 if row > 1 and not laid[row - 2]),
    ):
        height = float(np.linalg.norm(motion.position[lifted] - motion.position[bead_row]))
        if height > length and not np.isnan(joints[lifted]).any():
            found.append((int(bead_row), height, int(motion.layer[lifted]), int(motion.bead[lifted])))
    return found


def _along(motion: Motion, row: int, height: float) -> tuple[Array, Array]:
    """Tip and tool axis (k, 3) at looks from a point of the deposit up along its tool axis."""
    axis = motion.tool[row]
    tip = motion.position[row] + np.append(np.arange(0.0, height, SLIDE), height)[:, None] * axis
    return tip, np.broadcast_to(axis, tip.shape)


def _way(motion: Motion, cell: Cell, row: int) -> tuple[Array, Array]:
    """Tip and tool axis (k, 3) at looks along the travel to a row, in part coordinates."""
    start, end = motion.joints[row - 1], motion.joints[row]
    steps = np.where(cell.machine.chain.sliding, SLIDE, STEP)
    looks = 1 + int(np.ceil((np.abs(end - start) / steps).max()))
    joints = start + np.linspace(0.0, 1.0, looks + 1)[:, None] * (end - start)
    return cell.tip_in_part(cell.machine.chain.forward(joints))


def _hits_bodies(ways: Sequence[tuple[Array, Array]], bodies: Sequence[Body], cell: Cell, low: float) -> Mask:
    """Whether the nozzle, above the height `low`, meets a body on each of the ways."""
    if not bodies:
        return np.zeros(len(ways), dtype=bool)
    nozzle = cell.nozzle
    solid = Frustum(
        max(0.5 * nozzle.diameter - BODY_TOUCH, 0.0), float(np.tan(nozzle.half_angle)), max(low, BODY_TOUCH),
        nozzle.length,
    )
    tip, axis = (np.concatenate(parts) for parts in zip(*ways, strict=True))
    touched = of_bodies(bodies, tip, solid.reach).touched(solid, tip, axis)
    begin = np.r_[0, np.cumsum([len(way[0]) for way in ways])[:-1]]
    hits: Mask = np.logical_or.reduceat(touched, begin)
    return hits


def _hits_deposit(
    ways: Sequence[tuple[Array, Array]], rows: Index, motion: Motion, cell: Cell, low: float = TOUCH
) -> Mask:
    """Whether the nozzle, above the height `low`, meets the platform or what is deposited before the row, on each way."""
    nozzle = cell.nozzle
    solid = Frustum(0.5 * nozzle.diameter - TOUCH, float(np.tan(nozzle.half_angle)), max(low, TOUCH), nozzle.length)
    points, laid = _obstacles(motion, cell)
    tip, axis = (np.concatenate(parts) for parts in zip(*ways, strict=True))
    count = np.array([len(way[0]) for way in ways])
    touched = Obstacles(points[:, None], laid).touched(solid, tip, axis, np.repeat(rows, count))
    local = (tip - cell.mount[:3, 3]) @ cell.mount[:3, :3]
    touched |= (local[:, 2] < -TOUCH) & (np.hypot(local[:, 0], local[:, 1]) < 0.5 * cell.platform_diameter)
    hits: Mask = np.logical_or.reduceat(touched, np.cumsum(count) - count)
    return hits


def _obstacles(motion: Motion, cell: Cell) -> tuple[Array, Index]:
    """Points (m, 3) of deposit and platform in part coordinates, and the row (m,) from which each is there."""
    rows = np.flatnonzero(motion.deposit)
    along = np.cumsum(np.linalg.norm(np.diff(motion.position[rows], axis=0, prepend=motion.position[rows[:1]]), axis=1))
    kept = np.append(True, np.diff(np.floor(along / GRAIN)) > 0)
    radius = 0.5 * cell.platform_diameter
    grid = np.arange(-radius, radius + PLATFORM_GRAIN, PLATFORM_GRAIN)
    x, y = (values.ravel() for values in np.meshgrid(grid, grid))
    inside = np.hypot(x, y) <= radius
    disc = np.stack([x, y, np.zeros(len(x))], axis=1)[inside] @ cell.mount[:3, :3].T + cell.mount[:3, 3]
    points = np.concatenate([disc, motion.position[rows[kept]]])
    return points, np.concatenate([np.full(len(disc), -1), rows[kept]])
