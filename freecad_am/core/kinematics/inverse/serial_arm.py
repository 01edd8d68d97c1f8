# SPDX-License-Identifier: LGPL-2.1-or-later
"""What planning asks of the inverse kinematics of a serial arm, whichever its wrist."""

from __future__ import annotations

from typing import Protocol

from ...types import Array, ArrayLike, Index


class SerialArm(Protocol):
    """The inverse of an arm with six revolute joints. Poses are flange poses in base_link, mm;
    angles serial, rad.

    Configurations follow the words of `opw.branch_name`, the first index of `inverse`; each
    kind of arm defines their meaning.
    """

    @property
    def followed(self) -> bool:
        """Whether several solutions may have the same words, so that along a bead the previous
        solution must be followed.
        """

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distances of axis 2 ahead of axis 1 and above base_link, mm."""

    @property
    def reach(self) -> float:
        """From axis 2 to the wrist of the stretched arm, mm."""

    def inverse(self, poses: ArrayLike) -> Array:
        """Return joint angles (configurations, n, 6) for flange poses (n, 4, 4) in [-pi, pi]; NaN if
        out of reach.

        The first eight follow the words; further ones, of arms that are `followed`, repeat the
        words of one of these.
        """

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Joint angles (n, 6) of one configuration of words; else as `inverse`."""

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse`, and the configuration (configurations, n) whose words
        each has, -1 without a solution.
        """

    def branch_of(self, q: ArrayLike) -> Index:
        """The configuration (...) of joint angles `q` (..., 6)."""

    def bend(self, q: ArrayLike) -> Array:
        """(...) how far angles `q` (..., 6) are from where wrist or elbow is stretched: 0 there, 1 square to it."""
