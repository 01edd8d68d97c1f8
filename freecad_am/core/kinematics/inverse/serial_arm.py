# SPDX-License-Identifier: LGPL-2.1-or-later
"""What planning asks of the inverse kinematics of a serial arm, whichever its wrist."""

from __future__ import annotations

from typing import Protocol

from ...types import Array, ArrayLike, Index


class SerialArm(Protocol):
    """The inverse of an arm with six revolute joints. Poses are those of the flange in base_link, mm; angles serial, rad.

    Configurations go by the words of `opw.branch_name`, the first index of `inverse`; each kind of arm says what they mean.
    """

    @property
    def followed(self) -> bool:
        """Whether several solutions may bear the same words, so that along a bead the one before has to be followed."""

    @property
    def shoulder(self) -> tuple[float, float]:
        """How far axis 2 lies ahead of axis 1 and above base_link, mm."""

    @property
    def reach(self) -> float:
        """From axis 2 to the wrist of the stretched arm, mm."""

    def inverse(self, poses: ArrayLike) -> Array:
        """Joint angles (configurations, n, 6) for flange poses (n, 4, 4) in [-pi, pi]; NaN where not reached. The first
        eight are those of the words; further ones, of arms that are `followed`, bear the words of one of these."""

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Joint angles (n, 6) of one configuration of words; else as `inverse`."""

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """All of `inverse`, and the configuration (configurations, n) whose words each bears, -1 where there is none."""

    def branch_of(self, q: ArrayLike) -> Index:
        """The configuration (...) of joint angles `q` (..., 6)."""

    def bend(self, q: ArrayLike) -> Array:
        """(...) how far angles `q` (..., 6) are from where wrist or elbow is stretched: 0 there, 1 square to it."""
