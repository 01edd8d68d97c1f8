# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solutions of arms with an offset wrist whose point of axes 4 and 5 is on axis 1, or next
to it.

There the position of the point no longer determines the plane of the arm, and while axis
6 sweeps the point past axis 1 the plane turns by half a turn within a few digits of its
angle. The plane is therefore taken from the condition between axes 4 and 5, two planes
for each elbow, and the angle of axis 6 is the one at which the point is in the plane.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ....geometry.angles import TURN
from ....types import Array, Index, Mask
from .search import Zeros
from .shoulder_loops import TINY, Curves, geometry

# of the length of the stretched arm: how near to axis 1 the point passes where this is done, how far from it solutions are
# taken, and within what no others are, for their planes have too few digits
PASS_SHARE, SOLVED_SHARE, NOISE_SHARE = 2e-5, 1e-3, 1e-7
SAME_RAD, SAME_SINE = 1e-7, 1e-3
MISMATCH = 1e-8  # of the cosine between axes 4 and 5: a sign that only changes with the plane's half turn is not a solution
SAMPLES, ROUNDS = 128, 40
STEP_RAD = 1e-2
PLANE_SHARE = 1e-13  # of the length of the stretched arm


def exact(curves: Curves, zeros: Zeros) -> tuple[Zeros, Array]:
    """Return zeros, exact next to axis 1, and sine and cosine (2, k) of their planes; NaN where
    the point determines the plane.
    """
    length = curves.upper + curves.fore
    row, angle = _passes(curves, length)
    if not len(row):
        return zeros, np.full((2, len(zeros.pose)), np.nan)
    solved, plane = _solved(
        curves,
        length,
        np.repeat(row, 4),
        np.repeat(angle, 4),
        np.tile([1.0, 1.0, -1.0, -1.0], len(row)),
        np.tile([1.0, -1.0], 2 * len(row)),
    )
    unreplaced = np.flatnonzero(~_replaced(curves, zeros, solved, plane, row, NOISE_SHARE * length))
    together = Zeros(
        *(
            np.concatenate([column[..., unreplaced], solved_column], axis=-1)
            for column, solved_column in zip(zeros, solved)
        )
    )
    return together, np.concatenate([np.full((2, len(unreplaced)), np.nan), plane], axis=1)


def _replaced(
    curves: Curves, zeros: Zeros, solved: Zeros, plane: Array, passing: Index, noise: float
) -> Mask:
    """Return which zeros (k,) at poses `passing` were found exactly, or have an undetermined
    plane.
    """
    is_passing = np.zeros(curves.point.shape[2], dtype=bool)
    is_passing[passing] = True
    result: Mask = is_passing[zeros.pose]
    rows = np.flatnonzero(result)
    x, y = zeros.side[rows] * _point(curves, zeros.pose[rows], zeros.angle[rows])[0][:2]
    radius = np.hypot(x, y)
    angle_gap = zeros.angle[rows, None] - solved.angle
    same = np.abs(angle_gap - TURN * np.rint(angle_gap * (1.0 / TURN))) < SAME_RAD
    for zero_column, solved_column in (
        (zeros.pose, solved.pose),
        (zeros.side, solved.side),
        (zeros.elbow, solved.elbow),
    ):
        same &= zero_column[rows, None] == solved_column
    x, y = x[:, None] - radius[:, None] * plane[1], y[:, None] - radius[:, None] * plane[0]
    same &= np.hypot(x, y) < SAME_SINE * radius[:, None]
    mismatch = np.abs(
        geometry(
            curves, zeros.pose[rows], zeros.angle[rows], zeros.side[rows], zeros.bent[:, rows]
        ).value
    )
    result[rows] = (radius < noise) | (mismatch > MISMATCH) | same.any(axis=1)
    return result


def _point(curves: Curves, pose: Index, angle: Array) -> tuple[Array, Array, Array]:
    """The point of axes 4 and 5 (3, k) and its first two derivatives by the angle of axis 6."""
    cos, sin = np.cos(angle), np.sin(angle)
    constant, by_cos, by_sin = curves.point[:, :, pose]
    around: Array = cos * by_cos + sin * by_sin
    return constant + around, cos * by_sin - sin * by_cos, -around


def _passes(curves: Curves, length: float) -> tuple[Index, Array]:
    """The pose (k,) and angle of axis 6 (k,) wherever the point passes close to axis 1."""
    centre, cos, sin = curves.point[:, :2]
    # the point is on axis 1 where the centre is the ellipse's affine map of a unit vector; its distance bounds from below
    size = np.abs(cos[0] * sin[1] - cos[1] * sin[0])
    mapped = np.hypot(
        sin[1] * centre[0] - sin[0] * centre[1], cos[0] * centre[1] - cos[1] * centre[0]
    )
    likely = np.flatnonzero(
        np.abs(mapped - size) <= PASS_SHARE * length * np.sqrt((cos * cos + sin * sin).sum(axis=0))
    )
    if not len(likely):
        return likely, np.zeros(0)
    angles = np.arange(SAMPLES) * (TURN / SAMPLES)
    points = _point(curves, likely[:, None], angles)[0]  # type: ignore[arg-type]
    radius = np.hypot(points[0], points[1])
    row, number = np.nonzero(
        (radius <= np.roll(radius, 1, axis=1)) & (radius < np.roll(radius, -1, axis=1))
    )
    pose, angle = likely[row], angles[number]
    for _ in range(ROUNDS):
        (x, y, _), (u, v, _), (du, dv, _) = _point(curves, pose, angle)
        curved = u * u + v * v + x * du + y * dv
        # only the Gauss part where the whole is not convex
        curved = np.where(curved > 0.0, curved, u * u + v * v + TINY)
        angle = angle - np.clip((x * u + y * v) / curved, -STEP_RAD, STEP_RAD)
    x, y, _ = _point(curves, pose, angle)[0]
    close = np.hypot(x, y) < PASS_SHARE * length
    return pose[close], angle[close]


def _solved(
    curves: Curves, length: float, pose: Index, angle: Array, elbow: Array, sense: Array
) -> tuple[Zeros, Array]:
    """Zeros near angles of axis 6 (k,), of an elbow 1 or -1 and one of the two ways 1 or -1 in which axis 5 is met, and sine
    and cosine (2, k) of the plane."""
    ahead, previous = np.zeros(len(pose)), (angle, np.full(len(pose), np.nan))
    for _ in range(ROUNDS):
        (x, y, above), (u, v, _), _ = _point(curves, pose, angle)
        bent, along, five, plane, sure = _plane_of_meeting(
            curves, pose, angle, ahead, above, elbow, sense
        )
        ahead = x * plane[1] + y * plane[0]
        off, slope = x * plane[0] - y * plane[1], u * plane[0] - v * plane[1]
        # the plane turns with the angle too: a secant method, once the steps allow it
        moved = angle - previous[0]
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (off - previous[1]) / moved
        slope = np.where(
            np.isfinite(secant) & (np.abs(moved) > 1e-10) & (secant * slope > 0.0), secant, slope
        )
        previous = angle, off
        angle = angle - np.clip(off / np.where(slope == 0.0, TINY, slope), -STEP_RAD, STEP_RAD)
    valid = np.flatnonzero(
        sure & (np.abs(off) < PLANE_SHARE * length) & (np.abs(ahead) < SOLVED_SHARE * length)
    )
    sweep = (x * v - y * u) / (x * x + y * y + TINY)
    rising = along[0] * (plane[1] * five[1] - plane[0] * five[0]) * sweep
    side = np.where(ahead >= 0.0, 1.0, -1.0)
    columns: tuple[Any, ...] = (pose, angle, side, elbow, bent, rising)
    return Zeros(*(column[..., valid] for column in columns)), plane[:, valid]


def _plane_of_meeting(
    curves: Curves,
    pose: Index,
    angle: Array,
    ahead: Array,
    above: Array,
    elbow: Array,
    sense: Array,
) -> tuple[Array, Array, Array, Array, Mask]:
    """Sine and cosine (2, k) of the elbow's bend, axis 4 in the plane (2, k), axis 5 (3, k), sine and cosine (2, k) of the
    plane in which they meet as they must, and where they can (k,)."""
    forward = ahead - curves.ahead
    squared = forward * forward + above * above
    bend = (squared - (curves.upper**2 + curves.fore**2)) / (2.0 * curves.upper * curves.fore)
    bent = np.stack([elbow * np.sqrt(np.maximum(1.0 - bend * bend, 0.0)), bend])
    common, turn = (
        (curves.fore + curves.upper * bend) / (squared + TINY),
        curves.upper * bent[0] / (squared + TINY),
    )
    fore = common * forward + turn * above, common * above - turn * forward
    cos, sin = curves.lean
    along = np.stack([fore[0] * cos + fore[1] * sin, fore[1] * cos - fore[0] * sin])
    constant, by_cos, by_sin = curves.five[:, :, pose]
    five = constant + np.cos(angle) * by_cos + np.sin(angle) * by_sin
    target = curves.square - along[1] * five[2]
    size = along[0] * np.hypot(five[0], five[1])
    share = target / np.where(size == 0.0, TINY, size)
    towards = np.arctan2(five[1], five[0]) + sense * np.arccos(np.clip(share, -1.0, 1.0))
    return (
        bent,
        along,
        five,
        np.stack([np.sin(towards), np.cos(towards)]),
        (np.abs(bend) <= 1.0) & (np.abs(share) <= 1.0),
    )
