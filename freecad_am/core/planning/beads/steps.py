# SPDX-License-Identifier: LGPL-2.1-or-later
"""Removes points of beads that follow each other faster than a controller steps.

Where walls are thin, small, or printed fast, corners and ends have points some hundredths of a
millimetre apart. Removed points are within a share of the chord error of the remaining path;
otherwise they stay, and the move gets the time of a step.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...controller import Controller
from ...geometry import frames
from ...kinematics.cell import Cell
from ...motion import Motion
from ...toolpath import Bead
from ...types import Array, Index, Integers, Mask
from ..turns import configurations as following


def refined_to_chord_error(
    motion: Motion, cell: Cell, chord_error: float, beads: Sequence[Bead]
) -> Motion:
    """Add points to the beads of a motion until it keeps the chord error.

    For a part on the robot. Added points are on the curves of the beads, evenly in length and
    in rotation; the points of a bead get new numbers. Segments without joint values at their
    ends stay unchanged.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    chord_error : float
        Largest deviation of the tip between two points, mm.
    beads : sequence of Bead
        The beads of the motion, in order.

    Returns
    -------
    Motion
        The motion with added rows.
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
    """Return the row of the motion from which each row of `refined_to_chord_error` comes.

    Parameters
    ----------
    motion : Motion
        The motion before the refinement, n rows.
    cell : Cell
        The cell.
    chord_error : float
        As in `refined_to_chord_error`, mm.

    Returns
    -------
    (m,) int array
        Row of the motion; for an added point, the row at the end of its segment.
    """
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
    """Return the number of pieces (n,) for the segment that ends at each row; 1 outside of beads."""
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
    on_flange = cell.poses.carried @ frames.inverse(cell.poses.mount)
    carried = position @ on_flange[:3, :3].T + on_flange[:3, 3]
    return frames.pose(
        rotation, cell.poses.station[:3, 3] - (rotation @ carried[:, :, None])[:, :, 0]
    )


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


MIN_STEP_SHARE = 0.96  # of the least way, below which a post rejects two points
OMITTED_DEVIATION_SHARE = 0.4  # share of the chord error for the deviation of omitted points
REACH = 2000.0  # mm; maximum distance of a point from the axis that turns it


def programmed(
    motion: Motion, controller: Controller, chord_error: float, blend: float
) -> tuple[Motion, Index]:
    """Return the motion for programs of a controller, without steps that are too short for it.

    Parameters
    ----------
    motion : Motion
        The motion of n rows.
    controller : Controller
        The controller, with its least time and blend between points.
    chord_error : float
        Largest deviation that removing a row may cause, mm.
    blend : float
        Blending of the program, percent.

    Returns
    -------
    motion : Motion
        The motion of m rows. The time of removed rows goes to the next remaining row.
    rows : (m,) int array
        Its rows in the given motion.
    """
    step, blended = controller.least_step, controller.least_blend
    if not step:
        return motion, np.arange(len(motion))
    rows = np.flatnonzero(
        _select_rows(motion, step, 100.0 * blended / blend if blend else 0.0, chord_error)
    )
    columns = {
        field.name: getattr(motion, field.name)[rows] for field in dataclasses.fields(motion)
    }
    inside = columns["deposit"] & (columns["point"] > 0)
    duration = np.diff(np.cumsum(motion.duration)[rows], prepend=0.0)
    # the time of removed rows goes to the move that replaces them
    joined = inside & (np.diff(rows, prepend=-1) > 1)
    columns["duration"] = np.where(joined, duration, columns["duration"])
    slow = inside & (columns["duration"] < step)
    columns["duration"] = np.where(slow, step, columns["duration"])
    step_lengths = np.linalg.norm(
        np.diff(columns["position"], axis=0, prepend=columns["position"][:1]), axis=1
    )
    columns["speed"] = np.where(
        joined | slow, step_lengths / np.where(inside, columns["duration"], 1.0), columns["speed"]
    )
    return Motion(**columns), rows


def _select_rows(motion: Motion, seconds: float, min_distance: float, chord_error: float) -> Mask:
    """Return which rows (n,) stay: ends of beads, rapids, and rows `seconds` and `min_distance` mm after
    the previous one.
    """
    step_lengths = np.linalg.norm(
        np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1
    )
    inside = motion.deposit & (motion.point > 0) & motion.reachable
    steps = np.nan_to_num(motion.duration) / seconds
    steps = np.where(
        inside, np.minimum(steps, step_lengths / min_distance) if min_distance else steps, 1.0
    )
    keep: Mask = np.ones(len(motion), dtype=np.bool_)
    last_points = inside & np.append(~inside[1:], True)
    starts = np.flatnonzero(motion.deposit & (motion.point == 0))
    soon = np.flatnonzero(inside & (steps < 1.0))
    for bead in np.unique(np.searchsorted(starts, soon, side="right") - 1).tolist():
        start = int(starts[bead])
        rows = slice(start, start + int(np.argmax(last_points[start:])) + 1)
        keep[rows] = _sparse(np.r_[0.0, np.cumsum(steps[rows][1:])])
    keep |= motion.halt
    keep = _add_needed(motion, keep, OMITTED_DEVIATION_SHARE * chord_error)
    return (
        _remove_returns(motion, keep, min_distance, OMITTED_DEVIATION_SHARE * chord_error)
        if min_distance
        else keep
    )


def _remove_returns(motion: Motion, keep: Mask, min_distance: float, off: float) -> Mask:
    """Return the rows that stay, without those closer than `min_distance` mm to the previous row.

    Such rows occur where a bead turns round in less than a blend: there the distance between two
    points counts, not the length along the bead. Removed rows are within `off` mm of the straight
    path between the remaining ones; otherwise the row stays.
    """
    keep, checked = keep.copy(), np.zeros(len(keep), dtype=bool)
    inside = motion.deposit & (motion.point > 0) & motion.reachable
    last_points = inside & np.append(~inside[1:], True)
    while True:
        rows = np.flatnonzero(keep)
        step_lengths = np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)
        # a rapid leads to the start of a bead, and it has no blend
        close_rows = 1 + np.flatnonzero(
            (step_lengths < MIN_STEP_SHARE * min_distance) & inside[rows[1:]]
        )
        pairs = [(rows[k], rows[k - 1]) for k in close_rows.tolist()]
        pair = next((pair for pair in pairs if not checked[pair[0]]), None)
        if pair is None:
            return keep
        checked[pair[0]] = True
        for row in pair:
            if motion.halt[row] or last_points[row] or not inside[row]:
                continue
            position = int(np.searchsorted(rows, row))
            start, end = int(rows[position - 1]), int(rows[position + 1])
            gone = np.arange(start + 1, end)
            ends = np.full(len(gone), start), np.full(len(gone), end)
            if (_off_way(motion, *ends, gone) <= off).all():
                keep[row] = False
                break


def _sparse(clock: Array) -> Mask:
    """Return which points (n,) of a bead stay so that they are at least 1 apart on a clock; both
    ends stay.
    """
    keep: Mask = np.r_[True, np.diff(np.floor(clock)) > 0.0] & (clock <= clock[-1] - 1.0)
    keep[0] = keep[-1] = True
    rows = np.flatnonzero(keep)
    too_close = np.r_[False, np.diff(clock[rows]) < 1.0]
    too_close[-1] = False
    keep[rows[too_close]] = False
    return keep


def _add_needed(motion: Motion, keep: Mask, off: float) -> Mask:
    """Return the rows that stay and as few additional rows as needed.

    Removed rows then lie within `off` mm of the path between the remaining ones, and axes do not
    turn far enough to leave the path in between.
    """
    keep = keep.copy()
    while True:
        gone = np.flatnonzero(~keep)
        rows = np.flatnonzero(keep)
        next_rows = np.searchsorted(rows, gone)
        start, end = rows[next_rows - 1], rows[next_rows]
        deviation = _off_way(motion, start, end, gone)
        exceeds = deviation > off
        if not exceeds.any():
            return keep
        # the farthest point of each gap often suffices for its neighbours
        order = np.lexsort((deviation[exceeds], start[exceeds]))
        farthest_rows = np.flatnonzero(np.diff(start[exceeds][order], append=-1))
        keep[gone[exceeds][order[farthest_rows]]] = True


def _off_way(motion: Motion, start: Index, end: Index, gone: Index) -> Array:
    """Return the distance (k,) mm of removed rows from the straight path between two rows, or the
    distance by which axes that turn between these would leave it.
    """
    chord = motion.position[end] - motion.position[start]
    offset = motion.position[gone] - motion.position[start]
    share = np.einsum("nk,nk->n", offset, chord) / np.maximum(
        np.einsum("nk,nk->n", chord, chord), 1e-300
    )
    distance = np.linalg.norm(offset - np.clip(share, 0.0, 1.0)[:, None] * chord, axis=1)
    turn = np.linalg.norm(motion.joints[end] - motion.joints[start], axis=1)
    deviation: Array = np.maximum(distance, 0.125 * REACH * turn * turn)
    return deviation
