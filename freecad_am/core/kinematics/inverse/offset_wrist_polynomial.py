# SPDX-License-Identifier: LGPL-2.1-or-later
"""All solutions of arms whose axis 4 runs along the forearm and square to axis 5, such as CRX and HC10, from a polynomial.

Seen from where axis 2 meets axis 1, with p the point of axes 4 and 5 and d the direction of axis 5, both functions of the
angle of axis 6: D = p p, P = p d, H = x dx + y dy, r^2 = x^2 + y^2, N = z H - r^2 dz. The forearm is (C p + T p') / D, where
p' is p turned by 90 deg in the arm's plane, C = (D + fore^2 - upper^2) / (2 fore) and T^2 = D - C^2. That axis 5 is square
to it reads C P r + T N = 0 in front of axis 1, C P r - T N = 0 at the back. The product of both, by D, is

    g = C^2 M - N^2,  M = H^2 + r^2 dz^2,

a trigonometric polynomial of degree 4: p and d turn together, so D and P are of degree 1, N = z P - D dz and
M = P^2 - 2 P z dz + D dz^2, whose highest terms cancel, of degree 2. Its eight zeros are the 16 solutions of six joints:
outside of reach D - C^2 < 0 and g > 0, so each zero is a solution in front and one at the back, and T = -C P r / N follows
without a root, as exact near the stretched arm as elsewhere.

Zeros are parted by bounds: in a step of h, |g| is at least its least at the ends less h^2 / 8 of the most of |g''|, so the
step has no zero where that is positive, and one at most where the same of g' and g''' is. What neither tells is cut into
pieces; where two zeros are still too near to each other `offset_wrist_search` looks for those of the pose too.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...geometry.angles import TURN
from ...types import Array, Index, Mask
from . import offset_wrist_search as search
from .offset_wrist_plane import TINY, Curves
from .offset_wrist_search import Zeros

DEGREE = 4
NODES, BOUNDS, STEPS = 10, 32, 80  # angles of axis 6: that give the polynomial, that bound its derivatives, that part zeros
PIECES, LEVELS = 12, 5  # into which undecided steps are cut, and how often
NEWTON, NEWTON_RAD = 12, 1e-7
SAME_RAD = 1e-6  # nearer zeros that the search finds are those found here
SQUARE = 1e-13  # sine of the angles that must be square or straight


def _angles(count: int) -> Array:
    return np.arange(count) * (2.0 * math.pi / count)


def _harmonics(angle: Array, derivative: int) -> Array:
    """Rows (9, m) of 1, cosines and sines of 1 to 4 times angles (m,), or of a derivative of these."""
    order = np.arange(DEGREE + 1)[:, None]
    # a derivative turns by a quarter and multiplies
    turned = order * angle + 0.5 * math.pi * derivative
    rows: Array = np.concatenate([np.cos(turned), np.sin(turned)[1:]]) * np.concatenate([order, order[1:]]) ** derivative
    return rows


FIRST = np.stack([np.ones(NODES), np.cos(_angles(NODES)), np.sin(_angles(NODES))])
TO_COEFFICIENTS = _harmonics(_angles(NODES), 0).T * np.where(np.arange(2 * DEGREE + 1) == 0, 1.0, 2.0) / NODES
GRID, GRID_SLOPE = (_harmonics(np.append(_angles(STEPS), 2.0 * math.pi), k) for k in (0, 1))
BENDS = [_harmonics(_angles(BOUNDS), k) / math.cos(DEGREE * math.pi / BOUNDS) for k in (2, 3)]


class _Terms(NamedTuple):
    """What the polynomial is made of, in the length of the stretched arm; see the head of this file."""

    x: Array
    y: Array
    z: Array
    radius: Array  # r
    squared: Array  # D
    along: Array  # P
    common: Array  # C
    across: Array  # N
    value: Array  # g


def applies(curves: Curves) -> bool:
    """Whether the arm is of the kind that this file is about."""
    return not curves.ahead and abs(curves.lean[1]) < SQUARE and abs(curves.square) < SQUARE


def zeros(curves: Curves) -> Zeros:
    """All zeros, in no order, as of `offset_wrist_search.zeros`."""
    length = 1.0 / (curves.upper + curves.fore)
    node = _terms(curves, length, *(parts.transpose(1, 2, 0) @ FIRST for parts in (curves.point * length, curves.five)))
    coefficients = node.value @ TO_COEFFICIENTS
    pose, low, high, close = _parted(coefficients)
    angle, slope, converged = _roots(curves, length, coefficients, pose, low, high)
    close[pose[~converged]] = True
    found = _both_sides(curves, length, pose[converged], angle[converged], slope[converged])
    left = np.flatnonzero(close)
    if not len(left):
        return found
    others = search.zeros(Curves(curves.point[:, :, left], curves.five[:, :, left], curves.upper, curves.fore, curves.lean,
                                 curves.square))
    return _together(found, others._replace(pose=left[others.pose]), close)


def _together(found: Zeros, others: Zeros, close: Mask) -> Zeros:
    """Zeros found here, and those of the search at poses (n,) that are `close`, each once."""
    sure = np.flatnonzero(~close[found.pose])
    unsure = np.flatnonzero(close[found.pose])
    same = np.ones((len(unsure), len(others.pose)), dtype=bool)
    for own, other in ((found.pose, others.pose), (found.side, others.side), (found.elbow, others.elbow)):
        same &= own[unsure, None] == other
    apart = found.angle[unsure, None] - others.angle
    same &= np.abs(apart - TURN * np.rint(apart * (1.0 / TURN))) < SAME_RAD
    kept = np.concatenate([sure, unsure[~same.any(axis=1)]])
    return Zeros(*(np.concatenate([own[..., kept], other], axis=-1) for own, other in zip(found, others)))


def _terms(curves: Curves, length: float, point: Array, five: Array) -> _Terms:
    """Of points and axes 5 by their components (3, ...)."""
    x, y, z = point
    upper, fore = curves.upper * length, curves.fore * length
    flat = x * x + y * y
    squared = flat + z * z
    within = x * five[0] + y * five[1]
    common = (squared + (fore * fore - upper * upper)) * (0.5 / fore)
    across = z * within - flat * five[2]
    value = common * common * (within * within + flat * five[2] * five[2]) - across * across
    return _Terms(x, y, z, np.sqrt(flat), squared, within + z * five[2], common, across, value)


def _terms_at(curves: Curves, length: float, pose: Index, angle: Array) -> _Terms:
    cos, sin = np.cos(angle), np.sin(angle)
    point, five = (parts[0][:, pose] + cos * parts[1][:, pose] + sin * parts[2][:, pose]
                   for parts in (curves.point, curves.five))
    return _terms(curves, length, point * length, five)


def _parted(coefficients: Array) -> tuple[Index, Array, Array, Mask]:
    """The pose (k,) and ends (k,), (k,) of steps with one zero, and the poses (n,) some of whose zeros are too near to each
    other to tell."""
    bend, third = (np.abs(coefficients @ rows).max(axis=1) for rows in BENDS)
    width = 2.0 * math.pi / STEPS
    values, slopes = coefficients @ GRID, coefficients @ GRID_SLOPE
    values[:, -1], slopes[:, -1] = values[:, 0], slopes[:, 0]
    row, at, open_row, open_at = _decided(values, slopes, bend, third, width)
    found = [(row, at * width, (at + 1) * width)]
    pose, begin, ends = open_row, open_at * width, values[open_row[:, None], open_at[:, None] + np.array([0, 1])]
    for _ in range(1, LEVELS):
        width /= PIECES
        share = np.arange(PIECES + 1) * width
        values, slopes = _polynomial(coefficients[pose].T[..., None], begin[:, None] + share)
        values[:, 0], values[:, -1] = ends.T  # to the last digit as in the steps beside
        row, at, open_row, open_at = _decided(values, slopes, bend[pose], third[pose], width)
        found.append((pose[row], begin[row] + share[at], begin[row] + share[at + 1]))
        ends = values[open_row[:, None], open_at[:, None] + np.array([0, 1])]
        pose, begin = pose[open_row], begin[open_row] + share[open_at]
    close = np.zeros(len(coefficients), dtype=bool)
    close[pose] = True
    pose, low, high = (np.concatenate(columns) for columns in zip(*found))
    return pose, low, high, close


def _decided(values: Array, slopes: Array, bend: Array, third: Array, width: float) -> tuple[Index, Index, Index, Index]:
    """Row and number of the steps that hold one zero, then of those that cannot be told, from values and slopes (m, s) at
    their ends and the most of the second and third derivative (m,)."""
    sagging = 0.125 * width * width
    near = np.abs(values) <= (sagging * bend)[:, None]
    steep = np.abs(slopes) > (sagging * third)[:, None]
    above, rising = values >= 0.0, slopes >= 0.0
    change = above[:, 1:] != above[:, :-1]
    unclear = near[:, 1:] | near[:, :-1] | change
    single = steep[:, 1:] & steep[:, :-1] & (rising[:, 1:] == rising[:, :-1])
    unclear &= ~single
    change &= single
    return *np.nonzero(change), *np.nonzero(unclear)  # type: ignore[return-value]


def _polynomial(coefficients: Array, angle: Array) -> tuple[Array, Array]:
    """The polynomial and its slope at angles; coefficients (9, ...)."""
    cos, sin = np.cos(angle), np.sin(angle)
    c, s = cos, sin
    value = coefficients[0] + coefficients[1] * c + coefficients[DEGREE + 1] * s
    slope = coefficients[DEGREE + 1] * c - coefficients[1] * s
    for order in range(2, DEGREE + 1):
        c, s = c * cos - s * sin, s * cos + c * sin
        value += coefficients[order] * c + coefficients[DEGREE + order] * s
        slope += order * (coefficients[DEGREE + order] * c - coefficients[order] * s)
    return value, slope


def _roots(
    curves: Curves, length: float, coefficients: Array, pose: Index, low: Array, high: Array
) -> tuple[Array, Array, Mask]:
    """The zero (k,) in each step, the slope there, and whether it was found: Newton's method, kept in the step. The last
    step takes the value from the arm itself, which has more digits than the polynomial where its parts are small."""
    of_pose = np.ascontiguousarray(coefficients[pose].T)
    angle, slope, step = 0.5 * (low + high), np.zeros(len(pose)), np.full(len(pose), np.inf)
    active = np.arange(len(pose))
    for _ in range(NEWTON):
        value, slope[active] = _polynomial(of_pose[:, active], angle[active])
        step[active] = value / np.where(slope[active] == 0.0, TINY, slope[active])
        angle[active] = np.clip(angle[active] - step[active], low[active], high[active])
        active = active[np.abs(step[active]) > NEWTON_RAD]
        if not len(active):
            break
    value = _terms_at(curves, length, pose, angle).value
    last = value / np.where(slope == 0.0, TINY, slope)
    converged = (np.abs(step) <= NEWTON_RAD) & (np.abs(last) < NEWTON_RAD)
    return angle - np.where(converged, last, 0.0), slope, converged


def _both_sides(curves: Curves, length: float, pose: Index, angle: Array, slope: Array) -> Zeros:
    """The solutions in front and at the back that belong to zeros of the polynomial, with the polynomial's slope there."""
    at = _terms_at(curves, length, pose, angle)
    upper, fore = curves.upper * length, curves.fore * length
    level = at.common * at.along * at.radius
    turn = -level / np.where(at.across == 0.0, TINY, at.across)
    # far from the stretched arm its height in the triangle has the more digits of the two
    height = np.sqrt(np.maximum(at.squared - at.common * at.common, 0.0))
    turn = np.where(at.radius * height > np.abs(at.across), np.copysign(height, turn), turn)
    sine, cosine = turn / upper, (at.common - fore) / upper
    by_angle = 0.5 * curves.lean[0] * slope / np.where(level == 0.0, TINY, level * at.radius)
    one = np.ones(len(pose))
    elbow = np.where(turn >= 0.0, 1.0, -1.0)
    return Zeros(
        np.concatenate([pose, pose]), np.concatenate([angle, angle]), np.concatenate([one, -one]),
        np.concatenate([elbow, -elbow]), np.stack([np.concatenate([sine, -sine]), np.concatenate([cosine, cosine])]),
        np.concatenate([by_angle, by_angle]),
    )
