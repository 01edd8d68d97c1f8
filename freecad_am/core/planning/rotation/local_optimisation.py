# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optimisation of the polynomials (Chalvin 2020, eqs. 16 to 19), with analytic gradients.

All beads are evaluated together once; those already at a stationary, feasible point are done. The others go
through SLSQP one by one.
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

# returns values (r,) of the constraints at all points, kept if >= 0, and their derivatives (r, k);
# None if unreachable
Constraints = Callable[[Array], "tuple[Array, Array] | None"]

REACH = 0.3  # of a first step, rad of the polynomial
MIN_STEP_RAD = 1e-5  # rad, of a step worth trying
SUFFICIENT_SLACK = 1e-3  # by how much constraints are wanted to be kept
GAIN = 1e-6  # of the worst constraint, less than which ends the search
STEPS = 40
MOST_ROWS = 600


def approached(constraints: Constraints, start: Array) -> Array:
    """Improve the worst constraint by steps of linear programs.

    Parameters
    ----------
    constraints : Constraints
        Returns values (r,) and derivatives (r, k) at x (k,); None out of reach.
    start : (k,) array
        Variables at the start.

    Returns
    -------
    (k,) array
        Variables at which the worst constraint is satisfied with SUFFICIENT_SLACK, or does
        not improve further.

    Notes
    -----
    A trust region bounds each step; its size follows the ratio of actual to predicted gain.
    """
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
        hoped = solved.x[-1] - worst
        got = -np.inf if trial is None else float(trial[0].min()) - worst
        if got > 0.1 * hoped:
            x, current = x + solved.x[:k], trial
            reach *= 2.0 if got > 0.7 * hoped else 1.0
        else:
            reach = 0.25 * min(reach, float(np.abs(solved.x[:k]).max()))
    return x


# by how little a constraint may be violated and count as kept: limits and condition have reserves many times as wide
CONSTRAINT_TOLERANCE = 4e-7
# runs of the optimiser, each with the constraints added that the one before came close to
ROUNDS = 4
INACTIVE_VALUE = 1.0  # value of an irrelevant constraint; limits and condition have smaller values
MIN_OBJECTIVE_SCALE = 1e-9  # objective that an objective is set against
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
    selected: Mask | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> Refined:
    """Improve the coefficients of every bead, or of selected ones.

    Closed beads that join up stay joined.

    Parameters
    ----------
    task : Task
        The plan, with the objective.
    points : Points
        All T points of the B beads.
    thresholds : (T,) array
        Smallest condition allowed.
    starts : (S, B, degree + 1) array
        Starts, the preferred one first; NaN where a bead has no further start.
    selected : (B,) bool array or None, optional
        Beads to improve; None for all.
    report : callable, optional
        Receives the finished share before each bead; may raise to cancel.

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
    """Linearised constraints >= 0 at all points of a bead, about the values `at` (T,) of its
    polynomial.

    value, slope: (r, T); irrelevant constraints have INACTIVE_VALUE and 0. reach: maximum change of
    the polynomial.
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
        The plan, with the objective.
    points : Points
        The T points of the bead.
    thresholds : (T,) array
        Smallest condition allowed.
    start : (degree + 1,) array
        Coefficients at the start, the constant first.
    directions : (degree + 1, degree + 1) array
        Allowed changes as columns, from `refine_state.changes`.
    extra_constraints : Linear
        Linearised constraints to keep.

    Returns
    -------
    coefficients : (degree + 1,) array
        The better coefficients.
    reason : str
        Why the optimiser stopped.
    iterations : int
        Its iterations.
    """
    used = directions[:, np.abs(directions).any(axis=0)]
    return _slsqp(_Bead(task, points, thresholds, extra_constraints), start, used)


@dataclass(frozen=True, eq=False)
class _Bead:
    """A single bead with its points, its smallest allowed conditions and optional extra
    constraints.
    """

    task: Task
    points: Points
    thresholds: Array
    extra_constraints: Linear | None = None

    def state(self, coefficients: Array) -> State:
        return state_of(self.task, self.points, self.thresholds, coefficients[None])

    def constraints(self, coefficients: Array, free: Array) -> tuple[Array, Array] | None:
        """All constraints at all points (r,) and their derivatives (r, k) along the free columns; None out of reach."""
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
        """Return the ranking key of a solution: worst violation of a constraint, then the
        objective; less is better.
        """
        state = self.state(coefficients)
        worst = float(np.nan_to_num(state.constraints, nan=-1.0).min())
        violated = max(0.0, -worst) if np.isfinite(state.objective[0]) else np.inf
        return (violated if violated > CONSTRAINT_TOLERANCE else 0.0, float(state.objective[0]))


def _better(result: tuple[Any, ...], reference: tuple[Any, ...]) -> bool:
    """Whether (violation, objective, ...) is less than another by more than rounding."""
    if not is_tied(result[0], reference[0]) or not is_tied(reference[0], result[0]):
        return bool(result[0] < reference[0])
    return not bool(is_tied(reference[1], result[1]))


def _optimise_by_degree(
    bead: _Bead, start: Array, directions: Array
) -> tuple[float, float, Array, str, int]:
    """Optimise degree by degree, so that a higher degree is never worse.

    Returns violation, objective, coefficients, why and after how many iterations the last degree
    stopped.
    """
    current, worth, reason, iterations = start, bead.rank_solution(start), STATIONARY, 0
    used = np.flatnonzero(np.abs(directions).any(axis=0))
    for count in range(1, len(used) + 1):
        # the search has covered slope and offset of an open bead of the first degree together
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
    """Return coefficients that violate the limits less than `current`, if there are any, and their worth."""
    nearer = current + free @ approached(
        lambda x: bead.constraints(current + free @ x, free), np.zeros(free.shape[1])
    )
    new_worth = bead.rank_solution(nearer)
    return (nearer, new_worth) if _better(new_worth, worth) else (current, worth)


def _slsqp(bead: _Bead, start: Array, directions: Array) -> tuple[Array, str, int]:
    """Return coefficients, why the optimiser stopped and after how many iterations; run again if it
    violates constraints that it was not given.
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
            values_and_rates = bead.constraints(start + directions @ x, directions)
            unreachable = np.full(len(rows), -1.0), np.zeros((len(rows), len(x)))
            everywhere[key] = (
                unreachable
                if values_and_rates is None
                else (values_and_rates[0][rows], values_and_rates[1][rows])
            )
        return everywhere[key]

    # first steps are as long as the gradient: where constraints turn it aside, one of an objective much below 1 is none
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
    ):  # changes are of the size of a rotation, so that together they stay within reach
        max_change, unit_matrix = bead.extra_constraints.reach / len(x), np.eye(len(x))
        both_signs = np.concatenate([unit_matrix, -unit_matrix])
        constraint_list.append(
            {
                "type": "ineq",
                "fun": lambda x: max_change - both_signs @ x,
                "jac": lambda x: -both_signs,
            }
        )
    # scipy's stubs do not know a list of constraint dictionaries with their own types
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

    Each row contributes its local minima along the bead and their neighbours, unless they are at
    least INACTIVE_VALUE.
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
    """Return the paths of all beads for coefficients, evaluated at every point.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The B beads.
    bead_ids : sequence of Place
        Layer and index of each bead.
    points : Points
        All T points of the beads.
    threshold : (T,) array
        Smallest condition allowed.
    coefficients : (B, degree + 1) array
        Coefficients, the constant first.
    refined : Refined
        Reason and iterations of each bead.

    Returns
    -------
    list of BeadPath
        The paths; the objective is NaN if it needs the Jacobian and a point is out of
        reach.
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
    # like the joints: on a bead of few points a steep polynomial makes whole turns between two points, the same at both
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
