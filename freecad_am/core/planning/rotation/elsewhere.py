# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotations of beads for which those that seemed best do not serve: the search looks at few points, and between them, or
between the points of the bead, it may come out of its limits or too near to a singularity."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from ...toolpath import Bead
from ...types import Array
from ..joint_path import BeadPath
from ..limit_rows import UNREACHABLE
from ..points import Points, gather
from ..task import FITS, Task, condition_margin
from . import refine, search
from .evaluation import judged

Place = tuple[int, int]

LOW = 3.0  # times the condition asked for; from there it may fall short between two points
HALVINGS = 2  # of each segment, where it is looked at between
CANDIDATES = 12  # rotations of a bead that are looked at there
TOGETHER = 64  # beads; bounds the memory


def lost(task: Task, beads: Sequence[Bead], paths: Sequence[BeadPath]) -> list[int]:
    """Which of the beads do not keep all limits with their rotation, at their points or between them."""
    found = [k for k, path in enumerate(paths) if path.margin < FITS]
    low = [
        k
        for k, path in enumerate(paths)
        if path.margin >= FITS and (path.condition < LOW * path.threshold).any()
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
        found += [k for k, least in zip(low, margin) if least < FITS]
    return sorted(found)


def where_lost(
    task: Task,
    beads: Sequence[Bead],
    places: Sequence[Place],
    paths: Sequence[BeadPath],
    found: search.Found,
    report: Callable[[float], None],
) -> dict[int, BeadPath | None]:
    """What `of_beads` finds for the beads that do not keep all limits though a candidate did at few of their points. report:
    takes the share that is done; it may raise to cancel."""
    promising = found.margin.max(axis=0) >= 0.0
    rows = [k for k in lost(task, beads, paths) if promising[k]]
    others: dict[int, BeadPath | None] = {}
    for start in range(0, len(rows), TOGETHER):
        report(start / len(rows))
        some = rows[start : start + TOGETHER]
        candidates = found.of_beads(np.array(some, dtype=np.intp))
        others |= zip(
            some, of_beads(task, [beads[k] for k in some], [places[k] for k in some], candidates)
        )
    return others


def of_beads(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], found: search.Found
) -> list[BeadPath | None]:
    """For each bead the path of the rotation that suits all its points, and those between them, best, refined from there
    where that keeps all limits too; None where none does. found: the candidates of these beads, judged at few points."""
    own, between = gather(beads, task.cell), gather([_finer(bead) for bead in beads], task.cell)
    thresholds = task.thresholds(own)
    here = _judged_at(task, own, thresholds, found, len(found.margin))
    here = _judged_at(task, between, task.thresholds(between), here, CANDIDATES)
    best, each = here.best(), np.arange(len(beads))
    start, serves = here.coefficients[best, each], here.margin[best, each] >= 0.0
    refined = refine.refine(task, own, thresholds, start[None], serves)
    as_found = dataclasses.replace(refined, coefficients=start)
    paths: list[BeadPath | None] = [None] * len(beads)
    for one in (refined, as_found):
        tried = judged(task, beads, places, own, thresholds, one.coefficients, one)
        short = lost(task, beads, tried)
        paths = [
            path or (other if good and k not in short else None)
            for k, (path, other, good) in enumerate(zip(paths, tried, serves))
        ]
    return paths


def _judged_at(
    task: Task, points: Points, thresholds: Array, found: search.Found, most: int
) -> search.Found:
    """Of the candidates of each bead that serve, the best, as many as `most` at most, judged at these points."""
    worth = np.where(found.margin >= 0.0, found.objective, np.inf)
    count = max(1, min(most, int((found.margin >= 0.0).sum(axis=0).max())))
    chosen = np.argsort(worth, axis=0, kind="stable")[:count]
    each = np.arange(points.beads)
    judged_there = search.judge(task, points, thresholds, found.coefficients[chosen, each])
    serves = found.margin[chosen, each] >= 0.0
    return dataclasses.replace(
        judged_there, margin=np.where(serves, judged_there.margin, UNREACHABLE)
    )


def _finer(bead: Bead) -> Bead:
    for _ in range(HALVINGS):
        bead = bead.halved(np.arange(len(bead) - 1))
    return bead
