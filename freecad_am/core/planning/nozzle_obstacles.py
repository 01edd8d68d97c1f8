# SPDX-License-Identifier: LGPL-2.1-or-later
"""Detect contact of a moving nozzle with `cell.obstacles` or links of positioner and track.

The check covers deposit moves, including between points, and rapids if the part moves in the world.
If the part is fixed, rapids treat obstacles like the other bodies around the part.
"""

from __future__ import annotations

import numpy as np

from ..collision.scene import depositing, scene
from ..geometry import frames
from ..issues import ERROR, Issue, Text, Word
from ..kinematics.cell import Cell
from ..motion import Motion
from ..types import Array, Mask
from .rapids.clearance import evenly

ON_BEADS = "CLEARANCE"
# maximum steps between two checks: joint motion, rad and mm, and motion of the nozzle ends in the
# world, mm
STEP, SLIDE, WAY = float(np.radians(2.0)), 5.0, 1.0
PIECE = 4096  # moves or checks per batch


def in_the_way(cell: Cell) -> tuple[str, ...]:
    """Return the names of the bodies to check for contact with a moving nozzle.

    Parameters
    ----------
    cell : Cell
        The cell.

    Returns
    -------
    tuple of str
        Names in messages: obstacles, then external links.
    """
    return (
        *(body.name for body in cell.shapes.obstacles),
        *(link.name for link in cell.shapes.external_links),
    )


def findings(motion: Motion, cell: Cell) -> list[Issue]:
    """Report each body that the nozzle touches while depositing, at the first bead with contact."""
    rows = 1 + np.flatnonzero(motion.deposit[1:])
    met_there, issues = find_contacts(cell, motion.joints[rows - 1], motion.joints[rows]), []
    for number, (name, hits) in enumerate(zip(in_the_way(cell), met_there, strict=True)):
        laying = rows[hits]
        remedy = (
            "move the obstacle in cell.obstacles, or move the part"
            if number < len(cell.shapes.obstacles)
            else ("raise the part with cell.platform, or move the mechanism in cell.external")
        )
        if len(laying):
            issues.append(
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
    return issues


def find_contacts(cell: Cell, start: Array, end: Array) -> Mask:
    """Return which bodies a moving nozzle touches on joint moves.

    Parameters
    ----------
    cell : Cell
        The cell; a fixed torch has no contacts.
    start, end : (n, axes) array
        Joints at the ends of the moves, rad or mm; moves with NaN have no contact.

    Returns
    -------
    (k, n) bool array
        One row per body of `in_the_way`.
    """
    hits = np.zeros((len(in_the_way(cell)), len(start)), dtype=bool)
    if cell.torch_stands or not len(hits):
        return hits
    reachable = np.flatnonzero(np.isfinite(start + end).all(axis=1))
    for begin in range(0, len(reachable), PIECE):
        rows = reachable[begin : begin + PIECE]
        hits[:, rows] = _find_batch_contacts(cell, start[rows], end[rows])
    return hits


def _find_batch_contacts(cell: Cell, start: Array, end: Array) -> Mask:
    nozzle, turned, obstacles = cell.nozzle, end - start, len(cell.shapes.obstacles)
    hits = np.zeros((obstacles + len(cell.shapes.external_links), len(start)), dtype=bool)
    joint_steps = np.abs(turned / np.where(cell.machine.chain.sliding, SLIDE, STEP)).max(
        axis=1, initial=0.0
    )
    (tip, axis), (end_tip, leant) = (_in_world(cell, joints) for joints in (start, end))
    tip_travel = np.linalg.norm(end_tip - tip, axis=1) + nozzle.length * np.linalg.norm(
        leant - axis, axis=1
    )
    move, share = evenly(1 + np.ceil(np.maximum(joint_steps, tip_travel / WAY)).astype(np.intp))
    cone = depositing(0.5 * nozzle.diameter, float(np.tan(nozzle.half_angle)), nozzle.length, 0.0)
    for begin in range(0, len(move), PIECE):
        batch = slice(begin, begin + PIECE)
        joints = start[move[batch]] + share[batch, None] * turned[move[batch]]
        tip, axis = _in_world(cell, joints)
        for number, body in enumerate(cell.shapes.obstacles):
            hit = scene((body,), tip, cone.reach).find_touching(cone, tip, axis)
            hits[number, move[batch][hit]] = True
        to_world = frames.inverse(cell.world(joints))[:, None] @ cell.external_link_frames(joints)
        for number, link in enumerate(cell.shapes.external_links):
            hit = link.solid.find_touching(
                cone.bodies, *_transform(frames.inverse(to_world[:, number]), tip, axis)
            )
            hits[obstacles + number, move[batch][hit]] = True
    return hits


def _in_world(cell: Cell, joints: Array) -> tuple[Array, Array]:
    """Return tip and axis (n, 3) of a moving nozzle in the manufacturer's base frame."""
    to_world = frames.inverse(cell.world(joints)) @ (
        cell.poses.station @ frames.inverse(cell.poses.mount)
    )
    return _transform(to_world, *cell.tip_in_part(cell.machine.chain.forward(joints)))


def _transform(pose: Array, tip: Array, axis: Array) -> tuple[Array, Array]:
    """Transform points and directions (n, 3) by poses (n, 4, 4)."""
    turn = pose[:, :3, :3]
    return np.einsum("nij,nj->ni", turn, tip) + pose[:, :3, 3], np.einsum("nij,nj->ni", turn, axis)
