# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nozzle contacts on the rapids of a motion, checked independently of planning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..collision.bead_ends import Bead, BeadEnds, Beads, Size
from ..collision.scene import scene
from ..geometry.obstacles import Body, disc
from ..kinematics.cell import Cell
from ..motion import Motion
from ..types import Index

# mm; maximum distance between checked positions along the path of any point of the nozzle.
# Fractions of a move at which its path length is measured
STEP, SHARES = 0.5, np.linspace(0.0, 1.0, 9)
PIECE = 2048  # batch size of moves or checked positions


@dataclass(frozen=True, eq=False)
class RapidsLooked:
    """Result of the rapid check.

    moves: number of rapids. places: number of checked positions. step: maximum spacing of checked
    positions, mm. rows: (k,) motion rows reached by a rapid with contact. place: layer, bead and
    point of the first contact, None without contact.
    """

    moves: int
    places: int
    step: float
    rows: Index
    place: tuple[int, int, int] | None


def looked_at(
    motion: Motion,
    beads: Sequence[Bead],
    cell: Cell,
    bodies: Sequence[Body],
    width: float,
    height: float,
    max_places: int,
) -> RapidsLooked:
    """Check whether the nozzle touches bodies, the platform or printed beads on any rapid.

    Rapids are straight in joint space. The path to the first row and to unreachable rows is unknown
    and not checked.

    Parameters
    ----------
    motion : Motion
        The motion.
    beads : sequence of Bead
        Beads of the motion in order, in the part.
    cell : Cell
        Machine, nozzle and platform.
    bodies : sequence of Body
        Obstacles in the part.
    width, height : float
        Width and height of beads without predicted values, mm.
    max_places : int
        Maximum number of positions to check, evenly along all rapids. Both ends of each rapid are
        always checked.

    Returns
    -------
    RapidsLooked
        Number of checks, spacing, mm, and rows with contact.
    """
    rows = 1 + np.flatnonzero(~motion.deposit[1:] & motion.reachable[1:] & motion.reachable[:-1])
    start, turned = motion.joints[rows - 1], motion.joints[rows] - motion.joints[rows - 1]
    chain = cell.machine.chain
    size = Size(
        0.5 * cell.nozzle.diameter, float(np.tan(cell.nozzle.half_angle)), cell.nozzle.length
    )
    travel, corners = np.zeros(len(rows)), [np.zeros((0, 3))]
    for rows_now in _pieces(len(rows)):
        joints = start[rows_now, None] + SHARES[:, None] * turned[rows_now, None]
        tip, axis = (
            column.reshape(len(rows_now), len(SHARES), 3)
            for column in cell.tip_in_part(chain.forward(joints.reshape(-1, chain.axes)))
        )
        for end in (tip, tip + size.length * axis):
            travel[rows_now] = np.maximum(
                travel[rows_now], np.linalg.norm(np.diff(end, axis=1), axis=2).sum(axis=1)
            )
        corners += [tip.min(axis=(0, 1))[None], tip.max(axis=(0, 1))[None]]
    # one more position for each move, because both ends are checked
    step = max(STEP, float(travel.sum()) / max(max_places - 2 * len(rows), 1))
    count = 2 + np.floor(travel / step).astype(np.intp)
    move = np.repeat(np.arange(len(rows)), count)
    share = (np.arange(len(move)) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(
        count - 1, count
    )

    ends = BeadEnds.of(Beads.of(beads, width, height), size)
    platform = (
        [disc(cell.platform_diameter, cell.poses.mount)] if cell.platform_diameter > 0.0 else []
    )
    reach = float(np.hypot(size.length, size.radius + size.slope * size.length))
    stands = [*bodies, *platform, *cell.in_part()]
    around = scene(stands, np.concatenate(corners), reach, ends.deposit) if len(rows) else None
    deposited = np.cumsum(motion.deposit)[rows]
    met = np.zeros(len(rows), dtype=bool)
    for rows_now in _pieces(len(move)):
        assert around is not None
        moves_now = move[rows_now]
        tip, axis = cell.tip_in_part(
            chain.forward(start[moves_now] + share[rows_now, None] * turned[moves_now])
        )
        hit = around.find_touching(
            ends.nozzle(tip, deposited[moves_now]), tip, axis, deposited[moves_now]
        )
        met[moves_now[hit]] = True
    touched, first_touch = rows[met], None
    if len(touched):
        row = touched[0]
        first_touch = (int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row]))
    return RapidsLooked(len(rows), len(move), step, touched, first_touch)


def _pieces(count: int) -> list[Index]:
    return [np.arange(begin, min(begin + PIECE, count)) for begin in range(0, count, PIECE)]
