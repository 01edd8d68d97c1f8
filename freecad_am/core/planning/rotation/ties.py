# SPDX-License-Identifier: LGPL-2.1-or-later
"""Choose one of many equal optima.

On a part of revolution the objective does not depend on the offset of the rotation (ERRATA): the
optimum is a flat valley. The solution with the largest smallest margin to limits and singularities
is chosen; if several are equally close, the one with the least motion from the previous bead.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...geometry.angles import TURN, shortest
from ...geometry.ties import first_most, index_of_minimum, is_tied
from ...types import Array, ArrayLike, Integers, Mask
from ..points import Points
from ..task import Task
from . import search

COARSE, FINE = 72, 15
# minimum separation of two different peaks of the margin, in coarse steps (30 deg)
MIN_PEAK_SEPARATION_STEPS = 6
# two objectives count as equal within this share, two margins within this distance (1 is the middle of a range)
OBJECTIVE_TOLERANCE = 1e-6
MAX_MARGIN_LOSS = 0.01


def resolve(task: Task, points: Points, thresholds: Array, coefficients: Array) -> Array:
    """(B, degree + 1) coefficients moved along their valley; unchanged where the optimum is the only one.

    points may be thinned; coefficients (B, degree + 1) are the optimum found.
    """
    current = search.judge(task, points, thresholds, coefficients[None])
    coarse = _offset_candidates(
        coefficients,
        np.broadcast_to(np.arange(COARSE)[:, None] * (TURN / COARSE), (COARSE, points.beads)),
    )
    rough = search.judge(task, points, thresholds, coarse, conditions=False)
    flat = as_good(task, rough.objective, current.objective)
    if not flat[1:].any():
        return coefficients
    rough = replace(rough, margin=np.where(flat, rough.margin, -np.inf))
    around = _peaks(search.add_conditions(task, points, thresholds, rough, _are_peaks)) * (
        TURN / COARSE
    )
    offsets = (around[:, None] + np.linspace(-1.0, 1.0, FINE)[:, None] * (TURN / COARSE)).reshape(
        -1, points.beads
    )
    fine = search.judge(task, points, thresholds, _offset_candidates(coefficients, offsets))
    flat = as_good(task, fine.objective, current.objective)
    margin = np.where(flat, fine.margin, -np.inf)
    chosen_ids = _least_motion(task, points, fine.coefficients, margin)
    improved = ~is_tied(-current.margin[0], -margin[chosen_ids, np.arange(points.beads)])
    return np.where(
        improved[:, None], fine.coefficients[chosen_ids, np.arange(points.beads)], coefficients
    )


def as_good(task: Task, objective: ArrayLike, best: Array) -> Mask:
    """Whether objectives count as equal to the best ones."""
    good: Mask = (
        np.asarray(objective) <= best * (1.0 + OBJECTIVE_TOLERANCE) + task.parameters.tolerance
    )
    return good


def _are_peaks(margin: Array) -> Mask:
    """(C, B) which candidates are `_peaks`."""
    is_peak: Mask = (np.arange(COARSE)[:, None] == _peaks(margin)[:, None]).any(axis=0)
    return is_peak


def _peaks(margin: Array) -> Array:
    """(2, B) coarse steps of the two highest peaks of the margin (C, B) around the turn that are different ones."""
    highest = first_most(margin, axis=0)
    separation = np.abs((np.arange(COARSE)[:, None] - highest + COARSE // 2) % COARSE - COARSE // 2)
    second_highest = first_most(
        np.where(separation >= MIN_PEAK_SEPARATION_STEPS, margin, -np.inf), axis=0
    )
    return np.stack([highest, second_highest]).astype(float)


def _offset_candidates(coefficients: Array, offsets: Array) -> Array:
    offset_coefficients = np.repeat(coefficients[None], len(offsets), axis=0)
    offset_coefficients[:, :, 0] += offsets
    return offset_coefficients


def _least_motion(task: Task, points: Points, candidates: Array, margin: Array) -> Integers:
    """Return the index (B,) of each bead's candidate: among those close to its largest margin, the
    nearest to the previous bead.
    """
    start = _joints_at(task, points, candidates, points.first)
    end = _joints_at(task, points, candidates, np.append(points.first[1:], len(points)) - 1)
    chosen_ids = np.empty(points.beads, dtype=np.int64)
    for bead in range(points.beads):
        close = margin[:, bead] >= margin[:, bead].max() - MAX_MARGIN_LOSS
        if bead == 0 or not np.isfinite(margin[:, bead].max()):
            chosen_ids[bead] = first_most(margin[:, bead])
            continue
        step = start[:, bead] - end[chosen_ids[bead - 1], bead - 1]
        step = shortest(step)
        chosen_ids[bead] = index_of_minimum(np.where(close, (step * step) @ task.weights, np.inf))
    return chosen_ids


def _joints_at(task: Task, points: Points, candidates: Array, index: Integers) -> Array:
    """(C, B, axes) joints at one point of each bead, zero where unreachable."""
    bead_points = points.select_points(index)
    value = np.stack([bead_points.polynomial(row) for row in candidates])
    phi = np.stack([task.rotation(bead_points, row)[0] for row in value])
    return np.nan_to_num(task.raw_joints(bead_points, phi))
