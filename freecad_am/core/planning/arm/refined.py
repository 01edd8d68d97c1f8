# SPDX-License-Identifier: LGPL-2.1-or-later
"""The local search of polynomials that keep the links clear: the clearances, linear about the last
check, are among its constraints.

A check costs many times as much as the rest, so all beads are checked together: each check finds
the gaps at all points and their change with the polynomial, the optimiser goes as far as these
serve, and the next check follows.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...kinematics.links.gaps import Gaps
from ...types import Array, Index, Mask
from ..points import Points
from ..rotation import basis
from ..rotation.refine import CONSTRAINT_TOLERANCE, INACTIVE_VALUE, Linear, Refined, refine_along
from ..rotation.refine_state import state_of
from ..task import Task
from .kept import ArmKept, Place

MAX_LINEARIZATIONS = 10
GAP_RANGE_MM = 50.0  # mm; pairs with more than this extra clearance are no constraint
EXTRA_GAP_MM = 0.01  # mm of extra clearance, so that the result is clear
REACH = 0.3  # rad that a polynomial may change by from the first look to the second
UNCHANGED = 1e-4  # rad, and share of the objective, less than which is no change
STOPPED = "the path to a better solution comes too near"


def refined_clear(
    task: Task, arm_clearance: ArmKept, points: Points, bead_ids: Sequence[Place], start: Array
) -> Refined:
    """Polynomials that are better than those of the beads at these places which it starts with (B, degree + 1), and keep the
    links as clear; those it starts with where none was found. points: all of the beads."""
    thresholds, directions = (
        task.thresholds(points),
        basis.changes(task, points, start.shape[1] - 1),
    )
    gaps = Gaps(arm_clearance.contact, GAP_RANGE_MM)
    moment = np.array([arm_clearance.moment(bead_id) for bead_id in bead_ids], dtype=np.int64)
    trial, best = start.copy(), start.copy()
    objective = np.full(points.beads, np.inf)
    reach, pending = np.full(points.beads, REACH), np.ones(points.beads, dtype=bool)
    reason, iterations = [STOPPED] * points.beads, [0] * points.beads
    for _ in range(MAX_LINEARIZATIONS):
        state = state_of(task, points, thresholds, trial, slopes=False)
        value, gap, slope = _looked(task, gaps, points, trial, moment, pending)
        clear = points.worst(gap.min(axis=0)) >= 0.0
        good = (
            clear
            & (state.constraints >= -CONSTRAINT_TOLERANCE).all(axis=1)
            & np.isfinite(state.objective)
        )
        better = pending & good & ~(state.objective > objective * (1.0 - UNCHANGED))
        best[better], objective[better] = trial[better], state.objective[better]
        pending &= better | ~clear
        reach[~better] *= 0.5
        for bead in np.flatnonzero(pending):
            bead_points, point_rows = points.only(int(bead))
            clearance_rows = Linear(
                value[point_rows],
                np.where(
                    gap[:, point_rows] < GAP_RANGE_MM,
                    (gap[:, point_rows] - EXTRA_GAP_MM) / GAP_RANGE_MM,
                    INACTIVE_VALUE,
                ),
                slope[:, point_rows] / GAP_RANGE_MM,
                reach[bead],
            )
            refined, why, count = refine_along(
                task,
                bead_points,
                thresholds[point_rows],
                trial[bead],
                directions[bead],
                clearance_rows,
            )
            reason[bead], iterations[bead] = why, iterations[bead] + count
            pending[bead] = bool(
                np.abs(bead_points.polynomial((refined - trial[bead])[None])).max() > UNCHANGED
            )
            trial[bead] = refined
        if not pending.any():
            break
    return Refined(best, objective, tuple(reason), tuple(iterations))


def _looked(
    task: Task, gaps: Gaps, points: Points, coefficients: Array, moment: Index, selected: Mask
) -> tuple[Array, Array, Array]:
    """Of beads asked about (B,): the values (T,) of their polynomials, and by how much all pairs are clear at all points,
    mm, and how that changes with these values, both (pairs, T)."""
    value = points.polynomial(coefficients)
    phi, phi_rate = task.rotation(points, value)
    joints = task.joints(points, phi)
    shape = len(gaps.pairs), len(points)
    gap, slope = np.full(shape, gaps.reach), np.zeros(shape)
    reachable_rows = np.flatnonzero(selected[points.bead] & np.isfinite(joints).all(axis=1))
    rates, _ = task.rotation_rates(
        points.frames.of(reachable_rows), phi[reachable_rows], joints[reachable_rows]
    )
    all_pairs = np.ones((len(gaps.pairs), len(reachable_rows)), dtype=bool)
    gap[:, reachable_rows], slope[:, reachable_rows] = gaps.gaps_and_rates(
        joints[reachable_rows],
        rates * phi_rate[reachable_rows, None],
        moment[points.bead[reachable_rows]],
        all_pairs,
    )
    return value, gap, slope
