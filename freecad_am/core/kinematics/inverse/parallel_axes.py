# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed-form kinematics of arms with parallel axes 2, 3 and 4, such as Universal Robots arms.

After Hawkins, "Analytic inverse kinematics for the Universal Robots", 2013, generalised to any
lengths and zeros. The point where axes 5 and 6 meet has a constant distance from the arm plane,
which gives axis 1. Axis 6 relative to the normal of this plane gives axis 5. Axes 2 to 4 form a
triangle. Arrays hold one component of all poses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...geometry import frames
from ...geometry.columns import columns
from ...geometry.frames import TURN
from ...types import Array, ArrayLike, Index

CHUNK = 2048
# tolerances for poses that rounding puts just out of reach: beyond a stretched arm (1 - cos^2 of
# the elbow), and within `offset` of axis 1 (mm)
STRETCH, TOUCH = 4e-12, 1e-9
# added to directions that may vanish: defines an angle there; elsewhere rounding absorbs it
HINT = 1e-150
PARALLEL = 1e-10  # rad; closer to the normal of the arm plane, axis 6 does not determine axis 5


@dataclass(frozen=True, eq=False)
class ParallelAxesArm:
    """An arm with lengths (mm), and `signs` and `zeros` (rad) of its joints.

    theta = sign * q + zero. If all theta are 0, the arm plane is XZ of base_link; upper arm,
    forearm and axis 5 point up, and axis 6 is along Y. Axis 2 is at `ahead` and `above`; axes 3 and
    4 follow at distances `upper` and `fore`. The point where axes 5 and 6 meet is at `wrist` (x, z)
    from axis 4 and at `offset` from the plane of axis 1. `tip` (4, 4) is the flange relative to
    this point, with X along axis 5 and Z along axis 6.

    A configuration is front if the point where axes 5 and 6 meet is on the side of axis 1 that the
    arm reaches to with all q 0. It is up if the elbow is above the line from shoulder to axis 4, as
    for a spherical wrist. It is flip if q5 < 0, measured from where axis 6 is parallel to axis 4.
    """

    ahead: float
    above: float
    upper: float
    fore: float
    wrist: tuple[float, float]
    offset: float
    tip: Array
    signs: tuple[int, ...]
    zeros: tuple[float, ...]

    followed = False

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distance of axis 2 ahead of axis 1, and its height above base_link, mm."""
        return self.ahead, self.above

    @property
    def reach(self) -> float:
        """Distance from axis 2 to axis 4 of the stretched arm, mm."""
        return self.upper + self.fore

    def inverse(self, poses: ArrayLike) -> Array:
        """Return the joint angles of all configurations for flange poses.

        If axis 6 is parallel to axis 4, axes 4 and 6 share their rotation so that the elbow is as
        close as possible to a right angle. If axis 1 is free, its theta is 0.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (8, n, 6) array
            Angles in -pi to pi, rad. All six are NaN for a configuration out of reach.
        """
        return self._solved(poses, tuple(range(8)))

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return joint angles (n, 6) of one configuration, see `inverse`."""
        result: Array = self._solved(poses, (branch,))[0]
        return result

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse`, and their configurations (8, n); -1 out of reach."""
        angles = self.inverse(poses)
        return angles, np.where(np.isnan(angles[..., 0]), -1, np.arange(8)[:, None])

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the configuration index (...) of joint angles `q` (..., 6)."""
        angles = np.asarray(q, float)
        theta = columns(angles * np.array(self.signs, float) + np.array(self.zeros))
        four = theta[1] + theta[2] + theta[3]
        ahead = self.ahead + self.upper * np.sin(theta[1]) + self.fore * np.sin(theta[1] + theta[2])
        ahead = ahead + self.wrist[0] * np.cos(four) + self.wrist[1] * np.sin(four)
        back = ahead < 0.0
        down = (np.sin(theta[2]) < 0.0) != back
        bent = np.sin(theta[4]) * self.signs[4] < 0.0
        result: Index = 4 * back + 2 * down + bent
        return result

    def bend(self, q: ArrayLike) -> Array:
        """Return the distance (...) of angles `q` (..., 6) from a stretched wrist or elbow.

        0 if stretched, 1 at a right angle.
        """
        theta = np.asarray(q, float) * np.array(self.signs, float) + np.array(self.zeros)
        bent: Array = np.minimum(np.abs(np.sin(theta[..., 4])), np.abs(np.sin(theta[..., 2])))
        return bent

    def _solved(self, poses: ArrayLike, branches: tuple[int, ...]) -> Array:
        targets = np.ascontiguousarray(poses, float)
        count = len(targets)
        tip = frames.inverse(self.tip)
        result = np.empty((len(branches), 6, count))
        with np.errstate(invalid="ignore", divide="ignore"):
            for start in range(0, count, CHUNK):
                rows_now = slice(start, start + CHUNK)
                rows = np.moveaxis(targets[rows_now, :3] @ tip, 0, -1).copy()
                self._solve_piece(rows, branches, result[:, :, rows_now])
        return result.transpose(0, 2, 1)

    def _solve_piece(self, rows: Array, branches: tuple[int, ...], out: Array) -> None:
        """Write the angles (branches, 6, m) of frames on axis 6 to `out`; rows: (3, 4, m)."""
        centre = rows[:, 3]
        squared = (centre[0] + HINT) ** 2 + centre[1] ** 2
        along = squared - self.offset**2
        unreachable = along < -2.0 * max(abs(self.offset), TOUCH) * TOUCH
        along = np.sqrt(np.maximum(along, 0.0))
        along[unreachable] = np.nan
        for back in (0, 1):
            of_side = {
                index & 3: out[slot] for slot, index in enumerate(branches) if index >> 2 == back
            }
            if not of_side:
                continue
            signed = -along if back else along
            sine = (centre[1] * signed - (centre[0] + HINT) * self.offset) / squared
            cosine = ((centre[0] + HINT) * signed + centre[1] * self.offset) / squared
            theta_1 = self._to_machine(0, np.arctan2(sine, cosine))
            # axis 6 in the arm frame: ahead, along the plane normal, up
            axis_6 = (
                rows[0, 2] * cosine + rows[1, 2] * sine,
                rows[1, 2] * cosine - rows[0, 2] * sine,
                rows[2, 2],
            )
            off = np.hypot(axis_6[0], axis_6[2])
            # axis 5 is normal to the plane normal and to axis 6; it is free if they are parallel
            five_x, five_z = axis_6[2] / off, -axis_6[0] / off
            free = off < PARALLEL
            if free.any():
                offsets = signed[free] - self.ahead, centre[2, free] - self.above
                five_x[free], five_z[free] = self._chosen(*offsets)
            bent = np.arctan2(off, axis_6[1])
            axis_5 = [
                (rows[0, k] * cosine + rows[1, k] * sine) * five_x + rows[2, k] * five_z
                for k in (0, 1)
            ]
            theta_6 = np.arctan2(-axis_5[1], axis_5[0])
            for turned in (0, 1):
                # this direction of axis 5 belongs to the solution with theta 5 > 0
                flip = turned if self.signs[4] > 0 else 1 - turned
                pair = [
                    (down, of_side[2 * down + flip])
                    for down in (0, 1)
                    if 2 * down + flip in of_side
                ]
                if not pair:
                    continue
                side = -1.0 if turned else 1.0
                fifth = self._to_machine(4, -bent if turned else bent)
                sixth = self._to_machine(
                    5, theta_6 - np.copysign(math.pi, theta_6) if turned else theta_6
                )
                x, z = side * five_x, side * five_z
                ahead = signed - self.ahead - self.wrist[0] * z - self.wrist[1] * x
                above = centre[2] - self.above + self.wrist[0] * x - self.wrist[1] * z
                theta_234 = np.arctan2(x, z)
                bend, towards, across = self._triangle(ahead, above)
                for down, angles in pair:
                    elbow_left = back == down
                    elbow = bend if elbow_left else -bend
                    turn = across if elbow_left else -across
                    theta_2 = np.arctan2(
                        ahead * towards - above * turn, above * towards + ahead * turn
                    )
                    angles[0], angles[4], angles[5] = theta_1, fifth, sixth
                    angles[1] = self._to_machine(1, theta_2)
                    angles[2] = self._to_machine(2, elbow)
                    angles[3] = self._to_machine(3, theta_234 - theta_2 - elbow)
                    angles[:, np.isnan(theta_2) | np.isnan(theta_1)] = np.nan

    def _chosen(self, ahead: Array, above: Array) -> tuple[Array, Array]:
        """Return the direction (x, z) of a free axis 5 that brings the elbow closest to 90 deg."""
        length = math.hypot(*self.wrist)
        distance = np.hypot(ahead, above) + HINT
        elbow_distance = np.clip(
            math.hypot(self.upper, self.fore), np.abs(distance - length), distance + length
        )
        # from the point of axes 5 and 6 back to axis 4, by the angle towards the shoulder there
        cosine = np.clip(
            (distance**2 + length**2 - elbow_distance**2) / (2.0 * distance * max(length, TOUCH)),
            -1.0,
            1.0,
        )
        turn = (
            np.arctan2(-ahead, -above)
            + np.arccos(cosine)
            - math.atan2(-self.wrist[0], -self.wrist[1])
        )
        return np.sin(turn), np.cos(turn)

    def _triangle(self, ahead: Array, above: Array) -> tuple[Array, Array, Array]:
        """Solve the triangle of shoulder, elbow and axis 4.

        Return the elbow angle for an elbow on the left, and axis 4 relative to the shoulder, along
        and across the upper arm; NaN where the triangle does not close.
        """
        upper, fore = self.upper, self.fore
        squared = ahead * ahead + above * above
        scale = 1.0 / (2.0 * upper * fore)
        cosine = (squared - (upper**2 + fore**2)) * scale
        sine = (squared - (upper - fore) ** 2) * scale * (((upper + fore) ** 2 - squared) * scale)
        unclosed = sine < -STRETCH
        if abs(upper - fore) < TOUCH:
            unclosed |= squared < TOUCH  # folded back onto the shoulder, where axis 2 is free
        sine = np.sqrt(np.maximum(sine, 0.0))
        sine[unclosed] = np.nan
        return np.arctan2(sine, cosine), upper + fore * cosine, fore * sine

    def _to_machine(self, axis: int, theta: Array) -> Array:
        """Convert angles of the arm to machine angles in [-pi, pi]."""
        angle = theta - self.zeros[axis] if self.zeros[axis] else theta
        turns = np.rint(angle * (1.0 / TURN))
        turns *= TURN
        result: Array = angle - turns
        return -result if self.signs[axis] < 0 else result
