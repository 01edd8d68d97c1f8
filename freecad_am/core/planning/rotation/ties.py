# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settles which of many equal optima is taken.

On a part of revolution the objective does not depend on the offset of the rotation (ERRATA): the optimum is a flat
valley. Of the solutions in it the one with the largest smallest margin to limits and singularities is taken;
where several come equally close, the one with the least motion from the bead before.
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
# two peaks of the margin are different ones when they lie this far apart, in coarse steps (30 deg)
APART = 6
# two objectives count as equal within this share, two margins within this distance (1 is the middle of a range)
FLAT = 1e-6
CLOSE = 0.01


def resolve(task: Task, points: Points, thresholds: Array, coefficients: Array) -> Array:
    """(B, degree + 1) coefficients moved along their valley; unchanged where the optimum is the only one.

    points may be thinned; coefficients (B, degree + 1) are the optimum found.
    """
    here = search.judge(task, points, thresholds, coefficients[None])
    coarse = _moved(
        coefficients,
        np.broadcast_to(np.arange(COARSE)[:, None] * (TURN / COARSE), (COARSE, points.beads)),
    )
    rough = search.judge(task, points, thresholds, coarse, conditions=False)
    flat = as_good(task, rough.objective, here.objective)
    if not flat[1:].any():
        return coefficients
    rough = replace(rough, margin=np.where(flat, rough.margin, -np.inf))
    around = _peaks(search.with_conditions(task, points, thresholds, rough, _are_peaks)) * (
        TURN / COARSE
    )
    offsets = (around[:, None] + np.linspace(-1.0, 1.0, FINE)[:, None] * (TURN / COARSE)).reshape(
        -1, points.beads
    )
    near = search.judge(task, points, thresholds, _moved(coefficients, offsets))
    flat = as_good(task, near.objective, here.objective)
    margin = np.where(flat, near.margin, -np.inf)
    chosen = _least_motion(task, points, near.coefficients, margin)
    improved = ~is_tied(-here.margin[0], -margin[chosen, np.arange(points.beads)])
    return np.where(
        improved[:, None], near.coefficients[chosen, np.arange(points.beads)], coefficients
    )


def as_good(task: Task, objective: ArrayLike, best: Array) -> Mask:
    """Whether objectives count as equal to the best ones."""
    good: Mask = np.asarray(objective) <= best * (1.0 + FLAT) + task.parameters.tolerance
    return good


def _are_peaks(margin: Array) -> Mask:
    """(C, B) which candidates are `_peaks`."""
    found: Mask = (np.arange(COARSE)[:, None] == _peaks(margin)[:, None]).any(axis=0)
    return found


def _peaks(margin: Array) -> Array:
    """(2, B) coarse steps of the two highest peaks of the margin (C, B) around the turn that are different ones."""
    first = first_most(margin, axis=0)
    apart = np.abs((np.arange(COARSE)[:, None] - first + COARSE // 2) % COARSE - COARSE // 2)
    second = first_most(np.where(apart >= APART, margin, -np.inf), axis=0)
    return np.stack([first, second]).astype(float)


def _moved(coefficients: Array, offsets: Array) -> Array:
    moved = np.repeat(coefficients[None], len(offsets), axis=0)
    moved[:, :, 0] += offsets
    return moved


def _least_motion(task: Task, points: Points, candidates: Array, margin: Array) -> Integers:
    """(B,) index of each bead's candidate: of those close to its largest margin, the nearest to the bead before."""
    start = _joints_at(task, points, candidates, points.first)
    end = _joints_at(task, points, candidates, np.append(points.first[1:], len(points)) - 1)
    chosen = np.empty(points.beads, dtype=np.int64)
    for bead in range(points.beads):
        close = margin[:, bead] >= margin[:, bead].max() - CLOSE
        if bead == 0 or not np.isfinite(margin[:, bead].max()):
            chosen[bead] = first_most(margin[:, bead])
            continue
        step = start[:, bead] - end[chosen[bead - 1], bead - 1]
        step = shortest(step)
        chosen[bead] = index_of_minimum(np.where(close, (step * step) @ task.weights, np.inf))
    return chosen


def _joints_at(task: Task, points: Points, candidates: Array, index: Integers) -> Array:
    """(C, B, axes) joints at one point of each bead, zero where unreachable."""
    at = points.select_points(index)
    value = np.stack([at.polynomial(row) for row in candidates])
    phi = np.stack([task.rotation(at, row)[0] for row in value])
    return np.nan_to_num(task.raw_joints(at, phi))
