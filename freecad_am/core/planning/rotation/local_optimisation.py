# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optimisation of the polynomials (Chalvin 2020, eqs. 16 to 19), with analytic gradients.

All beads are first evaluated at once. Beads at a feasible stationary point are finished; SLSQP
optimises the others one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry.tie_breaking import is_tied
from ...kinematics import jacobian as jac
from ...toolpath import Bead
from ...types import Array, Integers, Mask
from .. import criteria
from ..joint_path import BeadPath
from ..points import Points, whole_turns
from ..task import Task, condition_margin
from . import refine_state
from .refine_state import State, slopes_of, state_of, values_of

# returns values (r,) of the constraints at all points, satisfied if >= 0, and their derivatives
# (r, k); None if unreachable
Constraints = Callable[[Array], "tuple[Array, Array] | None"]

REACH = 0.3  # rad; maximum change of each variable in the first step
MIN_STEP_RAD = 1e-5  # rad; the search ends at smaller steps
SUFFICIENT_SLACK = 1e-3  # target value of the worst constraint
GAIN = 1e-6  # minimum predicted gain of the worst constraint per step
STEPS = 40
MOST_ROWS = 600


def approached(constraints: Constraints, start: Array) -> Array:
    """Improve the worst constraint by a sequence of linear programs.

    Parameters
    ----------
    constraints : Constraints
        Returns values (r,) and derivatives (r, k) at x (k,); None if unreachable.
    start : (k,) array
        Start variables.

    Returns
    -------
    (k,) array
        Variables at which the worst constraint reaches SUFFICIENT_SLACK or stops improving.

    Notes
    -----
    A trust region bounds each step. Its size follows the ratio of actual to predicted gain.
    """
    from scipy.optimize import (
        linprog,  # slow to import, and seldom needed for parts of revolution
    )

    x, reach, current = start, REACH, constraints(start)
    for _ in range(STEPS):
        if current is None or reach < MIN_STEP_RAD:
            return x
        value, rate = current
        worst = float(value.min())
        if worst >= SUFFICIENT_SLACK:
            return x
        # omit rows that cannot become the worst constraint within reach
        lowest = value - reach * np.abs(rate).sum(axis=1)
        rows = np.flatnonzero(lowest < max(SUFFICIENT_SLACK, float(value.min())) + GAIN)
        rows = rows[np.argsort(lowest[rows], kind="stable")[:MOST_ROWS]]
        k = len(x)
        # maximise t <= SUFFICIENT_SLACK with value + rate step >= t
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
        hoped = solved.x[-1] - worst
        got = -np.inf if trial is None else float(trial[0].min()) - worst
        if got > 0.1 * hoped:
            x, current = x + solved.x[:k], trial
            reach *= 2.0 if got > 0.7 * hoped else 1.0
        else:
            reach = 0.25 * min(reach, float(np.abs(solved.x[:k]).max()))
    return x


# violation that counts as satisfied; limits and condition have a much larger reserve
CONSTRAINT_TOLERANCE = 4e-7
# optimiser runs; each adds the constraints that the previous run came close to
ROUNDS = 4
INACTIVE_VALUE = 1.0  # value of an irrelevant constraint; limit and condition values are smaller
MIN_OBJECTIVE_SCALE = 1e-9  # minimum divisor of the objective
STATIONARY = "stationary at the start found by the search"
OUT_OF_LIMITS = "no polynomial found that keeps all limits"


@dataclass(frozen=True, eq=False)
class Refined:
    """One polynomial per bead.

    coefficients: (B, degree + 1). objective: (B,). reason, iterations: stop reason and iteration
    count of the optimiser.
    """

    coefficients: Array
    objective: Array
    reason: tuple[str, ...]
    iterations: tuple[int, ...]


def refine(
    task: Task,
    points: Points,
    thresholds: Array,
    starts: Array,
    selected: Mask | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> Refined:
    """Improve the coefficients of all beads or of selected beads.

    Closed beads whose rotation must return to its start keep this property.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        T points of B beads.
    thresholds : (T,) array
        Required minimum condition.
    starts : (S, B, degree + 1) array
        Start coefficients, the preferred ones first; NaN where a bead has fewer starts.
    selected : (B,) bool array or None, optional
        Beads to improve; None for all.
    report : callable, optional
        Receives the completed fraction before each bead; may raise to cancel.

    Returns
    -------
    Refined
        The best result of each bead.

    References
    ----------
    Chalvin 2020, eqs. 16 to 19.
    """
    initial = state_of(task, points, thresholds, starts[0], slopes=False)
    tolerance = task.parameters.tolerance
    alone = (
        np.isnan(starts[1:]).any(axis=(0, 2))
        if len(starts) > 1
        else np.ones(points.beads, dtype=bool)
    )
    finished = (
        np.isfinite(initial.objective)
        & (initial.predicted <= tolerance)
        & (initial.constraints >= 0.0).all(axis=1)
        & alone
    )
    if selected is not None:
        finished |= ~selected
    coefficients, objective = starts[0].copy(), initial.objective.copy()
    reasons = [STATIONARY] * points.beads
    iterations = [0] * points.beads
    directions = refine_state.changes(task, points, starts.shape[2] - 1)
    pending = np.flatnonzero(~finished)
    for number, bead in enumerate(pending):
        report(number / len(pending))
        bead_points, rows = points.only(int(bead))
        results = [
            _optimise_by_degree(_Bead(task, bead_points, thresholds[rows]), start, directions[bead])
            for start in starts[:, bead]
            if np.isfinite(start).all()
        ]
        best = 0
        for k in range(1, len(results)):
            if _better(results[k], results[best]):
                best = k
        _, objective[bead], coefficients[bead], reasons[bead], iterations[bead] = results[best]
    return Refined(coefficients, objective, tuple(reasons), tuple(iterations))


@dataclass(frozen=True, eq=False)
class Linear:
    """Linearised constraints >= 0 at all points of a bead.

    at: (T,) polynomial values of the linearisation. value, slope: (r, T) constraint values and
    derivatives; irrelevant constraints have INACTIVE_VALUE and 0. reach: maximum change of the
    polynomial, rad.
    """

    at: Array
    value: Array
    slope: Array
    reach: float


def refine_along(
    task: Task,
    points: Points,
    thresholds: Array,
    start: Array,
    directions: Array,
    extra_constraints: Linear,
) -> tuple[Array, str, int]:
    """Improve the coefficients of one bead under extra constraints.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        The T points of the bead.
    thresholds : (T,) array
        Required minimum condition.
    start : (degree + 1,) array
        Start coefficients in ascending order.
    directions : (degree + 1, degree + 1) array
        Columns of allowed changes, from `refine_state.changes`.
    extra_constraints : Linear
        Additional linearised constraints.

    Returns
    -------
    coefficients : (degree + 1,) array
        Improved coefficients.
    reason : str
        Stop reason of the optimiser.
    iterations : int
        Iteration count.
    """
    used = directions[:, np.abs(directions).any(axis=0)]
    return _slsqp(_Bead(task, points, thresholds, extra_constraints), start, used)


@dataclass(frozen=True, eq=False)
class _Bead:
    """A single bead with its points, its condition thresholds and optional extra constraints."""

    task: Task
    points: Points
    thresholds: Array
    extra_constraints: Linear | None = None

    def state(self, coefficients: Array) -> State:
        return state_of(self.task, self.points, self.thresholds, coefficients[None])

    def constraints(self, coefficients: Array, free: Array) -> tuple[Array, Array] | None:
        """Return all constraints at all points (r,) and their derivatives (r, k) along `free`.

        None if a point is unreachable.
        """
        values_and_rates = _at_all_points(
            self.task, self.points, self.thresholds, coefficients[None], free
        )
        if self.extra_constraints is None or values_and_rates is None:
            return values_and_rates
        shape = self.points.powers(len(coefficients) - 1)
        value = self.extra_constraints.value + self.extra_constraints.slope * (
            shape @ coefficients - self.extra_constraints.at
        )
        rate = (self.extra_constraints.slope[:, :, None] * (shape @ free)).reshape(
            -1, free.shape[1]
        )
        return np.append(values_and_rates[0], value.ravel()), np.concatenate(
            [values_and_rates[1], rate]
        )

    def rank_solution(self, coefficients: Array) -> tuple[float, float]:
        """Return the ranking key of a solution: the worst violation, then the objective.

        Lower is better.
        """
        state = self.state(coefficients)
        worst = float(np.nan_to_num(state.constraints, nan=-1.0).min())
        violated = max(0.0, -worst) if np.isfinite(state.objective[0]) else np.inf
        return (violated if violated > CONSTRAINT_TOLERANCE else 0.0, float(state.objective[0]))


def _better(result: tuple[Any, ...], reference: tuple[Any, ...]) -> bool:
    """Whether `result` (violation, objective, ...) is below `reference` by more than rounding."""
    if not is_tied(result[0], reference[0]) or not is_tied(reference[0], result[0]):
        return bool(result[0] < reference[0])
    return not bool(is_tied(reference[1], result[1]))


def _optimise_by_degree(
    bead: _Bead, start: Array, directions: Array
) -> tuple[float, float, Array, str, int]:
    """Optimise with increasing degree, so that a higher degree is never worse.

    Return violation, objective, coefficients, stop reason and iteration count of the last degree.
    """
    current, worth, reason, iterations = start, bead.rank_solution(start), STATIONARY, 0
    used = np.flatnonzero(np.abs(directions).any(axis=0))
    for count in range(1, len(used) + 1):
        # for an open bead, the global search has already covered offset and slope together
        if count == 1 and len(used) > 1 and used[1] == 1:
            continue
        free = directions[:, used[:count]]
        if worth[0] > 0.0:
            current, worth = _brought_in(bead, current, free, worth)
            if worth[0] > 0.0:
                reason = OUT_OF_LIMITS
                continue
        optimised, reason, iterations = _slsqp(bead, current, free)
        better = bead.rank_solution(optimised)
        if better <= worth:
            current, worth = optimised, better
    return (*worth, current, reason, iterations)


def _brought_in(
    bead: _Bead, current: Array, free: Array, worth: tuple[float, float]
) -> tuple[Array, tuple[float, float]]:
    """Return coefficients with a smaller violation, if found, and their ranking key."""
    nearer = current + free @ approached(
        lambda x: bead.constraints(current + free @ x, free), np.zeros(free.shape[1])
    )
    new_worth = bead.rank_solution(nearer)
    return (nearer, new_worth) if _better(new_worth, worth) else (current, worth)


def _slsqp(bead: _Bead, start: Array, directions: Array) -> tuple[Array, str, int]:
    """Return coefficients, stop reason and iteration count.

    Run the optimiser again if its result violates constraints that it did not include.
    """
    x, reason, iterations = np.zeros(directions.shape[1]), STATIONARY, 0
    rows = np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        constraint_state = bead.constraints(start + directions @ x, directions)
        if constraint_state is None:
            break
        previous_count = len(rows)
        rows = np.union1d(rows, _tightest(constraint_state[0], len(bead.points)))
        if len(rows) == previous_count:
            break
        result = _run(bead, start, directions, x, rows)
        x, reason, iterations = result.x, str(result.message), iterations + int(result.nit)
    return start + directions @ x, reason, iterations


def _run(bead: _Bead, start: Array, directions: Array, x: Array, rows: Integers) -> Any:
    from scipy.optimize import (
        minimize,  # slow to import, and seldom needed for parts of revolution
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
            values_and_rates = bead.constraints(start + directions @ x, directions)
            unreachable = np.full(len(rows), -1.0), np.zeros((len(rows), len(x)))
            everywhere[key] = (
                unreachable
                if values_and_rates is None
                else (values_and_rates[0][rows], values_and_rates[1][rows])
            )
        return everywhere[key]

    # the first steps are as long as the gradient; scale it, so that an objective far below 1 can
    # still move the solution along extra constraints
    scale = (
        1.0
        if bead.extra_constraints is None
        else max(float(state(x).objective[0]), MIN_OBJECTIVE_SCALE)
    )

    def objective(x: Array) -> float:
        value = float(state(x).objective[0]) / scale
        return value if np.isfinite(value) else 1e6

    constraint_list = [
        {"type": "ineq", "fun": lambda x: constraints(x)[0], "jac": lambda x: constraints(x)[1]}
    ]
    if (
        bead.extra_constraints is not None
    ):  # bound each change to a fraction of `reach`, so that the sum stays within it
        max_change, unit_matrix = bead.extra_constraints.reach / len(x), np.eye(len(x))
        both_signs = np.concatenate([unit_matrix, -unit_matrix])
        constraint_list.append(
            {
                "type": "ineq",
                "fun": lambda x: max_change - both_signs @ x,
                "jac": lambda x: -both_signs,
            }
        )
    # the scipy stubs reject a list of constraint dictionaries
    return minimize(  # type: ignore[call-overload]
        objective,
        x,
        jac=lambda x: np.nan_to_num(state(x).gradient[0]) @ directions / scale,
        constraints=constraint_list,
        method="SLSQP",
        options={
            "ftol": bead.task.parameters.tolerance,
            "maxiter": bead.task.parameters.max_iterations,
        },
    )


def _tightest(values: Array, points: int) -> Integers:
    """Select the constraints for the optimiser.

    Take the local minima of each constraint along the bead and their neighbours, except values of
    INACTIVE_VALUE or more.
    """
    value = values.reshape(-1, points)
    padded = np.pad(value, ((0, 0), (1, 1)), constant_values=np.inf)
    lowest = (value <= padded[:, :-2]) & (value <= padded[:, 2:])
    reported = lowest.copy()
    reported[:, 1:] |= lowest[:, :-1]
    reported[:, :-1] |= lowest[:, 1:]
    return np.flatnonzero((reported & (value < INACTIVE_VALUE)).ravel())


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


Place = tuple[int, int]


def evaluate_paths(
    task: Task,
    beads: Sequence[Bead],
    bead_ids: Sequence[Place],
    points: Points,
    threshold: Array,
    coefficients: Array,
    refined: Refined,
) -> list[BeadPath]:
    """Return the paths of all beads for given coefficients, evaluated at every point.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The B beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    points : Points
        T points of the B beads.
    threshold : (T,) array
        Required minimum condition.
    coefficients : (B, degree + 1) array
        Coefficients in ascending order.
    refined : Refined
        Stop reason and iteration count of each bead.

    Returns
    -------
    list of BeadPath
        The paths. The objective is NaN if it needs the Jacobian and a point is unreachable.
    """
    phi, _ = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    condition = task.condition(points, phi, joints)
    matrix = None
    if task.parameters.objective not in criteria.JOINT_ONLY and np.isfinite(joints).all():
        matrix = task.jacobian_at(points.frames, phi, joints)
    objective = (
        criteria.value(task, points, joints, matrix)
        if matrix is not None or task.parameters.objective in criteria.JOINT_ONLY
        else np.full(points.beads, np.nan)
    )
    margin = points.worst(
        np.minimum(task.rows.margin(joints), condition_margin(condition, threshold))
    )
    ends = np.append(points.first, len(points))
    # remove whole turns as for the joints: a steep polynomial may make a whole turn between two
    # points of a coarse bead
    turned = phi - whole_turns(np.diff(phi), points)
    return [
        BeadPath(
            layer,
            index,
            bead,
            turned[a:b],
            joints[a:b],
            condition[a:b],
            threshold[a:b],
            float(objective[k]),
            float(margin[k]),
            coefficients[k],
            refined.reason[k],
            refined.iterations[k],
        )
        for k, (bead, (layer, index), a, b) in enumerate(zip(beads, bead_ids, ends[:-1], ends[1:]))
    ]
