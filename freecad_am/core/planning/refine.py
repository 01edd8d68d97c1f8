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
from numpy.typing import NDArray

from ..geometry.ties import alike
from ..kinematics import jacobian as jac
from . import basis, criteria, feasible
from .points import Points
from .task import Task, in_pieces

Array = NDArray[np.float64]

# share by which the condition stays above its threshold, so that an optimum on it does not fall below between the points
CONDITION_RESERVE = 1e-3
# by how little a constraint may be violated and count as kept: limits and condition have reserves many times as wide
KEPT = 4e-7
# runs of the optimiser, each with the constraints added that the one before came close to
ROUNDS = 4
STATIONARY = "stationary at the start found by the search"
OUT_OF_LIMITS = "no polynomial found that keeps all limits"


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
    task: Task, points: Points, thresholds: Array, starts: Array, wanted: NDArray[np.bool_] | None = None,
    told: Callable[[float], None] = lambda share: None,
) -> Refined:
    """Improve the coefficients of every bead, or of the wanted (B,); points are all points of the beads.

    starts: (S, B, degree + 1), the first the one to be preferred; NaN where a bead has no further one. Closed beads that
    join up stay joined. told: the share of the beads that is done, before each; it may raise to cancel.
    """
    first = _state(task, points, thresholds, starts[0], slopes=False)
    tolerance = task.parameters.tolerance
    alone = np.isnan(starts[1:]).any(axis=(0, 2)) if len(starts) > 1 else np.ones(points.beads, dtype=bool)
    done = np.isfinite(first.objective) & (first.predicted <= tolerance) & (first.constraints >= 0.0).all(axis=1) & alone
    if wanted is not None:
        done |= ~wanted
    coefficients, objective = starts[0].copy(), first.objective.copy()
    reasons = [STATIONARY] * points.beads
    iterations = [0] * points.beads
    directions = basis.changes(task, points, starts.shape[2] - 1)
    left = np.flatnonzero(~done)
    for number, bead in enumerate(left):
        told(number / len(left))
        part, chosen = points.only(int(bead))
        tried = [
            _climbed(_Bead(task, part, thresholds[chosen]), start, directions[bead])
            for start in starts[:, bead] if np.isfinite(start).all()
        ]
        best = 0
        for k in range(1, len(tried)):
            if _better(tried[k], tried[best]):
                best = k
        _, objective[bead], coefficients[bead], reasons[bead], iterations[bead] = tried[best]
    return Refined(coefficients, objective, tuple(reasons), tuple(iterations))


@dataclass(frozen=True)
class _Bead:
    """One bead alone, its points and the condition asked for at each."""

    task: Task
    points: Points
    thresholds: Array

    def state(self, coefficients: Array) -> _State:
        return _state(self.task, self.points, self.thresholds, coefficients[None])

    def constraints(self, coefficients: Array, free: Array) -> tuple[Array, Array] | None:
        """All constraints at all points (r,) and their derivatives (r, k) along the free columns; None out of reach."""
        return _at_all_points(self.task, self.points, self.thresholds, coefficients[None], free)

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


def _brought_in(bead: _Bead, here: Array, free: Array, worth: tuple[float, float]) -> tuple[Array, tuple[float, float]]:
    """Coefficients that violate the limits less than those here, where there are any, and their worth."""
    nearer = here + free @ feasible.approached(lambda x: bead.constraints(here + free @ x, free), np.zeros(free.shape[1]))
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


def _run(bead: _Bead, start: Array, directions: Array, x: Array, rows: NDArray[np.int64]) -> Any:
    from scipy.optimize import minimize  # slow to import, and most jobs on parts of revolution never need it

    states: dict[bytes, _State] = {}
    everywhere: dict[bytes, tuple[Array, Array]] = {}

    def state(x: Array) -> _State:
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

    def objective(x: Array) -> float:
        value = float(state(x).objective[0])
        return value if np.isfinite(value) else 1e6

    # scipy's stubs do not know a list of constraint dictionaries with their own types
    return minimize(  # type: ignore[call-overload]
        objective, x, jac=lambda x: np.nan_to_num(state(x).gradient[0]) @ directions,
        constraints=[{"type": "ineq", "fun": lambda x: constraints(x)[0], "jac": lambda x: constraints(x)[1]}],
        method="SLSQP",
        options={"ftol": bead.task.parameters.tolerance, "maxiter": bead.task.parameters.max_iterations},
    )


def _tightest(values: Array, points: int) -> NDArray[np.int64]:
    """Which constraints are told to the optimiser: of each row those at its local minima along the bead and beside them."""
    value = values.reshape(-1, points)
    padded = np.pad(value, ((0, 0), (1, 1)), constant_values=np.inf)
    lowest = (value <= padded[:, :-2]) & (value <= padded[:, 2:])
    beside = lowest.copy()
    beside[:, 1:] |= lowest[:, :-1]
    beside[:, :-1] |= lowest[:, 1:]
    return np.flatnonzero(beside.ravel())


def _state(task: Task, points: Points, thresholds: Array, coefficients: Array, slopes: bool = True) -> _State:
    """The state at coefficients (B, degree + 1): with the derivatives of the constraints, or else `predicted`."""
    phi, phi_rate = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    if np.isnan(joints).any():
        return _partly_unreachable(task, points, thresholds, coefficients, joints, slopes)
    powers = points.powers(coefficients.shape[1] - 1)
    if not slopes and task.parameters.objective in criteria.JOINT_ONLY:
        return _state_in_pieces(task, points, thresholds, phi, phi_rate, joints, powers)
    rates, matrix = task.spin_rates(points.frames.at(phi), joints)
    rates = rates * phi_rate[:, None]
    objective = criteria.value(task, points, joints, matrix)
    gradient = _gradient(points, criteria.rate(task, points, joints, rates, matrix), powers)
    value = _values(task, thresholds, phi, joints, jac.condition(matrix, task.parameters.characteristic_length))
    worst = points.worst(value)
    if not slopes:
        predicted = _predicted(task, points, joints, rates, powers, gradient)
        return _State(objective, gradient, predicted, worst.T, np.zeros((points.beads, len(value), powers.shape[1])))
    slope = _slopes(task, phi, phi_rate, joints, rates, matrix)
    at = np.stack([_where_worst(points, row, least) for row, least in zip(value, worst)])
    rows = np.arange(len(value))[:, None]
    constraint_rates = (slope[rows, at][:, :, None] * powers[at]).transpose(1, 0, 2)
    return _State(objective, gradient, np.full(points.beads, np.nan), worst.T, constraint_rates)


def _state_in_pieces(
    task: Task, points: Points, thresholds: Array, phi: Array, phi_rate: Array, joints: Array, powers: Array
) -> _State:
    """The state without the derivatives of the constraints, of many beads at once. The condition is taken from below
    where that tells that it is kept, which is at all but a few points."""
    length = task.parameters.characteristic_length
    rates, ratio = np.empty_like(joints), np.empty(len(points))
    for some in in_pieces(len(points)):
        rates[some], matrix = task.spin_rates(points.frames.of(some).at(phi[some]), joints[some])
        bound = jac.condition_bound(matrix, length)
        open_ = bound < thresholds[some] * (1.0 + CONDITION_RESERVE)
        bound[open_] = jac.condition(matrix[open_], length)
        ratio[some] = bound
    rates *= phi_rate[:, None]
    gradient = _gradient(points, criteria.joint_rate(task, points, joints, rates), powers)
    worst = points.worst(_values(task, thresholds, phi, joints, ratio))
    return _State(
        criteria.value(task, points, joints, None), gradient, _predicted(task, points, joints, rates, powers, gradient),
        worst.T, np.zeros((points.beads, len(worst), powers.shape[1])),
    )


def _gradient(points: Points, slope: Array, powers: Array) -> Array:
    return points.total((slope[:, None] * powers).T).T


def _partly_unreachable(
    task: Task, points: Points, thresholds: Array, coefficients: Array, joints: Array, slopes: bool
) -> _State:
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
        one = _state(task, part, thresholds[chosen], coefficients[bead : bead + 1], slopes)
        for name in ("objective", "gradient", "predicted", "constraints", "constraint_rates"):
            getattr(state, name)[bead] = getattr(one, name)[0]
    return state


def _narrow(task: Task) -> int:
    low, high = task.parameters.rotation_range
    return int(high - low < 2.0 * np.pi - 1e-9)


def _values(task: Task, thresholds: Array, phi: Array, joints: Array, ratio: Array) -> Array:
    """Eqs. 18 and 19 as corrected, one row per limit and one for the condition `ratio` (T,): (m + 1, T)."""
    values = [
        0.25 * (1.0 - task.rows.offset(joints).T ** 2), (ratio - thresholds * (1.0 + CONDITION_RESERVE))[None],
    ]
    if _narrow(task):
        values.append(0.25 * (1.0 - _share(task, phi) ** 2)[None])
    return np.concatenate(values)


def _slopes(task: Task, phi: Array, phi_rate: Array, joints: Array, rates: Array, matrix: Array) -> Array:
    """(m + 1, T) their derivatives by the value of the polynomial at each point."""
    slopes = [
        -0.5 * task.rows.offset(joints).T * (rates @ task.rows.matrix.T / task.rows.half).T,
        criteria.condition_rate(task, joints, rates, matrix)[None],
    ]
    if _narrow(task):
        low, high = task.parameters.rotation_range
        slopes.append((-0.5 * _share(task, phi) / (0.5 * (high - low)) * phi_rate)[None])
    return np.concatenate(slopes)


def _share(task: Task, phi: Array) -> Array:
    low, high = task.parameters.rotation_range
    return (phi - 0.5 * (low + high)) / (0.5 * (high - low))


def _at_all_points(
    task: Task, points: Points, thresholds: Array, coefficients: Array, free: Array
) -> tuple[Array, Array] | None:
    phi, phi_rate = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    if np.isnan(joints).any():
        return None
    rates, matrix = task.spin_rates(points.frames.at(phi), joints)
    rates = rates * phi_rate[:, None]
    value = _values(task, thresholds, phi, joints, jac.condition(matrix, task.parameters.characteristic_length))
    slope = _slopes(task, phi, phi_rate, joints, rates, matrix)
    shape = points.powers(coefficients.shape[1] - 1) @ free
    rate = (np.nan_to_num(slope)[:, :, None] * shape).reshape(-1, free.shape[1])
    return np.nan_to_num(value, nan=-1.0).ravel(), rate


def _where_worst(points: Points, values: Array, worst: Array) -> NDArray[np.int64]:
    """(B,) index of the first point of each bead that has the bead's smallest value."""
    hits = np.flatnonzero(values <= worst[points.bead])
    _, position = np.unique(points.bead[hits], return_index=True)
    return hits[position]


def _predicted(task: Task, points: Points, joints: Array, rates: Array, powers: Array, gradient: Array) -> Array:
    """(B,) how much the objective would still fall by its second-order model, joined beads staying joined.

    Eq. 17 is a sum of squares, so its curvature is known (Gauss-Newton); of other objectives the
    gradient alone is taken.
    """
    free = basis.changes(task, points, powers.shape[1] - 1)
    gradient = (gradient[:, None] @ free)[:, 0]
    if task.parameters.objective != "displacement":
        return np.asarray(np.linalg.norm(gradient, axis=1))
    change = [_between(rates * power[:, None], points) for power in powers.T]
    curvature = np.empty((points.beads, len(change), len(change)))
    for j, one in enumerate(change):
        weighed = one * task.weights
        for k, other in enumerate(change[: j + 1]):
            curvature[:, j, k] = curvature[:, k, j] = 2.0 * points.total(np.einsum("ia,ia->i", weighed, other))
    curvature = np.swapaxes(free, 1, 2) @ curvature @ free
    inverse = np.linalg.pinv(curvature, rcond=1e-10, hermitian=True)
    fall: Array = 0.5 * np.einsum("bj,bjk,bk->b", gradient, inverse, gradient)
    return fall


def _between(values: Array, points: Points) -> Array:
    """What values (T, axes) change by from the point before; 0 at the first point of a bead."""
    change = np.zeros_like(values)
    np.subtract(values[1:], values[:-1], out=change[1:])
    change[points.starts] = 0.0
    return change


