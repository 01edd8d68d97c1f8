# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed-form kinematics of six-axis arms with parallel axes 2 and 3 and a spherical wrist.

Geometry and parameters: Brandstoetter, Angerer, Hofbaur, "An analytical solution of the inverse
kinematics problem of industrial serial manipulators with an ortho-parallel basis and a spherical
wrist", 2014. All functions work on arrays of poses.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.columns import columns
from ...types import Array, ArrayLike, Index, Mask

# ---- Arithmetic of the inverse

CHUNK = 4096
# tolerances for poses that rounding puts just out of reach: beyond a stretched arm (1 - cos^2 of
# the elbow), and within b of axis 1 (mm)
STRETCH, TOUCH = 4e-12, 1e-9
# added to directions that may vanish: the angle is then 0; elsewhere rounding absorbs it
HINT = 1e-150


def solve(arm: OpwArm, poses: ArrayLike, branches: tuple[int, ...]) -> Array:
    """Return the joint angles of selected branches.

    Parameters
    ----------
    arm : OpwArm
        The arm.
    poses : (n, 4, 4) array
        Flange poses in base_link, mm.
    branches : tuple of int
        Indices of the branches.

    Returns
    -------
    (branches, n, 6) array
        Angles in -pi to pi, rad; NaN out of reach, see `OpwArm.inverse`.
    """
    poses = np.asarray(poses, float)
    count = len(poses)
    by_component = np.moveaxis(poses[:, :3, :], 0, -1)
    # angles are stored by joint, with an (n, 6) view, so they are contiguous for code that works
    # joint by joint
    result = np.empty((len(branches), 6, count))
    with np.errstate(invalid="ignore", divide="ignore"):
        for start in range(0, count, CHUNK):
            rows = slice(start, start + CHUNK)
            _solve_piece(arm, by_component[:, :, rows].copy(), branches, result[:, :, rows])
    return result.transpose(0, 2, 1)


class _Side(NamedTuple):
    """One shoulder solution for m poses.

    sine, cosine: of the angle of the arm plane about Z. ahead, above: wrist centre relative to
    axis 2, along X of the arm plane and along Z, mm.
    """

    sine: Array
    cosine: Array
    ahead: Array
    above: Array


class _Triangle(NamedTuple):
    """Shoulder, elbow and wrist centre of one side, for an elbow left of the line to the wrist
    centre.

    bend: angle between upper arm and forearm. along, across: wrist centre relative to the shoulder,
    along and across the upper arm. The direction of axis 4 is (ahead, above) times
    `common[0] + turn[0]` plus (above, -ahead) times `common[1] + turn[1]`. For an elbow on the
    right, `bend`, `across` and `turn` change sign.
    """

    bend: Array
    along: Array
    across: Array
    common: tuple[Array, Array]
    turn: tuple[Array, Array]


def _solve_piece(arm: OpwArm, rows: Array, branches: tuple[int, ...], out: Array) -> None:
    """Write the angles (branches, 6, m) of poses to `out`; rows: (3, 4, m) of the poses."""
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
            # solve for q5 >= 0 in opw angles; the sign of axis 5 decides whether this is the flip
            plain, flipped = pair if arm.signs[4] > 0 else pair[::-1]
            angles = flipped if plain is None else plain
            if angles is None:
                continue
            angles[0] = base
            # viewed with q1 pointing right, a wrist centre at the back has its upper elbow on the
            # right
            direction = _arm(arm, side, triangle, elbow_left=back == down, angles=angles)
            _wrist(arm, rows[2], flange, direction, angles)
            if flipped is not None:
                _flip(arm, angles, flipped)


def _distance(arm: OpwArm, centre: Array) -> tuple[Array, Array]:
    """Return the squared distance of the wrist centre from axis 1, mm^2, and its distance along the
    arm plane, mm; the latter is NaN within b of axis 1.
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
    """Return the front or `back` shoulder: the wrist centre is at (+-along, b) in the frame of
    axis 1.
    """
    squared, along = distance
    signed = -along if back else along
    if arm.b == 0.0:
        sine, cosine = centre[1] / signed, centre[0] / signed
    else:
        sine = centre[1] * signed - centre[0] * arm.b
        cosine = centre[0] * signed + centre[1] * arm.b
        sine /= squared
        cosine /= squared
    return _Side(sine, cosine, signed - arm.a1, centre[2] - arm.c1)


def _triangle(arm: OpwArm, side: _Side) -> tuple[_Triangle, Mask | None]:
    """Return the triangle of a side, and the poses where it does not close; None if all close."""
    upper, fore = arm.c2, arm.forearm
    squared = side.ahead * side.ahead
    squared += side.above * side.above
    scale = 1.0 / (2.0 * upper * fore)
    cosine = squared - (upper**2 + fore**2)
    cosine *= scale
    # 1 - cosine^2 as a product keeps precision for an arm that is nearly stretched or folded
    sine = squared - (upper - fore) ** 2
    sine *= scale
    sine *= (upper + fore) ** 2 * scale - scale * squared
    unclosed = sine < -STRETCH
    if abs(upper - fore) < TOUCH:
        # folded back onto the shoulder: axis 2 is free, and the direction of the arm is undefined
        unclosed |= squared < TOUCH
    np.maximum(sine, 0.0, out=sine)
    any_lost = unclosed.any()
    if any_lost:
        sine[unclosed] = np.nan
    np.sqrt(sine, out=sine)
    # elbow to wrist centre = common * (ahead, above) + turn * (above, -ahead), then rotated to the
    # direction of axis 4
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
    """Write axes 2 and 3 of one elbow; return sine and cosine of the angle of axis 4 from Z."""
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
    """Return X and Y components (3, m) of the flange axes in the frame of axis 1."""
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
    """Write axes 4 to 6 for q5 >= 0 in opw angles."""
    sine, cosine = direction
    along, across = flange
    # flange axes along the forearm X; the forearm Y is the Y of the arm plane
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
    # axis 6 for the axis 4 above
    sixth = across[:2] * x
    sixth -= forearm[:2] * y
    np.arctan2(sixth[0], sixth[1], out=angles[5])
    for axis in (3, 4, 5):
        _to_machine(arm, axis, angles[axis])


def _flip(arm: OpwArm, angles: Array, flipped: Array) -> None:
    """Write the other wrist solution of `angles`; both arrays may be the same."""
    if flipped is not angles:
        flipped[:3] = angles[:3]
    np.negative(angles[4], out=flipped[4])
    if arm.offsets[4]:
        # both solutions are equally far from the stretched wrist
        flipped[4] += 2.0 * arm.signs[4] * arm.offsets[4]
        flipped[4] -= 2.0 * math.pi * np.rint(flipped[4] * (0.5 / math.pi))
    _half_turn(angles[3], flipped[3])
    _half_turn(angles[5], flipped[5])


def _half_turn(angle: Array, out: Array) -> None:
    """Write the angle half a turn away that also lies in [-pi, pi]."""
    np.subtract(angle, np.copysign(math.pi, angle), out=out)


def _to_machine(
    arm: OpwArm, axis: int, angle: Array, low: float = -math.pi, width: float = 2.0 * math.pi
) -> None:
    """Convert opw angles in [low, low + width] to machine angles in [-pi, pi], in place."""
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


SHOULDERS, ELBOWS, WRISTS = ("front", "back"), ("up", "down"), ("noflip", "flip")
BRANCHES = tuple(itertools.product(SHOULDERS, ELBOWS, WRISTS))


def branch_index(words: Sequence[str]) -> int:
    """Return the index 4 back + 2 down + flip of a branch given by three words.

    Raises ValueError for unknown words.
    """
    return BRANCHES.index((words[0], words[1], words[2]))


def branch_name(index: int) -> tuple[str, str, str]:
    """Return the three words of a branch.

    Parameters
    ----------
    index : int
        Branch index, 4 back + 2 down + flip.

    Returns
    -------
    tuple[str, str, str]
        Shoulder, elbow and wrist.
    """
    return BRANCHES[index]


@dataclass(frozen=True, eq=False)
class OpwArm:
    """An arm with the seven lengths (mm), `offsets` (rad) and `signs` of opw.

    q_opw = q * sign - offset. Poses are flange poses in base_link, mm. Joint angles are serial,
    rad.

    A branch is front if the wrist centre is on the side of axis 1 that q1 points to. It is up if
    the elbow is above the line from shoulder to wrist centre, that is, left of the line if the arm
    plane is viewed with the wrist centre to the right of axis 1. It is flip if q5 < 0, measured
    from the stretched wrist.
    """

    a1: float
    a2: float
    b: float
    c1: float
    c2: float
    c3: float
    c4: float
    offsets: tuple[float, ...]
    signs: tuple[int, ...]

    followed = False  # configuration names are unique

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distance of axis 2 ahead of axis 1, and its height above base_link, mm."""
        return self.a1, self.c1

    @property
    def reach(self) -> float:
        """Distance from axis 2 to the wrist centre of the stretched arm, mm."""
        return self.c2 + self.forearm

    @property
    def forearm(self) -> float:
        """Distance from the elbow to the wrist centre, mm."""
        return math.hypot(self.a2, self.c3)

    def forward(self, q: ArrayLike) -> Array:
        """Return the flange poses for joint angles.

        Parameters
        ----------
        q : (..., 6) array
            Serial angles, rad.

        Returns
        -------
        (..., 4, 4) array
            Poses in base_link, mm.
        """
        angles = np.asarray(q, float)
        turned = np.moveaxis(angles * np.array(self.signs, float) - np.array(self.offsets), -1, 0)
        (s1, s2, _, s4, s5, s6), (c1, c2, _, c4, c5, c6) = np.sin(turned), np.cos(turned)
        s23, c23 = np.sin(turned[1] + turned[2]), np.cos(turned[1] + turned[2])
        reach = self.a1 + self.c2 * s2 + self.a2 * c23 + self.c3 * s23
        height = self.c1 + self.c2 * c2 - self.a2 * s23 + self.c3 * c23
        # flange axes in the forearm frame, then rotated about the elbow and about axis 1
        wrist = (
            (c4 * c5 * c6 - s4 * s6, -c4 * c5 * s6 - s4 * c6, c4 * s5),
            (s4 * c5 * c6 + c4 * s6, -s4 * c5 * s6 + c4 * c6, s4 * s5),
            (-s5 * c6, s5 * s6, c5),
        )
        result = np.zeros(angles.shape[:-1] + (4, 4))
        for column in range(3):
            x, y, z = (wrist[row][column] for row in range(3))
            forward = c23 * x + s23 * z
            result[..., 0, column] = c1 * forward - s1 * y
            result[..., 1, column] = s1 * forward + c1 * y
            result[..., 2, column] = c23 * z - s23 * x
        result[..., 0, 3] = c1 * reach - s1 * self.b
        result[..., 1, 3] = s1 * reach + c1 * self.b
        result[..., 2, 3] = height
        result[..., :3, 3] += self.c4 * result[..., :3, 2]
        result[..., 3, 3] = 1.0
        return result

    def inverse(self, poses: ArrayLike) -> Array:
        """Return the joint angles of all branches for flange poses.

        At a wrist singularity, opw axis 4 is 0 and axis 6 takes the whole rotation. With the wrist
        centre on axis 1, opw axis 1 is 0. Forward kinematics reproduces the pose to about 1e-9 mm.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (8, n, 6) array
            Angles in -pi to pi, rad, in the order of `branch_name`. A branch that does not
            reach a pose has six NaN.
        """
        return solve(self, poses, tuple(range(8)))

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return joint angles (n, 6) of one branch (an index of `branch_name`), see `inverse`."""
        result: Array = solve(self, poses, (branch,))[0]
        return result

    def bend(self, q: ArrayLike) -> Array:
        """Return the distance (...) of angles `q` (..., 6) from a stretched wrist or elbow.

        0 if stretched, 1 at a right angle.
        """
        turned = np.asarray(q, float) * np.array(self.signs, float) - np.array(self.offsets)
        bent: Array = np.minimum(
            np.abs(np.sin(turned[..., 4])),
            np.abs(np.sin(turned[..., 2] + np.arctan2(self.a2, self.c3))),
        )
        return bent

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse`, and their configurations (8, n); -1 out of reach."""
        angles = self.inverse(poses)
        return angles, np.where(np.isnan(angles[..., 0]), -1, np.arange(8)[:, None])

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the branch index (...) of joint angles `q` (..., 6)."""
        angles = np.asarray(q, float)
        turned = columns(angles * np.array(self.signs, float) - np.array(self.offsets))
        forearm = turned[2] + math.atan2(self.a2, self.c3)
        reach = self.a1 + self.c2 * np.sin(turned[1]) + self.forearm * np.sin(turned[1] + forearm)
        back = reach < 0.0
        down = (np.sin(forearm) < 0.0) != back
        bent = angles[..., 4]
        if self.offsets[4]:
            bent = bent - self.signs[4] * self.offsets[4]
            bent = bent - 2.0 * math.pi * np.rint(bent * (0.5 / math.pi))
        result: Index = 4 * back + 2 * down + (bent < 0.0)
        return result
