# SPDX-License-Identifier: LGPL-2.1-or-later
"""The interface of the inverse kinematics of a serial arm that planning uses, for every kind of
wrist.
"""

from __future__ import annotations

from typing import Protocol

from ...types import Array, ArrayLike, Index


class SerialArm(Protocol):
    """The inverse of an arm with six revolute joints. Poses are flange poses in base_link, mm;
    angles serial, rad.

    Configurations follow the words of `spherical_wrist.branch_name`, the first index of `inverse`; each
    kind of arm defines their meaning.
    """

    @property
    def followed(self) -> bool:
        """Whether several solutions may have the same words, so that along a bead the previous
        solution must be followed.
        """

    @property
    def shoulder(self) -> tuple[float, float]:
        """Return the position of axis 2.

        Returns
        -------
        ahead : float
            Distance ahead of axis 1, mm.
        above : float
            Height above base_link, mm.
        """

    @property
    def reach(self) -> float:
        """From axis 2 to the wrist of the stretched arm, mm."""

    def inverse(self, poses: ArrayLike) -> Array:
        """Return joint angles of all solutions for flange poses.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (configurations, n, 6) array
            Angles in -pi to pi, rad; NaN out of reach. The first eight follow the
            words; further ones, for arms that are `followed`, repeat the words of one
            of the first.
        """

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return joint angles of one configuration.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.
        branch : int
            Index of the configuration.

        Returns
        -------
        (n, 6) array
            Angles in -pi to pi, rad; NaN out of reach.
        """

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse` with their configurations.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        angles : (configurations, n, 6) array
            Angles in -pi to pi, rad.
        words : (configurations, n) int array
            The configuration of each solution, -1 without a solution.
        """

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the configuration of joint angles.

        Parameters
        ----------
        q : (..., 6) array_like
            Joint angles, rad.

        Returns
        -------
        (...) array of int
            Numbers of the configurations, 0 to 7.
        """

    def bend(self, q: ArrayLike) -> Array:
        """Return how far the arm is from a stretched elbow or wrist.

        Parameters
        ----------
        q : (..., 6) array
            Serial angles, rad.

        Returns
        -------
        (...) array
            0 where stretched, 1 at a right angle.
        """
