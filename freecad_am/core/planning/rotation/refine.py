# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optimisation of the polynomials (Chalvin 2020, eqs. 16 to 19), with analytic gradients.

All beads are evaluated together once; those already at a stationary, feasible point are done. The others go
through SLSQP one by one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry.ties import alike
from ...kinematics import jacobian as jac
from ...types import Array, Integers, Mask
from ..points import Points
from ..task import Task
from . import basis, feasible
from .refine_state import State, slopes_of, state_of, values_of

# by how little a constraint may be violated and count as kept: limits and condition have reserves many times as wide
KEPT = 4e-7
# runs of the optimiser, each with the constraints added that the one before came close to
ROUNDS = 4
FAR_OFF = 1.0  # of a constraint that does not matter; those of limits and condition are less
SMALLEST = 1e-9  # objective that an objective is set against
STATIONARY = "stationary at the start found by the search"
OUT_OF_LIMITS = "no polynomial found that keeps all limits"


@dataclass(frozen=True, eq=False)
class Refined:
    """One polynomial per bead: coefficients (B, degree + 1), objective (B,), why and after how many iterations the
    optimiser stopped."""

    coefficients: Array
    objective: Array
    reason: tuple[str, ...]
    iterations: tuple[int, ...]


def refine(
    task: Task,
    points: Points,
    thresholds: Array,
    starts: Array,
    wanted: Mask | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> Refined:
    """Improve the coefficients of every bead, or of the wanted (B,); points are all points of the beads.

    starts: (S, B, degree + 1), the first the one to be preferred; NaN where a bead has no further one. Closed beads that
    join up stay joined. report: called before each bead with the share that is done; it may raise to cancel.
    """
    first = state_of(task, points, thresholds, starts[0], slopes=False)
    tolerance = task.parameters.tolerance
    alone = (
        np.isnan(starts[1:]).any(axis=(0, 2))
        if len(starts) > 1
        else np.ones(points.beads, dtype=bool)
    )
    done = (
        np.isfinite(first.objective)
        & (first.predicted <= tolerance)
        & (first.constraints >= 0.0).all(axis=1)
        & alone
    )
    if wanted is not None:
        done |= ~wanted
    coefficients, objective = starts[0].copy(), first.objective.copy()
    reasons = [STATIONARY] * points.beads
    iterations = [0] * points.beads
    directions = basis.changes(task, points, starts.shape[2] - 1)
    left = np.flatnonzero(~done)
    for number, bead in enumerate(left):
        report(number / len(left))
        part, chosen = points.only(int(bead))
        tried = [
            _climbed(_Bead(task, part, thresholds[chosen]), start, directions[bead])
            for start in starts[:, bead]
            if np.isfinite(start).all()
        ]
        best = 0
        for k in range(1, len(tried)):
            if _better(tried[k], tried[best]):
                best = k
        _, objective[bead], coefficients[bead], reasons[bead], iterations[bead] = tried[best]
    return Refined(coefficients, objective, tuple(reasons), tuple(iterations))


@dataclass(frozen=True, eq=False)
class Linear:
    """Constraints >= 0 at all points of a bead, about the values `at` (T,) of its polynomial there: `value` and `slope`
    (r, T), FAR_OFF and 0 of those that do not matter. reach: by how much the polynomial may change at most."""

    at: Array
    value: Array
    slope: Array
    reach: float


def refine_along(
    task: Task, points: Points, thresholds: Array, start: Array, directions: Array, more: Linear
) -> tuple[Array, str, int]:
    """Of one bead the coefficients (degree + 1,), better than those it starts with as long as `more` holds; why and after
    how many iterations the optimiser stopped. directions: (degree + 1, degree + 1) what may change, as `basis.changes`
    gives it; thresholds (T,)."""
    used = directions[:, np.abs(directions).any(axis=0)]
    return _slsqp(_Bead(task, points, thresholds, more), start, used)


@dataclass(frozen=True, eq=False)
class _Bead:
    """One bead alone, its points and the condition asked for at each; what else is to be kept, where that is asked for."""

    task: Task
    points: Points
    thresholds: Array
    more: Linear | None = None

    def state(self, coefficients: Array) -> State:
        return state_of(self.task, self.points, self.thresholds, coefficients[None])

    def constraints(self, coefficients: Array, free: Array) -> tuple[Array, Array] | None:
        """All constraints at all points (r,) and their derivatives (r, k) along the free columns; None out of reach."""
        found = _at_all_points(self.task, self.points, self.thresholds, coefficients[None], free)
        if self.more is None or found is None:
            return found
        shape = self.points.powers(len(coefficients) - 1)
        value = self.more.value + self.more.slope * (shape @ coefficients - self.more.at)
        rate = (self.more.slope[:, :, None] * (shape @ free)).reshape(-1, free.shape[1])
        return np.append(found[0], value.ravel()), np.concatenate([found[1], rate])

    def worth(self, coefficients: Array) -> tuple[float, float]:
        """By how much the constraints are violated at worst, and the objective: the less the better."""
        state = self.state(coefficients)
        worst = float(np.nan_to_num(state.constraints, nan=-1.0).min())
        violated = max(0.0, -worst) if np.isfinite(state.objective[0]) else np.inf
        return (violated if violated > KEPT else 0.0, float(state.objective[0]))


def _better(one: tuple[Any, ...], other: tuple[Any, ...]) -> bool:
    """Whether (violation, objective, ...) is less than another by more than rounding."""
    if not alike(one[0], other[0]) or not alike(other[0], one[0]):
        return bool(one[0] < other[0])
    return not bool(alike(other[1], one[1]))


def _climbed(bead: _Bead, start: Array, directions: Array) -> tuple[float, float, Array, str, int]:
    """Optimised degree by degree, so that a higher one is never worse: violation, objective, coefficients, why and after
    how many iterations the last degree stopped."""
    here, worth, reason, iterations = start, bead.worth(start), STATIONARY, 0
    used = np.flatnonzero(np.abs(directions).any(axis=0))
    for count in range(1, len(used) + 1):
        # an open bead of the first degree has been looked at in the search for slope and offset at once
        if count == 1 and len(used) > 1 and used[1] == 1:
            continue
        free = directions[:, used[:count]]
        if worth[0] > 0.0:
            here, worth = _brought_in(bead, here, free, worth)
            if worth[0] > 0.0:
                reason = OUT_OF_LIMITS
                continue
        found, reason, iterations = _slsqp(bead, here, free)
        better = bead.worth(found)
        if better <= worth:
            here, worth = found, better
    return (*worth, here, reason, iterations)


def _brought_in(
    bead: _Bead, here: Array, free: Array, worth: tuple[float, float]
) -> tuple[Array, tuple[float, float]]:
    """Coefficients that violate the limits less than those here, where there are any, and their worth."""
    nearer = here + free @ feasible.approached(
        lambda x: bead.constraints(here + free @ x, free), np.zeros(free.shape[1])
    )
    other = bead.worth(nearer)
    return (nearer, other) if _better(other, worth) else (here, worth)


def _slsqp(bead: _Bead, start: Array, directions: Array) -> tuple[Array, str, int]:
    """Coefficients, why the optimiser stopped and after how many iterations; run again where it came upon constraints that
    it had not been told of."""
    x, reason, iterations = np.zeros(directions.shape[1]), STATIONARY, 0
    rows = np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        known = bead.constraints(start + directions @ x, directions)
        if known is None:
            break
        before, rows = len(rows), np.union1d(rows, _tightest(known[0], len(bead.points)))
        if len(rows) == before:
            break
        result = _run(bead, start, directions, x, rows)
        x, reason, iterations = result.x, str(result.message), iterations + int(result.nit)
    return start + directions @ x, reason, iterations


def _run(bead: _Bead, start: Array, directions: Array, x: Array, rows: Integers) -> Any:
    from scipy.optimize import (
        minimize,  # slow to import, and most jobs on parts of revolution never need it
    )

    states: dict[bytes, State] = {}
    everywhere: dict[bytes, tuple[Array, Array]] = {}

    def state(x: Array) -> State:
        key = x.tobytes()
        if key not in states:
            states.clear()
            states[key] = bead.state(start + directions @ x)
        return states[key]

    def constraints(x: Array) -> tuple[Array, Array]:
        key = x.tobytes()
        if key not in everywhere:
            everywhere.clear()
            found = bead.constraints(start + directions @ x, directions)
            lost = np.full(len(rows), -1.0), np.zeros((len(rows), len(x)))
            everywhere[key] = lost if found is None else (found[0][rows], found[1][rows])
        return everywhere[key]

    # first steps are as long as the gradient: where constraints turn it aside, one of an objective much below 1 is none
    scale = 1.0 if bead.more is None else max(float(state(x).objective[0]), SMALLEST)

    def objective(x: Array) -> float:
        value = float(state(x).objective[0]) / scale
        return value if np.isfinite(value) else 1e6

    kept = [
        {"type": "ineq", "fun": lambda x: constraints(x)[0], "jac": lambda x: constraints(x)[1]}
    ]
    if (
        bead.more is not None
    ):  # changes are of the size of a rotation, so that together they stay within reach
        most, each = bead.more.reach / len(x), np.eye(len(x))
        both = np.concatenate([each, -each])
        kept.append({"type": "ineq", "fun": lambda x: most - both @ x, "jac": lambda x: -both})
    # scipy's stubs do not know a list of constraint dictionaries with their own types
    return minimize(  # type: ignore[call-overload]
        objective,
        x,
        jac=lambda x: np.nan_to_num(state(x).gradient[0]) @ directions / scale,
        constraints=kept,
        method="SLSQP",
        options={
            "ftol": bead.task.parameters.tolerance,
            "maxiter": bead.task.parameters.max_iterations,
        },
    )


def _tightest(values: Array, points: int) -> Integers:
    """Which constraints are told to the optimiser: of each row those at its local minima along the bead and beside them,
    but for those that are FAR_OFF from being violated."""
    value = values.reshape(-1, points)
    padded = np.pad(value, ((0, 0), (1, 1)), constant_values=np.inf)
    lowest = (value <= padded[:, :-2]) & (value <= padded[:, 2:])
    tried = lowest.copy()
    tried[:, 1:] |= lowest[:, :-1]
    tried[:, :-1] |= lowest[:, 1:]
    return np.flatnonzero((tried & (value < FAR_OFF)).ravel())


def _at_all_points(
    task: Task, points: Points, thresholds: Array, coefficients: Array, free: Array
) -> tuple[Array, Array] | None:
    phi, phi_rate = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    if np.isnan(joints).any():
        return None
    rates, matrix = task.rotation_rates(points.frames, phi, joints)
    rates = rates * phi_rate[:, None]
    value = values_of(
        task, thresholds, phi, joints, jac.condition(matrix, task.parameters.characteristic_length)
    )
    slope = slopes_of(task, phi, phi_rate, joints, rates, matrix)
    shape = points.powers(coefficients.shape[1] - 1) @ free
    rate = (np.nan_to_num(slope)[:, :, None] * shape).reshape(-1, free.shape[1])
    return np.nan_to_num(value, nan=-1.0).ravel(), rate
