# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotations of beads for which those that seemed best do not serve: the search looks at few points, and between them, or
between the points of the bead, it may come out of its limits or too near to a singularity."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

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


def lost(task: Task, beads: Sequence[Bead], paths: Sequence[BeadPath]) -> list[int]:
    """Which of the beads do not keep all limits with their rotation, at their points or between them."""
    found = [k for k, path in enumerate(paths) if path.margin < FITS]
    low = [k for k, path in enumerate(paths) if path.margin >= FITS and (path.condition < LOW * path.threshold).any()]
    if low:
        finer = [_finer(beads[k]) for k in low]
        points = gather(finer, task.cell)
        share = 0.5**HALVINGS
        phi = np.concatenate([
            np.interp(np.arange(len(bead)) * share, np.arange(len(paths[k].phi)), paths[k].phi)
            for k, bead in zip(low, finer)
        ])
        joints = task.joints(points, phi)
        condition = condition_margin(task.condition(points, phi, joints), task.thresholds(points))
        margin = points.worst(np.minimum(task.rows.margin(joints), condition))
        found += [k for k, least in zip(low, margin) if least < FITS]
    return sorted(found)


def where_lost(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], paths: Sequence[BeadPath], found: search.Found
) -> dict[int, BeadPath | None]:
    """What `of_beads` finds for the beads that do not keep all limits though a candidate did at few of their points."""
    promising = found.margin.max(axis=0) >= 0.0
    rows = [k for k in lost(task, beads, paths) if promising[k]]
    some = found.of_beads(np.array(rows, dtype=np.intp))
    return dict(zip(rows, of_beads(task, [beads[k] for k in rows], [places[k] for k in rows], some)))


def of_beads(
    task: Task, beads: Sequence[Bead], places: Sequence[Place], found: search.Found
) -> list[BeadPath | None]:
    """For each bead the path of the rotation that suits all its points, and those between them, best, refined from there;
    None where none keeps all limits. found: the candidates of these beads, judged at few of their points."""
    if not beads:
        return []
    own, finer = gather(beads, task.cell), [_finer(bead) for bead in beads]
    between = gather(finer, task.cell)
    thresholds = task.thresholds(between)
    here = _judged_at(task, own, task.thresholds(own), found, len(found.margin))
    here = _judged_at(task, between, thresholds, here, CANDIDATES)
    best, each = here.best(), np.arange(len(beads))
    start, wanted = here.coefficients[best, each], here.margin[best, each] >= 0.0
    refined = refine.refine(task, between, thresholds, start[None], wanted)
    at_all = judged(task, finer, places, between, thresholds, refined.coefficients, refined)
    paths = judged(task, beads, places, own, task.thresholds(own), refined.coefficients, refined)
    return [
        path if serves and min(path.margin, other.margin) >= FITS else None
        for path, other, serves in zip(paths, at_all, wanted)
    ]


def _judged_at(task: Task, points: Points, thresholds: Array, found: search.Found, most: int) -> search.Found:
    """Of the candidates of each bead that serve, the best, as many as `most` at most, judged at these points."""
    worth = np.where(found.margin >= 0.0, found.objective, np.inf)
    count = max(1, min(most, int((found.margin >= 0.0).sum(axis=0).max())))
    chosen = np.argsort(worth, axis=0, kind="stable")[:count]
    each = np.arange(points.beads)
    judged_there = search.judge(task, points, thresholds, found.coefficients[chosen, each])
    serves = found.margin[chosen, each] >= 0.0
    return dataclasses.replace(judged_there, margin=np.where(serves, judged_there.margin, UNREACHABLE))


def _finer(bead: Bead) -> Bead:
    for _ in range(HALVINGS):
        bead = bead.halved(np.arange(len(bead) - 1))
    return bead
