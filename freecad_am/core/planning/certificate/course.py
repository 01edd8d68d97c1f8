# SPDX-License-Identifier: LGPL-2.1-or-later
"""The best course of the rotation near a known one, each point free: Newton's steps along the chain of eq. 17."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...geometry.frames import TURN, shortest
from ...types import Array, Mask
from ..points import Points
from ..task import MIN_MARGIN, Task

STEPS = 30
STARTS, VALUE_TOLERANCE = (
    24,
    1e-6,
)  # courses about a turn, and the share by which one has to be better than those before it
DIFFERENCE_STEP_RAD = 1e-5  # rad; step of the finite difference for slopes
MAX_ACTIVE_SETS, HOLD_STIFFNESS = (
    6,
    1e9,
)  # rounds that fix more points, and their stiffness in multiples of the largest curvature
MIN_STEP_SHARE = 0.02  # of a Newton step that is still tried
MIN_DECREASE = 1e-7  # share of the value by which a step has to lower it


Joints = Callable[[Array], Array]
Broken = Callable[[Array, Array], Mask]


def none_broken(phi: Array, joints: Array) -> Mask:
    """Return that no rotation is broken.

    Parameters
    ----------
    phi : (n,) array
        Tool rotations, rad.
    joints : (n, axes) array
        Joint values, not used.

    Returns
    -------
    (n,) array of bool
        False.
    """
    return np.zeros(len(phi), dtype=bool)


def descend(
    joints_at: Joints, scale: Array, phi: Array, joined: bool, broken: Broken = none_broken
) -> tuple[Array, float]:
    """Minimise the displacement along a chain of points from given rotations.

    Parameters
    ----------
    joints_at : Joints
        Returns the joints (n, axes) for rotations (n,).
    scale : (n - 1, axes) array
        Weight of the squared step of each axis.
    phi : (n,) array
        Rotations at the start, rad.
    joined : bool
        Whether the last rotation keeps its distance to the first.
    broken : Broken, optional
        Returns the points (n,) at which rotations and their joints are not allowed.

    Returns
    -------
    phi : (n,) array
        The rotations, unchanged if a start is not allowed.
    value : float
        Sum of the weighted squared steps; infinite if a start is not allowed.

    Notes
    -----
    Gauss-Newton steps along the chain of eq. 17 with numerical slopes, at most STEPS.
    """
    joints = joints_at(phi)
    if broken(phi, joints).any():
        return phi, np.inf
    moved = _steps(joints)
    value = float((moved * moved * scale).sum())
    for _ in range(STEPS):
        slope = shortest(
            joints_at(phi + DIFFERENCE_STEP_RAD) - joints_at(phi - DIFFERENCE_STEP_RAD)
        ) / (2.0 * DIFFERENCE_STEP_RAD)
        if not (np.isfinite(slope).all() and np.isfinite(moved).all()):
            break
        lower = _take_step(joints_at, scale, phi, (moved, slope), joined, broken)
        if lower is None:
            break
        phi, moved = lower
        previous, value = value, float((moved * moved * scale).sum())
        if value > (1.0 - MIN_DECREASE) * previous:
            break
    return phi, value


def _take_step(
    joints_at: Joints,
    scale: Array,
    phi: Array,
    current: tuple[Array, Array],
    joined: bool,
    broken: Broken,
) -> tuple[Array, Array] | None:
    """Take a Newton step to allowed rotations with a lower sum.

    Returns the rotations and their joint steps, or None if no step succeeds. Points that would
    break a constraint are fixed, one group after another; the others keep moving.
    """
    value, blocked = float((current[0] ** 2 * scale).sum()), np.zeros(len(phi), dtype=bool)
    for _ in range(MAX_ACTIVE_SETS):
        change = _newton(*current, scale, joined, blocked)
        size, stopped = 1.0, blocked
        while size > MIN_STEP_SHARE:
            trial = phi + size * change
            joints = joints_at(trial)
            steps, stopped = _steps(joints), broken(trial, joints)
            if not stopped.any() and float((steps * steps * scale).sum()) < value:
                return trial, steps
            size *= 0.25
        if not (stopped & ~blocked).any():
            return None
        blocked |= stopped
    return None


def best(
    joints_at: Joints,
    scale: Array,
    phi: Array,
    joined: bool,
    broken: Broken = none_broken,
) -> tuple[Array, float]:
    """Return the best result of `descend` from several starts.

    The starts are the given rotations and these turned by fractions of a turn.

    Parameters
    ----------
    joints_at : Joints
        Returns the joints (n, axes) for rotations (n,).
    scale : (n - 1, axes) array
        Weight of the squared step of each axis.
    phi : (n,) array
        Rotations at the first start, rad.
    joined : bool
        Whether the last rotation keeps its distance to the first.
    broken : Broken, optional
        Returns the points (n,) at which rotations and their joints are not allowed.

    Returns
    -------
    phi : (n,) array
        The best rotations, rad.
    value : float
        Their sum; infinite if no allowed course exists.
    """
    best_phi, best_value = phi, np.inf
    for turned in TURN / STARTS * np.arange(STARTS):
        course, value = descend(joints_at, scale, phi + turned, joined, broken)
        if value < best_value * (1.0 - VALUE_TOLERANCE):
            best_phi, best_value = course, value
    return best_phi, best_value


def _newton(moved: Array, slope: Array, scale: Array, joined: bool, is_fixed: Mask) -> Array:
    """The step (n,) of Gauss and Newton for squared steps moved (n - 1, axes) with d q / d phi (n, axes); 0 at points that
    are `is_fixed` (n,)."""
    from scipy.linalg import solveh_banded  # slow to import, and few jobs ask for a certificate

    bands = np.zeros((2, len(slope)))
    bands[1, :-1] += (slope[:-1] ** 2 * scale).sum(axis=1)
    bands[1, 1:] += (slope[1:] ** 2 * scale).sum(axis=1)
    bands[0, 1:] = -(slope[:-1] * slope[1:] * scale).sum(axis=1)
    bands[1] += 1e-9 * bands[1].mean() + 1e-300
    rate = np.zeros(len(slope))
    rate[:-1] -= (moved * slope[:-1] * scale).sum(axis=1)
    rate[1:] += (moved * slope[1:] * scale).sum(axis=1)
    bands[1, is_fixed] = HOLD_STIFFNESS * bands[1].max()
    rate[is_fixed] = 0.0
    sides = rate[:, None]
    if joined:  # what holds both ends together is a multiplier
        together = np.zeros(len(slope))
        together[0], together[-1] = 1.0, -1.0
        sides = np.stack([rate, together], axis=1)
    try:
        solved = solveh_banded(bands, sides)
    except np.linalg.LinAlgError:
        solved = sides / bands[1][:, None]
    step = -solved[:, 0]
    if joined:
        is_fixed = solved[0, 1] - solved[-1, 1]
        step -= (step[0] - step[-1]) / is_fixed * solved[:, 1]
    return np.asarray(step, dtype=np.float64)


def broken_by(task: Task, points: Points, threshold: Array, phi: Array, joints: Array) -> Mask:
    """Return at which points of a chain rotations break limits, condition or range.

    Parameters
    ----------
    task : Task
        The plan, with limits and the range of the rotation.
    points : Points
        The n points, one after the other.
    threshold : (n,) array
        Smallest condition allowed at each point.
    phi : (n,) array
        Rotations, rad.
    joints : (n, axes) array
        Their joints as the inverse gives them, NaN out of reach.

    Returns
    -------
    (n,) bool array
        True where something is broken. If a point is out of reach, only such points.
    """
    unreachable = ~np.isfinite(joints).all(axis=1)
    if unreachable.any():
        return np.asarray(unreachable)
    run = joints[0] + np.concatenate(
        [np.zeros((1, joints.shape[1])), np.cumsum(_steps(joints), axis=0)]
    )
    turns = np.round((task.middle - 0.5 * (run.min(axis=0) + run.max(axis=0))) / TURN)
    beyond = task.rows.margin(run + np.where(task.unturned, 0.0, TURN * turns)) < MIN_MARGIN
    low, high = task.parameters.rotation_range
    if high - low < TURN - 1e-9:
        beyond |= (phi < low) | (phi > high)
    return np.asarray(beyond | (task.condition(points, phi, joints) < threshold * (1.0 - 1e-9)))


def _steps(joints: Array) -> Array:
    moved: Array = shortest(np.diff(joints, axis=0))
    return moved
