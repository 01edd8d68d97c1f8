# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bring a polynomial within the limits, or as near to them as possible.

The worst violation over all points is a maximum of many smooth functions: a descent along the worst
one only zigzags from point to point. Each step here is a linear program over all points at once in
a region where their derivatives are trusted.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...types import Array

# values (r,) of the constraints at all points, kept where >= 0, and their derivatives (r, k); None where unreachable
Constraints = Callable[[Array], "tuple[Array, Array] | None"]

REACH = 0.3  # of a first step, rad of the polynomial
MIN_STEP_RAD = 1e-5  # rad, of a step worth trying
SUFFICIENT_SLACK = 1e-3  # by how much constraints are wanted to be kept
GAIN = 1e-6  # of the worst constraint, less than which ends the search
STEPS = 40
MOST_ROWS = 600


def approached(constraints: Constraints, start: Array) -> Array:
    """x (k,) at which the worst constraint is as good as steps from the start (k,) make it, or good enough."""
    from scipy.optimize import (
        linprog,  # slow to import, and most jobs on parts of revolution never need it
    )

    x, reach, current = start, REACH, constraints(start)
    for _ in range(STEPS):
        if current is None or reach < MIN_STEP_RAD:
            return x
        value, rate = current
        worst = float(value.min())
        if worst >= SUFFICIENT_SLACK:
            return x
        # rows that cannot become the worst within reach are left out
        lowest = value - reach * np.abs(rate).sum(axis=1)
        rows = np.flatnonzero(lowest < max(SUFFICIENT_SLACK, float(value.min())) + GAIN)
        rows = rows[np.argsort(lowest[rows], kind="stable")[:MOST_ROWS]]
        k = len(x)
        # the largest t <= SUFFICIENT_SLACK with value + rate step >= t
        solved = linprog(
            np.r_[np.zeros(k), -1.0],
            A_ub=np.c_[-rate[rows], np.ones(len(rows))],
            b_ub=value[rows],
            bounds=[(-reach, reach)] * k + [(None, SUFFICIENT_SLACK)],
            method="highs",
        )
        if solved.x is None or solved.x[-1] < worst + GAIN:
            return x
        trial = constraints(x + solved.x[:k])
        hoped, got = (
            solved.x[-1] - worst,
            -np.inf if trial is None else float(trial[0].min()) - worst,
        )
        if got > 0.1 * hoped:
            x, current = x + solved.x[:k], trial
            reach *= 2.0 if got > 0.7 * hoped else 1.0
        else:
            reach = 0.25 * min(reach, float(np.abs(solved.x[:k]).max()))
    return x
