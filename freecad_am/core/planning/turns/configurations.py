# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solution tracking for arms with several solutions per configuration.

Along a bead, each point takes the solution nearest to the previous point, among the solutions in
the requested configuration.
"""

from __future__ import annotations

import numpy as np

from ...geometry.frames import shortest
from ...kinematics.inverse.serial_arm import SerialArm
from ...types import Array
from ..points import Points


def along_beads(arm: SerialArm, flange: Array, branch: int, points: Points) -> Array:
    """Return joints tracked from the first point of each bead.

    Parameters
    ----------
    arm : SerialArm
        An arm with several solutions per configuration.
    flange : (R, T, 4, 4) array
        Flange poses, base_link.
    branch : int
        Configuration index.
    points : Points
        The T points.

    Returns
    -------
    (R, T, axes) array
        Joints; a bead starts with the least singular solution. NaN without a solution.
    """
    found, several = _bearing(arm, flange, branch)
    joints: Array = found[0]
    if not several:
        return joints
    counts = np.diff(np.append(points.first, len(points)))
    for number in range(1, int(counts.max())):
        index = points.first[counts > number] + number
        joints[:, index] = _nearest(found[:, :, index], joints[:, index - 1])
    return joints


def from_before(arm: SerialArm, flange: Array, branch: int, before: Array) -> Array:
    """Return the joints nearest to previous joints.

    Parameters
    ----------
    arm : SerialArm
        An arm with several solutions per configuration.
    flange : (..., 4, 4) array
        Flange poses, base_link.
    branch : int
        Configuration index.
    before : (..., axes) array
        Previous joints, rad; leading dimensions broadcast.

    Returns
    -------
    (..., axes) array
        Joints, rad; NaN without a solution.
    """
    found, several = _bearing(arm, flange, branch)
    first: Array = found[0]
    return _nearest(found, np.broadcast_to(before, first.shape)) if several else first


def step_by_step(arm: SerialArm, flange: Array, branch: int, before: Array) -> Array:
    """Return joints tracked through sequences of moves.

    Parameters
    ----------
    arm : SerialArm
        An arm with several solutions per configuration.
    flange : (k, moves, 4, 4) array
        Flange poses, base_link.
    branch : int
        Configuration index.
    before : (k, axes) array
        Joints before the first move, rad.

    Returns
    -------
    (k, moves, axes) array
        Joints, rad; NaN without a solution.
    """
    found, several = _bearing(arm, flange, branch)
    joints: Array = found[0]
    if several:
        for move in range(joints.shape[1]):
            before = joints[:, move] = _nearest(found[:, :, move], before)
    return joints


def _bearing(arm: SerialArm, flange: Array, branch: int) -> tuple[Array, bool]:
    """Return the solutions (solutions, ..., axes) in the configuration, and whether any pose has
    several.

    The least singular solution comes first. Solutions in other configurations are NaN.
    """
    lead = flange.shape[:-2]
    joints, words = arm.solutions(flange.reshape(-1, 4, 4))
    bearing = words == branch
    several = bool((bearing.sum(axis=0) > 1).any())
    if not several:
        return joints[branch].reshape(1, *lead, joints.shape[-1]), False
    joints = np.where(bearing[..., None], joints, np.nan)
    order = [branch, *(k for k in range(len(joints)) if k != branch and bearing[k].any())]
    return joints[order].reshape(len(order), *lead, joints.shape[-1]), True


def _nearest(found: Array, before: Array) -> Array:
    """Select the solution nearest to the joints `before` (..., axes), up to whole turns.

    found: (solutions, ..., axes). If `before` is unknown, take the first solution.
    """
    step = found - before
    step = shortest(step)
    away = (step * step).sum(axis=-1)
    best = np.argmin(np.where(np.isnan(away), np.inf, away), axis=0)
    return np.asarray(np.take_along_axis(found, best[None, ..., None], axis=0)[0])
