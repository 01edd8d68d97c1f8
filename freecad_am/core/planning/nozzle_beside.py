# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a nozzle that moves meets what stands in the cell, `cell.obstacles`: while it deposits, between points too, and on
rapids where the part moves in the world, for those are led around obstacles only where they stand still beside the part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..collision.nozzle import depositing
from ..collision.scene import scene
from ..geometry import frames
from ..issues import ERROR, Issue
from ..kinematics.cell import Cell
from ..motion import Motion
from ..types import Array, Index
from .rapids.clearance import evenly

ON_BEADS, ON_RAPIDS = "CLEARANCE", "RAPID_COLLISION"
# between two looks: of the joint that moves most, rad and mm, and of the way of the nozzle's ends in the world, mm
STEP, SLIDE, WAY = float(np.radians(2.0)), 5.0, 1.0
PIECE = 4096  # moves, or looks, that are done together


def findings(motion: Motion, cell: Cell) -> list[Issue]:
    """An error for each obstacle that the nozzle meets, and each kind of move, at the first bead where it does."""
    if not cell.obstacles or cell.torch_stands or not cell.arrangement.redundant:
        return []
    known = motion.reachable[1:] & motion.reachable[:-1]
    rows = 1 + np.flatnonzero(known & (motion.deposit[1:] | cell.part_moves))
    met = np.zeros((len(cell.obstacles), len(motion)), dtype=bool)
    for first in range(0, len(rows), PIECE):
        _look(motion, cell, rows[first : first + PIECE], met)
    found = []
    for name, here in zip((one.name for one in cell.obstacles), met, strict=True):
        laying, rapid = np.flatnonzero(here & motion.deposit), np.flatnonzero(here & ~motion.deposit)
        if len(laying):
            found.append(Issue(
                ERROR, ON_BEADS, f"the nozzle touches {name} on {len(laying)} move(s) while it deposits; move it in "
                "cell.obstacles, or the part", *_place(motion, laying[0])))
        if len(rapid):
            found.append(Issue(
                ERROR, ON_RAPIDS, f"the nozzle touches {name} on {len(rapid)} rapid(s), which over a positioner are not led "
                "around it; move it in cell.obstacles, the part, or the seam", *_place(motion, rapid[0])))
    return found


def _place(motion: Motion, row: int) -> tuple[int, int]:
    return int(motion.layer[row]), int(motion.bead[row])


def _look(motion: Motion, cell: Cell, rows: Index, met: NDArray[np.bool_]) -> None:
    """Mark in `met` (obstacles, n) the moves to `rows` on which the nozzle touches."""
    nozzle = cell.nozzle
    start, turned = motion.joints[rows - 1], motion.joints[rows] - motion.joints[rows - 1]
    far = np.abs(turned / np.where(cell.machine.chain.sliding, SLIDE, STEP)).max(axis=1, initial=0.0)
    (tip, axis), (last, leant) = (_in_world(cell, joints) for joints in (start, motion.joints[rows]))
    way = np.linalg.norm(last - tip, axis=1) + nozzle.length * np.linalg.norm(leant - axis, axis=1)
    move, share = evenly(1 + np.ceil(np.maximum(far, way / WAY)).astype(np.intp))
    cone = depositing(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0)
    for first in range(0, len(move), PIECE):
        some = slice(first, first + PIECE)
        tip, axis = _in_world(cell, start[move[some]] + share[some, None] * turned[move[some]])
        for number, body in enumerate(cell.obstacles):
            hit = scene((body,), tip, cone.reach).touched(cone, tip, axis)
            met[number, rows[move[some][hit]]] = True


def _in_world(cell: Cell, joints: Array) -> tuple[Array, Array]:
    """Tip and axis (n, 3) of a nozzle that the flange carries, in the maker's base frame."""
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(joints))
    to_world = frames.inverse(cell.world(joints)) @ (cell.station @ frames.inverse(cell.mount))
    return (
        np.einsum("nij,nj->ni", to_world[:, :3, :3], tip) + to_world[:, :3, 3],
        np.einsum("nij,nj->ni", to_world[:, :3, :3], axis),
    )
