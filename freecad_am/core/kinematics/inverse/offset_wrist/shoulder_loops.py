# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ranges of axis 6 where the triangle of shoulder, elbow and wrist closes, for an arm whose
axis 2 is ahead of axis 1.

The squared distance of the point of axes 4 and 5 from axis 2 contains a root; squared
once more, the angles at which the arm is stretched or folded are the zeros of a
trigonometric polynomial of degree 2: eigenvalues of a matrix of four rows.
"""

from __future__ import annotations

import numpy as np

from ....geometry.angles import TURN
from ....types import Array, Index, Mask
from .plane import TINY, Curves

NEWTON = 3
LONGEST_STEP_RAD = 1e-3
ENDS = 1e-12  # of the squared length: what an angle may leave of being stretched or folded to be an end
SHORTEST_RAD = 1e-12


def spans(curves: Curves, side: float) -> tuple[Index, Array, Array, Mask, Mask, Index]:
    """Angles of axis 6 at which the arm reaches its point on a side, 1 in front of axis 1 or -1: the pose, begin and end of
    each span (k,) rad, whether it begins stretched and whether it ends folded, and the poses that reach it at all angles."""
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
    """The squared distance (...) of the point from axis 2, in the arm's plane."""
    x, y, above = (
        harmonics[0][pose] + np.cos(angle) * harmonics[1][pose] + np.sin(angle) * harmonics[2][pose]
        for harmonics in curves.point.transpose(1, 0, 2)
    )
    result: Array = (side * np.hypot(x, y) - curves.ahead) ** 2 + above**2
    return result


def _length_difference(
    curves: Curves, pose: Index, angle: Array, side: float, lengths: Array
) -> tuple[Array, Array]:
    """Return the difference (...) of the squared distance from the nearer of both squared
    lengths, and its slope.
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
    """By how much the squared distance (k,) at an angle differs from that twice `half` further on, without the loss of
    digits of a difference."""
    far_angle = angle + 2.0 * half
    constant, cos, sin = (curves.point[harmonic][:, pose] for harmonic in range(3))
    # of cosine and sine between both angles
    by_cos, by_sin = (
        -2.0 * np.sin(half) * np.sin(angle + half),
        2.0 * np.sin(half) * np.cos(angle + half),
    )
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
    """The angles (n, 4) in [0, 2 pi) at which the squared distance may be `squared`, on either side; too many are given."""
    constant, cos, sin = curves.point
    mean = (constant**2).sum(axis=0) + 0.5 * ((cos**2).sum(axis=0) + (sin**2).sum(axis=0))
    # (p p + k)^2 - (2 a)^2 (p p - z z), by constant, cosine, sine, cosine and sine of twice the angle
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
    """Return the square (5, n) of constant + cos c + sin s, as constant, cosine and sine, and
    cosine and sine of twice the angle.
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
