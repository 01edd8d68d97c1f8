# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point by point: at each point the rotation that moves the joints least from the point before (Chalvin 2020, 5.2).

All beads go forward together, one point at a time. Each step is a Gauss-Newton step of the one unknown; where
it would break a limit or come too near a singularity, the whole turn is searched. Beads start where the
margin is largest. Kept for comparison: the sudden moves it makes are why layers are planned as a whole.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...geometry.angles import TURN
from ...geometry.ties import first_least, first_most
from ...issues import Issue
from ...toolpath import Bead
from ...types import Array, Index
from ..joint_path import BeadPath
from ..limit_rows import UNREACHABLE
from ..points import Points, gather, unwrapped
from ..task import Task, condition_margin
from .constant import bead_paths

Progress = Callable[[float, str], None]

CANDIDATES = 180
STEPS = 2


def plan(
    task: Task, beads: Sequence[Bead], places: Sequence[tuple[int, int]], progress: Progress
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths of all beads, each point judged against the point before."""
    points = gather(beads, task.cell)
    threshold = task.thresholds(points)
    counts = np.diff(np.append(points.first, len(points)))
    kept = task.kept
    deposited = np.array(
        [0 if kept is None else kept.moment(place) for place in places], dtype=np.int64
    )
    phi = np.zeros(len(points))
    joints = np.full((len(points), len(task.weights)), np.nan)
    for number in range(counts.max()):
        index = points.first[counts > number] + number
        at = points.each(index)
        if number == 0:
            phi[index], joints[index] = _searched(
                task, at, threshold[index], deposited[points.bead[index]], None
            )
            continue
        phi[index], joints[index] = _step(
            task,
            at,
            threshold[index],
            deposited[points.bead[index]],
            phi[index - 1],
            joints[index - 1],
        )
        if number % 20 == 0:
            progress(0.1 + 0.8 * number / counts.max(), "going from point to point")
    joints = task.in_range(unwrapped(joints, points), points)
    return bead_paths(task, beads, places, points, threshold, phi, joints, "point by point"), []


def _step(
    task: Task, at: Points, threshold: Array, deposited: Index, phi: Array, before: Array
) -> tuple[Array, Array]:
    phi = phi.copy()
    for _ in range(STEPS):
        joints = _near(task, at, phi, before)
        good = np.isfinite(joints).all(axis=1)
        if not good.any():
            break
        part = at.each(np.flatnonzero(good))
        rates, _ = task.rotation_rates(part.frames, phi[good], joints[good])
        away = joints[good] - before[good]
        curvature = (rates * rates) @ task.weights
        phi[good] -= np.clip(
            ((away * rates) @ task.weights) / np.maximum(curvature, 1e-15), -0.2, 0.2
        )
    joints = _near(task, at, phi, before)
    bad = _margin(task, at, phi, joints, threshold) < 0.0
    if task.kept is not None:
        bad |= task.kept.contact.touches(joints, deposited).any
    if bad.any():
        phi[bad], joints[bad] = _searched(
            task, at.each(np.flatnonzero(bad)), threshold[bad], deposited[bad], before[bad]
        )
    return phi, joints


def _near(task: Task, at: Points, phi: Array, before: Array) -> Array:
    """Joints at phi in the turns nearest to the joints before; NaN where unreachable."""
    joints = task.raw_joints(at, phi, before)
    joints -= TURN * np.nan_to_num(np.round((joints - before) / TURN))
    return joints


def _margin(task: Task, at: Points, phi: Array, joints: Array, threshold: Array) -> Array:
    condition = task.condition(at, phi, joints)
    return np.minimum(task.rows.margin(joints), condition_margin(condition, threshold))


def _searched(
    task: Task, at: Points, threshold: Array, deposited: Index, before: Array | None
) -> tuple[Array, Array]:
    """The best of a whole turn of candidates: the least motion among the feasible, of these among those with which links are
    clear, where there are any; else the largest margin. laid: (k,) how many points of the deposit are there."""
    turn = np.arange(CANDIDATES) * (TURN / CANDIDATES) - np.pi
    phi = np.repeat(turn[:, None], len(at), axis=1)
    joints = task.raw_joints(at, phi, before)
    if before is None:
        joints = task.in_range(joints, at)
    else:
        joints -= TURN * np.nan_to_num(np.round((joints - before) / TURN))
    margin = np.minimum(
        task.rows.margin(joints), condition_margin(task.condition(at, phi, joints), threshold)
    )
    if task.kept is not None:
        looked = np.where((margin >= 0.0)[..., None], joints, np.nan)
        near = task.kept.contact.touches(
            looked.reshape(-1, looked.shape[2]), np.tile(deposited, CANDIDATES)
        ).any
        clear = (margin >= 0.0) & ~near.reshape(margin.shape)
        margin = np.where(clear.any(axis=0) & ~clear, UNREACHABLE, margin)
    best = first_most(margin, axis=0)
    if before is not None:
        away = joints - before
        motion = np.where(margin >= 0.0, (away * away) @ task.weights, np.inf)
        best = np.where((margin >= 0.0).any(axis=0), first_least(motion, axis=0), best)
    each = np.arange(len(at))
    return phi[best, each], joints[best, each]
