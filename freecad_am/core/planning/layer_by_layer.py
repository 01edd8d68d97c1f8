# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer by layer: one polynomial of the rotation per bead (Chalvin 2020, section 4.3).

Search everywhere, refine locally, settle in the flat valley, then find room for the turns of limited axes.
"""

from __future__ import annotations

import dataclasses
from typing import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..issues import ERROR, Issue
from ..toolpath import Bead
from . import criteria, refine, search, turns, valley
from .joint_path import BeadPath
from .points import Points, gather
from .task import Task, condition_margin

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]
Place = tuple[int, int]

# slopes that close a full turn in joint space: only with these may a seam be moved after the planning
CLOSING_SLOPES = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])


def plan(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths of all beads with their layer and index, and what was done to make them fit."""
    coarse, full = gather(beads, task.cell, search.POINTS_PER_BEAD), gather(beads, task.cell)
    coarse_threshold, threshold = task.thresholds(coarse), task.thresholds(full)
    progress(0.1, "searching rotations")
    found = search.everywhere(task, coarse, coarse_threshold)
    start = found.coefficients[found.best(), np.arange(len(beads))]
    progress(0.4, "refining layers")
    refined = refine.refine(task, full, threshold, start)
    progress(0.7, "settling")
    settled = valley.settle(task, coarse, coarse_threshold, refined.coefficients)
    paths = judged(task, beads, places, full, threshold, settled, refined)
    fallback = judged(task, beads, places, full, threshold, refined.coefficients, refined)
    paths = [path if path.margin >= min(0.0, other.margin) else other for path, other in zip(paths, fallback)]
    progress(0.8, "finding room for the turns")
    return _with_room(task, paths)


def judged(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], points: Points, threshold: Array, coefficients: Array,
    refined: refine.Refined,
) -> list[BeadPath]:
    """The paths of all beads for given coefficients (B, degree + 1), evaluated at all their points."""
    phi, _ = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    condition = task.condition(points, phi, joints)
    matrix = None
    if task.parameters.objective not in criteria.JOINT_ONLY and np.isfinite(joints).all():
        matrix = task.jacobian(points, phi, joints)
    objective = (
        criteria.value(task, points, joints, matrix)
        if matrix is not None or task.parameters.objective in criteria.JOINT_ONLY
        else np.full(points.beads, np.nan)
    )
    margin = points.worst(np.minimum(task.rows.margin(joints), condition_margin(condition, threshold)))
    ends = np.append(points.first, len(points))
    return [
        BeadPath(
            layer, index, bead, phi[a:b], joints[a:b], condition[a:b], threshold[a:b], float(objective[k]),
            float(margin[k]), coefficients[k], refined.reason[k], refined.iterations[k],
        )
        for k, (bead, (layer, index), a, b) in enumerate(zip(beads, places, ends[:-1], ends[1:]))
    ]


def _with_room(task: Task, paths: list[BeadPath]) -> tuple[list[BeadPath], list[Issue]]:
    """Move seams and split beads where that is what keeps a limited axis within its limits."""
    result: list[BeadPath] = []
    moved: list[int] = []
    split: list[int] = []
    issues: list[Issue] = []
    for path in paths:
        if path.margin >= 0.0 or task.endless.all():
            result.append(path)
            continue
        if turns.is_spiral(path.bead):
            if turns.turning_axis(task, path.joints) is not None:
                issues.append(Issue(ERROR, "SPIRAL_LIMITED", "a spiral turns an axis without end, and the limits of this "
                                    "set end it; use path: layers or a limit set with an endless axis", layer=path.layer))
            result.append(path)
            continue
        roomy = _closing(task, path)
        if roomy is None or len(roomy) == 1 and roomy[0].margin <= path.margin:
            result.append(path)
            continue
        (moved if len(roomy) == 1 else split).append(path.layer)
        result.extend(roomy)
    notes = ([turns.seam_note(moved)] if moved else []) + ([turns.split_note(split)] if split else [])
    return _numbered(result), issues + notes


def _closing(task: Task, path: BeadPath) -> list[BeadPath] | None:
    """The bead with another seam, or split, whichever first keeps all limits; None when nothing helps."""
    unlimited = dataclasses.replace(task, cell=dataclasses.replace(task.cell, limits=_without_turning(task)))
    coarse = gather([path.bead], task.cell, search.POINTS_PER_BEAD)
    found = search.everywhere(unlimited, coarse, task.thresholds(coarse), CLOSING_SLOPES, 72)
    best = found.best()[0]
    if found.margin[best, 0] < 0.0:
        return None
    coefficients = valley.settle(unlimited, coarse, task.thresholds(coarse), found.coefficients[best])
    refined = refine.Refined(coefficients, found.objective[best], ("seam moved",), (0,))
    whole = _one(unlimited, path, path.bead, coefficients, refined)
    bead, index = turns.moved_seam(task, path.bead, whole.joints)
    if index:
        again = _one(task, path, bead, coefficients, refined)
        if again.margin >= 0.0:
            return [again]
    parts = turns.pieces(task, path.bead, whole.joints)
    if len(parts) == 1:
        return None
    cuts = [_one(task, path, turns.cut(path.bead, part), coefficients, refined) for part in parts]
    return cuts if all(piece.margin >= 0.0 for piece in cuts) else None


def _one(task: Task, path: BeadPath, bead: Bead, coefficients: Array, refined: refine.Refined) -> BeadPath:
    points = gather([bead], task.cell)
    place = [(path.layer, path.index)]
    return judged(task, [bead], place, points, task.thresholds(points), coefficients, refined)[0]


def _without_turning(task: Task):  # type: ignore[no-untyped-def]
    """The limits with every axis that can turn right round taken as endless, to look for rotations first."""
    limits = task.cell.limits
    last = np.zeros(limits.axes, dtype=bool)
    last[-1] = True
    return dataclasses.replace(
        limits, lower=np.where(last, -np.inf, limits.lower), upper=np.where(last, np.inf, limits.upper)
    )


def _numbered(paths: list[BeadPath]) -> list[BeadPath]:
    """The paths with their beads numbered anew within each layer."""
    count: dict[int, int] = {}
    result = []
    for path in paths:
        index = count.get(path.layer, 0)
        count[path.layer] = index + 1
        result.append(dataclasses.replace(path, index=index))
    return result


