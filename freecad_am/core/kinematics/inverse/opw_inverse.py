# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inverse of an arm with a spherical wrist, as in `opw`: the arithmetic.

Sines and cosines are computed as ratios of lengths, so one arc tangent per joint and
branch is the only transcendental function. Axis 6 is computed with the axis 4 found, so a
wrist at or near its singularity loses no accuracy. An array holds one component of all
poses, in pieces that fit the processor's cache.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...types import Array, ArrayLike, Mask

if TYPE_CHECKING:
    from .opw import OpwArm

CHUNK = 4096
# how far rounding may take a pose that is reached past a stretched arm (as 1 - cos^2 of the elbow), and past b (mm)
STRETCH, TOUCH = 4e-12, 1e-9
# added where a direction may vanish: gives the angle 0 and is lost in any other number
HINT = 1e-150


def solve(arm: OpwArm, poses: ArrayLike, branches: tuple[int, ...]) -> Array:
    """The joint angles (branches, n, 6) of flange poses (n, 4, 4); see `OpwArm.inverse`."""
    poses = np.asarray(poses, float)
    count = len(poses)
    by_component = np.moveaxis(poses[:, :3, :], 0, -1)
    # angles are stored by joint, with (n, 6) as a view: code that works joint by joint finds them contiguous
    result = np.empty((len(branches), 6, count))
    with np.errstate(invalid="ignore", divide="ignore"):
        for start in range(0, count, CHUNK):
            rows = slice(start, start + CHUNK)
            _solve_piece(arm, by_component[:, :, rows].copy(), branches, result[:, :, rows])
    return result.transpose(0, 2, 1)


class _Side(NamedTuple):
    """One shoulder over m poses: the arm's plane as `sine`, `cosine` of its angle about Z, and in it the wrist
    centre from axis 2: `ahead` along the plane's X, `above` along Z. Lengths in mm."""

    sine: Array
    cosine: Array
    ahead: Array
    above: Array


class _Triangle(NamedTuple):
    """Shoulder, elbow and wrist centre of one side, for the elbow on the left of the way to the wrist centre.

    `bend` is the angle between upper arm and forearm, (`along`, `across`) the wrist centre from the shoulder,
    along the upper arm and across it. Axis 4 is (ahead, above) times the first of `common` + `turn` plus (above,
    -ahead) times the second. For the elbow on the right, `bend`, `across` and `turn` change their sign.
    """

    bend: Array
    along: Array
    across: Array
    common: tuple[Array, Array]
    turn: tuple[Array, Array]


def _solve_piece(arm: OpwArm, rows: Array, branches: tuple[int, ...], out: Array) -> None:
    """Write the angles `out` (branches, 6, m) of poses given by their upper three `rows` (3, 4, m)."""
    centre = rows[:, 3] - arm.c4 * rows[:, 2]
    distance = _distance(arm, centre)
    for back in (0, 1):
        slots = {index & 3: out[slot] for slot, index in enumerate(branches) if index >> 2 == back}
        if not slots:
            continue
        side = _side(arm, centre, distance, back)
        triangle, unclosed = _triangle(arm, side)
        base = np.arctan2(side.sine, side.cosine)
        if unclosed is not None:
            base[unclosed] = np.nan
        _to_machine(arm, 0, base)
        flange = _about_axis_1(side, rows)
        for down in (0, 1):
            pair = (slots.get(2 * down), slots.get(2 * down + 1))
            # the wrist solution with opw's q5 >= 0; whether that is a flip is the sign's matter
            plain, flipped = pair if arm.signs[4] > 0 else pair[::-1]
            angles = flipped if plain is None else plain
            if angles is None:
                continue
            angles[0] = base
            # seen with q1's direction to the right, a wrist centre at the back has the upper elbow on the right
            direction = _arm(arm, side, triangle, elbow_left=back == down, angles=angles)
            _wrist(arm, rows[2], flange, direction, angles)
            if flipped is not None:
                _flip(arm, angles, flipped)


def _distance(arm: OpwArm, centre: Array) -> tuple[Array, Array]:
    """Return the squared distance of the wrist centre from axis 1, and its distance along the
    arm's plane; NaN within b. mm.
    """
    centre[0] += HINT
    squared = centre[0] * centre[0]
    squared += centre[1] * centre[1]
    if arm.b == 0.0:
        return squared, np.sqrt(squared)
    along = squared - arm.b * arm.b
    unreachable = along < -2.0 * abs(arm.b) * TOUCH
    np.maximum(along, 0.0, out=along)
    if unreachable.any():
        along[unreachable] = np.nan
    return squared, np.sqrt(along, out=along)


def _side(arm: OpwArm, centre: Array, distance: tuple[Array, Array], back: int) -> _Side:
    """The shoulder `back` or not: the wrist centre is at (+-along, b) in the frame turned with axis 1."""
    squared, along = distance
    signed = -along if back else along
    if arm.b == 0.0:
        sine, cosine = centre[1] / signed, centre[0] / signed
    else:
        sine, cosine = (
            centre[1] * signed - centre[0] * arm.b,
            centre[0] * signed + centre[1] * arm.b,
        )
        sine /= squared
        cosine /= squared
    return _Side(sine, cosine, signed - arm.a1, centre[2] - arm.c1)


def _triangle(arm: OpwArm, side: _Side) -> tuple[_Triangle, Mask | None]:
    """The triangle of a side, and where it does not close (None: everywhere it does)."""
    upper, fore = arm.c2, arm.forearm
    squared = side.ahead * side.ahead
    squared += side.above * side.above
    scale = 1.0 / (2.0 * upper * fore)
    cosine = squared - (upper**2 + fore**2)
    cosine *= scale
    # 1 - cosine^2 as a product keeps the digits of an arm that is nearly stretched or folded
    sine = squared - (upper - fore) ** 2
    sine *= scale
    sine *= (upper + fore) ** 2 * scale - scale * squared
    unclosed = sine < -STRETCH
    if abs(upper - fore) < TOUCH:
        # folded back on the shoulder, where axis 2 is free and the arm has no direction
        unclosed |= squared < TOUCH
    np.maximum(sine, 0.0, out=sine)
    any_lost = unclosed.any()
    if any_lost:
        sine[unclosed] = np.nan
    np.sqrt(sine, out=sine)
    # elbow to wrist centre = common * (ahead, above) + turn * (above, -ahead); then turned from there to axis 4
    over = 1.0 / squared
    common = over * (0.5 * (fore**2 - upper**2))
    common += 0.5
    turn = over
    turn *= sine
    turn *= upper * fore
    ahead, aside = arm.c3 / fore**2, arm.a2 / fore**2
    triangle = _Triangle(
        bend=np.arctan2(sine, cosine),
        along=upper + fore * cosine,
        across=fore * sine,
        common=(common * ahead, common * -aside),
        turn=(turn * aside, turn * ahead),
    )
    return triangle, unclosed if any_lost else None


def _arm(
    arm: OpwArm, side: _Side, triangle: _Triangle, elbow_left: bool, angles: Array
) -> tuple[Array, Array]:
    """Write axes 2 and 3 of one elbow; give sine and cosine of the angle of axis 4 from the vertical."""
    inclined = math.atan2(arm.a2, arm.c3)
    ahead, above = side.ahead, side.above
    along_ahead, along_above = ahead * triangle.along, above * triangle.along
    across_ahead, across_above = ahead * triangle.across, above * triangle.across
    if elbow_left:
        along_ahead -= across_above
        along_above += across_ahead
        towards = triangle.common[0] + triangle.turn[0]
        sideways = triangle.common[1] + triangle.turn[1]
        np.subtract(triangle.bend, inclined, out=angles[2])
    else:
        along_ahead += across_above
        along_above -= across_ahead
        towards = triangle.common[0] - triangle.turn[0]
        sideways = triangle.common[1] - triangle.turn[1]
        np.subtract(-inclined, triangle.bend, out=angles[2])
    np.arctan2(along_ahead, along_above, out=angles[1])
    _to_machine(arm, 1, angles[1])
    _to_machine(arm, 2, angles[2], -inclined if elbow_left else -inclined - math.pi, math.pi)
    sine = ahead * towards
    sine += above * sideways
    cosine = above * towards
    cosine -= ahead * sideways
    return sine, cosine


def _about_axis_1(side: _Side, rows: Array) -> tuple[Array, Array]:
    """X and Y components (3, m) of the flange's axes in the frame turned with axis 1."""
    along = rows[0, :3] * side.cosine
    along += rows[1, :3] * side.sine
    across = rows[1, :3] * side.cosine
    across -= rows[0, :3] * side.sine
    return along, across


def _wrist(
    arm: OpwArm,
    height: Array,
    flange: tuple[Array, Array],
    direction: tuple[Array, Array],
    angles: Array,
) -> None:
    """Write axes 4 to 6 with opw's q5 >= 0."""
    sine, cosine = direction
    along, across = flange
    # the flange's axes along the forearm's X; the forearm's Y is the Y of the arm's plane
    forearm = along * cosine
    forearm -= height[:3] * sine
    x, y = forearm[2], across[2]
    x += HINT
    np.arctan2(y, x, out=angles[3])
    off = x * x
    off += y * y
    np.sqrt(off, out=off)
    on = along[2] * sine
    on += height[2] * cosine
    np.arctan2(off, on, out=angles[4])
    # axis 6 with the axis 4 just found
    sixth = across[:2] * x
    sixth -= forearm[:2] * y
    np.arctan2(sixth[0], sixth[1], out=angles[5])
    for axis in (3, 4, 5):
        _to_machine(arm, axis, angles[axis])


def _flip(arm: OpwArm, angles: Array, flipped: Array) -> None:
    """Write the other wrist solution of `angles`; both may be the same array."""
    if flipped is not angles:
        flipped[:3] = angles[:3]
    np.negative(angles[4], out=flipped[4])
    if arm.offsets[4]:
        # both are equally far from the stretched wrist
        flipped[4] += 2.0 * arm.signs[4] * arm.offsets[4]
        flipped[4] -= 2.0 * math.pi * np.rint(flipped[4] * (0.5 / math.pi))
    _half_turn(angles[3], flipped[3])
    _half_turn(angles[5], flipped[5])


def _half_turn(angle: Array, out: Array) -> None:
    """Write the angle half a turn away that is in [-pi, pi] too."""
    np.subtract(angle, np.copysign(math.pi, angle), out=out)


def _to_machine(
    arm: OpwArm, axis: int, angle: Array, low: float = -math.pi, width: float = 2.0 * math.pi
) -> None:
    """From opw's angle, in [low, low + width], to the machine's in [-pi, pi], in place."""
    sign, shift = arm.signs[axis], arm.offsets[axis]
    if shift and abs(abs(shift) - math.pi) < 1e-12 and width > math.pi:
        _half_turn(angle, angle)
        low, shift = -math.pi, 0.0
    elif shift:
        angle += shift
    if low + shift < -math.pi or low + shift + width > math.pi:
        turns = np.rint(angle * (0.5 / math.pi))
        turns *= 2.0 * math.pi
        angle -= turns
    if sign < 0:
        np.negative(angle, out=angle)
