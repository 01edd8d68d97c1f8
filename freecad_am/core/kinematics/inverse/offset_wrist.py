# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinematics of arms with an offset wrist, such as FANUC CRX, Yaskawa HC10 and ABB GoFa.

Axes 4 and 5 meet in a point that axis 6 moves. For each angle of axis 6, the triangle of shoulder,
elbow and that point determines axis 4, for either side of axis 1 and either elbow. The remaining
condition is the angle between axes 4 and 5. This is a function of axis 6 alone, and its zeros are
all solutions, at most 16. `offset_wrist_polynomial` finds them. `offset_wrist_search` finds zeros
that are too close to each other for it, and `exact` those next to axis 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry import frames
from ...geometry.frames import TURN
from ...types import Array, ArrayLike, Index, Mask
from ..chain import Chain
from . import offset_wrist_polynomial, offset_wrist_search
from .offset_wrist_search import Zeros
from .shoulder_loops import TINY, Curves, geometry

# ---- Solutions where the point of axes 4 and 5 is on axis 1 or next to it

# shares of the length of the stretched arm: distance from axis 1 below which this section applies,
# distance up to which its solutions are used, and distance within which no others are used because
# their planes are too inaccurate
PASS_SHARE, SOLVED_SHARE, NOISE_SHARE = 2e-5, 1e-3, 1e-7
SAME_RAD, SAME_SINE = 1e-7, 1e-3
MISMATCH = 1e-8  # cosine; a sign change because the plane makes a half turn is no solution
SAMPLES, ROUNDS = 128, 40
AXIS_STEP_RAD = 1e-2
PLANE_SHARE = 1e-13  # of the length of the stretched arm


def exact(curves: Curves, zeros: Zeros) -> tuple[Zeros, Array]:
    """Replace zeros next to axis 1 by exact ones.

    Parameters
    ----------
    curves : Curves
        Geometry of n poses.
    zeros : Zeros
        The k zeros found by the search.

    Returns
    -------
    zeros : Zeros
        The zeros.
    plane : (2, k) array
        Sine and cosine of the arm's plane; NaN where the point itself determines the plane.
    """
    length = curves.upper + curves.fore
    row, angle = _passes(curves, length)
    if not len(row):
        return zeros, np.full((2, len(zeros.pose)), np.nan)
    solved, plane = _solved(
        curves,
        length,
        np.repeat(row, 4),
        np.repeat(angle, 4),
        np.tile([1.0, 1.0, -1.0, -1.0], len(row)),
        np.tile([1.0, -1.0], 2 * len(row)),
    )
    unreplaced = np.flatnonzero(~_replaced(curves, zeros, solved, plane, row, NOISE_SHARE * length))
    together = Zeros(
        *(
            np.concatenate([column[..., unreplaced], solved_column], axis=-1)
            for column, solved_column in zip(zeros, solved)
        )
    )
    return together, np.concatenate([np.full((2, len(unreplaced)), np.nan), plane], axis=1)


def _replaced(
    curves: Curves, zeros: Zeros, solved: Zeros, plane: Array, passing: Index, noise: float
) -> Mask:
    """Return which zeros (k,) at the poses `passing` are among the exact ones, or are no solutions,
    or have an undetermined plane.
    """
    is_passing = np.zeros(curves.point.shape[2], dtype=bool)
    is_passing[passing] = True
    result: Mask = is_passing[zeros.pose]
    rows = np.flatnonzero(result)
    x, y = zeros.side[rows] * _point(curves, zeros.pose[rows], zeros.angle[rows])[0][:2]
    radius = np.hypot(x, y)
    angle_gap = zeros.angle[rows, None] - solved.angle
    same = np.abs(angle_gap - TURN * np.rint(angle_gap * (1.0 / TURN))) < SAME_RAD
    for zero_column, solved_column in (
        (zeros.pose, solved.pose),
        (zeros.side, solved.side),
        (zeros.elbow, solved.elbow),
    ):
        same &= zero_column[rows, None] == solved_column
    x, y = x[:, None] - radius[:, None] * plane[1], y[:, None] - radius[:, None] * plane[0]
    same &= np.hypot(x, y) < SAME_SINE * radius[:, None]
    mismatch = np.abs(
        geometry(
            curves, zeros.pose[rows], zeros.angle[rows], zeros.side[rows], zeros.bent[:, rows]
        ).value
    )
    result[rows] = (radius < noise) | (mismatch > MISMATCH) | same.any(axis=1)
    return result


def _point(curves: Curves, pose: Index, angle: Array) -> tuple[Array, Array, Array]:
    """Return the point of axes 4 and 5 (3, k) and its first two derivatives by axis 6."""
    cos, sin = np.cos(angle), np.sin(angle)
    constant, by_cos, by_sin = curves.point[:, :, pose]
    around: Array = cos * by_cos + sin * by_sin
    return constant + around, cos * by_sin - sin * by_cos, -around


def _passes(curves: Curves, length: float) -> tuple[Index, Array]:
    """Return poses (k,) and angles of axis 6 (k,) where the point passes close to axis 1."""
    centre, cos, sin = curves.point[:, :2]
    # the point is on axis 1 if the ellipse maps a unit vector to its centre; this distance is a
    # lower bound
    size = np.abs(cos[0] * sin[1] - cos[1] * sin[0])
    mapped = np.hypot(
        sin[1] * centre[0] - sin[0] * centre[1], cos[0] * centre[1] - cos[1] * centre[0]
    )
    likely = np.flatnonzero(
        np.abs(mapped - size) <= PASS_SHARE * length * np.sqrt((cos * cos + sin * sin).sum(axis=0))
    )
    if not len(likely):
        return likely, np.zeros(0)
    angles = np.arange(SAMPLES) * (TURN / SAMPLES)
    points = _point(curves, likely[:, None], angles)[0]  # type: ignore[arg-type]
    radius = np.hypot(points[0], points[1])
    row, number = np.nonzero(
        (radius <= np.roll(radius, 1, axis=1)) & (radius < np.roll(radius, -1, axis=1))
    )
    pose, angle = likely[row], angles[number]
    for _ in range(ROUNDS):
        (x, y, _), (u, v, _), (du, dv, _) = _point(curves, pose, angle)
        curved = u * u + v * v + x * du + y * dv
        # if the sum is not convex, use only its Gauss-Newton part
        curved = np.where(curved > 0.0, curved, u * u + v * v + TINY)
        angle = angle - np.clip((x * u + y * v) / curved, -AXIS_STEP_RAD, AXIS_STEP_RAD)
    x, y, _ = _point(curves, pose, angle)[0]
    close = np.hypot(x, y) < PASS_SHARE * length
    return pose[close], angle[close]


def _solved(
    curves: Curves, length: float, pose: Index, angle: Array, elbow: Array, sense: Array
) -> tuple[Zeros, Array]:
    """Return the zeros near angles of axis 6 (k,), and sine and cosine (2, k) of their planes.

    elbow: 1 or -1. sense: 1 or -1 for the two planes in which axes 4 and 5 are at their angle.
    """
    ahead, previous = np.zeros(len(pose)), (angle, np.full(len(pose), np.nan))
    for _ in range(ROUNDS):
        (x, y, above), (u, v, _), _ = _point(curves, pose, angle)
        bent, along, five, plane, sure = _plane_of_meeting(
            curves, pose, angle, ahead, above, elbow, sense
        )
        ahead = x * plane[1] + y * plane[0]
        off, slope = x * plane[0] - y * plane[1], u * plane[0] - v * plane[1]
        # the plane turns with the angle too, so use a secant method once the steps are small enough
        moved = angle - previous[0]
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = (off - previous[1]) / moved
        slope = np.where(
            np.isfinite(secant) & (np.abs(moved) > 1e-10) & (secant * slope > 0.0), secant, slope
        )
        previous = angle, off
        angle = angle - np.clip(
            off / np.where(slope == 0.0, TINY, slope), -AXIS_STEP_RAD, AXIS_STEP_RAD
        )
    valid = np.flatnonzero(
        sure & (np.abs(off) < PLANE_SHARE * length) & (np.abs(ahead) < SOLVED_SHARE * length)
    )
    sweep = (x * v - y * u) / (x * x + y * y + TINY)
    rising = along[0] * (plane[1] * five[1] - plane[0] * five[0]) * sweep
    side = np.where(ahead >= 0.0, 1.0, -1.0)
    columns: tuple[Any, ...] = (pose, angle, side, elbow, bent, rising)
    return Zeros(*(column[..., valid] for column in columns)), plane[:, valid]


def _plane_of_meeting(
    curves: Curves,
    pose: Index,
    angle: Array,
    ahead: Array,
    above: Array,
    elbow: Array,
    sense: Array,
) -> tuple[Array, Array, Array, Array, Mask]:
    """Return the plane in which axes 4 and 5 are at their angle, and the arm in it.

    These are sine and cosine (2, k) of the elbow's bend, axis 4 in the plane (2, k), axis 5 (3, k),
    sine and cosine (2, k) of the plane, and whether there is such a plane (k,).
    """
    forward = ahead - curves.ahead
    squared = forward * forward + above * above
    bend = (squared - (curves.upper**2 + curves.fore**2)) / (2.0 * curves.upper * curves.fore)
    bent = np.stack([elbow * np.sqrt(np.maximum(1.0 - bend * bend, 0.0)), bend])
    common = (curves.fore + curves.upper * bend) / (squared + TINY)
    turn = curves.upper * bent[0] / (squared + TINY)
    fore = common * forward + turn * above, common * above - turn * forward
    cos, sin = curves.lean
    along = np.stack([fore[0] * cos + fore[1] * sin, fore[1] * cos - fore[0] * sin])
    constant, by_cos, by_sin = curves.five[:, :, pose]
    five = constant + np.cos(angle) * by_cos + np.sin(angle) * by_sin
    target = curves.square - along[1] * five[2]
    size = along[0] * np.hypot(five[0], five[1])
    share = target / np.where(size == 0.0, TINY, size)
    towards = np.arctan2(five[1], five[0]) + sense * np.arccos(np.clip(share, -1.0, 1.0))
    return (
        bent,
        along,
        five,
        np.stack([np.sin(towards), np.cos(towards)]),
        (np.abs(bend) <= 1.0) & (np.abs(share) <= 1.0),
    )


CHUNK = 2048
MAX_SOLUTIONS = 16  # of six revolute joints
STEP_RAD = 1e-5  # step of axis 6 for the slope
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class OffsetWristArm:
    """Lengths (mm) and zeros (rad) of the arm of a `chain` in a base_link whose Z is axis 1.

    In the arm's plane, axis 2 is `ahead` of axis 1 and `above` base_link; `upper` is the distance
    from there to axis 3, `fore` from axis 3 to the point where axes 4 and 5 meet. `turns` are the
    angles of the plane (from X), the upper arm and the forearm (from Z towards the plane's front)
    with all joints at 0. `signs` are those of axes 1 to 3. `lean` is the angle from the direction
    elbow to point to axis 4. `point` (3,) is the point in base_link with all joints at 0. `flips`
    gives, for each of the four combinations of shoulder and elbow, the sense of passing zero for
    which q5 < 0.

    Front, back, up and down are defined as for a spherical wrist, with the point where axes 4 and 5
    meet in place of the wrist centre. Flip and noflip are separated by the singularities of the
    wrist, which need not be at q5 = 0; q5 is mostly negative for flip. Several solutions may share
    a configuration.
    """

    chain: Chain
    above: float
    upper: float
    fore: float
    turns: tuple[float, float, float]
    signs: tuple[int, int, int]
    lean: float
    point: Array
    flips: tuple[bool, bool, bool, bool]
    ahead: float = 0.0

    followed = True

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distances of axis 2 ahead of axis 1 and above base_link, mm."""
        return self.ahead, self.above

    @property
    def reach(self) -> float:
        """Distance from axis 2 to the point of axes 4 and 5 of the stretched arm, mm."""
        return self.upper + self.fore

    def inverse(self, poses: ArrayLike) -> Array:
        """Return joint angles of all solutions for flange poses.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (16, n, 6) array
            Angles in -pi to pi, rad. The first eight are the least singular solution of
            each configuration, the others follow. NaN where there are no more.
        """
        return self.solutions(poses)[0]

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return the joint angles (n, 6) of one configuration, of several solutions the least
        singular; otherwise as `inverse`.
        """
        result: Array = self.inverse(poses)[branch]
        return result

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse` with their configurations.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        angles : (16, n, 6) array
            Angles in -pi to pi, rad.
        words : (16, n) int array
            The configuration of each solution, -1 where there is none.
        """
        targets = np.asarray(poses, float)
        result = np.full((MAX_SOLUTIONS, len(targets), 6), np.nan)
        words = np.full((MAX_SOLUTIONS, len(targets)), -1, dtype=np.intp)
        for start in range(0, len(targets), CHUNK):
            rows = slice(start, start + CHUNK)
            self._solve_piece(targets[rows], result[:, rows], words[:, rows])
        return result, words

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the configuration (...) of joint angles `q` (..., 6)."""
        angles = np.asarray(q, float)
        flat = angles.reshape(-1, 6)
        back, elbow_left = self._sides(flat)
        curves = self._curves(self.chain.forward(flat))
        rows = np.arange(len(flat))
        side, elbow = np.where(back, -1.0, 1.0), np.where(elbow_left, 1.0, -1.0)
        ahead, behind = (
            offset_wrist_search.values(curves, rows, flat[:, 5] + step, side, elbow)
            for step in (STEP_RAD, -STEP_RAD)
        )
        configurations = self._words(back, elbow_left, ahead > behind)
        return configurations.reshape(angles.shape[:-1])

    def bend(self, q: ArrayLike) -> Array:
        """Return how far angles `q` (..., 6) are from a stretched elbow or wrist: (...) values, 0
        where stretched, 1 at a right angle.
        """
        angles = np.asarray(q, float)
        two, three = self._plane(angles)
        bent: Array = np.minimum(np.abs(np.sin(three - two)), np.abs(np.sin(angles[..., 4])))
        return bent

    def _plane(self, q: Array) -> tuple[Array, Array]:
        """Return the angles (...) of upper arm and forearm from Z towards the plane's front."""
        two = q[..., 1] * self.signs[1] + self.turns[1]
        return two, two - self.turns[1] + self.turns[2] + q[..., 2] * self.signs[2]

    def _sides(self, q: Array) -> tuple[Mask, Mask]:
        """Return whether the arm is at the back, and its elbow left of the line to the wrist."""
        two, three = self._plane(q)
        back = self.ahead + self.upper * np.sin(two) + self.fore * np.sin(three) < 0.0
        return np.asarray(back), np.asarray(np.sin(three - two) >= 0.0)

    def _words(self, back: Mask, elbow_left: Mask, rising: Mask) -> Index:
        down = back == elbow_left
        flip = rising == np.array(self.flips)[2 * back.astype(int) + elbow_left.astype(int)]
        result: Index = 4 * back.astype(np.intp) + 2 * down + flip
        return result

    def _curves(self, poses: Array) -> Curves:
        """Return the point of axes 4 and 5, and axis 5, as functions of axis 6."""
        at_rest = self.chain.frames(np.zeros(6))
        axis, through = at_rest.directions[5], at_rest.origins[5]
        back = frames.inverse(at_rest.flange)
        moved = poses @ back
        circles = []
        for vector, anchor in (
            (self.point - through, through),
            (at_rest.directions[4], np.zeros(3)),
        ):
            along = axis * float(axis @ vector)
            across = vector - along
            circles.append((along + anchor, across, np.cross(axis, across)))
        rotation = moved[:, :3, :3]
        point = [
            rotation @ circles[0][0] + moved[:, :3, 3],
            rotation @ circles[0][1],
            -(rotation @ circles[0][2]),
        ]
        five = [rotation @ circles[1][0], rotation @ circles[1][1], -(rotation @ circles[1][2])]
        point[0][:, 2] -= self.above
        square = float(at_rest.directions[3] @ at_rest.directions[4])
        return Curves(
            np.stack(point).transpose(0, 2, 1).copy(),
            np.stack(five).transpose(0, 2, 1).copy(),
            self.upper,
            self.fore,
            (math.cos(self.lean), math.sin(self.lean)),
            square,
            self.ahead,
        )

    def _solve_piece(self, poses: Array, out: Array, named: Index) -> None:
        """Write the solutions of poses (m, 4, 4) to `out` (16, m, 6), their configurations to
        `named` (16, m).
        """
        curves = self._curves(poses)
        zeros, plane = exact(curves, offset_wrist_polynomial.zeros(curves))
        if not len(zeros.pose):
            return
        q = self._angles(poses, curves, zeros, plane)
        words = self._words(zeros.side < 0.0, zeros.elbow > 0.0, zeros.slope > 0.0)
        # first the least singular solution of each configuration, after these eight the others
        order = np.lexsort((-np.abs(zeros.slope), words, zeros.pose))
        pose, words = zeros.pose[order], words[order]
        is_first = np.ones(len(order), dtype=bool)
        is_first[1:] = (pose[1:] != pose[:-1]) | (words[1:] != words[:-1])
        slot = words.copy()
        further = np.flatnonzero(~is_first)
        begins = np.ones(len(further), dtype=bool)
        begins[1:] = pose[further[1:]] != pose[further[:-1]]
        number = np.arange(len(further))
        slot[further] = 8 + number - np.maximum.accumulate(np.where(begins, number, 0))
        in_range = slot < MAX_SOLUTIONS
        out[slot[in_range], pose[in_range]] = q[order[in_range]]
        named[slot[in_range], pose[in_range]] = words[in_range]

    def _angles(self, poses: Array, curves: Curves, zeros: Zeros, plane: Array) -> Array:
        """Return the joint angles (k, 6) of zeros, in [-pi, pi].

        plane: (2, k) its sine and cosine, NaN where the point determines it.
        """
        at_rest = self.chain.frames(np.zeros(6))
        z = at_rest.directions
        spot = geometry(curves, zeros.pose, zeros.angle, zeros.side, zeros.bent)
        fore = np.stack([spot.fore_ahead, spot.fore_above])
        upper = np.stack([spot.ahead, spot.above]) - self.fore * fore
        three, two = np.arctan2(*fore), np.arctan2(*upper)
        q = np.empty((6, len(three)))
        plane = np.where(np.isnan(plane), [spot.sine, spot.cosine], plane)
        q[0] = (np.arctan2(*plane) - self.turns[0]) * self.signs[0]
        q[1] = (two - self.turns[1]) * self.signs[1]
        q[2] = (three - two - (self.turns[2] - self.turns[1])) * self.signs[2]
        six = (poses[:, :3, :3] @ (at_rest.flange[:3, :3].T @ z[5])).T[:, zeros.pose]
        # axes 5 and 6 of the arm with axes 1 to 3 at zero
        plane = _subtract_angle(plane, self.turns[0])
        turned = _subtract_angle(fore / np.hypot(*fore), self.turns[2])
        normal = z[1] * self.signs[1]
        five, six = (
            _rotate_back(normal, turned, _rotate_back(UP, plane, direction))
            for direction in (np.stack(spot.five), six)
        )
        fourth = _towards(z[3], z[4], five)
        six = _rotate_back(z[3], fourth / np.hypot(*fourth), six)
        q[3], q[4], q[5] = np.arctan2(*fourth), np.arctan2(*_towards(z[4], z[5], six)), zeros.angle
        q -= TURN * np.rint(q * (1.0 / TURN))
        return q.T


def _subtract_angle(sine_cosine: Array, angle: float) -> Array:
    """Return sine and cosine (2, k) of angles minus an angle; the angles as sine and cosine."""
    sine, cosine = sine_cosine
    cos, sin = math.cos(angle), math.sin(angle)
    return np.stack([sine * cos - cosine * sin, cosine * cos + sine * sin])


def _rotate_back(axis: Array, by: Array, vectors: Array) -> Array:
    """Return vectors (3, k) rotated back about an axis (3,) by angles with sine and cosine `by`
    (2, k).
    """
    across = np.cross(axis, np.eye(3)).T @ vectors
    result: Array = (
        by[1] * vectors - by[0] * across + axis[:, None] * ((1.0 - by[1]) * (axis @ vectors))
    )
    return result


def _towards(axis: Array, vector: Array, target: Array) -> Array:
    """Return sine and cosine (2, k) of the angles about an axis (3,) that turn a vector (3,) to
    targets (3, k).

    Both are multiplied by the same positive length.
    """
    across = vector - axis * float(axis @ vector)
    result: Array = np.stack([np.cross(axis, across), across]) @ target
    return result
