# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check a planned bead point by point, and report problems with layer, point and axis."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..geometry import frames
from ..issues import ERROR, Issue, Text, Word
from ..kinematics.cell import Cell
from .joint_path import BeadPath
from .task import Task

# rad; rounding error of the closed form and of whole turns, for joints exactly at a limit
ROUNDING = 1e-9


def findings(task: Task, path: BeadPath) -> list[Issue]:
    """Return at most one issue per kind and axis, at the worst point of the bead."""
    bead_fields = {"layer": path.layer, "bead": path.index}
    unreachable = np.flatnonzero(~np.isfinite(path.joints).all(axis=1))
    if len(unreachable) and not task.cell.machine.free:
        return [
            Issue(
                ERROR,
                "UNREACHABLE",
                Text(
                    "{} of {} directions are out of reach of the torch on this machine; tilt "
                    "less, or mount the part differently",
                    len(unreachable),
                    len(path.joints),
                ),
                point=int(unreachable[0]),
                **bead_fields,
            )
        ]
    if len(unreachable):
        count = Text(
            "{} of {} points are out of reach in this configuration; ",
            len(unreachable),
            len(path.joints),
        )
        external = task.cell.external
        return [
            Issue(
                ERROR,
                "UNREACHABLE",
                Text("{}move the positioner, choose another branch or tilt less", Word(count))
                if external and external.turning
                else Text(
                    "{}move the deposition point, choose another branch or tilt less", Word(count)
                ),
                point=int(unreachable[0]),
                **bead_fields,
            )
        ]
    return (
        _limit_findings(task, path, bead_fields)
        + _condition_findings(path, bead_fields)
        + _range_findings(task, path, bead_fields)
    )


def out_of_reach(cell: Cell, paths: Sequence[BeadPath]) -> list[Issue]:
    """Report a positioner out of reach: arm and tool are too short for every point of the part."""
    external, arm = cell.external, cell.robot.arm
    if (
        external is None
        or not external.turning
        or arm is None
        or any(path.reachable for path in paths)
    ):
        return []
    shoulder, height = arm.shoulder
    nearest = math.inf
    for path in paths:
        values = path.bead.external
        if values is None:
            return []
        to_part = frames.inverse(external.base(values)) @ frames.pose(
            np.eye(3), cell.to_carrier(path.bead.points)
        )
        ahead = np.hypot(to_part[:, 0, 3], to_part[:, 1, 3]) - shoulder
        nearest = min(nearest, float(np.hypot(ahead, to_part[:, 2, 3] - height).min()))
    lengths = (
        *cell.robot.chain.origins[4:, :3, 3],
        cell.robot.chain.flange[:3, 3],
        cell.poses.carried[:3, 3],
    )
    reach = arm.reach + sum(float(np.linalg.norm(length)) for length in lengths)
    if nearest <= reach:
        return []
    return [
        Issue(
            ERROR,
            "UNREACHABLE",
            Text(
                "the robot cannot reach the positioner: the nearest point of the part is {:.0f} "
                "mm from the shoulder, but arm and tool reach only {:.0f} mm; move the "
                "positioner nearer (cell.external)",
                nearest,
                reach,
            ),
        )
    ]


def _limit_findings(task: Task, path: BeadPath, bead_fields: dict[str, int]) -> list[Issue]:
    rows = task.given_rows
    values = path.joints @ rows.matrix.T
    over = np.maximum(rows.lower - values, values - rows.upper)
    issues = []
    for row in np.flatnonzero((over > ROUNDING).any(axis=0)):
        point = int(over[:, row].argmax())
        value = values[point, row]
        limit = rows.lower[row] if value < rows.lower[row] else rows.upper[row]
        unit, factor = (
            ("mm", 1.0)
            if (rows.matrix[row] @ task.cell.machine.chain.sliding).any()
            else ("deg", math.radians(1.0))
        )
        text = Text(
            "{} would be at {:.2f} {}, beyond its limit of {:g} {}",
            rows.labels[row],
            value / factor,
            unit,
            limit / factor,
            unit,
        )
        issues.append(
            Issue(
                ERROR,
                "LIMIT",
                text
                if task.cell.machine.free
                else Text("{}; move the part on the table", Word(text)),
                point=point,
                **bead_fields,
            )
        )
    return issues


def _condition_findings(path: BeadPath, bead_fields: dict[str, int]) -> list[Issue]:
    short = path.threshold - path.condition
    point = int(short.argmax())
    # `not >` also covers NaN: machines without redundancy have no condition number
    if not short[point] > ROUNDING:
        return []
    return [
        Issue(
            ERROR,
            "SINGULAR",
            Text(
                "inverse condition number {:.4f} is below the required {:.4f}, too close to a "
                "singularity; move the part in the cell, or lower joints.min_condition",
                path.condition[point],
                path.threshold[point],
            ),
            point=point,
            **bead_fields,
        )
    ]


def _range_findings(task: Task, path: BeadPath, bead_fields: dict[str, int]) -> list[Issue]:
    low, high = task.parameters.rotation_range
    if high - low >= 2.0 * np.pi - 1e-9:
        return []
    over = np.maximum(low - path.phi, path.phi - high)
    point = int(over.argmax())
    if over[point] <= ROUNDING:
        return []
    return [
        Issue(
            ERROR,
            "ROTATION_RANGE",
            Text(
                "the tool rotation would be {:.2f} deg, outside joints.rotation_range; widen the "
                "range, or move the part in the cell",
                math.degrees(path.phi[point]),
            ),
            point=point,
            **bead_fields,
        )
    ]
