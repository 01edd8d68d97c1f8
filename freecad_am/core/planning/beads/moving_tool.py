# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points added where linear moves to a fixed target, each with a tool frame of its own, would leave the bead.

Such a move takes the next point of the part straight to the deposition point while the flange turns (Chalvin 2019,
III.A). Seen from the part the nozzle then follows p - (1 - s) R((1 - s) angle) d, s from 0 to 1, for a segment d that
ends at p: it leaves the segment by at most d (1 - s) sin(s angle) <= d angle / 4, outside of a circle where its own
chord error is inside.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...geometry import frames
from ...kinematics.cell import Cell
from ...motion import Motion
from ...toolpath import Bead
from ...types import Array, Integers
from ..turns import configurations as following


def refined_to_chord_error(
    motion: Motion, cell: Cell, chord_error: float, beads: Sequence[Bead]
) -> Motion:
    """Return the motion with points added to its beads until it keeps the chord error (mm).

    beads: the beads of the motion, in order. For the part on the robot. Added points are on the
    curves of the beads, evenly in length and in rotation; the points of a bead get new numbers.
    Segments without joint values at their ends stay unchanged.
    """
    counts = _piece_counts(motion, cell, chord_error)
    row = np.repeat(np.arange(len(motion)), counts)
    step = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    share = step / counts[row]
    added = np.flatnonzero(step < counts[row])
    if not len(added):
        return motion
    columns = {field.name: getattr(motion, field.name)[row] for field in dataclasses.fields(motion)}
    start, end, along = row[added] - 1, row[added], share[added, None]
    columns["position"][added] = _curve_points(motion, beads, end, along[:, 0])
    for name in ("build", "joints"):
        column = getattr(motion, name)
        columns[name][added] = column[start] + along * (column[end] - column[start])
    columns["width"][added] += (1.0 - along[:, 0]) * (motion.width[start] - motion.width[end])
    columns["build"][added] /= np.linalg.norm(columns["build"][added], axis=1, keepdims=True)
    flange = _interpolate_flange(motion, cell, start, end, along[:, 0], columns["position"][added])
    columns["joints"][added] = _joints(motion, cell, flange, columns["joints"][added])
    columns["tool"][added] = cell.tip_in_part(flange)[1]
    columns["halt"][added] = False
    columns["duration"] = columns["duration"] / counts[row]
    first_rows = np.repeat(
        np.maximum.accumulate(np.where(motion.point == 0, np.cumsum(counts) - counts, 0)), counts
    )
    columns["point"] = np.arange(len(row)) - first_rows
    return Motion(**columns)


def origins(motion: Motion, cell: Cell, chord_error: float) -> Integers:
    """(m,) the row of the motion that each row of `refined_to_chord_error` is, or that it is on the way to."""
    return np.repeat(np.arange(len(motion)), _piece_counts(motion, cell, chord_error))


def _curve_points(motion: Motion, beads: Sequence[Bead], end: Integers, share: Array) -> Array:
    """(n, 3) points of the beads a share (n,) of the way along the segments that end at the rows (n,)."""
    number = np.cumsum(motion.deposit & (motion.point == 0)) - 1
    result = np.empty((len(end), 3))
    for bead in np.unique(number[end]):
        in_bead = number[end] == bead
        result[in_bead] = beads[bead].outline.at(motion.point[end[in_bead]] - 1, share[in_bead])[0]
    return result


def _piece_counts(motion: Motion, cell: Cell, chord_error: float) -> Integers:
    """(n,) into how many pieces the segment that ends at each row is cut; 1 where it is none of a bead."""
    counts = np.ones(len(motion), dtype=np.int64)
    inside = (
        motion.deposit[1:] & (motion.point[1:] > 0) & motion.reachable[1:] & motion.reachable[:-1]
    )
    ends = np.flatnonzero(inside) + 1
    start, end = (
        cell.machine.chain.forward(motion.joints[rows])[:, :3, :3] for rows in (ends - 1, ends)
    )
    angle = np.linalg.norm(_rotation_vector(start, end), axis=1)
    length = np.linalg.norm(motion.position[ends] - motion.position[ends - 1], axis=1)
    counts[ends] = np.maximum(
        np.ceil(np.sqrt(length * angle / (4.0 * chord_error)) - 1e-9), 1
    ).astype(np.int64)
    return counts


def _rotation_vector(start: Array, end: Array) -> Array:
    """(n, 3) axis times angle of the rotation that takes start to end (n, 3, 3), in the axes of both their frames."""
    turn = np.swapaxes(start, 1, 2) @ end
    twice = np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        axis=1,
    )
    sine = 0.5 * np.linalg.norm(twice, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0))
    vector: Array = twice * (0.5 * angle / np.maximum(sine, 1e-12))[:, None]
    return vector


def _interpolate_flange(
    motion: Motion, cell: Cell, start: Integers, end: Integers, share: Array, position: Array
) -> Array:
    """(n, 4, 4) flange poses a share of the way from row to row in rotation, with points of the part at the nozzle."""
    start_rotation, end_rotation = (
        cell.machine.chain.forward(motion.joints[rows])[:, :3, :3] for rows in (start, end)
    )
    vector = _rotation_vector(start_rotation, end_rotation)
    angle = np.linalg.norm(vector, axis=1)
    axis = np.where(
        angle[:, None] > 1e-12, vector / np.maximum(angle, 1e-12)[:, None], [0.0, 0.0, 1.0]
    )
    rotation = start_rotation @ frames.rotation_about(axis, share * angle)
    on_flange = cell.carried @ frames.inverse(cell.mount)
    carried = position @ on_flange[:3, :3].T + on_flange[:3, 3]
    return frames.pose(rotation, cell.station[:3, 3] - (rotation @ carried[:, :, None])[:, :, 0])


def _joints(motion: Motion, cell: Cell, flange: Array, reference: Array) -> Array:
    """Joints (n, axes) of the flange poses in the branch of the motion and in the turns of `reference`."""
    arm = cell.machine.arm
    assert arm is not None
    branch = int(np.bincount(arm.branch_of(motion.joints[motion.reachable])).argmax())
    joints = (
        following.from_before(arm, flange, branch, reference)
        if arm.followed
        else arm.inverse_branch(flange, branch)
    )
    turned: Array = joints + 2.0 * np.pi * np.round((reference - joints) / (2.0 * np.pi))
    return turned
