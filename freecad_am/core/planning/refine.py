# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optimisation of the polynomials (Chalvin 2020, eqs. 16 to 19), with analytic gradients.

All beads are evaluated together once; those already at a stationary, feasible point are done. The others go
through SLSQP one by one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..kinematics import jacobian as jac
from . import criteria
from .points import Points
from .task import Task

Array = NDArray[np.float64]

# share by which the condition stays above its threshold, so that an optimum on it does not fall below by rounding
CONDITION_RESERVE = 1e-6
STATIONARY = "stationary at the start found by the search"


@dataclass(frozen=True)
class Refined:
    """One polynomial per bead: coefficients (B, degree + 1), objective (B,), why and after how many iterations the
    optimiser stopped."""

    coefficients: Array
    objective: Array
    reason: tuple[str, ...]
    iterations: tuple[int, ...]


@dataclass(frozen=True)
class _State:
    """Everything eqs. 17 to 19 need at one set of coefficients; constraints are >= 0 where kept."""

    objective: Array
    gradient: Array
    predicted: Array
    constraints: Array
    constraint_rates: Array


def refine(
    task: Task, points: Points, thresholds: Array, start: Array, wanted: NDArray[np.bool_] | None = None
) -> Refined:
    """Improve the coefficients (B, degree + 1) of every bead, or of the wanted (B,); points are all points of the beads."""
    first = _state(task, points, thresholds, start, slopes=False)
    tolerance = task.parameters.tolerance
    done = np.isfinite(first.objective) & (first.predicted <= tolerance) & (first.constraints >= 0.0).all(axis=1)
    if wanted is not None:
        done |= ~wanted
    coefficients, objective = start.copy(), first.objective.copy()
    reasons = [STATIONARY] * points.beads
    iterations = [0] * points.beads
    for bead in np.flatnonzero(~done):
        part, chosen = points.only(int(bead))
        found, value, reasons[bead], iterations[bead] = _slsqp(task, part, thresholds[chosen], start[bead])
        coefficients[bead], objective[bead] = found, value
    return Refined(coefficients, objective, tuple(reasons), tuple(iterations))


def _slsqp(task: Task, points: Points, thresholds: Array, start: Array) -> tuple[Array, float, str, int]:
    from scipy.optimize import minimize  # slow to import, and most jobs on parts of revolution never need it

    cache: dict[bytes, _State] = {}
    # coefficients of high powers act more strongly: bring them to the scale of a rotation
    scale = np.abs(points.parameter).max() ** np.arange(len(start))

    def state(x: Array) -> _State:
        key = x.tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = _state(task, points, thresholds, (x / scale)[None])
        return cache[key]

    def objective(x: Array) -> float:
        value = float(state(x).objective[0])
        return value if np.isfinite(value) else 1e6

    # scipy's stubs do not know a list of constraint dictionaries with their own types
    result = minimize(  # type: ignore[call-overload]
        objective,
        start * scale,
        jac=lambda x: np.nan_to_num(state(x).gradient[0]) / scale,
        constraints=[{
            "type": "ineq",
            "fun": lambda x: np.nan_to_num(state(x).constraints[0], nan=-1.0),
            "jac": lambda x: np.nan_to_num(state(x).constraint_rates[0]) / scale,
        }],
        method="SLSQP",
        options={"ftol": task.parameters.tolerance, "maxiter": task.parameters.max_iterations},
    )
    kept = _better(state, start * scale, result.x)
    return kept / scale, float(state(kept).objective[0]), str(result.message), int(result.nit)


def _better(state, start: Array, end: Array) -> Array:  # type: ignore[no-untyped-def]
    """The end of the optimisation, or its start where only that is feasible."""
    def violated(x: Array) -> float:
        value = float(np.nan_to_num(state(x).constraints, nan=-1.0).min())
        return max(0.0, -value) if np.isfinite(state(x).objective[0]) else np.inf

    if violated(end) <= 1e-9 or violated(end) < violated(start):
        return end
    return start


def _state(task: Task, points: Points, thresholds: Array, coefficients: Array, slopes: bool = True) -> _State:
    """The state at coefficients (B, degree + 1); without `slopes` the constraints' derivatives are left at 0."""
    phi, phi_rate = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    if np.isnan(joints).any():
        return _partly_unreachable(task, points, thresholds, coefficients, joints)
    rates, matrix = task.spin_rates(points, phi, joints)
    rates = rates * phi_rate[:, None]
    powers = points.powers(coefficients.shape[1] - 1)
    objective = criteria.value(task, points, joints, matrix)
    slope = criteria.rate(task, points, joints, rates, matrix)
    gradient = points.total((slope[:, None] * powers).T).T
    constraints, constraint_rates = _constraints(
        task, points, thresholds, phi, phi_rate, joints, rates, matrix, powers, slopes
    )
    predicted = _predicted(task, points, joints, rates, powers, gradient)
    return _State(objective, gradient, predicted, constraints, constraint_rates)


def _partly_unreachable(task: Task, points: Points, thresholds: Array, coefficients: Array, joints: Array) -> _State:
    """With one bead there is nothing to say; with several, those within reach are still worth judging."""
    b, k = coefficients.shape
    rows = len(task.rows.labels) + 1 + _narrow(task)
    state = _State(
        np.full(b, np.inf), np.zeros((b, k)), np.full(b, np.inf), np.full((b, rows), -1.0), np.zeros((b, rows, k))
    )
    if b == 1:
        return state
    lost = np.add.reduceat(np.isnan(joints).any(axis=1), points.first) > 0
    for bead in np.flatnonzero(~lost):
        part, chosen = points.only(int(bead))
        one = _state(task, part, thresholds[chosen], coefficients[bead : bead + 1])
        for name in ("objective", "gradient", "predicted", "constraints", "constraint_rates"):
            getattr(state, name)[bead] = getattr(one, name)[0]
    return state


def _narrow(task: Task) -> int:
    low, high = task.parameters.rotation_range
    return int(high - low < 2.0 * np.pi - 1e-9)


def _constraints(
    task: Task, points: Points, thresholds: Array, phi: Array, phi_rate: Array, joints: Array, rates: Array,
    matrix: Array, powers: Array, wanted: bool,
) -> tuple[Array, Array]:
    """Eqs. 18 and 19 as corrected, one value per limit and bead: (B, m + 1) and derivatives (B, m + 1, degree + 1)."""
    offset = task.rows.offset(joints)
    ratio = jac.condition(matrix, task.parameters.characteristic_length)
    values = [0.25 * (1.0 - offset.T**2), (ratio - thresholds * (1.0 + CONDITION_RESERVE))[None]]
    low, high = task.parameters.rotation_range
    half = 0.5 * (high - low)
    share = (phi - (low + half)) / half
    if _narrow(task):
        values.append(0.25 * (1.0 - share**2)[None])
    value = np.concatenate(values)
    worst = points.worst(value)
    if not wanted:
        return worst.T, np.zeros((points.beads, len(value), powers.shape[1]))
    slopes = [
        -0.5 * offset.T * (rates @ task.rows.matrix.T / task.rows.half).T,
        criteria.condition_rate(task, joints, rates, matrix)[None],
    ]
    if _narrow(task):
        slopes.append((-0.5 * share / half * phi_rate)[None])
    slope = np.concatenate(slopes)
    at = np.stack([_where_worst(points, row, least) for row, least in zip(value, worst)])
    rows = np.arange(len(value))[:, None]
    return worst.T, (slope[rows, at][:, :, None] * powers[at]).transpose(1, 0, 2)


def _where_worst(points: Points, values: Array, worst: Array) -> NDArray[np.int64]:
    """(B,) index of the first point of each bead that has the bead's smallest value."""
    hits = np.flatnonzero(values <= worst[points.bead])
    _, position = np.unique(points.bead[hits], return_index=True)
    return hits[position]


def _predicted(task: Task, points: Points, joints: Array, rates: Array, powers: Array, gradient: Array) -> Array:
    """(B,) how much the objective would still fall by its second-order model.

    Eq. 17 is a sum of squares, so its curvature is known (Gauss-Newton); of other objectives the
    gradient alone is taken.
    """
    if task.parameters.objective != "displacement":
        return np.asarray(np.linalg.norm(gradient, axis=1))
    spread = rates[:, :, None] * powers[:, None, :]
    change = np.zeros_like(spread)
    change[1:] = spread[1:] - spread[:-1]
    change[points.starts] = 0.0
    curvature = 2.0 * points.total(np.einsum("a,iaj,iak->jki", task.weights, change, change)).transpose(2, 0, 1)
    inverse = np.linalg.pinv(curvature, rcond=1e-10, hermitian=True)
    fall: Array = 0.5 * np.einsum("bj,bjk,bk->b", gradient, inverse, gradient)
    return fall


