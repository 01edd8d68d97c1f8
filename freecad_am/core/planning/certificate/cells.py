# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a rotation about the tool axis within a cell, from one angle to another, may keep limits and condition."""

from __future__ import annotations

import numpy as np

from ...geometry.angles import shortest
from ...kinematics import jacobian as jac
from ...types import Array, Index, Mask
from ..points import Points
from ..task import Task

CELLS, PARTS = 36, 3  # in a turn at first, and of a cell when it is divided


def whole_turn() -> tuple[Array, float]:
    """The middles (CELLS,) of the cells of a whole turn and half the width of each, rad."""
    half = np.pi / CELLS
    return -np.pi + half * (2.0 * np.arange(CELLS) + 1.0), half


def divided(phi: Array, half: float) -> Array:
    """(PARTS n,) the middles of the parts of cells phi (n,) +- half, those of one cell side by side."""
    offsets = (2.0 * np.arange(PARTS) - (PARTS - 1)) * half / PARTS
    return np.asarray((phi[:, None] + offsets).ravel())


def possible(
    task: Task, points: Points, index: Index, phi: Array, half: Array, threshold: Array
) -> Mask:
    """(n,) whether a rotation in the cells phi +- half (n,), rad, at points `index` (n,) may keep limits and condition, of
    which threshold (n,) is the smallest allowed, from their middle and ends. Joints are taken to bend at most twice as much
    between these as their second differences say."""
    count = len(phi)
    begins = ~_goes_on(
        index, phi, half
    )  # where the end of the cell before is not the beginning of this one
    sampled = np.concatenate([phi[begins] - half[begins], phi, phi + half])
    sampled_points = points.select_points(np.concatenate([index[begins], index, index]))
    joints, begin_count = task.raw_joints(sampled_points, sampled), int(begins.sum())
    rows = begin_count + np.arange(2 * count).reshape(2, count)
    rows = np.stack([np.where(begins, np.cumsum(begins) - 1, rows[1] - 1), *rows])
    previous, middle, following = joints[rows]
    ahead, behind = _short(following - middle), _short(middle - previous)
    # a cell at the edge of reach goes on beyond the edge as it does before it
    lost_ahead, lost_behind = (np.isnan(difference).any(axis=1) for difference in (ahead, behind))
    feasible = np.isfinite(middle).all(axis=1) & ~(lost_ahead & lost_behind)
    ahead, behind = (
        np.where(lost_ahead[:, None], behind, ahead),
        np.where(lost_behind[:, None], ahead, behind),
    )
    turned, bend = 0.5 * np.abs(ahead + behind), np.abs(ahead - behind)
    # of a parabola the line through its ends, a quarter of the second difference away, is off by as much: twice that here
    off = 0.5 * bend + (half**2)[:, None] * turned.max(axis=1, keepdims=True)
    off = np.where((lost_ahead ^ lost_behind)[:, None], 0.5 * np.abs(ahead), off)
    feasible &= _within_limits(task, middle, turned + off + bend)
    open_ = np.flatnonzero(feasible)
    once, inverse_rows = np.unique(rows[:, open_], return_inverse=True)
    thresholds = np.empty(len(once))
    thresholds[inverse_rows.ravel()] = np.tile(threshold[open_], 3)
    ratio = _condition(task, sampled_points, sampled, joints, once, thresholds)[
        inverse_rows
    ].reshape(3, -1)
    feasible[open_] = 2.0 * ratio.max(axis=0) - ratio.min(axis=0) >= threshold[open_]
    return np.asarray(feasible)


def _goes_on(index: Index, phi: Array, half: Array) -> Mask:
    """(n,) whether a cell phi +- half at a point begins where the one before it ends, at the same point."""
    continues = np.zeros(len(phi), dtype=bool)
    gap = np.abs(phi[1:] - phi[:-1] - half[1:] - half[:-1])
    continues[1:] = (index[1:] == index[:-1]) & (gap < 1e-6 * half[1:])
    return continues


def _within_limits(task: Task, joints: Array, reach: Array) -> Mask:
    """Whether joints (n, axes), moved by up to `reach` and by whole turns, can be within the limits of each axis."""
    limits = task.cell.limits
    beyond = np.abs(_short(joints - task.middle)) - np.where(
        task.continuous, np.inf, 0.5 * (limits.upper - limits.lower)
    )
    return np.asarray((beyond <= reach).all(axis=1))


def _condition(
    task: Task, points: Points, phi: Array, joints: Array, rows: Index, threshold: Array
) -> Array:
    """The condition at chosen rows, 0 out of reach; where a bound tells that it is far above the threshold, that bound."""
    ratio = np.zeros(len(rows))
    good = np.flatnonzero(np.isfinite(joints[rows]).all(axis=1))
    matrix = task.jacobian_at(points.frames.of(rows[good]), phi[rows[good]], joints[rows[good]])
    length = task.parameters.characteristic_length
    bound = jac.condition_bound(matrix, length)
    uncertain = bound < 2.0 * threshold[good]
    bound[uncertain] = jac.condition(matrix[uncertain], length)
    ratio[good] = bound
    return ratio


def _short(angle: Array) -> Array:
    short: Array = shortest(angle)
    return short
