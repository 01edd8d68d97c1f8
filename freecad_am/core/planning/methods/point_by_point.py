# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point by point: the rotation with the minimum joint motion from the previous point (Chalvin 2020,
section 5.2).

All beads advance together, one point at a time. Each step is a Gauss-Newton step in the rotation,
the only unknown. If it would exceed a limit or come too close to a singularity, the full turn is
searched. Beads start at the maximum margin. The method serves for comparison: its sudden motions
are the reason to plan whole layers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...geometry.frames import TURN
from ...geometry.tie_breaking import first_most, index_of_minimum
from ...issues import Issue
from ...toolpath import Bead
from ...types import Array, Index
from ..joint_path import BeadPath
from ..points import Points, gather, unwrapped
from ..task import UNREACHABLE, Task, condition_margin
from .constant import bead_paths

Progress = Callable[[float, str], None]

CANDIDATES = 180
STEPS = 2


def plan(
    task: Task, beads: Sequence[Bead], bead_ids: Sequence[tuple[int, int]], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """Plan the paths point by point, each with the minimum motion from the previous point.

    Parameters
    ----------
    task : Task
        The plan.
    beads : sequence of Bead
        The beads in print order.
    bead_ids : Sequence[tuple[int, int]]
        Layer and index of each bead.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    paths : list of BeadPath
        The paths.
    issues : list of Issue
        Always empty.

    References
    ----------
    Chalvin 2020, section 5.2.
    """
    points = gather(beads, task.cell)
    threshold = task.thresholds(points)
    counts = np.diff(np.append(points.first, len(points)))
    arm_clearance = task.kept
    deposited = np.array(
        [0 if arm_clearance is None else arm_clearance.moment(bead_id) for bead_id in bead_ids],
        dtype=np.int64,
    )
    phi = np.zeros(len(points))
    joints = np.full((len(points), len(task.weights)), np.nan)
    for number in range(counts.max()):
        index = points.first[counts > number] + number
        current = points.select_points(index)
        if number == 0:
            phi[index], joints[index] = _searched(
                task, current, threshold[index], deposited[points.bead[index]], None
            )
            continue
        phi[index], joints[index] = _step(
            task,
            current,
            threshold[index],
            deposited[points.bead[index]],
            phi[index - 1],
            joints[index - 1],
        )
        if number % 20 == 0:
            progress(0.1 + 0.8 * number / counts.max(), "planning point by point")
    joints = task.in_range(unwrapped(joints, points), points)
    return bead_paths(task, beads, bead_ids, points, threshold, phi, joints, "point by point"), []


def _step(
    task: Task, points: Points, threshold: Array, deposited: Index, phi: Array, previous: Array
) -> tuple[Array, Array]:
    phi = phi.copy()
    for _ in range(STEPS):
        joints = _near(task, points, phi, previous)
        good = np.isfinite(joints).all(axis=1)
        if not good.any():
            break
        reachable = points.select_points(np.flatnonzero(good))
        rates, _ = task.rotation_rates(reachable.frames, phi[good], joints[good])
        motion = joints[good] - previous[good]
        curvature = (rates * rates) @ task.weights
        phi[good] -= np.clip(
            ((motion * rates) @ task.weights) / np.maximum(curvature, 1e-15), -0.2, 0.2
        )
    joints = _near(task, points, phi, previous)
    bad = _margin(task, points, phi, joints, threshold) < 0.0
    if task.kept is not None:
        bad |= task.kept.contact.touches(joints, deposited).any
    if bad.any():
        phi[bad], joints[bad] = _searched(
            task,
            points.select_points(np.flatnonzero(bad)),
            threshold[bad],
            deposited[bad],
            previous[bad],
        )
    return phi, joints


def _near(task: Task, points: Points, phi: Array, previous: Array) -> Array:
    """Return joints at phi, shifted by whole turns towards `previous`; NaN where unreachable."""
    joints = task.raw_joints(points, phi, previous)
    joints -= TURN * np.nan_to_num(np.round((joints - previous) / TURN))
    return joints


def _margin(task: Task, points: Points, phi: Array, joints: Array, threshold: Array) -> Array:
    condition = task.condition(points, phi, joints)
    return np.minimum(task.rows.margin(joints), condition_margin(condition, threshold))


def _searched(
    task: Task, points: Points, threshold: Array, deposited: Index, previous: Array | None
) -> tuple[Array, Array]:
    """Return the feasible rotation of a full turn with the minimum motion, and its joints.

    Candidates with clear links are preferred. If no candidate is feasible, use the one with the
    maximum margin. deposited: (k,) number of points printed before each point.
    """
    turn = np.arange(CANDIDATES) * (TURN / CANDIDATES) - np.pi
    phi = np.repeat(turn[:, None], len(points), axis=1)
    joints = task.raw_joints(points, phi, previous)
    if previous is None:
        joints = task.in_range(joints, points)
    else:
        joints -= TURN * np.nan_to_num(np.round((joints - previous) / TURN))
    margin = np.minimum(
        task.rows.margin(joints), condition_margin(task.condition(points, phi, joints), threshold)
    )
    if task.kept is not None:
        feasible_joints = np.where((margin >= 0.0)[..., None], joints, np.nan)
        touching = task.kept.contact.touches(
            feasible_joints.reshape(-1, feasible_joints.shape[2]), np.tile(deposited, CANDIDATES)
        ).any
        clear = (margin >= 0.0) & ~touching.reshape(margin.shape)
        margin = np.where(clear.any(axis=0) & ~clear, UNREACHABLE, margin)
    best = first_most(margin, axis=0)
    if previous is not None:
        moved = joints - previous
        motion = np.where(margin >= 0.0, (moved * moved) @ task.weights, np.inf)
        best = np.where((margin >= 0.0).any(axis=0), index_of_minimum(motion, axis=0), best)
    point_rows = np.arange(len(points))
    return phi[best, point_rows], joints[best, point_rows]
