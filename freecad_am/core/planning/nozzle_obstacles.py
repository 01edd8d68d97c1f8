# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a nozzle that moves meets what stands in the cell, `cell.obstacles`, or the links of positioner and track: while
it deposits, between points too, and on rapids where the part moves in the world. Where it stands still rapids see obstacles
among all that stands about the part."""

from __future__ import annotations

import numpy as np

from ..collision.nozzle import depositing
from ..collision.scene import scene
from ..geometry import frames
from ..issues import ERROR, Issue, Text, Word
from ..kinematics.cell import Cell
from ..motion import Motion
from ..types import Array, Mask
from .rapids.clearance import evenly

ON_BEADS = "CLEARANCE"
# between two looks: of the joint that moves most, rad and mm, and of the way of the nozzle's ends in the world, mm
STEP, SLIDE, WAY = float(np.radians(2.0)), 5.0, 1.0
PIECE = 4096  # moves, or looks, that are done together


def in_the_way(cell: Cell) -> tuple[str, ...]:
    """What is looked at, by the names that messages have: obstacles, then the links beside the robot."""
    return (*(body.name for body in cell.obstacles), *(one.name for one in cell.external_links))


def findings(motion: Motion, cell: Cell) -> list[Issue]:
    """An error for each of these that the nozzle meets while it deposits, at the first bead where it does."""
    rows = 1 + np.flatnonzero(motion.deposit[1:])
    met_there, found = met(cell, motion.joints[rows - 1], motion.joints[rows]), []
    for number, (name, here) in enumerate(zip(in_the_way(cell), met_there, strict=True)):
        laying = rows[here]
        remedy = (
            "move it in cell.obstacles, or the part"
            if number < len(cell.obstacles)
            else ("lift the part over it by cell.platform, or move it in cell.external")
        )
        if len(laying):
            found.append(
                Issue(
                    ERROR,
                    ON_BEADS,
                    Text(
                        "the nozzle touches {} on {} move(s) while it deposits; {}",
                        name,
                        len(laying),
                        Word(remedy),
                    ),
                    int(motion.layer[laying[0]]),
                    int(motion.bead[laying[0]]),
                )
            )
    return found


def met(cell: Cell, start: Array, end: Array) -> Mask:
    """(k, n) which of what is `in_the_way` a nozzle meets on n moves straight in the joints (n, axes); none where these are
    NaN."""
    found = np.zeros((len(in_the_way(cell)), len(start)), dtype=bool)
    if cell.torch_stands or not len(found):
        return found
    known = np.flatnonzero(np.isfinite(start + end).all(axis=1))
    for first in range(0, len(known), PIECE):
        rows = known[first : first + PIECE]
        found[:, rows] = _met(cell, start[rows], end[rows])
    return found


def _met(cell: Cell, start: Array, end: Array) -> Mask:
    nozzle, turned, obstacles = cell.nozzle, end - start, len(cell.obstacles)
    found = np.zeros((obstacles + len(cell.external_links), len(start)), dtype=bool)
    far = np.abs(turned / np.where(cell.machine.chain.sliding, SLIDE, STEP)).max(
        axis=1, initial=0.0
    )
    (tip, axis), (last, leant) = (_in_world(cell, joints) for joints in (start, end))
    way = np.linalg.norm(last - tip, axis=1) + nozzle.length * np.linalg.norm(leant - axis, axis=1)
    move, share = evenly(1 + np.ceil(np.maximum(far, way / WAY)).astype(np.intp))
    cone = depositing(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0)
    for first in range(0, len(move), PIECE):
        some = slice(first, first + PIECE)
        joints = start[move[some]] + share[some, None] * turned[move[some]]
        tip, axis = _in_world(cell, joints)
        for number, body in enumerate(cell.obstacles):
            hit = scene((body,), tip, cone.reach).touched(cone, tip, axis)
            found[number, move[some][hit]] = True
        to_world = frames.inverse(cell.world(joints))[:, None] @ cell.external_link_frames(joints)
        for number, one in enumerate(cell.external_links):
            hit = one.solid.touched(
                cone.bodies, *_seen(frames.inverse(to_world[:, number]), tip, axis)
            )
            found[obstacles + number, move[some][hit]] = True
    return found


def _in_world(cell: Cell, joints: Array) -> tuple[Array, Array]:
    """Tip and axis (n, 3) of a nozzle that the flange carries, in the maker's base frame."""
    to_world = frames.inverse(cell.world(joints)) @ (cell.station @ frames.inverse(cell.mount))
    return _seen(to_world, *cell.tip_in_part(cell.machine.chain.forward(joints)))


def _seen(pose: Array, tip: Array, axis: Array) -> tuple[Array, Array]:
    """Points and directions (n, 3) seen through poses (n, 4, 4)."""
    turn = pose[:, :3, :3]
    return np.einsum("nij,nj->ni", turn, tip) + pose[:, :3, 3], np.einsum("nij,nj->ni", turn, axis)
