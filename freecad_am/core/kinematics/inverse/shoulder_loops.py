# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ranges of axis 6 in which the triangle of shoulder, elbow and wrist closes.

For an arm whose axis 2 is ahead of axis 1, the squared distance of the point of axes 4 and 5 from
axis 2 contains a square root. Squared once more, the angles where the arm is stretched or folded
are zeros of a trigonometric polynomial of degree 2, found as eigenvalues of a 4 x 4 matrix.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...geometry.frames import TURN
from ...types import Array, Index, Mask

TINY = 1e-150


@dataclass(frozen=True, eq=False)
class Curves:
    """Geometry of n poses, mm.

    `point` (3, 3, n) and `five` (3, 3, n) are functions of axis 6: the point where axes 4 and 5
    meet, relative to axis 1 at the height of the shoulder, and the direction of axis 5. The first
    index selects the constant, cosine or sine part, the second the component. `lean` holds cosine
    and sine of the angle from the forearm to axis 4, `square` is the cosine between axes 4 and 5.
    Axis 2 is `ahead` of axis 1.
    """

    point: Array
    five: Array
    upper: float
    fore: float
    lean: tuple[float, float]
    square: float
    ahead: float = 0.0


class Spot(NamedTuple):
    """The arm at given angles of axis 6 (k,).

    sine, cosine: of the plane. ahead, above: the point in the plane. fore_ahead, fore_above: the
    direction from elbow to point. five: components of axis 5. value: the function whose zeros are
    the solutions. along: (2, k) axis 4.
    """

    sine: Array
    cosine: Array
    ahead: Array
    above: Array
    fore_ahead: Array
    fore_above: Array
    five: list[Array]
    value: Array
    along: tuple[Array, Array]


class Plane(NamedTuple):
    """The values of `Spot` that do not depend on the elbow; `five` holds the components."""

    sine: Array
    cosine: Array
    ahead: Array
    above: Array
    five: list[Array]


def geometry(curves: Curves, pose: Index, angle: Array, side: Array, bent: Array) -> Spot:
    """Return the arm at angles of axis 6.

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
    bent : (2, k) array
        Sine and cosine of the bend of the elbow.

    Returns
    -------
    Spot
        The arm and the value of the function.
    """
    return spot_of(curves, plane_of(curves, pose, angle, side), bent)


def plane_of(curves: Curves, pose: Index, angle: Array, side: Array) -> Plane:
    """Return the arm without its elbow at angles of axis 6.

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

    Returns
    -------
    Plane
        The plane of the arm, and the point in it.
    """
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, above = (
        harmonics[0][pose] + cos * harmonics[1][pose] + sin * harmonics[2][pose]
        for harmonics in curves.point.transpose(1, 0, 2)
    )
    five = [
        harmonics[0][pose] + cos * harmonics[1][pose] + sin * harmonics[2][pose]
        for harmonics in curves.five.transpose(1, 0, 2)
    ]
    x = x + TINY
    ahead = side * np.sqrt(x * x + y * y)
    return Plane(y / ahead, x / ahead, ahead - curves.ahead, above, five)


def spot_of(curves: Curves, plane: Plane, bent: Array | tuple[Array, Array]) -> Spot:
    """Return the arm in its plane, with the elbow.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    plane : Plane
        The arm without its elbow.
    bent : (2, k) array
        Sine and cosine of the bend of the elbow.

    Returns
    -------
    Spot
        The arm and the value of the function.
    """
    sine, cosine, ahead, above, five = plane
    # direction of the forearm at the point: that to the shoulder, rotated by the angle of the
    # triangle
    squared = ahead * ahead + above * above + TINY
    common = (curves.fore + curves.upper * bent[1]) / squared
    turn = curves.upper * bent[0] / squared
    fore_ahead = common * ahead + turn * above
    fore_above = common * above - turn * ahead
    along = (
        fore_ahead * curves.lean[0] + fore_above * curves.lean[1],
        fore_above * curves.lean[0] - fore_ahead * curves.lean[1],
    )
    value = along[0] * (cosine * five[0] + sine * five[1]) + along[1] * five[2] - curves.square
    return Spot(sine, cosine, ahead, above, fore_ahead, fore_above, five, value, along)


NEWTON = 3
LONGEST_STEP_RAD = 1e-3
ENDS = 1e-12  # share of the squared length; largest error at a stretched or folded end
SHORTEST_RAD = 1e-12


def spans(curves: Curves, side: float) -> tuple[Index, Array, Array, Mask, Mask, Index]:
    """Return the spans of axis 6 in which the arm reaches its point on one side.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    side : float
        1 in front of axis 1, -1 behind it.

    Returns
    -------
    pose : (k,) int array
        The pose of each span.
    begin, end : (k,) array
        Its ends, rad.
    stretched : (k,) bool array
        Whether the arm is stretched at the beginning, otherwise folded.
    folded : (k,) bool array
        Whether the arm is folded at the end, otherwise stretched.
    full_circles : (m,) int array
        Poses that are reached at all angles of axis 6.
    """
    lengths: Array = np.array(
        [(curves.upper + curves.fore) ** 2, (curves.upper - curves.fore) ** 2]
    )
    angles = np.concatenate([_angles(curves, squared) for squared in lengths], axis=1)
    pose = np.arange(len(angles))[:, None]
    for _ in range(NEWTON):
        off, slope = _length_difference(curves, pose, angles, side, lengths)
        angles = angles - np.clip(
            off / np.where(np.abs(slope) < TINY, TINY, slope), -LONGEST_STEP_RAD, LONGEST_STEP_RAD
        )
    angles[
        np.abs(_length_difference(curves, pose, angles, side, lengths)[0]) > ENDS * lengths[0]
    ] = np.nan
    angles %= TURN
    angles = np.sort(angles, axis=1)
    count = np.isfinite(angles).sum(axis=1)
    rows = np.arange(len(angles))
    following = np.roll(angles, -1, axis=1)
    following[rows[count > 0], count[count > 0] - 1] = angles[count > 0, 0] + TURN
    row, column = np.nonzero(np.isfinite(angles))
    begin, end = angles[row, column], following[row, column]
    inside = end - begin > SHORTEST_RAD
    row, begin, end = row[inside], begin[inside], end[inside]
    closing = _closes(squared_distance(curves, row, 0.5 * (begin + end), side), lengths)
    none = np.flatnonzero(count == 0)
    full_circles = none[_closes(squared_distance(curves, none, np.zeros(len(none)), side), lengths)]
    row, begin, end = row[closing], begin[closing], end[closing]
    stretched, straight = (
        np.abs(distance - lengths[0]) < np.abs(distance - lengths[1])
        for distance in (squared_distance(curves, row, angle, side) for angle in (begin, end))
    )
    return row, begin, end, stretched, ~straight, full_circles


def squared_distance(curves: Curves, pose: Index, angle: Array, side: float | Array) -> Array:
    """Return the squared distance of the point from axis 2, in the arm's plane.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    pose : (...) int array
        Numbers of the poses.
    angle : (...) array
        Angles of axis 6, rad.
    side : float or (...) array
        1 in front of axis 1, -1 behind it.

    Returns
    -------
    (...) array
        Squared distances, mm2.
    """
    x, y, above = (
        harmonics[0][pose] + np.cos(angle) * harmonics[1][pose] + np.sin(angle) * harmonics[2][pose]
        for harmonics in curves.point.transpose(1, 0, 2)
    )
    result: Array = (side * np.hypot(x, y) - curves.ahead) ** 2 + above**2
    return result


def _length_difference(
    curves: Curves, pose: Index, angle: Array, side: float, lengths: Array
) -> tuple[Array, Array]:
    """Return how much the squared distance differs from the nearer of the two squared lengths, and
    its slope: (...) each.
    """
    cos, sin = np.cos(angle), np.sin(angle)
    harmonics = [
        (component[0][pose], component[1][pose], component[2][pose])
        for component in curves.point.transpose(1, 0, 2)
    ]
    x, y, above = (constant + cos * by_cos + sin * by_sin for constant, by_cos, by_sin in harmonics)
    x_slope, y_slope, rise = (cos * by_sin - sin * by_cos for _, by_cos, by_sin in harmonics)
    radius = np.hypot(x, y) + TINY
    squared = (side * radius - curves.ahead) ** 2 + above**2
    slope = (
        2.0 * (side * radius - curves.ahead) * side * (x * x_slope + y * y_slope) / radius
        + 2.0 * above * rise
    )
    differences = squared[..., None] - lengths
    off = np.where(
        np.abs(differences[..., 0]) < np.abs(differences[..., 1]),
        differences[..., 0],
        differences[..., 1],
    )
    return off, slope


def difference(curves: Curves, pose: Index, angle: Array, half: Array, side: Array) -> Array:
    """Return the change of the squared distance between two angles without cancellation.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    pose : (k,) int array
        Numbers of the poses.
    angle : (k,) array
        First angle of axis 6, rad.
    half : (k,) array
        Half the step to the second angle, rad.
    side : (k,) array
        1 in front of axis 1, -1 behind it.

    Returns
    -------
    (k,) array
        Squared distance at the second angle minus that at the first, mm2.
    """
    far_angle = angle + 2.0 * half
    constant, cos, sin = (curves.point[harmonic][:, pose] for harmonic in range(3))
    # changes of cosine and sine between the two angles
    by_cos = -2.0 * np.sin(half) * np.sin(angle + half)
    by_sin = 2.0 * np.sin(half) * np.cos(angle + half)
    squares = 2.0 * ((constant * cos).sum(axis=0) * by_cos + (constant * sin).sum(axis=0) * by_sin)
    rise = cos[2] * by_cos + sin[2] * by_sin
    near_point, far_point = (
        constant + np.cos(turned) * cos + np.sin(turned) * sin for turned in (angle, far_angle)
    )
    around = squares - rise * (near_point[2] + far_point[2])
    radius_sum = np.hypot(near_point[0], near_point[1]) + np.hypot(far_point[0], far_point[1])
    result: Array = squares - 2.0 * side * curves.ahead * around / (radius_sum + TINY)
    return result


def _closes(squared: Array, lengths: Array) -> Mask:
    return np.asarray((squared < lengths[0]) & (squared > lengths[1]))


def _angles(curves: Curves, squared: float) -> Array:
    """Return the angles (n, 4) in [0, 2 pi) at which the squared distance may be `squared`, on
    either side; some of them are not solutions.
    """
    constant, cos, sin = curves.point
    mean = (constant**2).sum(axis=0) + 0.5 * ((cos**2).sum(axis=0) + (sin**2).sum(axis=0))
    # (p p + k)^2 - (2 a)^2 (p p - z z): constant, factors of cosine and sine of the angle, and of
    # twice the angle
    linear = np.stack([2.0 * (constant * cos).sum(axis=0), 2.0 * (constant * sin).sum(axis=0)])
    shifted, twice = mean + curves.ahead**2 - squared, 4.0 * curves.ahead**2
    squared_terms = _square(shifted, *linear)
    height = _square(*curves.point[:, 2])
    trig = squared_terms + twice * height
    trig[0] -= twice * mean
    trig[1] -= twice * linear[0]
    trig[2] -= twice * linear[1]
    scale = np.abs(trig).max(axis=0) + TINY
    trig = trig / scale
    second_order = 0.5 * (trig[3] - 1j * trig[4])
    second_order = np.where(np.abs(second_order) < 1e-14, 1e-14, second_order)
    first_order = 0.5 * (trig[1] - 1j * trig[2])
    companion = np.zeros((len(mean), 4, 4), dtype=complex)
    companion[:, [1, 2, 3], [0, 1, 2]] = 1.0
    for row, coefficient in enumerate(
        (np.conj(second_order), np.conj(first_order), trig[0], first_order)
    ):
        companion[:, row, 3] = -coefficient / second_order
    angle = np.angle(np.linalg.eigvals(companion))
    for _ in range(NEWTON):
        c, s, c2, s2 = np.cos(angle), np.sin(angle), np.cos(2.0 * angle), np.sin(2.0 * angle)
        t = trig[:, :, None]
        value = t[0] + t[1] * c + t[2] * s + t[3] * c2 + t[4] * s2
        slope = -t[1] * s + t[2] * c - 2.0 * t[3] * s2 + 2.0 * t[4] * c2
        step = value / np.where(np.abs(slope) < 1e-12, 1e-12, slope)
        angle = angle - np.clip(step, -0.1, 0.1)
    result: Array = angle % TURN
    return result


def _square(constant: Array, cos: Array, sin: Array) -> Array:
    """Return the square (5, n) of constant + cos c + sin s: the constant and the factors of cosine
    and sine of the angle and of twice the angle.
    """
    return np.stack(
        [
            constant**2 + 0.5 * (cos**2 + sin**2),
            2.0 * constant * cos,
            2.0 * constant * sin,
            0.5 * (cos**2 - sin**2),
            cos * sin,
        ]
    )


EDGE = 1e-12  # error of a cosine of axis 6: rounding may put a stretched arm out of reach by it


class Loops(NamedTuple):
    """Loops (k,) of axis 6.

    Each has a pose and a side. `elbow` is 1 or -1 for whole turns, 0 for others. The angle of
    axis 6 is middle - half cos t, or middle + t for whole turns. `near_angle` and `far_angle` are
    the angles where the arm is stretched and where it is folded, counted from the angle where the
    point is farthest out. `stretched` and `folded` say whether it ever is. `mean` and `swing` are
    mean and half the range of the squared distance from the shoulder.

    For an arm whose axis 2 is ahead of axis 1, `near_angle` and `far_angle` are the angles at both
    ends, `stretched` and `folded` say whether it is stretched at the first end and folded at the
    last, and `mean` and `swing` are 0.
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
        """Return the loops with the given numbers.

        Parameters
        ----------
        rows : (r,) array of int
            Numbers of the loops.

        Returns
        -------
        Loops
            The selected loops.
        """
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
    near_at = np.arccos(np.clip(near_cosine, -1.0, 1.0))
    far_at = np.arccos(np.clip(far_cosine, -1.0, 1.0))
    full_circle, two_arcs = reached & ~stretched & ~folded, reached & stretched & folded
    none = np.zeros(len(mean))
    middle_of = 0.5 * (near_at + far_at)
    half_of = 0.5 * (far_at - near_at)
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
    """Return loops over a whole turn of axis 6.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    pose : (k,) int array
        Numbers of the poses.
    side : (k,) array
        1 in front of axis 1, -1 behind it.
    elbow : (k,) array
        1 for the elbow on the left, otherwise -1.

    Returns
    -------
    loops : Loops
        Loops for an arm that reaches its point at every angle.
    begin : (k,) array
        Angles of axis 6 where they begin, rad.
    """
    none = np.zeros(len(pose))
    mean, swing, out = (
        (none,) * 3 if curves.ahead else (column[pose] for column in _distances(curves))
    )
    return Loops(pose, side, elbow, out, none, none, none, none > 0.0, none > 0.0, mean, swing), out


def _distances(curves: Curves) -> tuple[Array, Array, Array]:
    """Return mean and half the range (n,) of the squared distance from the shoulder.

    The third result is the angle of axis 6 at which it is largest.
    """
    constant, cos, sin = curves.point
    radius = 0.5 * ((cos * cos).sum(axis=0) + (sin * sin).sum(axis=0))
    mean = (constant * constant).sum(axis=0) + radius
    by_cos, by_sin = 2.0 * (constant * cos).sum(axis=0), 2.0 * (constant * sin).sum(axis=0)
    return mean, np.hypot(by_cos, by_sin) + TINY, np.arctan2(by_sin, by_cos)


def _offset_loops(curves: Curves) -> Loops:
    """Return the loops of all poses, on both sides, for an arm whose axis 2 is ahead of axis 1."""
    loops = []
    for side in (1.0, -1.0):
        pose, begin, end, stretched, folded, full_circles = spans(curves, side)
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
    """Return the angle of axis 6 and the bend of the elbow along loops.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    loops : Loops
        The k loops.
    t : (k,) array
        Parameter along the loops, rad.

    Returns
    -------
    angle : (k,) array
        Angle of axis 6, rad.
    bent : (2, k) array
        Sine and cosine of the bend of the elbow, accurate to the last digits where the arm is
        stretched or folded.
    """
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
        # half the distance from the nearer end, and whether the arm is stretched there
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
    # change of the squared distance to where the arm is stretched, and to where it is folded, with
    # differences of cosines as products
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
    """Return sine and cosine (2, k) of the bend of the elbow, accurate near the ends of a span.

    end: angle of the end, half the angle from there, and whether the arm is stretched there.
    """
    ends, since, stretched = end
    longest, shortest = (curves.upper + curves.fore) ** 2, (curves.upper - curves.fore) ** 2
    squared = squared_distance(curves, loops.pose, angle, loops.side)
    nearer = np.abs(difference(curves, loops.pose, ends, since, loops.side))
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
