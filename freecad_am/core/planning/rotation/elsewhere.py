# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotations of beads for which those that seemed best do not serve: the search looks at few points, and between them, or
between the points of the bead, it may come out of its limits or too near to a singularity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...toolpath import Bead
from ..joint_path import BeadPath
from ..points import gather
from ..task import FITS, Task
from . import refine, search
from .evaluation import judged

Place = tuple[int, int]

LOW = 3.0  # times the condition asked for; from there it may fall short between two points
HALVINGS = 2  # of each segment, where it is looked at between


def lost(task: Task, beads: Sequence[Bead], places: Sequence[Place], paths: Sequence[BeadPath]) -> list[int]:
    """Which of the beads do not keep all limits with their rotation, at their points or between them."""
    found = [k for k, path in enumerate(paths) if path.margin < FITS]
    low = [k for k, path in enumerate(paths) if path.margin >= FITS and (path.condition < LOW * path.threshold).any()]
    if low:
        finer, asked = [_finer(beads[k]) for k in low], [paths[k] for k in low]
        points = gather(finer, task.cell)
        as_they_are = refine.Refined(
            np.array([path.coefficients for path in asked]), np.array([path.objective for path in asked]),
            tuple(path.reason for path in asked), tuple(path.iterations for path in asked),
        )
        between = judged(
            task, finer, [places[k] for k in low], points, task.thresholds(points), as_they_are.coefficients, as_they_are
        )
        found += [k for k, path in zip(low, between) if path.margin < FITS]
    return sorted(found)


def of_beads(task: Task, beads: Sequence[Bead], places: Sequence[Place]) -> list[BeadPath | None]:
    """For each bead the path of the rotation that suits all its points, and those between them, best, refined from there;
    None where none keeps all limits."""
    if not beads:
        return []
    finer = [_finer(bead) for bead in beads]
    points = gather(finer, task.cell)
    thresholds = task.thresholds(points)
    found = search.everywhere(task, points, thresholds, best_alone=True)
    best, each = found.best(), np.arange(len(beads))
    wanted = found.margin[best, each] >= 0.0
    refined = refine.refine(task, points, thresholds, found.coefficients[best, each][None], wanted)
    between = judged(task, finer, places, points, thresholds, refined.coefficients, refined)
    points = gather(beads, task.cell)
    paths = judged(task, beads, places, points, task.thresholds(points), refined.coefficients, refined)
    return [path if min(path.margin, other.margin) >= FITS else None for path, other in zip(paths, between)]


def _finer(bead: Bead) -> Bead:
    for _ in range(HALVINGS):
        bead = bead.halved(np.arange(len(bead) - 1))
    return bead
