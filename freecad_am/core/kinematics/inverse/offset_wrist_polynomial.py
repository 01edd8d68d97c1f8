# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solutions of arms with an offset wrist as zeros of a trigonometric polynomial of the angle of
axis 6.

Seen from axis 1 at the height of the shoulder, let p = (x, y, z) be the point of axes 4 and 5, and
d = (dx, dy, dz) the direction of axis 5, both functions of the angle of axis 6. Let H = x dx +
y dy, and R with R^2 = x^2 + y^2, positive in front of axis 1 and negative at the back. Axis 2 is
`a` ahead of axis 1. In the arm's plane, p is at (R - a, z) from axis 2, at a squared distance D,
and d is (H / R, dz). The forearm is (C p + T p') / D, where p' is p rotated by 90 deg, C = (D +
fore^2 - upper^2) / (2 fore) and T^2 = D - C^2. Axis 4 is the forearm rotated by the lean, whose
cosine is c and sine s. The cosine between axes 4 and 5 is q. With

S = R (H + z dz) - a H,  N = z H - R^2 dz + a R dz,  X = c S + s N,  Y = c N - s S,  M =
H^2 + R^2 dz^2

the condition is C X + T Y - q D R = 0. Its product over both elbows, divided by D, is

g = C^2 M - Y^2 - 2 q R C X + q^2 D R^2.

Out of reach T^2 < 0. There the product is that of a number and its conjugate, and so positive.
Each zero of g is therefore one solution. Its T = (q D R - C X) / Y needs no square root, and is
as accurate near the stretched arm as elsewhere.

D and C are of degree 1 in R and in cosine and sine, R^2 and H are of degree 2. So g = A + R B with
trigonometric polynomials A of degree 4 and B of degree 3. The zeros of A^2 - R^2 B^2, of degree 8,
are those in front and at the back: the 16 solutions of six joints. Where a, s and q are 0, as for
CRX and HC10, B is 0, and each zero of A is one solution in front and one at the back.
`trigonometric_zeros` isolates the zeros. Where two are too close to each other for that,
`offset_wrist_search` finds the zeros of the pose too.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...geometry.frames import TURN
from ...types import Array, Index, Mask
from . import offset_wrist_search
from . import trigonometric_zeros as trigonometric
from .offset_wrist_search import SAME_RAD, Zeros
from .shoulder_loops import EDGE, TINY, Curves, whole_turns

NEWTON, NEWTON_RAD = 12, 5e-10  # the flange rotations have this error
SAME_AS_SEARCHED_RAD = 1e-6  # zeros of the search closer than this to one found here are the same
TWICE_RAD = 4e-6  # distance to other zeros within which the polynomial only touches zero
MEETS = 2e-10  # cosine between axes 4 and 5; if off by more, the zero is of another side or elbow
NEAR_AXIS = (
    3e-4  # share of the length of the stretched arm; closer to axis 1 the search is more accurate
)
SQUARE = 1e-13  # sine of an angle that must be right or straight


class _Lengths(NamedTuple):
    """Lengths `upper`, `fore` and `ahead` as shares of the length of the stretched arm.

    cos, sin: of the lean. square: cosine between axes 4 and 5.
    """

    upper: float
    fore: float
    ahead: float
    cos: float
    sin: float
    square: float


class _Terms(NamedTuple):
    """R, D, C, X, Y, g and the slope of g; see the module docstring."""

    radius: Array
    squared: Array
    common: Array
    level: Array
    across: Array
    value: Array
    slope: Array


def is_even(curves: Curves) -> bool:
    """Return whether solutions in front and at the back have the same angles of axis 6."""
    return not curves.ahead and abs(curves.lean[1]) < SQUARE and abs(curves.square) < SQUARE


def zeros(curves: Curves) -> Zeros:
    """Return all zeros, in no particular order, as `offset_wrist_search.zeros` does."""
    length = 1.0 / (curves.upper + curves.fore)
    arm = _Lengths(
        curves.upper * length,
        curves.fore * length,
        curves.ahead * length,
        *curves.lean,
        curves.square,
    )
    harmonics = np.stack([curves.point * length, curves.five])
    even = is_even(curves)
    number, low, high, bounds_near, close, touching, drowned = trigonometric.isolate_zeros(
        _coefficients(arm, harmonics, even)
    )
    of_zero = np.take(harmonics, number, axis=3)
    side = np.ones(len(number)) if even else _side(arm, of_zero, low, high)
    angle, sure, distance = _roots(arm, of_zero, side, low, high, bounds_near)
    close[number[~sure | (distance < NEAR_AXIS)]] = True
    if not sure.all():
        # where three zeros meet, rounding moves them by more than the tolerance
        moved = np.flatnonzero(~sure)
        touching = (
            np.concatenate([touching[0], number[moved]]),
            np.concatenate([touching[1], angle[moved]]),
        )
        sure_rows = np.flatnonzero(sure)
        number = number[sure_rows]
        angle = angle[sure_rows]
        side = side[sure_rows]
        of_zero = of_zero[..., sure_rows]
    solutions = _solutions(arm, of_zero, number, angle, side)
    if even:
        solutions = _both_sides(solutions)
    doubtful = np.flatnonzero(close)
    if not len(doubtful):
        return solutions
    searched = offset_wrist_search.zeros(
        Curves(
            curves.point[:, :, doubtful],
            curves.five[:, :, doubtful],
            curves.upper,
            curves.fore,
            curves.lean,
            curves.square,
            curves.ahead,
        )
    )
    solutions = _merge_zeros(solutions, searched._replace(pose=doubtful[searched.pose]), close)
    solutions = _add_zeros(solutions, _touching(arm, curves, harmonics, *touching))
    return (
        _add_zeros(solutions, zeros_without_digits(curves, *drowned))
        if len(drowned[0])
        else solutions
    )


def _touching(
    arm: _Lengths, curves: Curves, harmonics: Array, number: Index, angle: Array
) -> Zeros:
    """Return the solutions where the polynomial touches zero without a change of sign, if they
    reproduce their pose.
    """
    even = is_even(curves)
    # on either side of axis 1
    side = np.repeat([1.0] if even else [1.0, -1.0], len(number))
    number, angle = np.tile(number, 1 if even else 2), np.tile(angle, 1 if even else 2)
    solutions = _solutions(arm, np.take(harmonics, number, axis=3), number, angle, side)
    if even:
        solutions = _both_sides(solutions)
    off = np.abs(
        offset_wrist_search.values(
            curves, solutions.pose, solutions.angle, solutions.side, solutions.elbow
        )
    )
    valid, columns = np.flatnonzero(off < MEETS), tuple[Any, ...](solutions)
    return Zeros(*(column[..., valid] for column in columns))


def _add_zeros(zeros: Zeros, extra: Zeros) -> Zeros:
    """Return the zeros, and additional ones that are not among them, each once."""
    for k in range(len(extra.pose)):
        same = (
            (zeros.pose == extra.pose[k])
            & (zeros.side == extra.side[k])
            & (zeros.elbow == extra.elbow[k])
        )
        angle_gap = zeros.angle[same] - extra.angle[k]
        if not (np.abs(angle_gap - TURN * np.rint(angle_gap * (1.0 / TURN))) < TWICE_RAD).any():
            zeros = Zeros(
                *(
                    np.concatenate([zero_column, extra_column[..., k : k + 1]], axis=-1)
                    for zero_column, extra_column in zip(zeros, extra)
                )
            )
    return zeros


def _merge_zeros(zeros: Zeros, searched: Zeros, close: Mask) -> Zeros:
    """Merge zeros found here with those of the search at `close` poses (n,), each once."""
    sure = np.flatnonzero(~close[zeros.pose])
    unsure = np.flatnonzero(close[zeros.pose])
    same = np.ones((len(unsure), len(searched.pose)), dtype=bool)
    for zero_column, searched_column in (
        (zeros.pose, searched.pose),
        (zeros.side, searched.side),
        (zeros.elbow, searched.elbow),
    ):
        same &= zero_column[unsure, None] == searched_column
    angle_gap = zeros.angle[unsure, None] - searched.angle
    same &= np.abs(angle_gap - TURN * np.rint(angle_gap * (1.0 / TURN))) < SAME_AS_SEARCHED_RAD
    unmatched = np.concatenate([sure, unsure[~same.any(axis=1)]])
    return Zeros(
        *(
            np.concatenate([zero_column[..., unmatched], searched_column], axis=-1)
            for zero_column, searched_column in zip(zeros, searched)
        )
    )


def _coefficients(arm: _Lengths, harmonics: Array, even: bool) -> Array:
    """Return the coefficients (9 or 17, n) of the polynomial.

    harmonics: constant, cosine and sine parts of point and axis 5 (2, 3, 3, n).
    """
    degree = 4 if even else 8
    nodes = 2 * degree + 2
    node_angles = trigonometric.angles(nodes)
    basis = np.stack([np.ones(nodes), np.cos(node_angles), np.sin(node_angles)], axis=1)
    point, five = (
        [basis @ np.ascontiguousarray(harmonic[:, k]) for k in range(3)] for harmonic in harmonics
    )
    constant_part, by_radius, flat = _halves(arm, point, five)
    value: Array = (
        constant_part if even else constant_part * constant_part - flat * by_radius * by_radius
    )
    weights = np.where(np.arange(2 * degree + 1) == 0, 1.0, 2.0) / nodes
    result: Array = (trigonometric.harmonics(degree, node_angles) * weights[:, None]) @ value
    return result


def _halves(arm: _Lengths, point: list[Array], five: list[Array]) -> tuple[Array, Array, Array]:
    """Return A, B and R^2, for points and axes 5 given as components."""
    (x, y, z), (five_x, five_y, up) = point, five
    flat = x * x + y * y
    within = x * five_x + y * five_y
    rise = z * within - flat * up
    level = within + z * up
    # C, X and Y as a constant and a factor of R
    common = (flat + z * z + (arm.ahead**2 + arm.fore**2 - arm.upper**2)) * (0.5 / arm.fore)
    factor = -arm.ahead / arm.fore
    squared = common * common + (factor * factor) * flat
    across = arm.cos * rise + (arm.sin * arm.ahead) * within
    by_across = (arm.cos * arm.ahead) * up - arm.sin * level
    sizes = within * within + flat * up * up
    constant_part = squared * sizes - across * across - flat * by_across * by_across
    by_radius = 2.0 * (factor * common * sizes - across * by_across)
    if arm.square:
        # terms in q, then those in q^2
        out = arm.sin * rise - (arm.cos * arm.ahead) * within
        by_out = (arm.sin * arm.ahead) * up + arm.cos * level
        constant_part -= (2.0 * arm.square) * flat * (common * by_out + factor * out)
        by_radius -= (2.0 * arm.square) * (common * out + factor * by_out * flat)
        constant_part += arm.square**2 * flat * (flat + z * z + arm.ahead**2)
        by_radius -= (2.0 * arm.square**2 * arm.ahead) * flat
    return constant_part, by_radius, flat


def _side(arm: _Lengths, harmonics: Array, low: Array, high: Array) -> Array:
    """Return 1 where the zero of a step is in front of axis 1, -1 where it is at the back, and 0
    where this is undecided.
    """
    ends = []
    for angle in (low, high):
        point, five = _evaluate(harmonics, np.cos(angle), np.sin(angle))
        constant_part, by_radius, flat = _halves(arm, list(point), list(five))
        by_radius *= np.sqrt(flat)
        ends.append((constant_part + by_radius >= 0.0, constant_part - by_radius >= 0.0))
    front, back = (at_low != at_high for at_low, at_high in zip(*ends))
    result: Array = front.astype(float) - back
    return result


def _evaluate(harmonics: Array, cos: Array, sin: Array) -> Array:
    """Return point and axis 5: (2, 3, k)."""
    result: Array = harmonics[:, 1] * cos
    result += harmonics[:, 2] * sin
    result += harmonics[:, 0]
    return result


def _terms(arm: _Lengths, harmonics: Array, angle: Array, side: Array) -> _Terms:
    """Return the terms at angles (k,) on a side of axis 1; harmonics (2, 3, 3, k)."""
    cos, sin = np.cos(angle), np.sin(angle)
    (x, y, z), (five_x, five_y, up) = _evaluate(harmonics, cos, sin)
    moved = harmonics[:, 2] * cos
    moved -= harmonics[:, 1] * sin
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
    level_ = within_ + z_ * up + z * up_
    rise_ = z_ * within + z * within_ - 2.0 * half_flat_ * up - flat * up_
    # S and N
    out, out_ = radius * level, radius_ * level + radius * level_
    if arm.ahead:
        out, out_ = out - arm.ahead * within, out_ - arm.ahead * within_
        rise = rise + arm.ahead * radius * up
        rise_ = rise_ + arm.ahead * (radius_ * up + radius * up_)
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
    arm: _Lengths, harmonics: Array, side: Array, low: Array, high: Array, first_guess: Array
) -> tuple[Array, Mask, Array]:
    """Return the zero of each step, whether it was found, and its distance from axis 1: (k,) each.

    Newton's method is used, kept within the step.
    """
    angle = first_guess.copy()
    step = np.full(len(first_guess), np.inf)
    radii = np.zeros(len(first_guess))
    active, active_harmonics, its_side = np.arange(len(first_guess)), harmonics, side
    if not side.all():
        active = np.flatnonzero(side)
        active_harmonics, its_side = harmonics[..., active], side[active]
    for _ in range(NEWTON):
        terms = _terms(arm, active_harmonics, angle[active], its_side)
        moved = terms.value / np.where(terms.slope == 0.0, TINY, terms.slope)
        step[active], radii[active] = moved, np.abs(terms.radius)
        angle[active] = np.clip(angle[active] - moved, low[active], high[active])
        going = np.flatnonzero(np.abs(moved) > NEWTON_RAD)
        if not len(going):
            break
        if 2 * len(going) < len(active):
            # most have converged, so continue with the others only
            active = active[going]
            active_harmonics = active_harmonics[..., going]
            its_side = its_side[going]
    return angle, np.abs(step) <= NEWTON_RAD, radii


def _solutions(arm: _Lengths, harmonics: Array, pose: Index, angle: Array, side: Array) -> Zeros:
    """Return the solutions at zeros of the polynomial."""
    terms = _terms(arm, harmonics, angle, side)
    target = arm.square * terms.squared * terms.radius
    level = terms.common * terms.level
    turn = (target - level) / np.where(terms.across == 0.0, TINY, terms.across)
    # far from the stretched arm, the height of the point in the triangle is more accurate
    height = np.sqrt(np.maximum(terms.squared - terms.common * terms.common, 0.0))
    turn = np.where(
        np.abs(terms.radius) * height > np.abs(terms.across), np.copysign(height, turn), turn
    )
    bent = np.stack([turn, terms.common - arm.fore]) * (1.0 / arm.upper)
    by_angle = 0.5 * terms.slope / np.where(level == target, TINY, (level - target) * terms.radius)
    return Zeros(pose, angle, side, np.where(turn >= 0.0, 1.0, -1.0), bent, by_angle)


def _both_sides(front: Zeros) -> Zeros:
    """Return the solutions in front of axis 1 and those at the back at the same angles."""
    pose, angle, side, elbow, bent, slope = (
        np.concatenate([column, column], axis=-1) for column in front
    )
    count = len(front.pose)
    side[count:] *= -1.0
    elbow[count:] *= -1.0
    bent[0, count:] *= -1.0
    return Zeros(pose, angle, side, elbow, bent, slope)


# ---- Zeros in spans of axis 6 where the polynomial is as small as the rounding error
#
# There the point of axes 4 and 5 passes close to axis 1, or several solutions nearly coincide. The
# polynomial is a product of the conditions for both sides and both elbows, and is inaccurate where
# more than one of them is small. The condition for one side and one elbow stays accurate, and is
# sampled here, because `offset_wrist_search` covers a whole turn and misses such narrow features.

SAMPLES = 24  # samples of a span, finer where the condition is nearly zero
# level of the search from which steps are cut: samples of a span are as close as those of its first
# pieces
SEARCH_LEVEL = 1


def zeros_without_digits(curves: Curves, pose: Index, low: Array, high: Array) -> Zeros:
    """Return all zeros that samples of spans show, in no particular order.

    Both sides of axis 1 and both elbows are searched.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    pose : (k,) int array
        Pose of each span.
    low, high : (k,) array
        Ends of the spans, angles of axis 6 in rad.

    Returns
    -------
    Zeros
        The zeros.
    """
    pose, low, high = _merge_spans(pose, low, high)
    span = np.repeat(np.arange(len(pose)), 4)
    side, elbow = (
        np.tile(signs, len(pose)) for signs in ([1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0])
    )
    loops, begin = whole_turns(curves, pose[span], side, elbow)
    # one more sample at both ends, to find extremes next to them
    share = np.arange(-1, SAMPLES + 2) / SAMPLES
    t = (low[span] - begin)[:, None] + share * (high - low)[span, None]
    samples = offset_wrist_search.find_zeros_along(curves, loops, t, SEARCH_LEVEL)
    reached = np.abs(samples.bent[1]) <= 1.0 + EDGE
    columns: tuple[Any, ...] = samples
    return Zeros(*(column[..., reached] for column in columns))


def _merge_spans(pose: Index, low: Array, high: Array) -> tuple[Index, Array, Array]:
    """Merge spans of the same pose that overlap or touch."""
    order = np.lexsort((low, pose))
    pose, low, high = pose[order], low[order], high[order]
    is_first = np.ones(len(pose), dtype=bool)
    is_first[1:] = (pose[1:] != pose[:-1]) | (low[1:] > high[:-1] + SAME_RAD)
    begins = np.flatnonzero(is_first)
    return pose[begins], low[begins], np.maximum.reduceat(high, begins)
