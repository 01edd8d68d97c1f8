# SPDX-License-Identifier: LGPL-2.1-or-later
"""Counts the turns of the axes along the whole job, and finds room for them where an axis is limited.

A part of revolution turns one axis by a full turn per layer. An endless axis accumulates. A limited one turns back
between beads; where a whole bead does not fit from the seam it was given, the seam is moved; where the axis
has not even the stroke for a full turn, the bead is split.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...geometry.angles import TURN, shortest
from ...geometry.ties import index_of_minimum
from ...issues import NOTE, WARNING, Issue, Text
from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath
from ..task import Task

# an axis that moves this much between two beads is said to turn back, rad
TURNS_BACK = 1.5 * math.pi
# rad; an axis that ends no farther from where it started has come back
ROUNDING = 1e-6
# share of the stroke a piece of a split bead may use
USABLE = 0.98


def unwrapped(task: Task, paths: list[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
    """The paths with whole turns added so that each starts as near to the end of the one before as its margin allows."""
    result: list[BeadPath] = []
    back: dict[int, list[int]] = {}
    before: Array | None = None
    for path, following in zip(paths, [*paths[1:], None]):
        if before is not None and path.reachable:
            path = replace(path, joints=path.joints + _turns(task, path, before) * TURN)
            for axis in np.flatnonzero(
                (np.abs(path.joints[0] - before) > TURNS_BACK) & ~task.cell.machine.chain.sliding
            ):
                back.setdefault(int(axis), []).append(path.layer)
        elif path.reachable and following is not None and following.reachable:
            # nothing comes before the first bead: it is turned towards the second
            towards = following.joints[0] - (path.joints[-1] - path.joints[0])
            path = replace(path, joints=path.joints + _turns(task, path, towards) * TURN)
        if path.reachable:
            before = path.joints[-1]
        result.append(path)
    names = task.cell.machine.axes
    notes = [
        Issue(
            NOTE,
            "UNWIND",
            Text(
                "axis {} rewinds {} times between beads, first before layer {}",
                names[axis],
                len(layers),
                layers[0],
            ),
            layer=layers[0],
        )
        for axis, layers in back.items()
    ]
    return result, notes


def _turns(task: Task, path: BeadPath, before: Array) -> Array:
    """(axes,) whole turns that bring a bead nearest to the joints before without costing it any of its margin."""
    limits = task.cell.limits
    half = np.where(task.continuous, 0.0, 0.5 * (limits.upper - limits.lower))
    kept = 0.0 if path.margin < 0.0 else (path.margin - 1e-9) * half
    by_axis = np.ascontiguousarray(path.joints.T)
    fewest = np.ceil((limits.lower + kept - by_axis.min(axis=1)) / TURN - 1e-12)
    greatest = np.floor((limits.upper - kept - by_axis.max(axis=1)) / TURN + 1e-12)
    wanted = np.round((before - path.joints[0]) / TURN)
    return np.where(
        (fewest <= greatest) & ~task.cell.machine.chain.sliding,
        np.clip(wanted, fewest, greatest),
        0.0,
    )


def moved_seam(task: Task, bead: Bead, joints: Array) -> tuple[Bead, int]:
    """A closed bead started where the turning axis has room, and the index of the new start.

    joints: (n, axes) counted on over the bead as it is. The bead itself where no axis turns or where no start helps, and
    where an external axis that waits at its limit does not come round.
    """
    axis = turning_axis(task, joints)
    if axis is None or not bead.closed or not _come_round(bead):
        return bead, 0
    limits = task.cell.limits
    centre = 0.5 * (limits.lower[axis] + limits.upper[axis])
    turn = joints[-1, axis] - joints[0, axis]
    off = joints[:-1, axis] + 0.5 * turn - centre
    off = shortest(off)
    index = int(index_of_minimum(np.abs(off)))
    return bead.started_at(index), index


def _come_round(bead: Bead) -> bool:
    """Whether the external axes of a closed bead end where they began, but for whole turns."""
    return bead.external is None or bool(
        (np.abs(shortest(bead.external[-1] - bead.external[0])) < ROUNDING).all()
    )


def turning_axis(task: Task, joints: Array) -> int | None:
    """The limited axis that ends a whole turn or more away from where it started, None when there is none."""
    if not np.isfinite(joints).all():
        return None
    turns = np.where(task.unturned, 0.0, np.abs(np.round((joints[-1] - joints[0]) / TURN)))
    return int(turns.argmax()) if turns.max() >= 1.0 else None


def pieces(task: Task, bead: Bead, joints: Array, more: int = 0) -> list[slice]:
    """Where a bead is cut so that the turning axis starts each piece anew within its limits.

    A piece ends where the axis would pass a limit; the next starts with the axis turned back. An axis
    without the stroke for a full turn gets pieces of equal length, `more` than the fewest, which then need
    rotations of their own; where points are out of reach nobody knows how many, and the bead is left whole.
    """
    axis = int(np.argmax(np.ptp(joints, axis=0) * ~task.unturned))
    low, high = task.rows_of_axis(axis)
    along = joints[:, axis]
    if high - low < TURN:
        if not np.isfinite(along).all():
            return [slice(0, len(bead))]
        count = int(np.ceil(np.ptp(along) / (USABLE * (high - low)))) + more
        count = min(count, len(bead) - 1)  # a piece has two points at least
        ends = np.round(np.linspace(0, len(bead) - 1, count + 1)).astype(int)
        return [slice(int(start), int(end) + 1) for start, end in zip(ends[:-1], ends[1:])]
    if abs(along[-1] - along[0]) > ROUNDING:
        return _cut(along, bool(along[-1] > along[0]), low, high)
    # an axis that comes back may start from either side: from that with the fewer pieces, one alone being no way
    both = [_cut(along, rising, low, high) for rising in (True, False)]
    return min(both, key=lambda parts: (len(parts) == 1, len(parts)))


def _cut(along: Array, rising: bool, low: float, high: float) -> list[slice]:
    """The pieces of an axis (n,) that runs up, or down, each as far as the axis has room; one where that does not help."""
    cuts = [0]
    while True:
        turns = (
            np.ceil((low - along[cuts[-1]]) / TURN)
            if rising
            else np.floor((high - along[cuts[-1]]) / TURN)
        )
        turned = along[cuts[-1] :] + turns * TURN
        out = np.flatnonzero(turned > high if rising else turned < low)
        if not len(out):
            return [slice(start, end + 1) for start, end in zip(cuts, [*cuts[1:], len(along) - 1])]
        if out[0] < 2:
            return [slice(0, len(along))]
        cuts.append(cuts[-1] + int(out[0]) - 1)


def is_spiral(bead: Bead) -> bool:
    """True for an open bead that runs more than one turn about the axis."""
    return not bead.closed and abs(bead.parameter[-1] - bead.parameter[0]) > 1.01 * TURN


def is_otherwise(bead: Bead, pieces: Sequence[Bead]) -> bool:
    """Whether a bead is laid from another seam, or in several pieces."""
    return len(pieces) > 1 or bool((pieces[0].points[0] != bead.points[0]).any())


def seam_notes(moved: list[int], split: list[int]) -> list[Issue]:
    """What is said of layers whose seams were moved, and of those with beads that were split."""
    return ([seam_note(moved)] if moved else []) + ([split_note(split)] if split else [])


def seam_note(layers: list[int]) -> Issue:
    """Says that seams were moved to find room for a limited axis."""
    return Issue(
        NOTE,
        "SEAM_MOVED",
        Text("the seams of {} beads were moved to keep an axis within limits", len(layers)),
        layer=layers[0],
    )


def split_note(layers: list[int]) -> Issue:
    """Says that beads were split because an axis lacks the stroke."""
    return Issue(
        WARNING,
        "BEAD_SPLIT",
        Text("{} beads were split, as an axis lacks the stroke for the whole bead", len(layers)),
        layer=layers[0],
    )
