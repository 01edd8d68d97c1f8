# SPDX-License-Identifier: LGPL-2.1-or-later
"""Remove bead points that follow each other faster than the controller's interpolation step.

In walls that are thin, small or printed fast, corners and ends have points hundredths of a
millimetre apart. A point is removed only if it lies within a fraction of the chord error of the
remaining path. Otherwise it stays, and its move lasts one step.
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

    This applies to a part on the robot. Added points lie on the bead curves, evenly spaced in
    length and rotation. Points are renumbered within each bead. Segments with an unreachable end
    stay unchanged.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    chord_error : float
        Maximum deviation of the tip between two points, mm.
    beads : sequence of Bead
        The beads of the motion, in order.

    Returns
    -------
    Motion
        The motion, including added rows.
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
    """Return the original row of each row of `refined_to_chord_error`.

    Parameters
    ----------
    motion : Motion
        The motion before the refinement, n rows.
    cell : Cell
        The cell.
    chord_error : float
        Chord error of `refined_to_chord_error`, mm.

    Returns
    -------
    (m,) int array
        Row index; for an added point, the row at the end of its segment.
    """
    return np.repeat(np.arange(len(motion)), _piece_counts(motion, cell, chord_error))


def _curve_points(motion: Motion, beads: Sequence[Bead], end: Integers, share: Array) -> Array:
    """Return curve points (n, 3) at fractions (n,) of the segments that end at rows (n,)."""
    number = np.cumsum(motion.deposit & (motion.point == 0)) - 1
    result = np.empty((len(end), 3))
    for bead in np.unique(number[end]):
        in_bead = number[end] == bead
        result[in_bead] = beads[bead].outline.at(motion.point[end[in_bead]] - 1, share[in_bead])[0]
    return result


def _piece_counts(motion: Motion, cell: Cell, chord_error: float) -> Integers:
    """Return the number of parts (n,) of the segment that ends at each row; 1 outside of beads."""
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
    """Return the rotation vectors (n, 3) from start to end (n, 3, 3).

    Their components are the same in both frames.
    """
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
    """Return flange poses (n, 4, 4) at fractions of the rotation from row to row.

    The part points `position` lie at the nozzle.
    """
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
    """Return joints (n, axes) of flange poses, in the branch of the motion and near `reference`."""
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


MIN_STEP_SHARE = 0.96  # fraction of the minimum distance below which a post rejects two points
OMITTED_DEVIATION_SHARE = 0.4  # fraction of the chord error that removed points may deviate
REACH = 2000.0  # mm; maximum distance of a point from the axis that rotates it


def programmed(
    motion: Motion, controller: Controller, chord_error: float, blend: float
) -> tuple[Motion, Index]:
    """Return the motion for a controller, without steps that are too short for it.

    Parameters
    ----------
    motion : Motion
        The motion of n rows.
    controller : Controller
        The controller, including its minimum time and blend between points.
    chord_error : float
        Chord error, mm; bounds the deviation of removed rows.
    blend : float
        Blending of the program, %.

    Returns
    -------
    motion : Motion
        The motion of m rows. Each remaining row takes over the time of the rows removed before it.
    rows : (m,) int array
        Row indices in the given motion.
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
    # the move that replaces removed rows takes over their time
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
    """Return which rows (n,) stay: bead ends, rapids, and rows at least `seconds` and
    `min_distance` (mm) after the previous row.
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
    """Return which rows stay after removing rows within `min_distance` mm of the previous row.

    Such rows occur where a bead reverses within a blend: there the direct distance counts, not the
    length along the bead. A row is removed only if all removed rows then deviate by at most `off`
    mm from the straight path.
    """
    keep, checked = keep.copy(), np.zeros(len(keep), dtype=bool)
    inside = motion.deposit & (motion.point > 0) & motion.reachable
    last_points = inside & np.append(~inside[1:], True)
    while True:
        rows = np.flatnonzero(keep)
        step_lengths = np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)
        # exclude bead starts, because the rapid to a bead start has no blend
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
    """Return which points (n,) of a bead stay, at least 1 apart on `clock`; both ends stay."""
    keep: Mask = np.r_[True, np.diff(np.floor(clock)) > 0.0] & (clock <= clock[-1] - 1.0)
    keep[0] = keep[-1] = True
    rows = np.flatnonzero(keep)
    too_close = np.r_[False, np.diff(clock[rows]) < 1.0]
    too_close[-1] = False
    keep[rows[too_close]] = False
    return keep


def _add_needed(motion: Motion, keep: Mask, off: float) -> Mask:
    """Add as few rows as needed to the rows that stay.

    Removed rows then lie within `off` mm of the path between the remaining rows, also where axes
    rotate between them.
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
    """Return the deviation (k,) of removed rows from the path between two rows, mm.

    It is the distance from the straight path, or the deviation that axis rotation between the rows
    may cause, whichever is greater.
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
