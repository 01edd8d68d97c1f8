# SPDX-License-Identifier: LGPL-2.1-or-later
"""Objective, constraints and their derivatives for polynomial coefficients."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from ...kinematics import jacobian as jac
from ...types import Array, Integers
from .. import criteria
from ..points import Points, in_pieces
from ..task import Task


def changes(task: Task, points: Points, degree: int) -> Array:
    """Return independent changes of the coefficients of each bead.

    They are Chebyshev polynomials over the bead parameter, so all have the size of a rotation. For
    a closed bead whose rotation must return to its start, the column that prevents this is zero.

    Parameters
    ----------
    task : Task
        The plan; `joined` applies to closed beads.
    points : Points
        Points of B beads.
    degree : int
        Degree of the polynomials.

    Returns
    -------
    (B, degree + 1, degree + 1) array
        One change per column, with coefficients in ascending order.
    """
    joined = task.joined & points.closed
    # many beads share the same parameter range
    ends, of_bead = np.unique(np.stack(points.ends, axis=1), axis=0, return_inverse=True)
    result = np.stack([_chebyshev(low, high, degree) for low, high in ends])[of_bead]
    if degree > 0:
        result[joined, :, 3::2] -= result[joined, :, 1:2]
        result[joined, :, 1] = 0.0
    return result


def _chebyshev(low: float, high: float, degree: int) -> Array:
    """Return the columns T_0 to T_degree for a parameter range low to high mapped to -1 to 1."""
    columns = np.zeros((degree + 1, degree + 1))
    shift = np.array([-(high + low) / (high - low), 2.0 / (high - low)])
    for j in range(degree + 1):
        value = np.zeros(1)
        for coefficient in chebyshev.cheb2poly(np.eye(degree + 1)[j])[::-1]:
            value = polynomial.polyadd(polynomial.polymul(value, shift), [coefficient])
        columns[: len(value), j] = value[: degree + 1]
    return columns


# relative reserve of the condition above its threshold, so that it stays above between the points
CONDITION_RESERVE = 1e-3


@dataclass(frozen=True, eq=False)
class State:
    """The terms of eqs. 17 to 19 for given coefficients; constraints are satisfied if >= 0."""

    objective: Array
    gradient: Array
    predicted: Array
    constraints: Array
    constraint_rates: Array


def state_of(
    task: Task, points: Points, thresholds: Array, coefficients: Array, slopes: bool = True
) -> State:
    """Return objective, constraints and derivatives for given coefficients.

    Parameters
    ----------
    task : Task
        The plan, including objective and limits.
    points : Points
        T points of B beads.
    thresholds : (T,) array
        Required minimum condition.
    coefficients : (B, degree + 1) array
        Coefficients in ascending order.
    slopes : bool, optional
        Whether to compute the derivatives of the constraints; otherwise compute the predicted
        decrease of the objective.

    Returns
    -------
    State
        The state.

    References
    ----------
    Chalvin 2020, eqs. 17 to 19.
    """
    phi, phi_rate = task.rotation(points, points.polynomial(coefficients))
    joints = task.joints(points, phi)
    if np.isnan(joints).any():
        return _partly_unreachable(task, points, thresholds, coefficients, joints, slopes)
    powers = points.powers(coefficients.shape[1] - 1)
    if not slopes and task.parameters.objective in criteria.JOINT_ONLY:
        return _state_in_pieces(task, points, thresholds, phi, phi_rate, joints, powers)
    rates, matrix = task.rotation_rates(points.frames, phi, joints)
    rates = rates * phi_rate[:, None]
    objective = criteria.value(task, points, joints, matrix)
    gradient = _gradient(points, criteria.rate(task, points, joints, rates, matrix), powers)
    value = values_of(
        task, thresholds, phi, joints, jac.condition(matrix, task.parameters.characteristic_length)
    )
    worst = points.worst(value)
    if not slopes:
        predicted = _predicted(task, points, joints, rates, powers, gradient)
        return State(
            objective,
            gradient,
            predicted,
            worst.T,
            np.zeros((points.beads, len(value), powers.shape[1])),
        )
    slope = slopes_of(task, phi, phi_rate, joints, rates, matrix)
    worst_points = np.stack(
        [_find_worst_points(points, row, lowest) for row, lowest in zip(value, worst)]
    )
    rows = np.arange(len(value))[:, None]
    constraint_rates = (slope[rows, worst_points][:, :, None] * powers[worst_points]).transpose(
        1, 0, 2
    )
    return State(objective, gradient, np.full(points.beads, np.nan), worst.T, constraint_rates)


def _state_in_pieces(
    task: Task,
    points: Points,
    thresholds: Array,
    phi: Array,
    phi_rate: Array,
    joints: Array,
    powers: Array,
) -> State:
    """Return the state of many beads in batches, without derivatives of the constraints.

    At all but a few points, a lower bound proves that the condition is kept and replaces it.
    """
    length = task.parameters.characteristic_length
    rates, ratio = np.empty_like(joints), np.empty(len(points))
    for rows_now in in_pieces(len(points)):
        rates[rows_now], matrix = task.rotation_rates(
            points.frames.of(rows_now), phi[rows_now], joints[rows_now]
        )
        bound = jac.condition_bound(matrix, length)
        open_ = bound < thresholds[rows_now] * (1.0 + CONDITION_RESERVE)
        bound[open_] = jac.condition(matrix[open_], length)
        ratio[rows_now] = bound
    rates *= phi_rate[:, None]
    gradient = _gradient(points, criteria.joint_rate(task, points, joints, rates), powers)
    worst = points.worst(values_of(task, thresholds, phi, joints, ratio))
    return State(
        criteria.value(task, points, joints, None),
        gradient,
        _predicted(task, points, joints, rates, powers, gradient),
        worst.T,
        np.zeros((points.beads, len(worst), powers.shape[1])),
    )


def _gradient(points: Points, slope: Array, powers: Array) -> Array:
    return points.total((slope[:, None] * powers).T).T


def _partly_unreachable(
    task: Task, points: Points, thresholds: Array, coefficients: Array, joints: Array, slopes: bool
) -> State:
    """Return the state if points are unreachable: evaluate the reachable beads one by one."""
    b, k = coefficients.shape
    rows = len(task.rows.labels) + 1 + _narrow(task)
    state = State(
        np.full(b, np.inf),
        np.zeros((b, k)),
        np.full(b, np.inf),
        np.full((b, rows), -1.0),
        np.zeros((b, rows, k)),
    )
    if b == 1:
        return state
    unreachable = np.add.reduceat(np.isnan(joints).any(axis=1), points.first) > 0
    for bead in np.flatnonzero(~unreachable):
        bead_points, point_rows = points.only(int(bead))
        bead_state = state_of(
            task, bead_points, thresholds[point_rows], coefficients[bead : bead + 1], slopes
        )
        for name in ("objective", "gradient", "predicted", "constraints", "constraint_rates"):
            getattr(state, name)[bead] = getattr(bead_state, name)[0]
    return state


def _narrow(task: Task) -> int:
    low, high = task.parameters.rotation_range
    return int(high - low < 2.0 * np.pi - 1e-9)


def values_of(task: Task, thresholds: Array, phi: Array, joints: Array, ratio: Array) -> Array:
    """Return the constraint values at all points.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    thresholds : (T,) array
        Required minimum condition.
    phi : (T,) array
        Rotations, rad.
    joints : (T, axes) array
        Joints, rad or mm.
    ratio : (T,) array
        Inverse condition number, sigma_min / sigma_max.

    Returns
    -------
    (m + 1, T) array
        One row per limit and one for the condition; another row if the rotation range is less
        than a full turn. Values are >= 0 if satisfied.

    References
    ----------
    Chalvin 2020, eqs. 18 and 19 as corrected in ERRATA.
    """
    values = [
        0.25 * (1.0 - task.rows.offset(joints).T ** 2),
        (ratio - thresholds * (1.0 + CONDITION_RESERVE))[None],
    ]
    if _narrow(task):
        values.append(0.25 * (1.0 - _share(task, phi) ** 2)[None])
    return np.concatenate(values)


def slopes_of(
    task: Task, phi: Array, phi_rate: Array, joints: Array, rates: Array, matrix: Array
) -> Array:
    """Return the derivatives of the constraint values with respect to the polynomial value.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    phi : (T,) array
        Rotations, rad.
    phi_rate : (T,) array
        d phi / d polynomial value.
    joints : (T, axes) array
        Joints, rad or mm.
    rates : (T, axes) array
        d q / d polynomial value.
    matrix : (T, 6, axes) array
        Jacobians at the deposition point.

    Returns
    -------
    (m + 1, T) array
        One row per row of `values_of`.
    """
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


def _find_worst_points(points: Points, values: Array, worst: Array) -> Integers:
    """Return the index (B,) of the first point of each bead at its minimum value."""
    hits = np.flatnonzero(values <= worst[points.bead])
    _, position = np.unique(points.bead[hits], return_index=True)
    return hits[position]


def _predicted(
    task: Task, points: Points, joints: Array, rates: Array, powers: Array, gradient: Array
) -> Array:
    """Return the predicted decrease (B,) of the objective by its second-order model.

    Joined beads stay joined. Eq. 17 is a sum of squares, so its curvature is known (Gauss-Newton).
    For other objectives, return the norm of the gradient.
    """
    free = changes(task, points, powers.shape[1] - 1)
    gradient = (gradient[:, None] @ free)[:, 0]
    if task.parameters.objective != "displacement":
        return np.asarray(np.linalg.norm(gradient, axis=1))
    change = [_between(rates * power[:, None], points) for power in powers.T]
    curvature = np.empty((points.beads, len(change), len(change)))
    for j, change_j in enumerate(change):
        weighed = change_j * task.weights
        for k, change_k in enumerate(change[: j + 1]):
            curvature[:, j, k] = curvature[:, k, j] = 2.0 * points.total(
                np.einsum("ia,ia->i", weighed, change_k)
            )
    curvature = np.swapaxes(free, 1, 2) @ curvature @ free
    inverse = np.linalg.pinv(curvature, rcond=1e-10, hermitian=True)
    fall: Array = 0.5 * np.einsum("bj,bjk,bk->b", gradient, inverse, gradient)
    return fall


def _between(values: Array, points: Points) -> Array:
    """Return the change of values (T, axes) from the previous point; 0 at bead starts."""
    change = np.zeros_like(values)
    np.subtract(values[1:], values[:-1], out=change[1:])
    change[points.starts] = 0.0
    return change
