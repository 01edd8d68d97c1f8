# SPDX-License-Identifier: LGPL-2.1-or-later
"""At how many points of a toolpath a robot serves at all where the part stands: what no rotation about the tool serves at
one point cannot be planned, and need not be tried."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..geometry.angles import TURN
from ..kinematics.cell import Cell
from ..parameters.joints import JointParameters
from ..planning.points import Points
from ..planning.task import FITS, Task
from ..toolpath import Bead
from ..types import Array, Mask

TURNS = 72  # rotations about the tool that are looked at
FINER = 9  # between two of these, about the best one of a point that none of them serves
BRANCHES = 8


class Screened(NamedTuple):
    """The share of points that some rotation serves, within limits and far enough from singularities, in the configuration
    that serves most, and this one."""

    share: float
    branch: int


def alone(beads: Sequence[Bead], cell: Cell) -> Points:
    """The points of beads, each standing for itself."""
    position, tool, parameter = (
        np.concatenate([getattr(bead, name) for bead in beads])
        for name in ("points", "tool", "parameter")
    )
    external = None
    if cell.external is not None:
        external = np.concatenate([bead.external for bead in beads if bead.external is not None])
    each, sliding = np.arange(len(position)), cell.machine.chain.sliding
    return Points(
        position,
        tool,
        parameter,
        each,
        each,
        np.zeros(len(each), dtype=bool),
        cell.pose_frames(position, tool, external),
        external,
        sliding if sliding.any() else None,
    )


def screened(
    cell: Cell, points: Points, parameters: JointParameters, wanted: int | None
) -> Screened:
    """How many of the points (each for itself) a robot serves, in a configuration or in the best of all."""
    found = [
        Screened(float(_served(Task(cell, branch, parameters), points).mean()), branch)
        for branch in (range(BRANCHES) if wanted is None else (wanted,))
    ]
    return max(found, key=lambda one: one.share)


def _served(task: Task, points: Points) -> Mask:
    """(C,) which points some rotation serves."""
    low, high = task.parameters.rotation_range
    whole = high - low >= TURN - 1e-9
    values = np.linspace(low, high, TURNS, endpoint=not whole)
    phi = np.broadcast_to(values[:, None], (TURNS, len(points)))
    served, margin = _serves(task, points, phi)
    left = np.flatnonzero(~served & np.isfinite(margin).any(axis=0))
    if len(left):
        step = values[1] - values[0]
        best = (
            values[margin[:, left].argmax(axis=0)]
            + step * np.linspace(-1.0, 1.0, 2 * FINER + 1)[:, None]
        )
        served[left] = _serves(
            task, points.each(left), best if whole else np.clip(best, low, high)
        )[0]
    return served


def _serves(task: Task, points: Points, phi: Array) -> tuple[Mask, Array]:
    """(C,) which points one of their rotations (R, C) serves, and the margins (R, C) of the limits."""
    joints = task.joints(points, phi)
    margin = task.rows.margin(joints)
    threshold = task.thresholds(points)
    served = np.zeros(len(points), dtype=bool)
    # most points are served by the rotation with the largest margin: the condition takes the longest
    first = np.zeros(phi.shape, dtype=bool)
    first[margin.argmax(axis=0), np.arange(len(points))] = True
    for some in (first, ~first):
        row, column = np.nonzero(some & (margin >= FITS) & ~served)
        if len(row):
            flange = points.frames.of(column).flange_poses(phi[row, column])
            kept = task.condition_at(flange, joints[row, column]) >= threshold[column]
            served[column[kept]] = True
    return served, margin
