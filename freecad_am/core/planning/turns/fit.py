# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finds room for the turns of limited axes: another seam, or as the last resort a split bead."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from ...issues import ERROR, Issue
from ...kinematics.cell import Cell
from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath, numbered
from ..points import gather
from ..rotation import refine, search, ties
from ..rotation.evaluation import evaluate_paths
from ..task import MIN_MARGIN, Task
from . import unwrap as turns

Place = tuple[int, int]

OFFSETS = 72
MORE_PIECES = 3
MOVED, SPLIT = "seam moved for a limited axis", "split for a limited axis"


def for_beads(
    task: Task, beads: Sequence[Bead], places: Sequence[Place]
) -> list[list[BeadPath] | None]:
    """For each bead the path from another seam, or of its pieces; None where neither keeps all limits.

    The rotations are looked for as if the robot's last axis, and those beside it, had no end; then a start, or cuts, are
    found that suit their limits.
    """
    result: list[list[BeadPath] | None] = [None] * len(beads)
    left = [k for k, bead in enumerate(beads) if not turns.is_spiral(bead)]
    if task.continuous.all():
        return result
    free = dataclasses.replace(task, cell=_last_continuous(task.cell))
    for most in (
        search.POINTS_PER_BEAD,
        None,
    ):  # what suits few points may not suit those between them
        if not left:
            break
        points = gather([beads[k] for k in left], task.cell, most)
        threshold = task.thresholds(points)
        # only with slopes of whole turns can a seam be moved after the planning
        found = search.everywhere(
            free, points, threshold, search.CLOSING_SLOPES, OFFSETS, best_alone=True
        )
        best, each = found.best(), np.arange(len(left))
        resolved = ties.resolve(free, points, threshold, found.coefficients[best, each])
        serving = np.flatnonzero(found.margin[best, each] >= 0.0).tolist()
        for number in serving:
            k = left[number]
            result[k] = _fitted(task, free, beads[k], places[k], resolved[number : number + 1])
        left = [left[number] for number in serving if result[left[number]] is None]
    return result


def put_in(
    task: Task, paths: Sequence[BeadPath], helped: Mapping[int, list[BeadPath]]
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths with those that were helped in their places, beads numbered anew, and what was done said."""
    result: list[BeadPath] = []
    issues: list[Issue] = []
    for k, path in enumerate(paths):
        result += helped.get(k, [path])
        lost = k not in helped and path.margin < MIN_MARGIN and turns.is_spiral(path.bead)
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
    return numbered(result), [*issues, *turns.seam_notes(moved, split)]


def _would_fit_continuous(task: Task, path: BeadPath) -> bool:
    """Whether the end of the last axis is what keeps a spiral from its limits: it turns an axis that ends, or all limits
    would hold if the last one had none. Of the least evils the search may have taken one at another axis.
    """
    if turns.turning_axis(task, path.joints) is not None:
        return True
    free = dataclasses.replace(task, cell=_last_continuous(task.cell))
    coarse = gather([path.bead], task.cell, search.POINTS_PER_BEAD)
    return bool(
        (
            search.everywhere(free, coarse, task.thresholds(coarse), best_alone=True).margin >= 0.0
        ).any()
    )


def _fitted(
    task: Task, free: Task, bead: Bead, place: Place, coefficients: Array
) -> list[BeadPath] | None:
    whole = _one(free, bead, place, coefficients, MOVED)
    started, index = turns.moved_seam(task, bead, whole.joints)
    if index:
        moved = _one(task, started, place, coefficients, MOVED)
        if moved.margin >= MIN_MARGIN:
            return [moved]
    for more in range(MORE_PIECES):
        parts = turns.pieces(task, bead, whole.joints, more)
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
    coarse, full = gather([bead], task.cell, search.POINTS_PER_BEAD), gather([bead], task.cell)
    found = search.everywhere(task, coarse, task.thresholds(coarse), best_alone=True)
    threshold = task.thresholds(full)
    refined = refine.refine(task, full, threshold, found.coefficients[None, found.best()[0]])
    return evaluate_paths(task, [bead], [place], full, threshold, refined.coefficients, refined)[0]


def _one(task: Task, bead: Bead, place: Place, coefficients: Array, reason: str) -> BeadPath:
    points = gather([bead], task.cell)
    given = refine.Refined(coefficients, np.zeros(1), (reason,), (0,))
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
