# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lower bound of an objective that rates every point separately: its minimum over all rotations at
each point.
"""

from __future__ import annotations

import numpy as np

from ...geometry.angles import shortest
from ...kinematics import jacobian as jac
from ...types import Array, Index
from ..points import Points
from ..task import Task
from .lattice import CELLS, divided, possible, whole_turn

LEVELS = 4
BOUND_TOLERANCE = 1e-3  # share of a point's value at which its bound is near enough


def point_bound(task: Task, points: Points, threshold: Array) -> float:
    """The least that the objective of the task can be for one bead; threshold (n,) of the condition at its points. Infinite
    where a point has no rotation that keeps limits and condition."""
    count = len(points)
    phi, half = whole_turn()
    index, phi = np.repeat(np.arange(count), CELLS), np.tile(phi, count)
    bound = np.full(count, np.inf)
    for level in range(LEVELS):
        feasible = possible(task, points, index, phi, np.full(len(phi), half), threshold[index])
        index, phi = index[feasible], phi[feasible]
        three = np.stack(
            [_values(task, points, index, phi + side * half) for side in (-1.0, 0.0, 1.0)]
        )
        bend = np.nan_to_num(np.abs(three[0] - 2.0 * three[1] + three[2]), nan=0.0)
        lower = np.maximum(np.nanmin(three, axis=0) - bend, 0.0)
        bound = np.full(count, np.inf)
        np.minimum.at(bound, index, lower)
        sampled_min = np.full(count, np.inf)
        np.minimum.at(sampled_min, index, three[1])
        open_ = (bound < (1.0 - BOUND_TOLERANCE) * sampled_min)[index] & (
            lower < sampled_min[index]
        )
        if level + 1 == LEVELS or not open_.any():
            break
        settled = np.bincount(index[open_], minlength=count) == 0
        retained = open_ | (settled[index] & (lower <= bound[index]))
        index, phi = np.repeat(index[retained], 3), divided(phi[retained], half)
        half /= 3.0
    if task.parameters.objective == "limits-klein":
        return float(bound.max())
    return float(bound.mean())


def _values(task: Task, points: Points, index: Index, phi: Array) -> Array:
    """(n,) what the objective says of rotations phi (n,) at chosen points; NaN out of reach."""
    name, selected = task.parameters.objective, points.select_points(index)
    joints = task.raw_joints(selected, phi)
    if name not in ("manipulability", "condition"):
        centred = joints - task.middle
        offset = np.abs(task.given_rows.offset(task.middle + shortest(centred)))
        if name == "limits-klein":
            return np.asarray(0.5 * offset.max(axis=1))
        return np.asarray((offset**2).sum(axis=1) * (0.25 if name == "limits-fournier" else 1.0))
    worth = np.full(len(phi), np.nan)
    good = np.flatnonzero(np.isfinite(joints).all(axis=1))
    matrix = task.jacobian_at(selected.frames.of(good), phi[good], joints[good])
    measure = jac.manipulability if name == "manipulability" else jac.condition
    worth[good] = 1.0 / np.maximum(measure(matrix, task.parameters.characteristic_length), 1e-300)
    return worth
