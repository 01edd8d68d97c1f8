# SPDX-License-Identifier: LGPL-2.1-or-later
"""The closed loops of axis 6 along which the arm of an offset wrist closes its triangle of shoulder, elbow and wrist."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ....types import Array, Index, Mask
from . import shoulder_loops
from .plane import TINY, Curves

EDGE = 1e-12  # of the cosine of axis 6: by how much rounding may take a stretched arm out of reach


class Loops(NamedTuple):
    """Loops (k,) of axis 6.

    pose and side; `elbow` 1 or -1 for whole turns, 0 for others. The angle of axis 6 is
    middle - half cos t, or middle + t for whole turns. `near_angle`, `far_angle`: the angles,
    from where the point is farthest out, at which the arm is stretched and folded;
    `stretched`, `folded`: whether it ever is. `mean`, `swing`: mean and half the difference
    of squared distances from the shoulder.

    For an arm whose axis 2 is ahead of axis 1, `near_angle` and `far_angle` are the angles at
    both ends, `stretched` and `folded` whether it is stretched at the first and folded at the
    last, `mean` and `swing` 0.
    """

    pose: Index
    side: Array
    elbow: Array
    middle: Array
    half: Array
    near_angle: Array
    far_angle: Array
    stretched: Mask
    folded: Mask
    mean: Array
    swing: Array

    def select(self, rows: Index) -> Loops:
        """Return selected loops."""
        columns: tuple[Any, ...] = self
        return Loops(*(column[rows] for column in columns))


def loops_of(curves: Curves) -> Loops:
    """Return the loops of all poses, on both sides."""
    if curves.ahead:
        return _offset_loops(curves)
    mean, swing, out = _distances(curves)
    near_cosine = ((curves.upper + curves.fore) ** 2 - mean) / swing
    far_cosine = ((curves.upper - curves.fore) ** 2 - mean) / swing
    stretched, folded = near_cosine < 1.0, far_cosine > -1.0
    reached = (near_cosine > -1.0 - EDGE) & (far_cosine < 1.0 + EDGE)
    near_at, far_at = (
        np.arccos(np.clip(near_cosine, -1.0, 1.0)),
        np.arccos(np.clip(far_cosine, -1.0, 1.0)),
    )
    full_circle, two_arcs = reached & ~stretched & ~folded, reached & stretched & folded
    none, middle_of, half_of = (
        np.zeros(len(mean)),
        0.5 * (near_at + far_at),
        0.5 * (far_at - near_at),
    )
    kinds = [
        (full_circle, 1.0, out, none),
        (full_circle, -1.0, out, none),
        (reached & stretched & ~folded, 0.0, out + math.pi, math.pi - near_at),
        (reached & folded & ~stretched, 0.0, out, far_at),
        (two_arcs, 0.0, out + middle_of, half_of),
        (two_arcs, 0.0, out - middle_of, -half_of),
    ]
    loops = []
    for selected, elbow, middles, half in kinds:
        pose = np.flatnonzero(selected)
        ones = np.ones(len(pose))
        of_pose = tuple[Any, ...](
            column[pose]
            for column in (middles, half, near_at, far_at, stretched, folded, mean, swing)
        )
        loops += [Loops(pose, side * ones, elbow * ones, *of_pose) for side in (1.0, -1.0)]
    return Loops(*(np.concatenate(columns) for columns in zip(*loops)))


def whole_turns(curves: Curves, pose: Index, side: Array, elbow: Array) -> tuple[Loops, Array]:
    """Loops (k,) as if the arm reached all of a turn, and the angles of axis 6 at which they begin."""
    none = np.zeros(len(pose))
    mean, swing, out = (
        (none,) * 3 if curves.ahead else (column[pose] for column in _distances(curves))
    )
    return Loops(pose, side, elbow, out, none, none, none, none > 0.0, none > 0.0, mean, swing), out


def _distances(curves: Curves) -> tuple[Array, Array, Array]:
    """Mean and half the difference (n,) of squared distances from the shoulder, and the angle of the farthest."""
    constant, cos, sin = curves.point
    radius = 0.5 * ((cos * cos).sum(axis=0) + (sin * sin).sum(axis=0))
    mean = (constant * constant).sum(axis=0) + radius
    by_cos, by_sin = 2.0 * (constant * cos).sum(axis=0), 2.0 * (constant * sin).sum(axis=0)
    return mean, np.hypot(by_cos, by_sin) + TINY, np.arctan2(by_sin, by_cos)


def _offset_loops(curves: Curves) -> Loops:
    """Return the loops of all poses, on both sides, for an arm whose axis 2 is ahead of axis 1."""
    loops = []
    for side in (1.0, -1.0):
        pose, begin, end, stretched, folded, full_circles = shoulder_loops.spans(curves, side)
        ones, zero = np.ones(len(pose)), np.zeros(len(full_circles))
        no = zero > 0.0
        none = 0.0 * ones
        loops.append(
            Loops(
                pose,
                side * ones,
                none,
                0.5 * (begin + end),
                0.5 * (end - begin),
                begin,
                end,
                stretched,
                folded,
                none,
                none,
            )
        )
        loops += [
            Loops(full_circles, zero + side, zero + elbow, *(zero,) * 4, no, no, zero, zero)
            for elbow in (1.0, -1.0)
        ]
    return Loops(*(np.concatenate(columns) for columns in zip(*loops)))


def angle_along(curves: Curves, loops: Loops, t: Array) -> tuple[Array, Array]:
    """The angle of axis 6 (k,) at t along loops, and sine and cosine (2, k) of the elbow's bend, exact to its last digits
    where the arm is stretched or folded."""
    full_circle = loops.elbow != 0.0
    sine_half, cosine_half = np.sin(0.5 * t), np.cos(0.5 * t)
    course = sine_half * sine_half
    half = np.abs(loops.half)
    since = 2.0 * half * course
    angle = np.where(
        full_circle, loops.middle + t, loops.middle - loops.half * (1.0 - 2.0 * course)
    )
    if curves.ahead:
        elbow = np.where(
            full_circle, loops.elbow, np.where(sine_half * cosine_half >= 0.0, 1.0, -1.0)
        )
        # half the way from the nearer end, and whether the arm is stretched there
        first_half = course <= 0.5
        since = np.where(first_half, loops.half * course, -loops.half * cosine_half * cosine_half)
        ends = np.where(first_half, loops.near_angle, loops.far_angle)
        stretched = np.where(first_half, loops.stretched, ~loops.folded)
        return angle, _bent_from_end(curves, loops, angle, elbow, (ends, since, stretched))
    from_out = np.where(
        full_circle, t, np.where(loops.stretched, loops.near_angle + since, since - half)
    )
    scale = 1.0 / (2.0 * curves.upper * curves.fore)
    squared = loops.mean + loops.swing * np.cos(from_out)
    begin, end = np.sin(half * course), np.sin(half * cosine_half * cosine_half)
    # squared distances to where the arm is stretched, and to where it is folded: differences of cosines as products
    factor = np.where(loops.folded, np.sin(0.5 * (from_out + loops.near_angle)), end)
    to_stretched = np.where(
        loops.stretched,
        2.0 * loops.swing * factor * begin,
        (curves.upper + curves.fore) ** 2 - squared,
    )
    factor = np.where(loops.stretched, np.sin(0.5 * (from_out + loops.far_angle)), begin)
    to_folded = np.where(
        loops.folded, 2.0 * loops.swing * factor * end, squared - (curves.upper - curves.fore) ** 2
    )
    cosine = 1.0 - to_stretched * scale
    sine = scale * np.sqrt(np.maximum(to_stretched, 0.0) * np.maximum(to_folded, 0.0))
    sign = np.where(full_circle, loops.elbow, np.where(sine_half * cosine_half >= 0.0, 1.0, -1.0))
    return angle, np.stack([sign * sine, cosine])


def _bent_from_end(
    curves: Curves, loops: Loops, angle: Array, elbow: Array, end: tuple[Array, Array, Array]
) -> Array:
    """Sine and cosine (2, k) of the elbow's bend, exact near the end of a span: its angle, half the way since, and whether
    the arm is stretched there."""
    ends, since, stretched = end
    longest, shortest = (curves.upper + curves.fore) ** 2, (curves.upper - curves.fore) ** 2
    squared = shoulder_loops.squared_distance(curves, loops.pose, angle, loops.side)
    nearer = np.abs(shoulder_loops.difference(curves, loops.pose, ends, since, loops.side))
    free = loops.elbow != 0.0
    to_stretched = np.where(free | ~stretched, longest - squared, nearer)
    to_folded = np.where(free | stretched, squared - shortest, nearer)
    scale = 1.0 / (2.0 * curves.upper * curves.fore)
    sine = scale * np.sqrt(np.maximum(to_stretched, 0.0) * np.maximum(to_folded, 0.0))
    return np.stack(
        [
            elbow * sine,
            np.where(stretched | free, 1.0 - to_stretched * scale, to_folded * scale - 1.0),
        ]
    )
