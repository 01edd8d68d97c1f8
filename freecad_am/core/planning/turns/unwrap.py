# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unwraps the axes along the whole job, and fits them to the limits.

A part of revolution turns one axis by a full turn per layer. A continuous axis accumulates these
turns. A limited axis rewinds between beads. If a bead does not fit from its seam, the seam is
moved; if the stroke of the axis is less than a full turn, the bead is split.
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

# an axis that moves this much between two beads is said to turn back, rad
TURNS_BACK = 1.5 * math.pi
# rad; an axis that ends no farther from where it started has come back
ROUNDING = 1e-6
# share of the stroke a piece of a split bead may use
USABLE = 0.98


def unwrapped(task: Task, paths: list[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
    """Add whole turns so that each path starts near the end of the previous one.

    The margin of each path to the limits limits the turns.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    paths : list of BeadPath
        The paths in print order.

    Returns
    -------
    paths : list of BeadPath
        The paths.
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
    """Return a closed bead from a start at which the turning axis has enough stroke.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joints unwrapped over the bead, rad or mm.

    Returns
    -------
    bead : Bead
        The bead; unchanged if no axis turns, no start helps, or an external axis waits at
        its limit and does not close.
    index : int
        Index of the start; 0 for an unchanged bead.
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
    """Return whether the external axes of a closed bead end at their start values, apart from whole
    turns.
    """
    return bead.external is None or bool(
        (np.abs(shortest(bead.external[-1] - bead.external[0])) < ROUNDING).all()
    )


def turning_axis(task: Task, joints: Array) -> int | None:
    """Return the limited axis that ends a whole turn or more from its start.

    Parameters
    ----------
    task : Task
        The task, with the axes without limits.
    joints : (n, axes) array
        Joint values of a path, rad or mm.

    Returns
    -------
    int or None
        The axis that turns most; None without one, or if a value is not finite.
    """
    if not np.isfinite(joints).all():
        return None
    turns = np.where(task.unturned, 0.0, np.abs(np.round((joints[-1] - joints[0]) / TURN)))
    return int(turns.argmax()) if turns.max() >= 1.0 else None


def pieces(task: Task, bead: Bead, joints: Array, more: int = 0) -> list[slice]:
    """Divide a bead so that the turning axis stays within its limits.

    A piece ends where the axis would pass a limit; the next one starts with the axis turned
    back. An axis without the stroke for a full turn gets pieces of equal length, which then
    need rotations of their own.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    bead : Bead
        The bead of n points.
    joints : (n, axes) array
        Joints unwrapped over the bead, rad or mm.
    more : int, optional
        Number of pieces beyond the fewest.

    Returns
    -------
    list of slice
        The points of each piece; one piece if points are out of reach or cutting does not
        help.
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
    # an axis that comes back may start from either side: take the side with fewer pieces; a single
    # piece does not help
    both = [_cut(along, rising, low, high) for rising in (True, False)]
    return min(both, key=lambda parts: (len(parts) == 1, len(parts)))


def _cut(along: Array, rising: bool, low: float, high: float) -> list[slice]:
    """Return the pieces of an axis (n,) that runs up or down, each as long as its stroke; one if
    cutting does not help.
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
    """True for an open bead that runs more than one turn about the axis."""
    return not bead.closed and abs(bead.parameter[-1] - bead.parameter[0]) > 1.01 * TURN


def is_otherwise(bead: Bead, pieces: Sequence[Bead]) -> bool:
    """Return whether a bead has another seam or several pieces."""
    return len(pieces) > 1 or bool((pieces[0].points[0] != bead.points[0]).any())


def seam_notes(moved: list[int], split: list[int]) -> list[Issue]:
    """Return the notes on layers with moved seams and on layers with split beads."""
    return ([seam_note(moved)] if moved else []) + ([split_note(split)] if split else [])


def seam_note(layers: list[int]) -> Issue:
    """Return the note that seams were moved to suit a limited axis."""
    return Issue(
        NOTE,
        "SEAM_MOVED",
        Text("the seams of {} beads were moved to keep an axis within limits", len(layers)),
        layer=layers[0],
    )


def split_note(layers: list[int]) -> Issue:
    """Return the warning that beads were split because an axis lacks the stroke."""
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
    """Find another seam or pieces for beads that exceed limits.

    The search treats the robot's last axis and the external axes as continuous; then a start or
    cuts are chosen that suit their limits.

    Parameters
    ----------
    task : Task
        The plan, with limits.
    beads : sequence of Bead
        The beads.
    places : sequence of Place
        Layer and index of each bead.

    Returns
    -------
    list[list[BeadPath] or None]
        The path from another seam, or the paths of the pieces; None if neither keeps all
        limits.
    """
    result: list[list[BeadPath] | None] = [None] * len(beads)
    left = [k for k, bead in enumerate(beads) if not is_spiral(bead)]
    if task.continuous.all():
        return result
    free = dataclasses.replace(task, cell=_last_continuous(task.cell))
    for most in (
        global_search.POINTS_PER_BEAD,
        None,
    ):  # what suits few points may not suit those between them
        if not left:
            break
        points = gather([beads[k] for k in left], task.cell, most)
        threshold = task.thresholds(points)
        # only with slopes of whole turns can a seam be moved after the planning
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
    """Insert replacements of paths and renumber the beads.

    Parameters
    ----------
    task : Task
        The plan.
    paths : sequence of BeadPath
        The paths.
    helped : Mapping[int, list[BeadPath]]
        Replacements by index of the path.

    Returns
    -------
    paths : list of BeadPath
        The paths in print order.
    issues : list of Issue
        Notes on moved seams and split beads; an error for a spiral on a limited axis.
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
                    "a spiral needs a continuous axis, but this set of limits bounds it; use "
                    "path: layers, or a limit set with a continuous axis",
                    layer=path.layer,
                )
            )
    moved = sorted({found[0].layer for found in helped.values() if len(found) == 1})
    split = sorted({found[0].layer for found in helped.values() if len(found) > 1})
    return numbered(result), [*issues, *seam_notes(moved, split)]


def _would_fit_continuous(task: Task, path: BeadPath) -> bool:
    """Return whether the limits of the last axis are why a spiral breaks a limit.

    The limited axis makes a whole turn, or a continuous last axis would keep every limit. The
    search chooses the least violation, which may be at another axis.
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
    """A piece with the rotation of the whole bead, or where that does not serve with one of its own."""
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
