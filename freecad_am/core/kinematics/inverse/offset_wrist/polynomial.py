# SPDX-License-Identifier: LGPL-2.1-or-later
"""All solutions of arms with an offset wrist, from a trigonometric polynomial of the angle of axis 6.

Seen from axis 1 at the shoulder's height, with p the point of axes 4 and 5 and d the direction of axis 5, both functions of
the angle of axis 6: H = x dx + y dy, and R, R^2 = x^2 + y^2, is positive in front of axis 1 and negative at the back. Axis 2
is `a` ahead of axis 1. In the arm's plane axis 2 sees p at (R - a, z), at a squared distance D; d is (H / R, dz) there. The
forearm is (C p + T p') / D, where p' is p turned by 90 deg, C = (D + fore^2 - upper^2) / (2 fore) and T^2 = D - C^2. Axis 4
is the forearm turned by the lean, cosine c and sine s, and has the cosine q with axis 5. With

    S = R (H + z dz) - a H,  N = z H - R^2 dz + a R dz,  X = c S + s N,  Y = c N - s S,  M = H^2 + R^2 dz^2

that reads C X + T Y - q D R = 0. The product for both elbows, by D, is

    g = C^2 M - Y^2 - 2 q R C X + q^2 D R^2.

Outside of reach T^2 < 0, where the product is that of a number and its conjugate and positive. So each zero of g is one
solution, and its T = (q D R - C X) / Y follows without a root, as exact near the stretched arm as elsewhere.

D and C are of degree 1 in R and in cosine and sine, R^2 and H are of degree 2; so g = A + R B, where A is a trigonometric
polynomial of degree 4 and B one of degree 3. A^2 - R^2 B^2, of degree 8, has the zeros in front and at the back, the 16
solutions of six joints. Where a, s and q are 0, as of CRX and HC10, B is 0, and each zero of A is a solution in front and
one at the back. `trigonometric_zeros` parts them. Where two are too near to each other for that, `search` looks
for those of the pose too.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ....geometry.angles import TURN
from ....types import Array, Index, Mask
from . import flat as without_digits
from . import search
from . import trigonometric_zeros as trigonometric
from .plane import TINY, Curves
from .search import Zeros

NEWTON, NEWTON_RAD = 12, 5e-10  # turns of the flange that follow are off by as much
SAME_RAD = 1e-6  # nearer zeros that the search finds are those found here
TWICE_RAD = 4e-6  # as near to others are zeros at which the polynomial only touches zero
MEETS = 2e-10  # of the cosine between axes 4 and 5, which is off where such a touch is none of this side or elbow
NEAR_AXIS = 3e-4  # of the length of the stretched arm: nearer to axis 1 the search has more digits
SQUARE = 1e-13  # sine of the angles that must be square or straight


class _Lengths(NamedTuple):
    """Upper arm, forearm and `ahead` in the length of the stretched arm; cosine and sine of the lean; `square`."""

    upper: float
    fore: float
    ahead: float
    cos: float
    sin: float
    square: float


class _Terms(NamedTuple):
    """See the head of this file: R, D, C, X, Y, g and the slope of g."""

    radius: Array
    squared: Array
    common: Array
    level: Array
    across: Array
    value: Array
    slope: Array


def is_even(curves: Curves) -> bool:
    """Whether the arm's solutions in front and at the back are at the same angles of axis 6."""
    return not curves.ahead and abs(curves.lean[1]) < SQUARE and abs(curves.square) < SQUARE


def zeros(curves: Curves) -> Zeros:
    """All zeros, in no order, as of `search.zeros`."""
    length = 1.0 / (curves.upper + curves.fore)
    arm = _Lengths(
        curves.upper * length,
        curves.fore * length,
        curves.ahead * length,
        *curves.lean,
        curves.square,
    )
    parts = np.stack([curves.point * length, curves.five])
    even = is_even(curves)
    number, low, high, near, close, touching, drowned = trigonometric.parted(
        _coefficients(arm, parts, even)
    )
    of_zero = np.take(parts, number, axis=3)
    side = np.ones(len(number)) if even else _side(arm, of_zero, low, high)
    angle, sure, away = _roots(arm, of_zero, side, low, high, near)
    close[number[~sure | (away < NEAR_AXIS)]] = True
    if not sure.all():
        # where three meet, rounding moves a zero by more than is asked for
        moved = np.flatnonzero(~sure)
        touching = (
            np.concatenate([touching[0], number[moved]]),
            np.concatenate([touching[1], angle[moved]]),
        )
        kept = np.flatnonzero(sure)
        number, angle, side, of_zero = number[kept], angle[kept], side[kept], of_zero[..., kept]
    found = _solutions(arm, of_zero, number, angle, side)
    if even:
        found = _both_sides(found)
    left = np.flatnonzero(close)
    if not len(left):
        return found
    others = search.zeros(
        Curves(
            curves.point[:, :, left],
            curves.five[:, :, left],
            curves.upper,
            curves.fore,
            curves.lean,
            curves.square,
            curves.ahead,
        )
    )
    found = _together(found, others._replace(pose=left[others.pose]), close)
    found = _with(found, _touching(arm, curves, parts, *touching))
    return _with(found, without_digits.zeros(curves, *drowned)) if len(drowned[0]) else found


def _touching(arm: _Lengths, curves: Curves, parts: Array, number: Index, angle: Array) -> Zeros:
    """Solutions where the polynomial touches zero and no sign changes, those of them that give back their pose."""
    even = is_even(curves)
    # on either side of axis 1
    side = np.repeat([1.0] if even else [1.0, -1.0], len(number))
    number, angle = np.tile(number, 1 if even else 2), np.tile(angle, 1 if even else 2)
    found = _solutions(arm, np.take(parts, number, axis=3), number, angle, side)
    if even:
        found = _both_sides(found)
    off = np.abs(search.values(curves, found.pose, found.angle, found.side, found.elbow))
    kept, columns = np.flatnonzero(off < MEETS), tuple[Any, ...](found)
    return Zeros(*(column[..., kept] for column in columns))


def _with(found: Zeros, more: Zeros) -> Zeros:
    """Zeros, and those of some more that are none of them, each once."""
    for k in range(len(more.pose)):
        same = (
            (found.pose == more.pose[k])
            & (found.side == more.side[k])
            & (found.elbow == more.elbow[k])
        )
        apart = found.angle[same] - more.angle[k]
        if not (np.abs(apart - TURN * np.rint(apart * (1.0 / TURN))) < TWICE_RAD).any():
            found = Zeros(
                *(
                    np.concatenate([own, other[..., k : k + 1]], axis=-1)
                    for own, other in zip(found, more)
                )
            )
    return found


def _together(found: Zeros, others: Zeros, close: Mask) -> Zeros:
    """Zeros found here, and those of the search at poses (n,) that are `close`, each once."""
    sure = np.flatnonzero(~close[found.pose])
    unsure = np.flatnonzero(close[found.pose])
    same = np.ones((len(unsure), len(others.pose)), dtype=bool)
    for own, other in (
        (found.pose, others.pose),
        (found.side, others.side),
        (found.elbow, others.elbow),
    ):
        same &= own[unsure, None] == other
    apart = found.angle[unsure, None] - others.angle
    same &= np.abs(apart - TURN * np.rint(apart * (1.0 / TURN))) < SAME_RAD
    kept = np.concatenate([sure, unsure[~same.any(axis=1)]])
    return Zeros(
        *(np.concatenate([own[..., kept], other], axis=-1) for own, other in zip(found, others))
    )


def _coefficients(arm: _Lengths, parts: Array, even: bool) -> Array:
    """Of the polynomial (9 or 17, n), for constant, cosine and sine parts of point and axis 5 (2, 3, 3, n)."""
    degree = 4 if even else 8
    nodes = 2 * degree + 2
    at = trigonometric.angles(nodes)
    first = np.stack([np.ones(nodes), np.cos(at), np.sin(at)], axis=1)
    point, five = ([first @ np.ascontiguousarray(part[:, k]) for k in range(3)] for part in parts)
    whole, by_radius, flat = _halves(arm, point, five)
    value: Array = whole if even else whole * whole - flat * by_radius * by_radius
    weights = np.where(np.arange(2 * degree + 1) == 0, 1.0, 2.0) / nodes
    result: Array = (trigonometric.harmonics(degree, at) * weights[:, None]) @ value
    return result


def _halves(arm: _Lengths, point: list[Array], five: list[Array]) -> tuple[Array, Array, Array]:
    """A, B and R^2, for points and axes 5 by their components."""
    (x, y, z), (five_x, five_y, up) = point, five
    flat = x * x + y * y
    within = x * five_x + y * five_y
    rise = z * within - flat * up
    level = within + z * up
    # C, X and Y by constant and factor of R
    common = (flat + z * z + (arm.ahead**2 + arm.fore**2 - arm.upper**2)) * (0.5 / arm.fore)
    factor = -arm.ahead / arm.fore
    squared = common * common + (factor * factor) * flat
    across, by_across = (
        arm.cos * rise + (arm.sin * arm.ahead) * within,
        (arm.cos * arm.ahead) * up - arm.sin * level,
    )
    sizes = within * within + flat * up * up
    whole = squared * sizes - across * across - flat * by_across * by_across
    by_radius = 2.0 * (factor * common * sizes - across * by_across)
    if arm.square:
        # what is multiplied by q, then what by its square
        out, by_out = (
            arm.sin * rise - (arm.cos * arm.ahead) * within,
            (arm.sin * arm.ahead) * up + arm.cos * level,
        )
        whole -= (2.0 * arm.square) * flat * (common * by_out + factor * out)
        by_radius -= (2.0 * arm.square) * (common * out + factor * by_out * flat)
        whole += arm.square**2 * flat * (flat + z * z + arm.ahead**2)
        by_radius -= (2.0 * arm.square**2 * arm.ahead) * flat
    return whole, by_radius, flat


def _side(arm: _Lengths, parts: Array, low: Array, high: Array) -> Array:
    """1 where the zero of a step is one in front of axis 1, -1 where it is one at the back, 0 where this cannot be told."""
    ends = []
    for angle in (low, high):
        point, five = _turned(parts, np.cos(angle), np.sin(angle))
        whole, by_radius, flat = _halves(arm, list(point), list(five))
        by_radius *= np.sqrt(flat)
        ends.append((whole + by_radius >= 0.0, whole - by_radius >= 0.0))
    front, back = (one != other for one, other in zip(*ends))
    result: Array = front.astype(float) - back
    return result


def _turned(parts: Array, cos: Array, sin: Array) -> Array:
    """Point and axis 5 (2, 3, k)."""
    result: Array = parts[:, 1] * cos
    result += parts[:, 2] * sin
    result += parts[:, 0]
    return result


def _terms(arm: _Lengths, parts: Array, angle: Array, side: Array) -> _Terms:
    """Of points and axes 5 (2, 3, 3, k) at angles (k,), on a side of axis 1."""
    cos, sin = np.cos(angle), np.sin(angle)
    (x, y, z), (five_x, five_y, up) = _turned(parts, cos, sin)
    moved = parts[:, 2] * cos
    moved -= parts[:, 1] * sin
    (x_, y_, z_), (five_x_, five_y_, up_) = moved
    flat = x * x + y * y
    radius = side * (np.sqrt(flat) + TINY)
    half_flat_ = x * x_ + y * y_
    radius_ = half_flat_ / radius
    within, within_ = x * five_x + y * five_y, x_ * five_x + x * five_x_ + y_ * five_y + y * five_y_
    squared = flat + z * z - (2.0 * arm.ahead) * radius + arm.ahead**2
    common = (squared + (arm.fore**2 - arm.upper**2)) * (0.5 / arm.fore)
    common_ = (half_flat_ + z * z_ - arm.ahead * radius_) * (1.0 / arm.fore)
    level, rise = within + z * up, z * within - flat * up
    level_, rise_ = (
        within_ + z_ * up + z * up_,
        z_ * within + z * within_ - 2.0 * half_flat_ * up - flat * up_,
    )
    # S and N
    out, out_ = radius * level, radius_ * level + radius * level_
    if arm.ahead:
        out, out_ = out - arm.ahead * within, out_ - arm.ahead * within_
        rise, rise_ = (
            rise + arm.ahead * radius * up,
            rise_ + arm.ahead * (radius_ * up + radius * up_),
        )
    ahead, across = arm.cos * out + arm.sin * rise, arm.cos * rise - arm.sin * out
    across_ = arm.cos * rise_ - arm.sin * out_
    sizes = within * within + flat * up * up
    half_sizes_ = within * within_ + up * (half_flat_ * up + flat * up_)
    value = common * common * sizes - across * across
    slope = 2.0 * (common * (common_ * sizes + common * half_sizes_) - across * across_)
    if arm.square:
        ahead_ = arm.cos * out_ + arm.sin * rise_
        product, product_ = radius * common, radius_ * common + radius * common_
        value -= arm.square * (2.0 * product * ahead - arm.square * squared * flat)
        slope -= (2.0 * arm.square) * (
            product_ * ahead
            + product * ahead_
            - arm.square * (arm.fore * common_ * flat + squared * half_flat_)
        )
    return _Terms(radius, squared, common, ahead, across, value, slope)


def _roots(
    arm: _Lengths, parts: Array, side: Array, low: Array, high: Array, near: Array
) -> tuple[Array, Mask, Array]:
    """The zero (k,) in each step, whether it was found, and how far from axis 1: Newton's method, kept in the step."""
    angle, step, away = near.copy(), np.full(len(near), np.inf), np.zeros(len(near))
    active, some, its_side = np.arange(len(near)), parts, side
    if not side.all():
        active = np.flatnonzero(side)
        some, its_side = parts[..., active], side[active]
    for _ in range(NEWTON):
        at = _terms(arm, some, angle[active], its_side)
        moved = at.value / np.where(at.slope == 0.0, TINY, at.slope)
        step[active], away[active] = moved, np.abs(at.radius)
        angle[active] = np.clip(angle[active] - moved, low[active], high[active])
        going = np.flatnonzero(np.abs(moved) > NEWTON_RAD)
        if not len(going):
            break
        if 2 * len(going) < len(active):
            # most are there: go on with the others alone
            active, some, its_side = active[going], some[..., going], its_side[going]
    return angle, np.abs(step) <= NEWTON_RAD, away


def _solutions(arm: _Lengths, parts: Array, pose: Index, angle: Array, side: Array) -> Zeros:
    """The solutions at zeros of the polynomial."""
    at = _terms(arm, parts, angle, side)
    wanted = arm.square * at.squared * at.radius
    level = at.common * at.level
    turn = (wanted - level) / np.where(at.across == 0.0, TINY, at.across)
    # far from the stretched arm its height in the triangle has the more digits of the two
    height = np.sqrt(np.maximum(at.squared - at.common * at.common, 0.0))
    turn = np.where(np.abs(at.radius) * height > np.abs(at.across), np.copysign(height, turn), turn)
    bent = np.stack([turn, at.common - arm.fore]) * (1.0 / arm.upper)
    by_angle = 0.5 * at.slope / np.where(level == wanted, TINY, (level - wanted) * at.radius)
    return Zeros(pose, angle, side, np.where(turn >= 0.0, 1.0, -1.0), bent, by_angle)


def _both_sides(found: Zeros) -> Zeros:
    """Solutions in front of axis 1, and those at the back at the same angles."""
    pose, angle, side, elbow, bent, slope = (
        np.concatenate([column, column], axis=-1) for column in found
    )
    count = len(found.pose)
    side[count:] *= -1.0
    elbow[count:] *= -1.0
    bent[0, count:] *= -1.0
    return Zeros(pose, angle, side, elbow, bent, slope)
