# SPDX-License-Identifier: LGPL-2.1-or-later
"""The best rotations near known ones, each point free: Newton's steps along the chain, and its multipliers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...geometry.angles import shortest
from ...types import Array, Index
from ..points import Points
from ..task import Task

STEPS = 15
APART = 1e-5  # rad, between the rotations of which a slope is taken
SHORTEST = 1e-3  # of a Newton step that is still tried
DONE = 1e-9  # share of the value by which a step has to lower it


def found(task: Task, points: Points, at: Index, phi: Array) -> tuple[Array, Array]:
    """Rotations (M,) at the points `at` (M,) of a bead with the least sum of squared steps over the number of steps between
    them that is found from phi (M,), and the multiplier (M,) of each: how fast that sum rises by what comes in. None at
    either end; all 0 where joints are not known on both sides."""
    chosen, count = points.each(at), np.diff(at).astype(float)[:, None]
    scale = task.weights / count

    def joints(rotation: Array) -> Array:
        return task.raw_joints(chosen, rotation)

    def value(moved: Array) -> float:
        return float((moved * moved * scale).sum())

    moved = _steps(joints(phi))
    for _ in range(STEPS):
        slope = _slopes(joints, phi)
        if not (np.isfinite(slope).all() and np.isfinite(moved).all()):
            break
        change = _newton(moved, slope, scale)
        size, lower = 1.0, None
        while size > SHORTEST:
            tried = _steps(joints(phi + size * change))
            if np.isfinite(tried).all() and value(tried) < value(moved):
                lower = tried
                break
            size *= 0.5
        if lower is None:
            break
        phi, small, moved = phi + size * change, value(lower) > (1.0 - DONE) * value(moved), lower
        if small:
            break
    slope = _slopes(joints, phi)
    multiplier = np.zeros(len(at))
    leaving = 2.0 * (moved * scale * slope[:-1]).sum(axis=1)
    coming = 2.0 * (moved * scale * slope[1:]).sum(axis=1)
    multiplier[1:-1] = 0.5 * (leaving[1:] + coming[:-1])
    return phi, multiplier if np.isfinite(multiplier).all() else np.zeros(len(at))


def _newton(moved: Array, slope: Array, scale: Array) -> Array:
    """The step (M,) of Gauss and Newton for squared steps moved (M - 1, axes) with d q / d phi (M, axes)."""
    from scipy.linalg import solveh_banded  # slow to import, and few jobs ask for a certificate

    bands = np.zeros((2, len(slope)))
    bands[1, :-1] += (slope[:-1] ** 2 * scale).sum(axis=1)
    bands[1, 1:] += (slope[1:] ** 2 * scale).sum(axis=1)
    bands[0, 1:] = -(slope[:-1] * slope[1:] * scale).sum(axis=1)
    bands[1] += 1e-9 * bands[1].mean() + 1e-300
    rate = np.zeros(len(slope))
    rate[:-1] -= (moved * slope[:-1] * scale).sum(axis=1)
    rate[1:] += (moved * slope[1:] * scale).sum(axis=1)
    try:
        return np.asarray(-solveh_banded(bands, rate), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.asarray(-rate / bands[1])


def _slopes(joints: Callable[[Array], Array], phi: Array) -> Array:
    difference = joints(phi + APART) - joints(phi - APART)
    slope: Array = shortest(difference) / (2.0 * APART)
    return slope


def _steps(joints: Array) -> Array:
    moved = np.diff(joints, axis=0)
    short: Array = shortest(moved)
    return short
