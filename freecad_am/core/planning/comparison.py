# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures by which joint paths are compared: ranges, margins, speeds, accelerations and jerks of the axes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..kinematics import jacobian as jac
from ..kinematics.cell import Cell
from ..kinematics.inverse import opw
from ..parameters.joints import OBJECTIVES, JointParameters
from ..types import Array
from . import criteria
from .joint_path import BeadPath, JointPath
from .points import gather
from .task import Task


def path_figures(path: JointPath, cell: Cell, parameters: JointParameters) -> dict[str, object]:
    """The figures of a planned joint path; of a machine with rotary axes those of its axes alone, which had no choice."""
    if not path.branch:
        return _figures(
            cell, path.beads, {"condition_min": None, "objective_value": None, "criteria": {}}
        )
    return figures(Task(cell, opw.branch_index(path.branch), parameters), path.beads)


def figures(task: Task, paths: Sequence[BeadPath]) -> dict[str, object]:
    """The figures of the joint paths of a robot, angles in degrees, lists in axis order; None where there is no value.

    limit_margin_deg is the smallest distance to a limit of each axis (None: endless). Speeds, accelerations and jerks
    are the largest within the beads at their travel speed, by differences over the points. Axes that slide have mm in the
    place of degrees.
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
    """Every criterion an objective can be (criteria.py) for the whole path, whichever it was planned by.

    Sums over steps for the displacement, the largest value for limits-klein, means over points for the others; None
    where a point is unreachable.
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
    values = {name: measure(task, points, joints) for name, measure in criteria.JOINT_ONLY.items()}
    values["manipulability"] = criteria.mean_inverse(points, manipulability)
    values["condition"] = criteria.mean_inverse(points, condition)
    totals = {name: float((value * share).sum()) for name, value in values.items()}
    totals |= {
        "displacement": float(values["displacement"].sum()),
        "limits-klein": float(values["limits-klein"].max()),
    }
    return {name: totals[name] for name in OBJECTIVES}


def _rates(path: BeadPath) -> tuple[Array, Array, Array]:
    """Largest speed, acceleration and jerk of each axis over one bead, rad or mm per s, s^2, s^3."""
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
    """Values of the axes in the unit each is shown in."""
    if values is None:
        return None
    return [float(value) if np.isfinite(value) else None for value in values / units]
