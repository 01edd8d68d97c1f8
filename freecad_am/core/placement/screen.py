# SPDX-License-Identifier: LGPL-2.1-or-later
"""Number of points of a toolpath that a robot serves at a pose of the part: if no rotation about the
tool serves a point, the pose needs no plan.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.angles import TURN
from ..kinematics.cell import Cell
from ..parameters.joints import JointParameters
from ..planning.points import Points
from ..planning.task import MIN_MARGIN, Task
from ..toolpath import Bead
from ..types import Array, Mask

TURNS = 72  # rotations about the tool to try
FINER = 9  # between two of these, about the best one of a point that none of them serves
BRANCHES = 8


class Screened(NamedTuple):
    """The share of points that some rotation serves, within limits and far enough from singularities, in the configuration
    that serves most, and this one."""

    share: float
    branch: int


def single_points(beads: Sequence[Bead], cell: Cell) -> Points:
    """The points of beads, each as a bead of one point."""
    position, tool, parameter = (
        np.concatenate([getattr(bead, name) for bead in beads])
        for name in ("points", "tool", "parameter")
    )
    external = None
    if cell.external is not None:
        external = np.concatenate([bead.external for bead in beads if bead.external is not None])
    numbers, sliding = np.arange(len(position)), cell.machine.chain.sliding
    return Points(
        position,
        tool,
        parameter,
        numbers,
        numbers,
        np.zeros(len(numbers), dtype=bool),
        cell.pose_frames(position, tool, external),
        external,
        sliding if sliding.any() else None,
    )


def screen_points(
    cell: Cell, points: Points, parameters: JointParameters, only_branch: int | None
) -> Screened:
    """Return the share of the points (each independent) that a robot serves, in a configuration or in
    the best one.
    """
    results = [
        Screened(float(_find_served(Task(cell, branch, parameters), points).mean()), branch)
        for branch in (range(BRANCHES) if only_branch is None else (only_branch,))
    ]
    return max(results, key=lambda result: result.share)


def _find_served(task: Task, points: Points) -> Mask:
    """(C,) which points some rotation serves."""
    low, high = task.parameters.rotation_range
    is_full_turn = high - low >= TURN - 1e-9
    values = np.linspace(low, high, TURNS, endpoint=not is_full_turn)
    phi = np.broadcast_to(values[:, None], (TURNS, len(points)))
    served, margin = _serves(task, points, phi)
    remaining = np.flatnonzero(~served & np.isfinite(margin).any(axis=0))
    if len(remaining):
        step = values[1] - values[0]
        best = (
            values[margin[:, remaining].argmax(axis=0)]
            + step * np.linspace(-1.0, 1.0, 2 * FINER + 1)[:, None]
        )
        served[remaining] = _serves(
            task,
            points.select_points(remaining),
            best if is_full_turn else np.clip(best, low, high),
        )[0]
    return served


def _serves(task: Task, points: Points, phi: Array) -> tuple[Mask, Array]:
    """(C,) which points one of their rotations (R, C) serves, and the margins (R, C) of the limits."""
    joints = task.joints(points, phi)
    margin = task.rows.margin(joints)
    threshold = task.thresholds(points)
    served = np.zeros(len(points), dtype=bool)
    # most points are served by the rotation with the largest margin: the condition takes the longest
    is_best = np.zeros(phi.shape, dtype=bool)
    is_best[margin.argmax(axis=0), np.arange(len(points))] = True
    for selected in (is_best, ~is_best):
        row, column = np.nonzero(selected & (margin >= MIN_MARGIN) & ~served)
        if len(row):
            flange = points.frames.of(column).flange_poses(phi[row, column])
            sufficient = task.condition_at(flange, joints[row, column]) >= threshold[column]
            served[column[sufficient]] = True
    return served, margin
