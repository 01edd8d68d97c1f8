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

from ..geometry.frustum import Frustum
from ..geometry.obstacles import of_bodies
from ..geometry.surroundings import Body
from ..issues import ERROR, Issue
from ..kinematics.cell import Cell
from ..motion import Motion

Array = NDArray[np.float64]

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
    ends belong to the travel and are looked at.
    """
    travels = np.flatnonzero(~motion.deposit[1:] & ~motion.deposit[:-1]) + 1
    # the way down onto a start is the last rapid row before the deposit: not a travel
    down = np.append(motion.deposit[1:], False)
    travels = travels[~down[travels]]
    if among is not None:
        chosen = [(int(motion.layer[row]), int(motion.bead[row])) in among for row in travels]
        travels = travels[np.array(chosen, dtype=bool)]
    travels = travels[~np.isnan(motion.joints[travels - 1] + motion.joints[travels]).any(axis=1)]
    if not len(travels):
        return []
    ways = [_way(motion, cell, row) for row in travels]
    obstacles, laid = _obstacles(motion, cell)
    met = np.array([_met(tip, axis, obstacles[laid < row], cell) for row, (tip, axis) in zip(travels, ways, strict=True)])
    hit = _hits_bodies(ways, bodies, cell)
    what = ", ".join(["the deposit", *(body.name for body in bodies)]) + " or the platform"
    return [
        Issue(
            ERROR, "RAPID_COLLISION",
            f"on its way from the bead before the nozzle would meet {what}; raise process.between_layers.lift",
            int(motion.layer[row]), int(motion.bead[row]),
        )
        for row in travels[met | hit]
    ]


def _way(motion: Motion, cell: Cell, row: int) -> tuple[Array, Array]:
    """Tip and tool axis (k, 3) at looks along the travel to a row, in part coordinates."""
    start, end = motion.joints[row - 1], motion.joints[row]
    steps = np.where(cell.machine.chain.sliding, SLIDE, STEP)
    looks = 1 + int(np.ceil((np.abs(end - start) / steps).max()))
    joints = start + np.linspace(0.0, 1.0, looks + 1)[:, None] * (end - start)
    return cell.tip_in_part(cell.machine.chain.forward(joints))


def _hits_bodies(ways: Sequence[tuple[Array, Array]], bodies: Sequence[Body], cell: Cell) -> NDArray[np.bool_]:
    """Whether the nozzle meets a body on each of the ways."""
    if not bodies:
        return np.zeros(len(ways), dtype=bool)
    nozzle = cell.nozzle
    solid = Frustum(
        max(0.5 * nozzle.diameter - BODY_TOUCH, 0.0), float(np.tan(nozzle.half_angle)), BODY_TOUCH, nozzle.length
    )
    tip, axis = (np.concatenate(parts) for parts in zip(*ways, strict=True))
    touched = of_bodies(bodies, tip, solid.reach).touched(solid, tip, axis)
    begin = np.r_[0, np.cumsum([len(way[0]) for way in ways])[:-1]]
    hits: NDArray[np.bool_] = np.logical_or.reduceat(touched, begin)
    return hits


def _obstacles(motion: Motion, cell: Cell) -> tuple[Array, NDArray[np.int64]]:
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


def _met(tip: Array, axis: Array, obstacles: Array, cell: Cell) -> bool:
    """Whether any obstacle point (m, 3) is inside the nozzle at any of the looks: tip and tool axis (k, 3)."""
    nozzle = cell.nozzle
    reach = nozzle.length + 0.5 * nozzle.diameter + nozzle.length * np.tan(nozzle.half_angle)
    near = ((obstacles > tip.min(axis=0) - reach) & (obstacles < tip.max(axis=0) + reach)).all(axis=1)
    if near.any() and _inside(tip, axis, obstacles[near], cell):
        return True
    below = (tip - cell.mount[:3, 3]) @ cell.mount[:3, 2] < -TOUCH
    across = (tip - cell.mount[:3, 3]) @ cell.mount[:3, :2]
    return bool((below & (np.linalg.norm(across, axis=1) < 0.5 * cell.platform_diameter)).any())


def _inside(tip: Array, axis: Array, obstacles: Array, cell: Cell) -> bool:
    """Whether any of the points (m, 3) is inside the nozzle."""
    nozzle = cell.nozzle
    # heights over the tip plane and squared distances from the tip, (m, k), as products of matrices
    height = obstacles @ axis.T - (tip * axis).sum(axis=1)
    centre = obstacles.mean(axis=0)
    local, seat = obstacles - centre, tip - centre
    square = (local * local).sum(axis=1)[:, None] - 2.0 * local @ seat.T + (seat * seat).sum(axis=1)
    room = np.maximum(0.5 * nozzle.diameter + height * np.tan(nozzle.half_angle) - TOUCH, 0.0)
    inside = (height > TOUCH) & (height <= nozzle.length)
    return bool((inside & (square - height * height < room * room)).any())
