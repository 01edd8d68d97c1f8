# SPDX-License-Identifier: LGPL-2.1-or-later
"""One RZ for the whole job: what is done without optimisation, kept for comparison and for simple parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...geometry.angles import TURN, shortest
from ...geometry.ties import first_most
from ...issues import NOTE, Issue
from ...toolpath import Bead
from ...types import Array
from .. import criteria
from ..joint_path import BeadPath
from ..points import Points, gather
from ..rotation import search
from ..task import Task, condition_margin

Progress = Callable[[float, str], None]

TRIED, FINE = 360, 21


def plan(
    task: Task, beads: Sequence[Bead], places: Sequence[tuple[int, int]], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths of all beads with the RZ of the job, or the one with the largest smallest margin when it is 'auto'."""
    wanted = task.parameters.rz
    full = gather(beads, task.cell)
    threshold = task.thresholds(full)
    issues: list[Issue] = []
    if isinstance(wanted, str):
        coarse = gather(beads, task.cell, search.POINTS_PER_BEAD)
        progress(0.1, "searching one RZ for all")
        rz, margin = best_rz(task, coarse, task.thresholds(coarse))
        if margin < 0.0:
            issues.append(Issue(NOTE, "RZ_CONSTANT", f"none of {TRIED} values of RZ serves for the whole job; the "
                                f"nearest to it is {np.degrees(rz):.1f} deg"))
    else:
        rz = float(wanted)
    progress(0.7, "following the beads")
    return _paths(task, beads, places, full, threshold, rz), issues


def best_rz(task: Task, points: Points, thresholds: Array) -> tuple[float, float]:
    """The RZ (rad) with the largest smallest margin over all points, and that margin (negative: none is feasible)."""
    rough = np.linspace(-np.pi, np.pi, TRIED, endpoint=False)
    peak = rough[int(first_most(margins(task, points, thresholds, rough)))]
    near: Array = peak + np.linspace(-1.0, 1.0, FINE) * (TURN / TRIED)
    fine = margins(task, points, thresholds, near)
    return float(near[int(first_most(fine))]), float(fine.max())


def margins(task: Task, points: Points, thresholds: Array, values: Array) -> Array:
    """(C,) the smallest margin over all points for each constant RZ of values (C,)."""
    result = np.empty(len(values))
    for index, rz in enumerate(values):
        phi, _ = task.cell.phi_of_rz(points.tool, np.full(len(points), rz))
        joints = task.joints(points, phi)
        margin = float(task.rows.margin(joints).min())
        if margin >= 0.0:
            condition = task.condition(points, phi, joints)
            margin = min(margin, float(condition_margin(condition, thresholds).min()))
        result[index] = margin
    return result


def _paths(
    task: Task, beads: Sequence[Bead], places: Sequence[tuple[int, int]], points: Points, threshold: Array, rz: float
) -> list[BeadPath]:
    phi, _ = task.cell.phi_of_rz(points.tool, np.full(len(points), rz))
    phi = _counted_on(phi, points)
    joints = task.joints(points, phi)
    return bead_paths(task, beads, places, points, threshold, phi, joints, f"constant RZ {np.degrees(rz):.4f} deg")


def bead_paths(
    task: Task, beads: Sequence[Bead], places: Sequence[tuple[int, int]], points: Points, threshold: Array, phi: Array,
    joints: Array, reason: str,
) -> list[BeadPath]:
    """Paths without a polynomial, from the rotation phi (T,) and joints (T, axes) of all points."""
    condition = task.condition(points, phi, joints)
    margin = points.worst(np.minimum(task.rows.margin(joints), condition_margin(condition, threshold)))
    objective = criteria.displacement(task, points, joints)
    ends = np.append(points.first, len(points))
    return [
        BeadPath(
            layer, index, bead, phi[a:b], joints[a:b], condition[a:b], threshold[a:b], float(objective[k]),
            float(margin[k]), None, reason,
        )
        for k, (bead, (layer, index), a, b) in enumerate(zip(beads, places, ends[:-1], ends[1:]))
    ]


def _counted_on(phi: Array, points: Points) -> Array:
    step = np.diff(phi, prepend=phi[:1])
    step = shortest(step)
    step[points.first] = 0.0
    rising = np.cumsum(step)
    return np.asarray(rising + (phi[points.first] - rising[points.first])[points.bead])
