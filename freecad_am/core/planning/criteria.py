# SPDX-License-Identifier: LGPL-2.1-or-later
"""Criteria of a joint path (Chalvin 2020, eqs. 1 to 6 as corrected in ERRATA, and eq. 17).

Each criterion is minimised. It has one value per bead and a derivative along d q / d phi at each
point. Values are means over points, so the number of points does not matter; eq. 17 is a sum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..kinematics import jacobian as jac
from ..kinematics.cell import Cell
from ..kinematics.inverse import spherical_wrist
from ..parameters.joints import OBJECTIVES, JointParameters
from ..types import Array, Integers, Mask
from .joint_path import BeadPath, JointPath
from .points import Points, gather, steps
from .task import Task

# maps joints (..., T, axes) to a criterion per bead (..., B), without computing the condition
Values = Callable[[Task, Points, Array], Array]


def displacement(task: Task, points: Points, joints: Array) -> Array:
    """Return the displacement criterion of each bead.

    Parameters
    ----------
    task : Task
        The plan, including axis weights.
    points : Points
        T points of B beads.
    joints : (..., T, axes) array
        Joints, rad or mm.

    Returns
    -------
    (..., B) array
        Sum over points and axes of alpha (q_i - q_i-1)^2.

    References
    ----------
    Chalvin 2020, eq. 17.
    """
    step = steps(joints, points)
    return points.total((step * step) @ task.weights)


def displacement_rate(task: Task, points: Points, joints: Array, rates: Array) -> Array:
    """Return the derivative of the displacement with respect to phi at each point.

    Parameters
    ----------
    task : Task
        The plan, including axis weights.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Joints, rad or mm.
    rates : (T, axes) array
        Derivatives d q / d phi.

    Returns
    -------
    (T,) array
        Derivative of eq. 17 with respect to the phi of each point.
    """
    step = steps(joints, points) * task.weights
    ahead = np.zeros_like(step)
    ahead[:-1] = step[1:]
    result: Array = 2.0 * np.einsum("ij,ij->i", step - ahead, rates)
    return result


def limits_liegeois(task: Task, points: Points, joints: Array) -> Array:
    """Return the mean squared distance of the joints from mid-range, relative to half the range.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    points : Points
        T points of B beads.
    joints : (..., T, axes) array
        Joints, rad or mm.

    Returns
    -------
    (..., B) array
        Mean over points of the sum of ((q - mean) / (mean - max))^2.

    References
    ----------
    Chalvin 2020, eq. 1.
    """
    return _mean(points, (task.given_rows.offset(joints) ** 2).sum(axis=-1))


def limits_fournier(task: Task, points: Points, joints: Array) -> Array:
    """Return the mean squared distance of the joints from mid-range, relative to the full range.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    points : Points
        T points of B beads.
    joints : (..., T, axes) array
        Joints, rad or mm.

    Returns
    -------
    (..., B) array
        Mean over points of the sum of ((q - mean) / stroke)^2.

    References
    ----------
    Chalvin 2020, eq. 2.
    """
    return 0.25 * limits_liegeois(task, points, joints)


def limits_klein(task: Task, points: Points, joints: Array) -> Array:
    """Return the maximum distance of any joint from mid-range, relative to the full range.

    Parameters
    ----------
    task : Task
        The plan, including limits.
    points : Points
        T points of B beads.
    joints : (..., T, axes) array
        Joints, rad or mm.

    Returns
    -------
    (..., B) array
        Maximum of abs(q - mean) / stroke over axes and points.

    References
    ----------
    Chalvin 2020, eq. 3.
    """
    return -points.worst(-0.5 * np.abs(task.given_rows.offset(joints)).max(axis=-1))


def _liegeois_rate(task: Task, points: Points, joints: Array, rates: Array) -> Array:
    slope = 2.0 * task.given_rows.offset(joints) / task.given_rows.half
    return np.asarray(
        np.einsum("im,im->i", slope, rates @ task.given_rows.matrix.T) / _count(points)
    )


def _klein_rate(task: Task, points: Points, joints: Array, rates: Array) -> Array:
    offset = task.given_rows.offset(joints)
    row = np.abs(offset).argmax(axis=1)
    point_rows = np.arange(len(points))
    slope = (
        0.5
        * np.sign(offset[point_rows, row])
        / task.given_rows.half[row]
        * (rates @ task.given_rows.matrix.T)[point_rows, row]
    )
    return np.where(_is_worst(points, -np.abs(offset[point_rows, row])), slope, 0.0)


def manipulability(task: Task, points: Points, joints: Array, matrix: Array) -> Array:
    """Return the mean inverse manipulability of each bead.

    Parameters
    ----------
    task : Task
        The plan, including the characteristic length that scales the translation rows.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Unused; all criteria share one signature.
    matrix : (T, 6, axes) array
        Jacobians at the deposition point.

    Returns
    -------
    (B,) array
        Mean over points of 1 / sqrt(det(J J^T)).

    References
    ----------
    Chalvin 2020, eq. 5 as corrected in ERRATA.
    """
    return mean_inverse(points, jac.manipulability(matrix, task.parameters.characteristic_length))


def condition(task: Task, points: Points, joints: Array, matrix: Array) -> Array:
    """Return the mean condition number of each bead.

    Parameters
    ----------
    task : Task
        The plan, including the characteristic length that scales the translation rows.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Unused; all criteria share one signature.
    matrix : (T, 6, axes) array
        Jacobians at the deposition point.

    Returns
    -------
    (B,) array
        Mean over points of sigma_max / sigma_min.

    References
    ----------
    Chalvin 2020, eq. 6, inverted.
    """
    return mean_inverse(points, jac.condition(matrix, task.parameters.characteristic_length))


def mean_inverse(points: Points, measure: Array) -> Array:
    """Return the mean reciprocal of a measure over the points of each bead.

    Parameters
    ----------
    points : Points
        T points of B beads.
    measure : (T,) array
        Distance from singularity; at least 1e-300 in the reciprocal.

    Returns
    -------
    (B,) array
        Mean of 1 / measure.
    """
    return _mean(points, 1.0 / np.maximum(measure, 1e-300))


def value(task: Task, points: Points, joints: Array, matrix: Array | None) -> Array:
    """Return the objective of the job for each bead.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Joints, rad or mm.
    matrix : (T, 6, axes) array or None
        Jacobians; None if the objective depends only on joints.

    Returns
    -------
    (B,) array
        Objective of each bead.
    """
    name = task.parameters.objective
    if name in JOINT_ONLY:
        return JOINT_ONLY[name](task, points, joints)
    assert matrix is not None
    return (manipulability if name == "manipulability" else condition)(task, points, joints, matrix)


def rate(task: Task, points: Points, joints: Array, rates: Array, matrix: Array) -> Array:
    """Return the derivative of the objective with respect to phi at each point.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Joints, rad or mm.
    rates : (T, axes) array
        Derivatives d q / d phi.
    matrix : (T, 6, axes) array
        Jacobians at the deposition point.

    Returns
    -------
    (T,) array
        Derivative with respect to the phi of each point.
    """
    name = task.parameters.objective
    if name in JOINT_ONLY:
        return joint_rate(task, points, joints, rates)
    length = task.parameters.characteristic_length
    if name == "manipulability":
        w = np.maximum(jac.manipulability(matrix, length), 1e-300)
        return np.asarray(
            -jac.manipulability_rate(matrix, rates[:, : matrix.shape[2]], length)
            / w**2
            / _count(points)
        )
    ratio = np.maximum(jac.condition(matrix, length), 1e-300)
    return np.asarray(-condition_rate(task, joints, rates, matrix) / ratio**2 / _count(points))


def joint_rate(task: Task, points: Points, joints: Array, rates: Array) -> Array:
    """Return the derivative of an objective of `JOINT_ONLY` with respect to phi at each point.

    Parameters
    ----------
    task : Task
        The plan, including the objective.
    points : Points
        T points of B beads.
    joints : (T, axes) array
        Joints, rad or mm.
    rates : (T, axes) array
        Derivatives d q / d phi.

    Returns
    -------
    (T,) array
        Derivative with respect to the phi of each point.
    """
    name = task.parameters.objective
    if name == "displacement":
        return displacement_rate(task, points, joints, rates)
    if name == "limits-liegeois":
        return _liegeois_rate(task, points, joints, rates)
    if name == "limits-fournier":
        return 0.25 * _liegeois_rate(task, points, joints, rates)
    return _klein_rate(task, points, joints, rates)


def condition_rate(task: Task, joints: Array, rates: Array, matrix: Array) -> Array:
    """Return the derivative of the inverse condition number with respect to phi at each point.

    Parameters
    ----------
    task : Task
        The plan, including the characteristic length.
    joints : (T, axes) array
        Unused.
    rates : (T, axes) array
        Derivatives d q / d phi.
    matrix : (T, 6, axes) array
        Jacobians at the deposition point.

    Returns
    -------
    (T,) array
        Derivative of sigma_min / sigma_max.
    """
    result: Array = jac.condition_rate(
        matrix, rates[:, : matrix.shape[2]], task.parameters.characteristic_length
    )
    return result


JOINT_ONLY: dict[str, Values] = {
    "displacement": displacement,
    "limits-liegeois": limits_liegeois,
    "limits-fournier": limits_fournier,
    "limits-klein": limits_klein,
}


def _count(points: Points) -> Array:
    return np.bincount(points.bead).astype(float)[points.bead]


def _mean(points: Points, values: Array) -> Array:
    mean: Array = points.total(values) / np.bincount(points.bead)
    return mean


def _is_worst(points: Points, values: Array) -> Mask:
    # mark one point per bead, the first worst one, so that a sum over points is the gradient of
    # the maximum
    worst = values <= points.worst(values)[points.bead]
    occurrence: Integers = np.cumsum(worst) - (np.cumsum(worst) - worst)[points.first][points.bead]
    return np.asarray(worst & (occurrence == 1), dtype=np.bool_)


def path_figures(path: JointPath, cell: Cell, parameters: JointParameters) -> dict[str, object]:
    """Return the statistics of a planned joint path for the report.

    Parameters
    ----------
    path : JointPath
        The joint path.
    cell : Cell
        The cell of the plan.
    parameters : JointParameters
        The parameters of the plan.

    Returns
    -------
    dict[str, object]
        Statistics with angles in degrees and lists in axis order. A five-axis machine has only
        the axis statistics.
    """
    if not path.branch:
        return _figures(
            cell, path.beads, {"condition_min": None, "objective_value": None, "criteria": {}}
        )
    return figures(Task(cell, spherical_wrist.branch_index(path.branch), parameters), path.beads)


def figures(task: Task, paths: Sequence[BeadPath]) -> dict[str, object]:
    """Return statistics of robot joint paths, with angles in degrees and lists in axis order.

    A missing value is None. limit_margin_deg is the minimum distance of each axis from its limits
    (None for a continuous axis). Speeds, accelerations and jerks are maxima within beads at their
    travel speed, from finite differences. Prismatic axes have mm instead of degrees.
    """
    complete = all(path.reachable for path in paths)
    return _figures(
        task.cell,
        paths,
        {
            "condition_min": float(min(path.condition.min() for path in paths)),
            "objective_value": float(sum(path.objective for path in paths)) if complete else None,
            "criteria": criteria_values(task, paths),
        },
    )


def _figures(
    cell: Cell, paths: Sequence[BeadPath], criteria_of_path: dict[str, object]
) -> dict[str, object]:
    joints = np.concatenate([path.joints for path in paths])
    limits, units = cell.limits, cell.machine.unit_values
    ranges = np.array([np.ptp(path.joints, axis=0) for path in paths if path.reachable])
    margin = (
        np.nanmin(np.minimum(joints - limits.lower, limits.upper - joints), axis=0)
        if len(ranges)
        else None
    )
    rates = [_rates(path) for path in paths if path.reachable]
    largest = [np.max([rate[k] for rate in rates], axis=0) if rates else None for k in range(3)]
    speed = largest[0]
    return {
        "min_deg": _in_axis_units(np.nanmin(joints, axis=0) if len(ranges) else None, units),
        "max_deg": _in_axis_units(np.nanmax(joints, axis=0) if len(ranges) else None, units),
        "range_per_layer_max_deg": _in_axis_units(
            ranges.max(axis=0) if len(ranges) else None, units
        ),
        "limit_margin_deg": _in_axis_units(margin, units),
        **criteria_of_path,
        "speed_max_deg_s": _in_axis_units(speed, units),
        "acceleration_max_deg_s2": _in_axis_units(largest[1], units),
        "jerk_max_deg_s3": _in_axis_units(largest[2], units),
        "speed_ratio_max": None
        if speed is None
        else [float(v) for v in speed / cell.machine.max_speed],
    }


def criteria_values(task: Task, paths: Sequence[BeadPath]) -> dict[str, float | None]:
    """Return all criteria for the whole path, including those that were not the objective.

    The displacement is a sum over steps and limits-klein a maximum; the other criteria are means
    over points. All are None if any point is unreachable.
    """
    if not all(path.reachable for path in paths):
        return dict.fromkeys(OBJECTIVES)
    points = gather([path.bead for path in paths], task.cell, posed=not task.cell.torch_stands)
    joints = np.concatenate([path.joints for path in paths])
    phi, condition = (
        np.concatenate([getattr(path, name) for path in paths]) for name in ("phi", "condition")
    )
    manipulability = np.empty(len(points))
    for rows, matrix in task.jacobians(points, phi, joints):
        manipulability[rows] = jac.manipulability(matrix, task.parameters.characteristic_length)
    share = np.diff(np.append(points.first, len(points))) / len(points)
    values = {name: measure(task, points, joints) for name, measure in JOINT_ONLY.items()}
    values["manipulability"] = mean_inverse(points, manipulability)
    values["condition"] = mean_inverse(points, condition)
    totals = {name: float((value * share).sum()) for name, value in values.items()}
    totals |= {
        "displacement": float(values["displacement"].sum()),
        "limits-klein": float(values["limits-klein"].max()),
    }
    return {name: totals[name] for name in OBJECTIVES}


def _rates(path: BeadPath) -> tuple[Array, Array, Array]:
    """Return the maximum speed, acceleration and jerk of each axis in a bead.

    Units are rad or mm per s, s^2 and s^3.
    """
    length = np.linalg.norm(np.diff(path.bead.points, axis=0), axis=1)
    time = length / path.bead.speed[1:]
    speed = np.diff(path.joints, axis=0) / time[:, None]
    none = np.zeros(path.joints.shape[1])
    if len(speed) < 2:
        return np.abs(speed).max(axis=0), none, none
    between = 0.5 * (time[1:] + time[:-1])
    acceleration = np.diff(speed, axis=0) / between[:, None]
    if len(acceleration) < 2:
        return np.abs(speed).max(axis=0), np.abs(acceleration).max(axis=0), none
    jerk = np.diff(acceleration, axis=0) / (0.5 * (between[1:] + between[:-1]))[:, None]
    return np.abs(speed).max(axis=0), np.abs(acceleration).max(axis=0), np.abs(jerk).max(axis=0)


def _in_axis_units(values: Array | None, units: Array) -> list[float | None] | None:
    """Convert axis values to displayed units."""
    if values is None:
        return None
    return [float(value) if np.isfinite(value) else None for value in values / units]
