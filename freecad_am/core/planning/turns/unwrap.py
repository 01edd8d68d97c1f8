# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unwrap the axes along the whole job and fit them to the limits.

A part of revolution rotates one axis by a full turn per layer. A continuous axis accumulates these
turns. A limited axis rewinds between beads. If a bead does not fit from its seam, the seam is
moved. If the stroke of the axis is less than a full turn, the bead is split.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...geometry.frames import TURN, shortest
from ...geometry.tie_breaking import index_of_minimum
from ...issues import ERROR, NOTE, WARNING, Issue, Text
from ...kinematics.cell import Cell
from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath, numbered
from ..points import gather
from ..rotation import global_search, local_optimisation
from ..rotation.local_optimisation import evaluate_paths
from ..task import MIN_MARGIN, Task

# rad; joint change between two beads that counts as a rewind
TURNS_BACK = 1.5 * math.pi
# rad; maximum difference between start and end of an axis that has returned
ROUNDING = 1e-6
# fraction of the stroke that a piece of a split bead may use
USABLE = 0.98


def unwrapped(task: Task, paths: list[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
    """Add whole turns so that each path starts near the end of the previous one.

    Whole turns never reduce the limit margin of a path.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    paths : list of BeadPath
        The paths in print order.

    Returns
    -------
    paths : list of BeadPath
        The unwrapped paths.
    issues : list of Issue
        Notes on axes that rewind between beads.
    """
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
            # no bead precedes the first one, so bring it near the second
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
    """Return the whole turns (axes,) that bring a bead nearest to the joints `before`.

    They do not reduce the margin of the bead.
    """
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
    """Move the seam of a closed bead to where the turning axis has enough stroke.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joints unwrapped over the bead, rad or mm.

    Returns
    -------
    bead : Bead
        The bead; unchanged if no axis makes a whole turn, if the bead is not closed, or if its
        external axes do not return to their start.
    index : int
        Index of the new start; 0 for an unchanged bead.
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
    """Whether the external axes of a closed bead return to their start, up to whole turns."""
    return bead.external is None or bool(
        (np.abs(shortest(bead.external[-1] - bead.external[0])) < ROUNDING).all()
    )


def turning_axis(task: Task, joints: Array) -> int | None:
    """Return the limited axis that makes at least one whole turn.

    Parameters
    ----------
    task : Task
        The plan, including the continuous axes.
    joints : (n, axes) array
        Joint values of a path, rad or mm.

    Returns
    -------
    int or None
        The axis with the most turns; None if no axis makes a turn or a value is not finite.
    """
    if not np.isfinite(joints).all():
        return None
    turns = np.where(task.unturned, 0.0, np.abs(np.round((joints[-1] - joints[0]) / TURN)))
    return int(turns.argmax()) if turns.max() >= 1.0 else None


def pieces(task: Task, bead: Bead, joints: Array, more: int = 0) -> list[slice]:
    """Split a bead so that the turning axis stays within its limits.

    A piece ends where the axis would exceed a limit. The axis rewinds before the next piece. An
    axis with a stroke below a full turn gets pieces of equal length; each piece then needs its own
    rotation.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joints unwrapped over the bead, rad or mm.
    more : int, optional
        Number of pieces beyond the minimum.

    Returns
    -------
    list of slice
        Points of each piece; a single piece if points are unreachable or splitting does not help.
    """
    axis = int(np.argmax(np.ptp(joints, axis=0) * ~task.unturned))
    low, high = task.rows_of_axis(axis)
    along = joints[:, axis]
    if high - low < TURN:
        if not np.isfinite(along).all():
            return [slice(0, len(bead))]
        count = int(np.ceil(np.ptp(along) / (USABLE * (high - low)))) + more
        count = min(count, len(bead) - 1)  # a piece has at least two points
        ends = np.round(np.linspace(0, len(bead) - 1, count + 1)).astype(int)
        return [slice(int(start), int(end) + 1) for start, end in zip(ends[:-1], ends[1:])]
    if abs(along[-1] - along[0]) > ROUNDING:
        return _cut(along, bool(along[-1] > along[0]), low, high)
    # an axis that returns may start from either limit: use the one with fewer pieces, but not with
    # a single piece, which does not help
    both = [_cut(along, rising, low, high) for rising in (True, False)]
    return min(both, key=lambda parts: (len(parts) == 1, len(parts)))


def _cut(along: Array, rising: bool, low: float, high: float) -> list[slice]:
    """Return pieces of an axis path (n,) that each use the full stroke, rising or falling.

    Return a single piece if splitting does not help.
    """
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
    """Whether an open bead makes more than one turn about the axis."""
    return not bead.closed and abs(bead.parameter[-1] - bead.parameter[0]) > 1.01 * TURN


def is_otherwise(bead: Bead, pieces: Sequence[Bead]) -> bool:
    """Whether planning moved the seam of a bead or split the bead."""
    return len(pieces) > 1 or bool((pieces[0].points[0] != bead.points[0]).any())


def seam_notes(moved: list[int], split: list[int]) -> list[Issue]:
    """Return notes on layers with moved seams and with split beads."""
    return ([seam_note(moved)] if moved else []) + ([split_note(split)] if split else [])


def seam_note(layers: list[int]) -> Issue:
    """Return a note that seams were moved to suit a limited axis."""
    return Issue(
        NOTE,
        "SEAM_MOVED",
        Text("the seams of {} beads were moved to keep an axis within its limits", len(layers)),
        layer=layers[0],
    )


def split_note(layers: list[int]) -> Issue:
    """Return a warning that beads were split because an axis lacks the stroke."""
    return Issue(
        WARNING,
        "BEAD_SPLIT",
        Text("{} beads were split, as an axis lacks the stroke for the whole bead", len(layers)),
        layer=layers[0],
    )


Place = tuple[int, int]

OFFSETS = 72
MORE_PIECES = 3
MOVED, SPLIT = "seam moved for a limited axis", "split for a limited axis"


def for_beads(
    task: Task, beads: Sequence[Bead], places: Sequence[Place]
) -> list[list[BeadPath] | None]:
    """Find a new seam or a split for beads that exceed limits.

    The search treats the last robot axis and the external axes as continuous. It then chooses a
    seam or pieces that suit their limits.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    beads : sequence of Bead
        The beads.
    places : sequence of Place
        Layer and index of each bead.

    Returns
    -------
    list[list[BeadPath] or None]
        The path from a new seam, or the paths of the pieces; None if neither is feasible.
    """
    result: list[list[BeadPath] | None] = [None] * len(beads)
    left = [k for k, bead in enumerate(beads) if not is_spiral(bead)]
    if task.continuous.all():
        return result
    free = dataclasses.replace(task, cell=_last_continuous(task.cell))
    for most in (
        global_search.POINTS_PER_BEAD,
        None,
    ):  # a solution for few points may fail between them, so retry with all points
        if not left:
            break
        points = gather([beads[k] for k in left], task.cell, most)
        threshold = task.thresholds(points)
        # a seam can move after planning only if slopes are integers
        found = global_search.everywhere(
            free, points, threshold, global_search.CLOSING_SLOPES, OFFSETS, best_alone=True
        )
        best, each = found.best(), np.arange(len(left))
        resolved = global_search.resolve(free, points, threshold, found.coefficients[best, each])
        serving = np.flatnonzero(found.margin[best, each] >= 0.0).tolist()
        for number in serving:
            k = left[number]
            result[k] = _fitted(task, free, beads[k], places[k], resolved[number : number + 1])
        left = [left[number] for number in serving if result[left[number]] is None]
    return result


def insert_replacements(
    task: Task, paths: Sequence[BeadPath], helped: Mapping[int, list[BeadPath]]
) -> tuple[list[BeadPath], list[Issue]]:
    """Insert replacement paths and renumber the beads.

    Parameters
    ----------
    task : Task
        The plan.
    paths : sequence of BeadPath
        The paths.
    helped : Mapping[int, list[BeadPath]]
        Replacements by path index.

    Returns
    -------
    paths : list of BeadPath
        The paths in print order.
    issues : list of Issue
        Notes on moved seams and split beads; an error if a spiral exceeds a limited axis.
    """
    result: list[BeadPath] = []
    issues: list[Issue] = []
    for k, path in enumerate(paths):
        result += helped.get(k, [path])
        lost = k not in helped and path.margin < MIN_MARGIN and is_spiral(path.bead)
        if lost and _would_fit_continuous(task, path):
            issues.append(
                Issue(
                    ERROR,
                    "SPIRAL_LIMITED",
                    "a spiral needs a continuous axis, but the limit set bounds this axis; use "
                    "path: layers, or a limit set with a continuous axis",
                    layer=path.layer,
                )
            )
    moved = sorted({found[0].layer for found in helped.values() if len(found) == 1})
    split = sorted({found[0].layer for found in helped.values() if len(found) > 1})
    return numbered(result), [*issues, *seam_notes(moved, split)]


def _would_fit_continuous(task: Task, path: BeadPath) -> bool:
    """Whether a spiral exceeds limits because its last axis is limited.

    This holds if a limited axis makes a whole turn, or if a continuous last axis would keep all
    limits. The second test is needed because the search minimises the violation, which may shift it
    to another axis.
    """
    if turning_axis(task, path.joints) is not None:
        return True
    free = dataclasses.replace(task, cell=_last_continuous(task.cell))
    coarse = gather([path.bead], task.cell, global_search.POINTS_PER_BEAD)
    return bool(
        (
            global_search.everywhere(free, coarse, task.thresholds(coarse), best_alone=True).margin
            >= 0.0
        ).any()
    )


def _fitted(
    task: Task, free: Task, bead: Bead, place: Place, coefficients: Array
) -> list[BeadPath] | None:
    whole = _one(free, bead, place, coefficients, MOVED)
    started, index = moved_seam(task, bead, whole.joints)
    if index:
        moved = _one(task, started, place, coefficients, MOVED)
        if moved.margin >= MIN_MARGIN:
            return [moved]
    for more in range(MORE_PIECES):
        parts = pieces(task, bead, whole.joints, more)
        if len(parts) == 1:
            return None
        cuts = [_piece(task, bead.part(part), place, coefficients) for part in parts]
        if all(piece.margin >= MIN_MARGIN for piece in cuts):
            return cuts
    return None


def _piece(task: Task, bead: Bead, place: Place, coefficients: Array) -> BeadPath:
    """Plan a piece with the rotation of the whole bead, or with its own rotation if needed."""
    path = _one(task, bead, place, coefficients, SPLIT)
    if path.margin >= MIN_MARGIN:
        return path
    coarse, full = (
        gather([bead], task.cell, global_search.POINTS_PER_BEAD),
        gather([bead], task.cell),
    )
    found = global_search.everywhere(task, coarse, task.thresholds(coarse), best_alone=True)
    threshold = task.thresholds(full)
    refined = local_optimisation.refine(
        task, full, threshold, found.coefficients[None, found.best()[0]]
    )
    return evaluate_paths(task, [bead], [place], full, threshold, refined.coefficients, refined)[0]


def _one(task: Task, bead: Bead, place: Place, coefficients: Array, reason: str) -> BeadPath:
    points = gather([bead], task.cell)
    given = local_optimisation.Refined(coefficients, np.zeros(1), (reason,), (0,))
    return evaluate_paths(
        task, [bead], [place], points, task.thresholds(points), coefficients, given
    )[0]


def _last_continuous(cell: Cell) -> Cell:
    limits = cell.limits
    last = np.arange(limits.axes) >= cell.robot.chain.axes - 1
    free = dataclasses.replace(
        limits,
        lower=np.where(last, -np.inf, limits.lower),
        upper=np.where(last, np.inf, limits.upper),
    )
    return dataclasses.replace(cell, limits=free)
