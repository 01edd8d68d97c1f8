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
    """Loops (k,): pose and side; `elbow` 1 or -1 of whole turns, 0 of others. The angle of axis 6 is middle - half cos t, or
    middle + t of whole turns. `near`, `far`: the angles, from where the point is farthest out, at which the arm is stretched
    and folded; whether it ever is. `mean`, `swing`: mean and half the difference of squared distances from the shoulder.

    Of an arm whose axis 2 is ahead of axis 1 `near` and `far` are the angles at both ends, `stretched` and `folded` whether
    the first is where it is stretched and the last where it is folded, `mean` and `swing` 0."""

    pose: Index
    side: Array
    elbow: Array
    middle: Array
    half: Array
    near: Array
    far: Array
    stretched: Mask
    folded: Mask
    mean: Array
    swing: Array

    def of(self, some: Index) -> Loops:
        """Some of them."""
        columns: tuple[Any, ...] = self
        return Loops(*(column[some] for column in columns))


def loops_of(curves: Curves) -> Loops:
    """The loops of all poses, on both sides."""
    if curves.ahead:
        return _offset_loops(curves)
    mean, swing, out = _distances(curves)
    near = ((curves.upper + curves.fore) ** 2 - mean) / swing
    far = ((curves.upper - curves.fore) ** 2 - mean) / swing
    stretched, folded = near < 1.0, far > -1.0
    reached = (near > -1.0 - EDGE) & (far < 1.0 + EDGE)
    near_at, far_at = np.arccos(np.clip(near, -1.0, 1.0)), np.arccos(np.clip(far, -1.0, 1.0))
    whole, both = reached & ~stretched & ~folded, reached & stretched & folded
    none, middle_of, half_of = (
        np.zeros(len(mean)),
        0.5 * (near_at + far_at),
        0.5 * (far_at - near_at),
    )
    kinds = [
        (whole, 1.0, out, none),
        (whole, -1.0, out, none),
        (reached & stretched & ~folded, 0.0, out + math.pi, math.pi - near_at),
        (reached & folded & ~stretched, 0.0, out, far_at),
        (both, 0.0, out + middle_of, half_of),
        (both, 0.0, out - middle_of, -half_of),
    ]
    loops = []
    for some, elbow, at, half in kinds:
        pose = np.flatnonzero(some)
        one = np.ones(len(pose))
        of_pose = tuple[Any, ...](
            column[pose] for column in (at, half, near_at, far_at, stretched, folded, mean, swing)
        )
        loops += [Loops(pose, side * one, elbow * one, *of_pose) for side in (1.0, -1.0)]
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
    """The loops of all poses, on both sides, of an arm whose axis 2 lies ahead of axis 1."""
    found = []
    for side in (1.0, -1.0):
        pose, begin, end, stretched, folded, whole = shoulder_loops.spans(curves, side)
        one, zero = np.ones(len(pose)), np.zeros(len(whole))
        no = zero > 0.0
        none = 0.0 * one
        found.append(
            Loops(
                pose,
                side * one,
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
        found += [
            Loops(whole, zero + side, zero + elbow, *(zero,) * 4, no, no, zero, zero)
            for elbow in (1.0, -1.0)
        ]
    return Loops(*(np.concatenate(columns) for columns in zip(*found)))


def angle_along(curves: Curves, at: Loops, t: Array) -> tuple[Array, Array]:
    """The angle of axis 6 (k,) at t along loops, and sine and cosine (2, k) of the elbow's bend, exact to its last digits
    where the arm is stretched or folded."""
    whole = at.elbow != 0.0
    begun, left = np.sin(0.5 * t), np.cos(0.5 * t)
    course = begun * begun
    half = np.abs(at.half)
    since = 2.0 * half * course
    angle = np.where(whole, at.middle + t, at.middle - at.half * (1.0 - 2.0 * course))
    if curves.ahead:
        elbow = np.where(whole, at.elbow, np.where(begun * left >= 0.0, 1.0, -1.0))
        # half the way from the nearer end, and whether the arm is stretched there
        first = course <= 0.5
        since = np.where(first, at.half * course, -at.half * left * left)
        ends = np.where(first, at.near, at.far)
        stretched = np.where(first, at.stretched, ~at.folded)
        return angle, _bent_from_end(curves, at, angle, elbow, (ends, since, stretched))
    from_out = np.where(whole, t, np.where(at.stretched, at.near + since, since - half))
    scale = 1.0 / (2.0 * curves.upper * curves.fore)
    squared = at.mean + at.swing * np.cos(from_out)
    begin, end = np.sin(half * course), np.sin(half * left * left)
    # squared distances to where the arm is stretched, and to where it is folded: differences of cosines as products
    other = np.where(at.folded, np.sin(0.5 * (from_out + at.near)), end)
    to_stretched = np.where(
        at.stretched, 2.0 * at.swing * other * begin, (curves.upper + curves.fore) ** 2 - squared
    )
    other = np.where(at.stretched, np.sin(0.5 * (from_out + at.far)), begin)
    to_folded = np.where(
        at.folded, 2.0 * at.swing * other * end, squared - (curves.upper - curves.fore) ** 2
    )
    cosine = 1.0 - to_stretched * scale
    sine = scale * np.sqrt(np.maximum(to_stretched, 0.0) * np.maximum(to_folded, 0.0))
    sign = np.where(whole, at.elbow, np.where(begun * left >= 0.0, 1.0, -1.0))
    return angle, np.stack([sign * sine, cosine])


def _bent_from_end(
    curves: Curves, at: Loops, angle: Array, elbow: Array, end: tuple[Array, Array, Array]
) -> Array:
    """Sine and cosine (2, k) of the elbow's bend, exact near the end of a span: its angle, half the way since, and whether
    the arm is stretched there."""
    ends, since, stretched = end
    longest, shortest = (curves.upper + curves.fore) ** 2, (curves.upper - curves.fore) ** 2
    squared = shoulder_loops.squared_distance(curves, at.pose, angle, at.side)
    nearer = np.abs(shoulder_loops.difference(curves, at.pose, ends, since, at.side))
    free = at.elbow != 0.0
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
