# SPDX-License-Identifier: LGPL-2.1-or-later
"""Two revolute axes that turn one direction to another (Dai 2020, section 3).

Solve Rot(first, q1) Rot(second, q2) source = target for any two unit axes that are not parallel.
Let v = Rot(second, q2) source. Its components along both axes are known: v . second =
source . second and v . first = target . first. The remaining component is normal to both axes, with
either sign. This gives two solutions, one if they coincide, and none if the components along the
axes are too long. It is solution 1 of the paper, for axes of any direction. Solution 2 goes through
the vertical and rotates about X and Z twice. It exists for every pair of directions, but needs more
than two axes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry import frames
from ...geometry.columns import columns
from ...types import Array, Mask

POLE = 1e-9  # sine of the angle to an axis below which the rotation about it is free
ROUNDING = 1e-12  # tolerance for a square that rounding makes negative


class Turns(NamedTuple):
    """Angles about the first and second axis, with one row per branch.

    first_turn, second_turn: (2, n) rad in (-pi, pi]; NaN without a real solution. first_free,
    second_free: (n,) whether rotation about the axis has no effect, because target or source is
    along it; the angle is then 0.
    """

    first_turn: Array
    second_turn: Array
    first_free: Mask
    second_free: Mask


def solve_turns(first_axis: Array, second_axis: Array, source: Array, target: Array) -> Turns:
    """Return the rotations about two axes that turn source to target directions.

    Parameters
    ----------
    first_axis, second_axis : (3,) array
        Unit axes at zero; the second is nearer to the source.
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.

    Returns
    -------
    Turns
        Angles of both branches.

    References
    ----------
    Dai 2020, section 3.2, solution 1.
    """
    target = np.broadcast_to(target, source.shape)
    across = np.cross(first_axis, second_axis)
    square, cosine = float(across @ across), float(first_axis @ second_axis)
    p, q = target @ first_axis, source @ second_axis
    # v = a first + b second + c across
    a, b = (p - cosine * q) / square, (q - cosine * p) / square
    squared = (1.0 - (a * a + b * b + 2.0 * a * b * cosine)) / square
    with np.errstate(invalid="ignore"):
        c = np.sqrt(np.where((squared < 0.0) & (squared > -ROUNDING), 0.0, squared))
    plane = a[:, None] * first_axis + b[:, None] * second_axis
    between_ = np.stack([plane + c[:, None] * across, plane - c[:, None] * across])
    first_free, second_free = _on(target, first_axis), _on(source, second_axis)
    angle_first = np.where(first_free, 0.0 * squared, _angle(first_axis, between_, target))
    angle_second = np.where(second_free, 0.0 * squared, _angle(second_axis, source, between_))
    unreal = np.isnan(c)
    angle_first[:, unreal], angle_second[:, unreal] = np.nan, np.nan
    return Turns(angle_first, angle_second, first_free, second_free)


class ByVertical(NamedTuple):
    """Rotations from source to target through the vertical.

    gamma, alpha: (n,) rad, with Rx(alpha) Rz(gamma) source = Z. alpha_back, gamma_back: (n,) rad,
    with Rz(gamma_back) Rx(alpha_back) Z = target.
    """

    gamma: Array
    alpha: Array
    alpha_back: Array
    gamma_back: Array


def by_vertical(source: Array, target: Array) -> ByVertical:
    """Turn one direction to another through the vertical.

    Solution 2 of Dai 2020, section 3.2, corrected (ERRATA): gamma = atan2(X, Y), alpha = acos(Z),
    and the same for the way back.

    Parameters
    ----------
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.

    Returns
    -------
    ByVertical
        Angles to the vertical, and from there to the target, rad.
    """
    target = np.broadcast_to(target, source.shape)
    gamma, back = (np.arctan2(v[0], v[1]) for v in (columns(source), columns(target)))
    up, down = (np.arctan2(np.hypot(v[0], v[1]), v[2]) for v in (columns(source), columns(target)))
    return ByVertical(gamma, up, -down, -back)


class Locked(NamedTuple):
    """Result for a locked axis.

    angle: (n,) of the other axis, rad. residual: (n,) angle between the directions, rad.
    """

    angle: Array
    residual: Array


def lock_first(
    first_axis: Array, second_axis: Array, angle: Array | float, source: Array, target: Array
) -> Locked:
    """Solve for the second axis, with a given angle of the first axis.

    Parameters
    ----------
    first_axis, second_axis : (3,) array
        Unit axes.
    angle : float or (n,) array
        Angle of the first axis, rad.
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.

    Returns
    -------
    Locked
        Angle of the second axis, and residual.
    """
    target = np.broadcast_to(target, source.shape)
    turned = frames.rotation_about(first_axis, -np.broadcast_to(angle, len(source)))
    return nearest(second_axis, source, np.einsum("nij,nj->ni", turned, target))


def lock_second(
    first_axis: Array, second_axis: Array, angle: Array | float, source: Array, target: Array
) -> Locked:
    """Solve for the first axis, with a given angle of the second axis.

    Parameters
    ----------
    first_axis, second_axis : (3,) array
        Unit axes.
    angle : float or (n,) array
        Angle of the second axis, rad.
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.

    Returns
    -------
    Locked
        Angle of the first axis, and residual.
    """
    target = np.broadcast_to(target, source.shape)
    turned = frames.rotation_about(second_axis, np.broadcast_to(angle, len(source)))
    return nearest(first_axis, np.einsum("nij,nj->ni", turned, source), target)


def minimise_residual(
    first_axis: Array,
    second_axis: Array,
    locked: int,
    source: Array,
    target: Array,
    low: float,
    high: float,
) -> float:
    """Return the angle of a locked axis with the smallest maximum residual.

    Parameters
    ----------
    first_axis, second_axis : (3,) array
        Unit axes.
    locked : int
        The locked axis, 0 or 1.
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.
    low, high : float
        Range of the angle, rad.

    Returns
    -------
    float
        The angle, rad.

    Notes
    -----
    The other axis compensates all but the angle between a direction and that axis. The residual is
    therefore the difference of these angles: of source and Rot(first, -angle) target to the second
    axis, or of Rot(second, angle) source and target to the first axis.
    """
    target = np.broadcast_to(target, source.shape)

    def worst(angles: Array) -> Array:
        if locked == 0:
            stands = _heights(target, first_axis, second_axis, -angles)
            turns = source @ second_axis
        else:
            stands = _heights(source, second_axis, first_axis, angles)
            turns = target @ first_axis
        residuals = (
            np.arccos(np.clip(stands, -1.0, 1.0)) - np.arccos(np.clip(turns, -1.0, 1.0))[:, None]
        )
        largest: Array = np.abs(residuals).max(axis=0)
        return largest

    for steps in (
        361,
        *[21] * 8,
    ):  # search the whole range, because there may be several local minima; then refine
        angles = np.linspace(low, high, steps)
        best = float(angles[int(np.argmin(worst(angles) + 1e-9 * np.abs(angles)))])
        width = 2.0 * (high - low) / (steps - 1)
        low, high = max(low, best - width), min(high, best + width)
    return best


def _heights(vectors: Array, axis: Array, other_axis: Array, angles: Array) -> Array:
    """Return other_axis . Rot(axis, angle) vector (n, k) for vectors (n, 3) and angles (k,).

    Rodrigues' formula.
    """
    along = (vectors @ axis) * float(axis @ other_axis)
    straight, sideways = vectors @ other_axis - along, vectors @ np.cross(other_axis, axis)
    turned: Array = (
        along[:, None] + straight[:, None] * np.cos(angles) + sideways[:, None] * np.sin(angles)
    )
    return turned


def nearest(axis: Array, source: Array, target: Array) -> Locked:
    """Return the rotation about an axis that turns directions as close as possible to targets.

    Parameters
    ----------
    axis : (3,) array
        Unit axis.
    source : (n, 3) array
        Unit vectors to turn.
    target : (n, 3) or (3,) array
        Unit vectors to reach.

    Returns
    -------
    Locked
        Angle, 0 if a vector is along the axis, and residual.
    """
    target = np.broadcast_to(target, source.shape)
    free = _on(source, axis) | _on(target, axis)
    angle = np.where(free, 0.0, _angle(axis, source, target))
    met = np.einsum("nij,nj->ni", frames.rotation_about(axis, angle), source)
    missed = np.arctan2(np.linalg.norm(np.cross(met, target), axis=1), (met * target).sum(axis=1))
    return Locked(angle, missed)


def _on(vectors: Array, axis: Array) -> Mask:
    on: Mask = np.linalg.norm(np.cross(vectors, axis), axis=-1) < POLE
    return on


def _angle(axis: Array, start: Array, end: Array) -> Array:
    """Return the rotation (..., n) about an axis between the components of two vectors normal to
    the axis.
    """
    sine = np.cross(start, end) @ axis
    cosine = (start * end).sum(axis=-1) - (start @ axis) * (end @ axis)
    angle: Array = np.arctan2(sine, cosine)
    return angle
