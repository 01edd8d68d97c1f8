# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a nozzle that moves meets what stands in the cell, `cell.obstacles`: while it deposits, between points too, and on
rapids where the part moves in the world. Where it stands still rapids see obstacles among all that stands about the part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..collision.nozzle import depositing
from ..collision.scene import scene
from ..geometry import frames
from ..issues import ERROR, Issue
from ..kinematics.cell import Cell
from ..motion import Motion
from ..types import Array
from .rapids.clearance import evenly

ON_BEADS = "CLEARANCE"
# between two looks: of the joint that moves most, rad and mm, and of the way of the nozzle's ends in the world, mm
STEP, SLIDE, WAY = float(np.radians(2.0)), 5.0, 1.0
PIECE = 4096  # moves, or looks, that are done together


def findings(motion: Motion, cell: Cell) -> list[Issue]:
    """An error for each obstacle that the nozzle meets while it deposits, at the first bead where it does."""
    rows = 1 + np.flatnonzero(motion.deposit[1:])
    met_there, found = met(cell, motion.joints[rows - 1], motion.joints[rows]), []
    for body, here in zip(cell.obstacles, met_there, strict=True):
        laying = rows[here]
        if len(laying):
            found.append(Issue(
                ERROR, ON_BEADS, f"the nozzle touches {body.name} on {len(laying)} move(s) while it deposits; move it in "
                "cell.obstacles, or the part", int(motion.layer[laying[0]]), int(motion.bead[laying[0]])))
    return found


def met(cell: Cell, start: Array, end: Array) -> NDArray[np.bool_]:
    """(obstacles, k) which of them a nozzle meets on moves straight in the joints (k, axes); none where these are NaN."""
    found = np.zeros((len(cell.obstacles), len(start)), dtype=bool)
    if cell.torch_stands or not cell.arrangement.redundant:
        return found
    known = np.flatnonzero(np.isfinite(start + end).all(axis=1)) if cell.obstacles else np.zeros(0, dtype=np.intp)
    for first in range(0, len(known), PIECE):
        rows = known[first : first + PIECE]
        found[:, rows] = _met(cell, start[rows], end[rows])
    return found


def _met(cell: Cell, start: Array, end: Array) -> NDArray[np.bool_]:
    nozzle, turned = cell.nozzle, end - start
    found = np.zeros((len(cell.obstacles), len(start)), dtype=bool)
    far = np.abs(turned / np.where(cell.machine.chain.sliding, SLIDE, STEP)).max(axis=1, initial=0.0)
    (tip, axis), (last, leant) = (_in_world(cell, joints) for joints in (start, end))
    way = np.linalg.norm(last - tip, axis=1) + nozzle.length * np.linalg.norm(leant - axis, axis=1)
    move, share = evenly(1 + np.ceil(np.maximum(far, way / WAY)).astype(np.intp))
    cone = depositing(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0)
    for first in range(0, len(move), PIECE):
        some = slice(first, first + PIECE)
        tip, axis = _in_world(cell, start[move[some]] + share[some, None] * turned[move[some]])
        for number, body in enumerate(cell.obstacles):
            hit = scene((body,), tip, cone.reach).touched(cone, tip, axis)
            found[number, move[some][hit]] = True
    return found


def _in_world(cell: Cell, joints: Array) -> tuple[Array, Array]:
    """Tip and axis (n, 3) of a nozzle that the flange carries, in the maker's base frame."""
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(joints))
    to_world = frames.inverse(cell.world(joints)) @ (cell.station @ frames.inverse(cell.mount))
    return (
        np.einsum("nij,nj->ni", to_world[:, :3, :3], tip) + to_world[:, :3, 3],
        np.einsum("nij,nj->ni", to_world[:, :3, :3], axis),
    )
