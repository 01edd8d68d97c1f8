# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed-form kinematics of six-axis arms with parallel axes 2 and 3 and a spherical wrist, over arrays of poses.

Geometry and parameters: Brandstoetter, Angerer, Hofbaur, "An analytical solution of the inverse kinematics
problem of industrial serial manipulators with an ortho-parallel basis and a spherical wrist", 2014.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.columns import columns
from ...types import Array, ArrayLike, Index
from .opw_inverse import solve

SHOULDERS, ELBOWS, WRISTS = ("front", "back"), ("up", "down"), ("noflip", "flip")
BRANCHES = tuple(itertools.product(SHOULDERS, ELBOWS, WRISTS))


def branch_index(words: Sequence[str]) -> int:
    """The index 4 back + 2 down + flip of a branch given by its three words; ValueError if they are none."""
    return BRANCHES.index((words[0], words[1], words[2]))


def branch_name(index: int) -> tuple[str, str, str]:
    """The three words of a branch: shoulder, elbow, wrist."""
    return BRANCHES[index]


@dataclass(frozen=True, eq=False)
class OpwArm:
    """The seven lengths (mm), `offsets` (rad) and `signs` of an arm: q_opw = q * sign - offset.

    All poses are poses of the flange in base_link, mm. Joint angles are the serial ones, rad.

    A branch is front if the wrist centre is on the side of axis 1 to which q1 points; up if
    the elbow is above the line from shoulder to wrist centre, that is on its left, seen in
    the arm's plane with the wrist centre's side of axis 1 to the right; flip if q5 < 0,
    counted from the stretched wrist.
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

    followed = False  # words distinguish all solutions

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distances of axis 2 ahead of axis 1 and above base_link, mm."""
        return self.a1, self.c1

    @property
    def reach(self) -> float:
        """From axis 2 to the wrist centre of the stretched arm, mm."""
        return self.c2 + self.forearm

    @property
    def forearm(self) -> float:
        """Distance from the elbow to the wrist centre."""
        return math.hypot(self.a2, self.c3)

    def forward(self, q: ArrayLike) -> Array:
        """The flange poses (..., 4, 4) for joint angles `q` (..., 6)."""
        angles = np.asarray(q, float)
        turned = np.moveaxis(angles * np.array(self.signs, float) - np.array(self.offsets), -1, 0)
        (s1, s2, _, s4, s5, s6), (c1, c2, _, c4, c5, c6) = np.sin(turned), np.cos(turned)
        s23, c23 = np.sin(turned[1] + turned[2]), np.cos(turned[1] + turned[2])
        reach = self.a1 + self.c2 * s2 + self.a2 * c23 + self.c3 * s23
        height = self.c1 + self.c2 * c2 - self.a2 * s23 + self.c3 * c23
        # the flange's axes in the forearm's frame, then about the elbow, then about axis 1
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
        """Return joint angles (8, n, 6) of all branches for flange poses (n, 4, 4), in [-pi, pi]
        rad.

        The first index follows `branch_name`. All six angles of a branch that does not reach a
        pose are NaN. At the singularity of the wrist (stretched) axis 4 takes the angle of opw
        zero and axis 6 the rest; with the wrist centre on axis 1, axis 1 takes it. Forward
        kinematics reproduces the pose to about 1e-9 mm.
        """
        return solve(self, poses, tuple(range(8)))

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Joint angles (n, 6) of one branch (an index of `branch_name`); else as `inverse`."""
        result: Array = solve(self, poses, (branch,))[0]
        return result

    def bend(self, q: ArrayLike) -> Array:
        """(...) how far angles `q` (..., 6) are from where wrist or elbow is stretched: 0 there, 1 square to it."""
        turned = np.asarray(q, float) * np.array(self.signs, float) - np.array(self.offsets)
        bent: Array = np.minimum(
            np.abs(np.sin(turned[..., 4])),
            np.abs(np.sin(turned[..., 2] + np.arctan2(self.a2, self.c3))),
        )
        return bent

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """All of `inverse`, and the configuration (8, n) of each, -1 where it does not reach."""
        angles = self.inverse(poses)
        return angles, np.where(np.isnan(angles[..., 0]), -1, np.arange(8)[:, None])

    def branch_of(self, q: ArrayLike) -> Index:
        """The branch index (...) that joint angles `q` (..., 6) are in."""
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
