# SPDX-License-Identifier: LGPL-2.1-or-later
"""Other rotations for beads whose best candidates fail: the search samples few points, and between
them, or between the points of the bead, a candidate may exceed limits or come too near to a
singularity.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath
from ..limit_rows import UNREACHABLE
from ..points import Points, gather
from ..task import MIN_MARGIN, Task, condition_margin
from . import refine, search
from .evaluation import evaluate_paths

Place = tuple[int, int]

LOW_CONDITION_RATIO = (
    3.0  # times the condition asked for; from there it may fall short between two points
)
HALVINGS = 2  # halvings of each segment to check between its points
CANDIDATES = 12  # rotations of a bead that are checked there
BEADS_PER_BATCH = 64  # beads; bounds the memory


def find_infeasible(task: Task, beads: Sequence[Bead], paths: Sequence[BeadPath]) -> list[int]:
    """Return which of the beads exceed a limit with their rotation, at their points or between them."""
    infeasible = [k for k, path in enumerate(paths) if path.margin < MIN_MARGIN]
    low = [
        k
        for k, path in enumerate(paths)
        if path.margin >= MIN_MARGIN
        and (path.condition < LOW_CONDITION_RATIO * path.threshold).any()
    ]
    if low:
        finer = [_finer(beads[k]) for k in low]
        points = gather(finer, task.cell)
        share = 0.5**HALVINGS
        phi = np.concatenate(
            [
                np.interp(np.arange(len(bead)) * share, np.arange(len(paths[k].phi)), paths[k].phi)
                for k, bead in zip(low, finer)
            ]
        )
        joints = task.joints(points, phi)
        condition = condition_margin(task.condition(points, phi, joints), task.thresholds(points))
        margin = points.worst(np.minimum(task.rows.margin(joints), condition))
        infeasible += [k for k, lowest_margin in zip(low, margin) if lowest_margin < MIN_MARGIN]
    return sorted(infeasible)


def replace_infeasible(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    paths: Sequence[BeadPath],
    candidates_found: search.Found,
    report: Callable[[float], None],
) -> dict[int, BeadPath | None]:
    """Return the results of `find_rotations` for beads that exceed limits though a candidate did not at
    few of their points. report: takes the finished share; it may raise to cancel.
    """
    promising = candidates_found.margin.max(axis=0) >= 0.0
    rows = [k for k in find_infeasible(task, beads, paths) if promising[k]]
    replacements: dict[int, BeadPath | None] = {}
    for start in range(0, len(rows), BEADS_PER_BATCH):
        report(start / len(rows))
        batch = rows[start : start + BEADS_PER_BATCH]
        candidates = candidates_found.select_beads(np.array(batch, dtype=np.intp))
        replacements |= zip(
            batch,
            find_rotations(
                task, [beads[k] for k in batch], [bead_ids[k] for k in batch], candidates
            ),
        )
    return replacements


def find_rotations(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[Place], candidates_found: search.Found
) -> list[BeadPath | None]:
    """Return for each bead the path of the rotation best at all its points and between them, refined from
    there if that keeps all limits too; None if no rotation serves.

    candidates_found: the candidates of these beads, judged at few points.
    """
    points, between = gather(beads, task.cell), gather([_finer(bead) for bead in beads], task.cell)
    thresholds = task.thresholds(points)
    judged_candidates = _judged_at(
        task, points, thresholds, candidates_found, len(candidates_found.margin)
    )
    judged_candidates = _judged_at(
        task, between, task.thresholds(between), judged_candidates, CANDIDATES
    )
    best, bead_rows = judged_candidates.best(), np.arange(len(beads))
    start, serves = (
        judged_candidates.coefficients[best, bead_rows],
        judged_candidates.margin[best, bead_rows] >= 0.0,
    )
    refined = refine.refine(task, points, thresholds, start[None], serves)
    as_found = dataclasses.replace(refined, coefficients=start)
    paths: list[BeadPath | None] = [None] * len(beads)
    for solution in (refined, as_found):
        attempted = evaluate_paths(
            task, beads, bead_ids, points, thresholds, solution.coefficients, solution
        )
        short = find_infeasible(task, beads, attempted)
        paths = [
            path or (attempt if good and k not in short else None)
            for k, (path, attempt, good) in enumerate(zip(paths, attempted, serves))
        ]
    return paths


def _judged_at(
    task: Task, points: Points, thresholds: Array, candidates: search.Found, max_count: int
) -> search.Found:
    """Of the candidates of each bead that serve, the best, as many as `max_count` at most, judged at these points."""
    worth = np.where(candidates.margin >= 0.0, candidates.objective, np.inf)
    count = max(1, min(max_count, int((candidates.margin >= 0.0).sum(axis=0).max())))
    best_rows = np.argsort(worth, axis=0, kind="stable")[:count]
    bead_rows = np.arange(points.beads)
    judged_there = search.judge(
        task, points, thresholds, candidates.coefficients[best_rows, bead_rows]
    )
    serves = candidates.margin[best_rows, bead_rows] >= 0.0
    return dataclasses.replace(
        judged_there, margin=np.where(serves, judged_there.margin, UNREACHABLE)
    )


def _finer(bead: Bead) -> Bead:
    for _ in range(HALVINGS):
        bead = bead.halved(np.arange(len(bead) - 1))
    return bead
