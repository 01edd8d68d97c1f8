# SPDX-License-Identifier: LGPL-2.1-or-later
"""The local search of polynomials that keep the links clear: how far they are off, linear about what was looked at last,
among its constraints.

To look costs many times what all else does, so that all beads are looked at together: at each look gaps and their changes
with the polynomial are found at all points, the optimiser goes as far as these serve, and there is the next look.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...kinematics.links.gaps import Gaps
from ...types import Array, Index, Mask
from ..points import Points
from ..rotation import basis
from ..rotation.refine import FAR_OFF, KEPT, Linear, Refined, refine_along
from ..rotation.refine_state import state_of
from ..task import Task
from .kept import ArmKept, Place

LOOKS = 10
WITHIN = 50.0  # mm; of what is farther off than it has to be nothing is told
SLACK = 0.01  # mm that are kept besides, so that what is found is clear
REACH = 0.3  # rad that a polynomial may change by from the first look to the second
UNCHANGED = 1e-4  # rad, and share of the objective, less than which is no change
STOPPED = "the way to what is better comes too near"


def refined_clear(
    task: Task, kept: ArmKept, points: Points, places: Sequence[Place], start: Array
) -> Refined:
    """Polynomials that are better than those of the beads at these places which it starts with (B, degree + 1), and keep the
    links as clear; those it starts with where none was found. points: all of the beads."""
    thresholds, directions = (
        task.thresholds(points),
        basis.changes(task, points, start.shape[1] - 1),
    )
    gaps = Gaps(kept.contact, WITHIN)
    moment = np.array([kept.moment(place) for place in places], dtype=np.int64)
    tried, best = start.copy(), start.copy()
    objective = np.full(points.beads, np.inf)
    reach, left = np.full(points.beads, REACH), np.ones(points.beads, dtype=bool)
    reason, iterations = [STOPPED] * points.beads, [0] * points.beads
    for _ in range(LOOKS):
        state = state_of(task, points, thresholds, tried, slopes=False)
        value, gap, slope = _looked(task, gaps, points, tried, moment, left)
        clear = points.worst(gap.min(axis=0)) >= 0.0
        good = clear & (state.constraints >= -KEPT).all(axis=1) & np.isfinite(state.objective)
        better = left & good & ~(state.objective > objective * (1.0 - UNCHANGED))
        best[better], objective[better] = tried[better], state.objective[better]
        left &= better | ~clear
        reach[~better] *= 0.5
        for bead in np.flatnonzero(left):
            part, chosen = points.only(int(bead))
            more = Linear(
                value[chosen],
                np.where(gap[:, chosen] < WITHIN, (gap[:, chosen] - SLACK) / WITHIN, FAR_OFF),
                slope[:, chosen] / WITHIN,
                reach[bead],
            )
            found, why, count = refine_along(
                task, part, thresholds[chosen], tried[bead], directions[bead], more
            )
            reason[bead], iterations[bead] = why, iterations[bead] + count
            left[bead] = bool(
                np.abs(part.polynomial((found - tried[bead])[None])).max() > UNCHANGED
            )
            tried[bead] = found
        if not left.any():
            break
    return Refined(best, objective, tuple(reason), tuple(iterations))


def _looked(
    task: Task, gaps: Gaps, points: Points, coefficients: Array, moment: Index, asked: Mask
) -> tuple[Array, Array, Array]:
    """Of beads asked about (B,): the values (T,) of their polynomials, and by how much all pairs are clear at all points,
    mm, and how that changes with these values, both (pairs, T)."""
    value = points.polynomial(coefficients)
    phi, phi_rate = task.rotation(points, value)
    joints = task.joints(points, phi)
    shape = len(gaps.pairs), len(points)
    gap, slope = np.full(shape, gaps.reach), np.zeros(shape)
    some = np.flatnonzero(asked[points.bead] & np.isfinite(joints).all(axis=1))
    rates, _ = task.rotation_rates(points.frames.of(some), phi[some], joints[some])
    wanted = np.ones((len(gaps.pairs), len(some)), dtype=bool)
    gap[:, some], slope[:, some] = gaps.at(
        joints[some], rates * phi_rate[some, None], moment[points.bead[some]], wanted
    )
    return value, gap, slope
