# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads that follow sooner than a controller steps: removed where the bead hardly needs
them.

Where walls are thin, small, or printed fast, corners and ends have points some hundredths of a
millimetre apart. Removed points are within a share of the chord error of the remaining path;
where they would not be, the move gets the time of a step.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from ...controller import Controller
from ...motion import Motion
from ...types import Array, Index, Mask

MIN_STEP_SHARE = 0.96  # of the least way, below which a post rejects two points
OMITTED_DEVIATION_SHARE = 0.4  # of the chord error, that points left out may lie off
REACH = 2000.0  # mm; so far off an axis, at most, is what it turns


def programmed(
    motion: Motion, controller: Controller, chord_error: float, blend: float
) -> tuple[Motion, Index]:
    """Return the motion for programs of a controller, and its rows (m,) in the given motion. blend:
    percent.
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
    """Return the rows that stay, without those that come back to within `min_distance` mm of the previous
    one, as where a bead turns round in less than a blend: there the distance between two points
    counts, not the length along the bead. Removed rows are within `off` mm of the straight path
    between the remaining ones; otherwise the row stays.
    """
    keep, checked = keep.copy(), np.zeros(len(keep), dtype=bool)
    inside = motion.deposit & (motion.point > 0) & motion.reachable
    last_points = inside & np.append(~inside[1:], True)
    while True:
        rows = np.flatnonzero(keep)
        step_lengths = np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1)
        # to the start of a bead there is a rapid, which has no blend of its own
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
    """Which points (n,) of a bead stay where none may come less than 1 after another on a clock; both ends stay."""
    keep: Mask = np.r_[True, np.diff(np.floor(clock)) > 0.0] & (clock <= clock[-1] - 1.0)
    keep[0] = keep[-1] = True
    rows = np.flatnonzero(keep)
    too_close = np.r_[False, np.diff(clock[rows]) < 1.0]
    too_close[-1] = False
    keep[rows[too_close]] = False
    return keep


def _add_needed(motion: Motion, keep: Mask, off: float) -> Mask:
    """Return the rows that stay and as few of the others as needed so that removed rows are within `off`
    mm of the path between these, and axes do not turn so far that they would leave it in between.
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
        # the farthest of each gap, which often is enough for its neighbours
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
