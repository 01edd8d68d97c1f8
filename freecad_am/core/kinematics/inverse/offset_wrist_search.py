# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search for all zeros of one function of axis 6, for many poses of an arm with an offset wrist at
once.

The function is smooth on closed loops. If the triangle of shoulder, elbow and wrist closes at all
angles of axis 6, there is one loop of a whole turn for each elbow. Otherwise a loop goes from the
stretched arm to the other end with one elbow, and back with the other elbow. Its parameter enters
axis 6 by a cosine, which makes the square root at the ends smooth. Loops are sampled, more finely
where the arm swings fast. Zeros are searched between samples of different sign and where samples
nearly touch zero.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...types import Array, Index
from . import shoulder_loops
from .shoulder_loops import (
    TINY,
    Curves,
    Loops,
    Spot,
    angle_along,
    geometry,
    loops_of,
    plane_of,
    spot_of,
)

SAMPLES = 36
# share of a step by which samples are shifted, so that none falls where the arm is stretched or
# folded: a zero there could have either sign
SAMPLE_SHIFT = 0.37
# a step in which the arm swings fast is cut into PIECES, up to LEVELS times
PIECES, LEVELS = 8, 6
# cosine between axes 4 and 5; steps with smaller values at both ends are cut, and so are their
# pieces
FLAT_VALUES = (0.02, 4e-4)
SWING = 0.96  # cosine of the largest turn of the arm or of axis 4 in one step
ROUNDS, PEAKS = 60, 12  # iterations of the search for a zero, and for an extremum
TOUCHES = 1e-11  # cosine between axes 4 and 5; a smaller extremum counts as a zero
SAME_RAD = 1e-7  # closer zeros count as one: rounding splits a double zero by its square root


class Zeros(NamedTuple):
    """Zeros (k,) of the function.

    pose: its number. angle: of axis 6. side: 1 in front of axis 1, -1 behind it. elbow: 1 on the
    left, otherwise -1. bent: (2, k) sine and cosine of the bend of the elbow. slope: of the
    function by the angle.
    """

    pose: Index
    angle: Array
    side: Array
    elbow: Array
    bent: Array
    slope: Array


def zeros(curves: Curves) -> Zeros:
    """Return all zeros, in no particular order."""
    loops = loops_of(curves)
    t = (np.arange(-1, SAMPLES + 2) + SAMPLE_SHIFT) * (2.0 * math.pi / SAMPLES)
    return find_zeros_along(
        curves, loops, np.broadcast_to(t, (len(loops.pose), len(t))), 0, alike=True
    )


def find_zeros_along(
    curves: Curves, loops: Loops, t: Array, level: int, alike: bool = False
) -> Zeros:
    """Return the zeros between samples along loops.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    loops : Loops
        The k loops.
    t : (k, s) array
        Samples along each loop; the first and the last serve only to find extremes next to them.
    level : int
        How often the steps between samples have been cut.
    alike : bool, optional
        Whether all rows of t are the same.

    Returns
    -------
    Zeros
        The zeros, each once.
    """
    loop, low, high = _steps(curves, loops, np.arange(len(loops.pose)), t, level, alike)
    zero_loops = loops.select(loop)
    root = _refined(curves, zero_loops, low, high)
    angle, bent = angle_along(curves, zero_loops, root)
    elbow = np.where(
        zero_loops.elbow != 0.0, zero_loops.elbow, np.where(np.sin(root) >= 0.0, 1.0, -1.0)
    )
    zeros = Zeros(
        zero_loops.pose,
        angle,
        zero_loops.side,
        elbow,
        bent,
        _slope(curves, zero_loops, angle, elbow),
    )
    columns: tuple[Any, ...] = zeros
    once = _once(zeros)
    return Zeros(*(column[..., once] for column in columns))


def _once(zeros: Zeros) -> Index:
    """Return which zeros to keep so that those found twice, in a step and in one of its pieces,
    count once.
    """
    angle = zeros.angle - 2.0 * math.pi * np.round(zeros.angle / (2.0 * math.pi))
    order = np.lexsort((angle, zeros.elbow, zeros.side, zeros.pose))
    twice = np.abs(np.diff(angle[order])) < SAME_RAD
    for column in (zeros.pose, zeros.side, zeros.elbow):
        twice &= column[order][1:] == column[order][:-1]
    return np.asarray(order[np.concatenate([np.ones(min(1, len(order)), dtype=bool), ~twice])])


def values(curves: Curves, pose: Index, angle: Array, side: Array, elbow: Array) -> Array:
    """Return the function whose zeros are solutions.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    pose : (k,) int array
        Numbers of the poses.
    angle : (k,) array
        Angles of axis 6, rad.
    side : (k,) array
        1 in front of axis 1, -1 behind it.
    elbow : (k,) array
        1 for the elbow on the left, otherwise -1.

    Returns
    -------
    (k,) array
        The values.
    """
    return geometry(curves, pose, angle, side, _bent(curves, pose, angle, side, elbow)).value


def _bent(curves: Curves, pose: Index, angle: Array, side: Array, elbow: Array) -> Array:
    """Return sine and cosine (2, k) of the bend of the elbow."""
    if curves.ahead:
        squared = shoulder_loops.squared_distance(curves, pose, angle, side)
    else:
        cos, sin = np.cos(angle), np.sin(angle)
        point = [
            harmonics[0][pose] + cos * harmonics[1][pose] + sin * harmonics[2][pose]
            for harmonics in curves.point.transpose(1, 0, 2)
        ]
        squared = point[0] ** 2 + point[1] ** 2 + point[2] ** 2
    scale = 1.0 / (2.0 * curves.upper * curves.fore)
    cosine = (squared - (curves.upper**2 + curves.fore**2)) * scale
    return np.stack([elbow * np.sqrt(np.maximum(1.0 - cosine * cosine, 0.0)), cosine])


def _evaluate(curves: Curves, loops: Loops, t: Array) -> Spot:
    angle, bent = angle_along(curves, loops, t)
    return geometry(curves, loops.pose, angle, loops.side, bent)


def _sampled(curves: Curves, loops: Loops, rows: Index, t: Array, alike: bool) -> Spot:
    """Return the arm (m, s) at t (m, s) along loops `rows` (m,).

    alike: all rows of t are the same. This takes half the time of `_evaluate`, but is less accurate
    close to where the arm is stretched or folded, where there are no samples.
    """
    sample_row = t[:1] if alike else t
    course, rising = np.cos(sample_row), np.where(np.sin(sample_row) >= 0.0, 1.0, -1.0)
    pose, side, elbow, middle, half = (
        column[rows][:, None]
        for column in (loops.pose, loops.side, loops.elbow, loops.middle, loops.half)
    )
    full_circle = elbow != 0.0
    plane = plane_of(curves, pose, np.where(full_circle, middle + t, middle - half * course), side)  # type: ignore[arg-type]
    squared = plane.ahead * plane.ahead + plane.above * plane.above
    bend = (squared - (curves.upper**2 + curves.fore**2)) / (2.0 * curves.upper * curves.fore)
    bent = np.where(full_circle, elbow, rising) * np.sqrt(np.maximum(1.0 - bend * bend, 0.0))
    return spot_of(curves, plane, (bent, bend))


def _steps(
    curves: Curves, loops: Loops, rows: Index, t: Array, level: int, alike: bool = False
) -> tuple[Index, Array, Array]:
    """Return the loops (k,) and both ends (k,) of steps with a zero, from samples t (m, s) along
    loops `rows` (m,).

    The first and the last sample serve only to find extremes next to them.
    """
    spot = _sampled(curves, loops, rows, t, alike)
    value = spot.value
    above = value >= 0.0
    change = above[:, 1:] != above[:, :-1]
    steps = _touching(curves, loops, rows, t, value)
    if level < LEVELS:
        fast = _turn_cosine(spot.cosine, spot.sine) < SWING
        fast |= _turn_cosine(*spot.along) < SWING
        # steps next to fast ones are uneven too, and a flat function may cross zero more than once
        fast[:, 1:] |= fast[:, :-1]
        fast[:, :-1] |= fast[:, 1:]
        size = np.abs(value)
        if level < len(FLAT_VALUES):
            fast |= np.maximum(size[:, :-1], size[:, 1:]) < FLAT_VALUES[level]
        change &= ~fast
        fast[:, [0, -1]] = False
        row, column = np.nonzero(fast)
        if len(row):
            share = np.arange(-1, PIECES + 2) / PIECES
            finer = t[row, column][:, None] + share * (t[row, column + 1] - t[row, column])[:, None]
            finer[:, -2] = t[row, column + 1]  # identical to that of the adjacent step
            steps.append(_steps(curves, loops, rows[row], finer, level + 1))
    change[:, [0, -1]] = False
    row, column = np.nonzero(change)
    steps.append((rows[row], t[row, column], t[row, column + 1]))
    return tuple(np.concatenate(columns) for columns in zip(*steps))  # type: ignore[return-value]


def _turn_cosine(cosine: Array, sine: Array) -> Array:
    """Return the cosine (m, s - 1) of the angle between neighbouring directions (m, s)."""
    return np.asarray(cosine[:, :-1] * cosine[:, 1:] + sine[:, :-1] * sine[:, 1:])


def _touching(
    curves: Curves, loops: Loops, rows: Index, t: Array, value: Array
) -> list[tuple[Index, Array, Array]]:
    """Return steps around extremes that reach zero between samples of the same sign.

    An extreme gives two steps with one zero each, or one of zero length.
    """
    size = np.abs(value)
    same = (value[:, 1:-1] >= 0.0) == (value[:, :-2] >= 0.0)
    same &= (value[:, 1:-1] >= 0.0) == (value[:, 2:] >= 0.0)
    is_minimum = (size[:, 1:-1] <= size[:, :-2]) & (size[:, 1:-1] <= size[:, 2:])
    curve = size[:, :-2] - 2.0 * size[:, 1:-1] + size[:, 2:]
    fall = (size[:, :-2] - size[:, 2:]) ** 2 / (8.0 * np.maximum(curve, TINY))
    row, column = np.nonzero(same & is_minimum & (size[:, 1:-1] - fall < 0.25 * curve))
    if not len(row):
        return []
    loop = loops.select(rows[row])
    sign = np.where(value[row, column + 1] >= 0.0, 1.0, -1.0)
    a, b, c = t[row, column], t[row, column + 1], t[row, column + 2]
    fa, fb, fc = (sign * value[row, column + k] for k in range(3))
    for _ in range(PEAKS):
        # minimum of the parabola through three samples, kept between the outer two
        fall_left, fall_right = (b - a) * (fb - fc), (b - c) * (fb - fa)
        with np.errstate(invalid="ignore", divide="ignore"):
            x = b - 0.5 * ((b - a) * fall_left - (b - c) * fall_right) / (fall_left - fall_right)
        wide = np.where(c - b > b - a, b + 0.3 * (c - b), b - 0.3 * (b - a))
        x = np.where((x > a) & (x < c) & (np.abs(x - b) > 1e-12), x, wide)
        fx = sign * _evaluate(curves, loop, x).value
        x, fx = (
            np.where(fb < 0.0, b, x),
            np.where(fb < 0.0, fb, fx),
        )  # b is already between two zeros
        lower, right = fx < fb, x > b
        above = ~lower & (x != b)
        a = np.where(lower & right, b, np.where(above & ~right, x, a))
        fa = np.where(lower & right, fb, np.where(above & ~right, fx, fa))
        c = np.where(lower & ~right, b, np.where(above & right, x, c))
        fc = np.where(lower & ~right, fb, np.where(above & right, fx, fc))
        b, fb = np.where(lower, x, b), np.where(lower, fx, fb)
    through, touch = fb < 0.0, (fb >= 0.0) & (fb < TOUCHES)
    return [
        (rows[row][through], a[through], b[through]),
        (rows[row][through], b[through], c[through]),
        (rows[row][touch], b[touch], b[touch]),
    ]


def _refined(curves: Curves, loops: Loops, low: Array, high: Array) -> Array:
    """Return the zero t (k,) of each step by Chandrupatla's method, which stays in the step."""
    a, b = high.copy(), low.copy()
    fa, fb = _evaluate(curves, loops, a).value, _evaluate(curves, loops, b).value
    c, fc = a.copy(), fa.copy()
    share = np.full(len(a), 0.5)
    best = np.where(np.abs(fa) < np.abs(fb), a, b)
    # samples are less accurate: in a step with the same sign at both ends, one end is zero within
    # their accuracy
    active = np.flatnonzero((a != b) & (fa != 0.0) & (fb != 0.0) & ((fa >= 0.0) != (fb >= 0.0)))
    for _ in range(ROUNDS):
        if not len(active):
            break
        k = active
        x = a[k] + share[k] * (b[k] - a[k])
        fx = _evaluate(curves, loops.select(k), x).value
        same_sign = (fx >= 0.0) == (fa[k] >= 0.0)
        c[k], fc[k] = np.where(same_sign, a[k], b[k]), np.where(same_sign, fa[k], fb[k])
        b[k], fb[k] = np.where(same_sign, b[k], a[k]), np.where(same_sign, fb[k], fa[k])
        a[k], fa[k] = x, fx
        nearer = np.abs(fa[k]) < np.abs(fb[k])
        best[k] = np.where(nearer, a[k], b[k])
        width = np.abs(b[k] - a[k])
        finished = (
            (fx == 0.0) | (width <= 4e-16 * np.maximum(np.abs(a[k]), 1.0)) | (np.abs(fx) < 2e-16)
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            xi, phi = (a[k] - b[k]) / (c[k] - b[k]), (fa[k] - fb[k]) / (fc[k] - fb[k])
            bowed = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
            step = fa[k] / (fb[k] - fa[k]) * fc[k] / (fb[k] - fc[k]) + (c[k] - a[k]) / (
                b[k] - a[k]
            ) * fa[k] / (fc[k] - fa[k]) * fb[k] / (fc[k] - fb[k])
            min_share = np.minimum(
                0.5, 2e-16 * np.maximum(np.abs(a[k]), 1.0) / np.maximum(width, TINY)
            )
        share[k] = np.where(
            bowed, np.clip(np.nan_to_num(step, nan=0.5), min_share, 1.0 - min_share), 0.5
        )
        active = k[~finished]
    return best


def _slope(curves: Curves, loops: Loops, angle: Array, elbow: Array) -> Array:
    """Return the slope (k,) of the function by the angle of axis 6."""
    step = 1e-6
    ahead, behind = (
        values(curves, loops.pose, angle + offset, loops.side, elbow) for offset in (step, -step)
    )
    result: Array = (ahead - behind) / (2.0 * step)
    return result
