# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance of a joint path from the optimum: its objective and a lower bound over all rotations.

The rotation about the tool axis is free at every point, not only along a polynomial. Eq. 17 of
Chalvin 2020 is a chain, because each step depends on the rotations at two points. Bellman's
recursion over a lattice of rotations at every point therefore gives the minimum objective
(lattice.py). Steps may end between the lattice rotations and are bounded from below there
(least_ahead.py). The lattice is refined until the bound is close to the best known rotation.

In a group of m consecutive steps, only the first and last joints count if this loses little: a sum
of m squares is at least the squared sum divided by m (Cauchy-Schwarz).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.frames import TURN, shortest
from ...issues import NOTE, Issue
from ...kinematics import jacobian as jac
from ...types import Array, Index, Mask
from ..beads.chord_error import refined_to_chord_error
from ..joint_path import BeadPath
from ..points import Points, gather, steps
from ..rotation import given
from ..task import MIN_MARGIN, Task, condition_margin
from . import least_ahead
from .lattice import CELLS, Lattice, divided, lattice, possible, whole_turn

# ---- Best rotations near known rotations, free at each point, by Newton steps along the chain of
# eq. 17

STEPS = 30
STARTS, VALUE_TOLERANCE = (
    24,
    1e-6,
)  # number of starts over a turn, and minimum relative improvement over earlier courses
DIFFERENCE_STEP_RAD = 1e-5  # rad; finite difference step for slopes
MAX_ACTIVE_SETS, HOLD_STIFFNESS = (
    6,
    1e9,
)  # rounds that fix further points, and their stiffness relative to the maximum curvature
MIN_STEP_SHARE = 0.02  # minimum fraction of a Newton step to try
MIN_DECREASE = 1e-7  # minimum relative decrease of the value per step


Joints = Callable[[Array], Array]
Broken = Callable[[Array, Array], Mask]


def none_broken(phi: Array, joints: Array) -> Mask:
    """Return False for every rotation: no constraint is violated.

    Parameters
    ----------
    phi : (n,) array
        Tool rotations, rad.
    joints : (n, axes) array
        Joint values, unused.

    Returns
    -------
    (n,) array of bool
        False.
    """
    return np.zeros(len(phi), dtype=bool)


def descend(
    joints_at: Joints, scale: Array, phi: Array, joined: bool, broken: Broken = none_broken
) -> tuple[Array, float]:
    """Minimise the displacement along a chain of points, starting from given rotations.

    Parameters
    ----------
    joints_at : Joints
        Returns the joints (n, axes) for rotations (n,).
    scale : (n - 1, axes) array
        Weights of the squared axis steps.
    phi : (n,) array
        Start rotations, rad.
    joined : bool
        Whether the difference between the last and first rotation is fixed.
    broken : Broken, optional
        Returns the points (n,) where rotations and their joints violate a constraint.

    Returns
    -------
    phi : (n,) array
        Optimised rotations; unchanged if the start violates a constraint.
    value : float
        Weighted sum of squared steps; infinite if the start violates a constraint.

    Notes
    -----
    It takes at most STEPS Gauss-Newton steps along the chain of eq. 17, with numerical slopes.
    """
    joints = joints_at(phi)
    if broken(phi, joints).any():
        return phi, np.inf
    moved = _steps(joints)
    value = float((moved * moved * scale).sum())
    for _ in range(STEPS):
        slope = shortest(
            joints_at(phi + DIFFERENCE_STEP_RAD) - joints_at(phi - DIFFERENCE_STEP_RAD)
        ) / (2.0 * DIFFERENCE_STEP_RAD)
        if not (np.isfinite(slope).all() and np.isfinite(moved).all()):
            break
        lower = _take_step(joints_at, scale, phi, (moved, slope), joined, broken)
        if lower is None:
            break
        phi, moved = lower
        previous, value = value, float((moved * moved * scale).sum())
        if value > (1.0 - MIN_DECREASE) * previous:
            break
    return phi, value


def _take_step(
    joints_at: Joints,
    scale: Array,
    phi: Array,
    current: tuple[Array, Array],
    joined: bool,
    broken: Broken,
) -> tuple[Array, Array] | None:
    """Take a Newton step to feasible rotations with a lower sum.

    Return the rotations and their joint steps, or None if no step succeeds. Points that would
    violate a constraint are fixed, group by group, while the other points keep moving.
    """
    value, blocked = float((current[0] ** 2 * scale).sum()), np.zeros(len(phi), dtype=bool)
    for _ in range(MAX_ACTIVE_SETS):
        change = _newton(*current, scale, joined, blocked)
        size, stopped = 1.0, blocked
        while size > MIN_STEP_SHARE:
            trial = phi + size * change
            joints = joints_at(trial)
            steps, stopped = _steps(joints), broken(trial, joints)
            if not stopped.any() and float((steps * steps * scale).sum()) < value:
                return trial, steps
            size *= 0.25
        if not (stopped & ~blocked).any():
            return None
        blocked |= stopped
    return None


def best_course(
    joints_at: Joints,
    scale: Array,
    phi: Array,
    joined: bool,
    broken: Broken = none_broken,
) -> tuple[Array, float]:
    """Return the best result of `descend` from several starts.

    The starts are the given rotations, offset by fractions of a turn.

    Parameters
    ----------
    joints_at : Joints
        Returns the joints (n, axes) for rotations (n,).
    scale : (n - 1, axes) array
        Weights of the squared axis steps.
    phi : (n,) array
        Rotations of the first start, rad.
    joined : bool
        Whether the difference between the last and first rotation is fixed.
    broken : Broken, optional
        Returns the points (n,) where rotations and their joints violate a constraint.

    Returns
    -------
    phi : (n,) array
        The best rotations, rad.
    value : float
        Sum of the best rotations; infinite if no course is feasible.
    """
    best_phi, best_value = phi, np.inf
    for turned in TURN / STARTS * np.arange(STARTS):
        course, value = descend(joints_at, scale, phi + turned, joined, broken)
        if value < best_value * (1.0 - VALUE_TOLERANCE):
            best_phi, best_value = course, value
    return best_phi, best_value


def _newton(moved: Array, slope: Array, scale: Array, joined: bool, is_fixed: Mask) -> Array:
    """Return the Gauss-Newton step (n,) of the rotations.

    moved: (n - 1, axes) joint steps. slope: (n, axes) d q / d phi. The step is 0 at points that are
    `is_fixed` (n,).
    """
    # slow to import, and few jobs request a certificate
    from scipy.linalg import solveh_banded

    bands = np.zeros((2, len(slope)))
    bands[1, :-1] += (slope[:-1] ** 2 * scale).sum(axis=1)
    bands[1, 1:] += (slope[1:] ** 2 * scale).sum(axis=1)
    bands[0, 1:] = -(slope[:-1] * slope[1:] * scale).sum(axis=1)
    bands[1] += 1e-9 * bands[1].mean() + 1e-300
    rate = np.zeros(len(slope))
    rate[:-1] -= (moved * slope[:-1] * scale).sum(axis=1)
    rate[1:] += (moved * slope[1:] * scale).sum(axis=1)
    bands[1, is_fixed] = HOLD_STIFFNESS * bands[1].max()
    rate[is_fixed] = 0.0
    sides = rate[:, None]
    if joined:  # a multiplier keeps the difference between the ends
        together = np.zeros(len(slope))
        together[0], together[-1] = 1.0, -1.0
        sides = np.stack([rate, together], axis=1)
    try:
        solved = solveh_banded(bands, sides)
    except np.linalg.LinAlgError:
        solved = sides / bands[1][:, None]
    step = -solved[:, 0]
    if joined:
        is_fixed = solved[0, 1] - solved[-1, 1]
        step -= (step[0] - step[-1]) / is_fixed * solved[:, 1]
    return np.asarray(step, dtype=np.float64)


def broken_by(task: Task, points: Points, threshold: Array, phi: Array, joints: Array) -> Mask:
    """Return the points of a chain where rotations violate limits, condition or range.

    Parameters
    ----------
    task : Task
        The plan, including limits and rotation range.
    points : Points
        The n consecutive points.
    threshold : (n,) array
        Required minimum condition.
    phi : (n,) array
        Rotations, rad.
    joints : (n, axes) array
        Joints from the inverse, NaN out of reach.

    Returns
    -------
    (n,) bool array
        True for violations. If any point is unreachable, only unreachable points are True.
    """
    unreachable = ~np.isfinite(joints).all(axis=1)
    if unreachable.any():
        return np.asarray(unreachable)
    run = joints[0] + np.concatenate(
        [np.zeros((1, joints.shape[1])), np.cumsum(_steps(joints), axis=0)]
    )
    turns = np.round((task.middle - 0.5 * (run.min(axis=0) + run.max(axis=0))) / TURN)
    beyond = task.rows.margin(run + np.where(task.unturned, 0.0, TURN * turns)) < MIN_MARGIN
    low, high = task.parameters.rotation_range
    if high - low < TURN - 1e-9:
        beyond |= (phi < low) | (phi > high)
    return np.asarray(beyond | (task.condition(points, phi, joints) < threshold * (1.0 - 1e-9)))


def _steps(joints: Array) -> Array:
    moved: Array = shortest(np.diff(joints, axis=0))
    return moved


# ---- Lower bound of objectives that rate each point separately: the minimum over all rotations at
# each point

LEVELS = 4
POINT_TOLERANCE = 1e-3  # relative gap at which the bound of a point is close enough


def point_bound(task: Task, points: Points, threshold: Array) -> float:
    """Return a lower bound of the objective of one bead, from separate bounds of its points.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        The n points of the bead.
    threshold : (n,) array
        Required minimum condition.

    Returns
    -------
    float
        Lower bound; infinite if a point has no feasible rotation.

    Notes
    -----
    The turn is divided into cells. Cells are subdivided, at most LEVELS times, until the bound is
    within POINT_TOLERANCE of a sampled value.
    """
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
        open_ = (bound < (1.0 - POINT_TOLERANCE) * sampled_min)[index] & (
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
    """Return the objective (n,) of rotations phi (n,) at selected points; NaN out of reach."""
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


BOUND_TOLERANCE = 0.005  # gap at which a bound is close enough, fraction of the objective
ROTATIONS = (
    180,
    360,
    720,
    1440,
)  # rotations per turn at each point; the next number is used if the bound is not close enough
BETWEEN_BEADS = 180  # rotations per turn for the bound of a whole job
PIECE = 100_000  # rotations per batch of points
MIN_GROUPS = 4  # minimum number of step groups per bead
GROUPED = 0.002  # maximum loss by grouping steps, fraction of the objective


@dataclass(frozen=True, eq=False)
class Optimality:
    """The objective of a joint path and its lower bound over all rotations, (B,) per bead."""

    objective: Array
    bound: Array

    @property
    def gaps(self) -> Array:
        """Return the relative gap between objective and bound of each bead.

        Returns
        -------
        (B,) array
            1 - bound / objective; 0 for beads without cost.
        """
        costs = np.where(self.objective > 0.0, self.objective, 1.0)
        return np.where(self.objective > 0.0, 1.0 - self.bound / costs, 0.0)


def summed(
    task: Task, paths: Sequence[BeadPath], report: Callable[[float], None] = lambda share: None
) -> tuple[dict[str, object] | None, list[Issue]]:
    """Return objective, bound and gap of a joint path for its report.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    paths : sequence of BeadPath
        The feasible paths.
    report : callable, optional
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    figures : dict or None
        Values for the sum over all beads, the bead with the largest gap and each bead; for the
        displacement also for the job including moves between beads. None for arms without a
        bound.
    issues : list of Issue
        A note for arms without a bound.
    """
    if task.arm.followed:
        return None, [
            Issue(
                NOTE,
                "NO_BOUND",
                "the lower bound is undefined, as several solutions of the arm share a "
                "configuration; remove joints.certificate",
            )
        ]
    displacement = task.parameters.objective == "displacement"
    share = 0.6 if displacement and len(paths) > 1 else 1.0
    certificate = certified(task, paths, lambda fraction: report(share * fraction))
    worst = paths[int(certificate.gaps.argmax())]
    figures: dict[str, object] = _figures(
        float(certificate.objective.sum()), float(certificate.bound.sum())
    )
    figures["worst"] = {
        "layer": worst.layer,
        "bead": worst.index,
        "gap": float(certificate.gaps.max()),
    }
    figures["beads"] = [
        {"layer": path.layer, "bead": path.index, **_figures(float(objective), float(bound))}
        for path, objective, bound in zip(paths, certificate.objective, certificate.bound)
    ]
    if displacement:
        figures["with_ways_between"] = _figures(
            *whole_job(task, paths, lambda fraction: report(share + (1.0 - share) * fraction))
        )
    return figures, []


def _figures(objective: float, bound: float) -> dict[str, object]:
    return {
        "objective": objective,
        "bound": bound,
        "gap": 1.0 - bound / objective if objective > 0.0 else 0.0,
    }


def certified(
    task: Task, paths: Sequence[BeadPath], report: Callable[[float], None] = lambda share: None
) -> Optimality:
    """Return the optimality of feasible paths, bead by bead.

    The bound holds for every rotation course along the beads, in the branch of the task, that keeps
    limits and condition at the points.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    paths : sequence of BeadPath
        The feasible paths.
    report : callable, optional
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    Optimality
        Objective and bound of each bead.
    """
    objective, bound = np.zeros(len(paths)), np.zeros(len(paths))
    for number, path in enumerate(paths):
        report(number / len(paths))
        points = gather([path.bead], task.cell)
        if task.parameters.objective != "displacement":
            objective[number] = path.objective
            bound[number] = min(path.objective, point_bound(task, points, path.threshold))
            continue
        objective[number] = _displacement_cost(task, points, path)
        bound[number] = _displacement_bound(task, points, path, objective[number])
    return Optimality(objective, bound)


def whole_job(
    task: Task, paths: Sequence[BeadPath], report: Callable[[float], None] = lambda share: None
) -> tuple[float, float]:
    """Return the displacement of a job, including steps between beads, and its lower bound.

    Parameters
    ----------
    task : Task
        The plan.
    paths : sequence of BeadPath
        The feasible paths, in print order.
    report : callable, optional
        Receives the completed fraction; may raise to cancel.

    Returns
    -------
    objective : float
        Eq. 17 for the beads and the steps from each bead end to the next start.
    bound : float
        Lower bound over all rotations.
    """
    bead_points = [gather([path.bead], task.cell) for path in paths]
    costs = [_displacement_cost(task, points, path) for points, path in zip(bead_points, paths)]
    step_costs = np.array(
        [next_path.joints[0] - path.joints[-1] for path, next_path in zip(paths, paths[1:])]
    )
    step_costs = (step_costs * step_costs) @ task.weights if len(step_costs) else np.zeros(0)
    objective = float(sum(costs) + step_costs.sum())
    value, following = np.zeros(BETWEEN_BEADS), None
    for number in range(len(paths) - 1, -1, -1):
        report(1.0 - (number + 1) / len(paths))
        # steps above this cost exceed any better course and are not checked individually
        max_cost = max([costs[number], *step_costs[max(0, number - 1) : number + 1]])
        value, first_lattice = _through(
            task, bead_points[number], paths[number], BETWEEN_BEADS, max_cost, value, following
        )
        following = first_lattice
    assert following is not None
    return objective, min(objective, least_ahead.least_of(value, following))


def _displacement_cost(task: Task, points: Points, path: BeadPath) -> float:
    """Return eq. 17 for one bead."""
    step = steps(path.joints, points)
    return float(((step * step) @ task.weights).sum())


def _displacement_bound(task: Task, points: Points, path: BeadPath, objective: float) -> float:
    """Return a lower bound of eq. 17 for one bead; `objective` is the cost of its path."""
    target, best = (1.0 - BOUND_TOLERANCE) * objective, 0.0
    for number, count in enumerate(ROTATIONS):
        value, first_lattice = _through(task, points, path, count, objective, np.zeros(count), None)
        previous, best = best, max(best, min(objective, least_ahead.least_of(value, first_lattice)))
        # halving the distance between rotations divides the error by sixteen
        if best >= target or (
            previous > 0.0 and best - previous < 8.0 * BOUND_TOLERANCE * objective
        ):
            break
        if number == 0:
            target = min(target, _best_known(task, points, path) - BOUND_TOLERANCE * objective)
            if best >= target:
                break
    return best


def _best_known(task: Task, points: Points, path: BeadPath) -> float:
    """Return the cost of the best rotation course found from the course of the path."""
    groups = _grouped(steps(path.joints, points), task.weights)
    group_points, scale, threshold = (
        points.select_points(groups),
        task.weights / np.diff(groups)[:, None],
        path.threshold[groups],
    )

    def broken(phi: Array, joints: Array) -> Mask:
        return broken_by(task, group_points, threshold, phi, joints)

    return best_course(
        lambda phi: task.raw_joints(group_points, phi), scale, path.phi[groups], False, broken
    )[1]


def _through(
    task: Task,
    points: Points,
    path: BeadPath,
    count: int,
    max_cost: float,
    value: Array,
    following: Lattice | None,
) -> tuple[Array, Lattice]:
    """Return the minimum sums (count,) from each rotation at the first point of a bead, and the
    lattice of this point.

    value: (count,) minimum sums from the first point of the next bead, with lattice `following`; if
    this is None, from the end of this bead.
    """
    groups = _grouped(steps(path.joints, points), task.weights)
    chunk_size = max(2, PIECE // count)
    next_lattice, step_count = following, 1.0  # the step to the next point
    for end in range(len(groups), 0, -chunk_size):
        rows = groups[max(0, end - chunk_size) : end]
        chunk = lattice(task, points, rows, path.threshold[rows], count)
        if next_lattice is not None:
            value = least_ahead.before(
                chunk, len(rows) - 1, next_lattice, 0, value, step_count, max_cost
            )
        value = least_ahead.ahead(chunk, value, np.diff(rows), max_cost)
        next_lattice = chunk.first
        step_count = float(rows[0] - groups[max(0, end - chunk_size) - 1])
    assert next_lattice is not None
    return value, next_lattice


def _grouped(step: Array, weights: Array) -> Index:
    """Return the end points of step groups; grouping loses at most GROUPED of the objective."""
    count = len(step) - 1
    total, travel = float(((step * step) @ weights).sum()), np.cumsum(step, axis=0)
    groups = MIN_GROUPS
    while groups < count:
        rows: Index = np.unique(np.round(np.linspace(0, count, groups + 1)).astype(np.int64))
        moved = np.diff(travel[rows], axis=0)
        preserved = float(((moved * moved) @ weights / np.diff(rows)).sum())
        if preserved >= total * (1.0 - GROUPED) and np.abs(moved).max() < 0.4 * TURN:
            return rows
        groups *= 2
    return np.arange(count + 1, dtype=np.int64)


# ---- Close the gap between a joint path and its bound: the best rotation course along a bead, free
# at each point

POINTWISE_REASON = "each point free"
MIN_GAIN = 1e-3  # minimum gain, fraction of the objective; for less, the polynomial stays


def close_gaps(
    task: Task, paths: list[tuple[BeadPath, list[Issue]]]
) -> list[tuple[BeadPath, list[Issue]]]:
    """Replace paths by better rotation courses if the task requests it.

    New courses are refined to the chord error.

    Parameters
    ----------
    task : Task
        The plan; `joints.close_gap` requests the search.
    paths : list of (BeadPath, list of Issue)
        The paths and their issues.

    Returns
    -------
    list of (BeadPath, list of Issue)
        The paths and issues, with better courses where found.
    """
    if not task.parameters.close_gap or not task.cell.machine.free or task.arm.followed:
        return paths
    return [
        (path, issues)
        if (best := closed(task, path)) is path
        else refined_to_chord_error(task, best, task.chord_error)
        for path, issues in paths
    ]


def closed(task: Task, path: BeadPath) -> BeadPath:
    """Return the path with the best rotation course found, if it is better.

    The course keeps limits, condition, rotation range, joined beads and link clearance. Given paths
    and infeasible paths stay unchanged.
    """
    if (
        task.parameters.objective != "displacement"
        or path.reason == given.GIVEN
        or not path.reachable
        or len(path.phi) < 3
    ):
        return path
    points = gather([path.bead], task.cell)

    def broken(phi: Array, joints: Array) -> Mask:
        return broken_by(task, points, path.threshold, phi, joints)

    def joints_at(phi: Array) -> Array:
        return task.raw_joints(points, phi)

    scale = np.broadcast_to(task.weights, (len(path.phi) - 1, len(task.weights)))
    phi, objective = best_course(
        joints_at, scale, path.phi, task.joined and path.bead.closed, broken
    )
    step = steps(path.joints, points)
    if not objective < (1.0 - MIN_GAIN) * float(((step * step) @ task.weights).sum()):
        return path
    joints, condition = task.joints(points, phi), task.condition(points, phi, joints_at(phi))
    if task.kept is not None:
        deposited = np.full(len(phi), task.kept.moment((path.layer, path.index)), dtype=np.int64)
        if task.kept.contact.touches(joints, deposited).any.any():
            return path
    margin = np.minimum(task.rows.margin(joints), condition_margin(condition, path.threshold))
    return dataclasses.replace(
        path,
        phi=phi,
        joints=joints,
        condition=condition,
        objective=objective,
        margin=float(margin.min()),
        coefficients=None,
        reason=POINTWISE_REASON,
    )
