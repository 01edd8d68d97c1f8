# SPDX-License-Identifier: LGPL-2.1-or-later
"""The interface between planning and the inverse kinematics of serial arms of all wrist types."""

from __future__ import annotations

from typing import Protocol

from ...types import Array, ArrayLike, Index


class SerialArm(Protocol):
    """The inverse kinematics of an arm with six revolute joints.

    Poses are flange poses in base_link, mm. Angles are serial joint values, rad. The first index of
    `inverse` is the configuration, named by `spherical_wrist.branch_name`; each type of arm defines
    the meaning of the names.
    """

    @property
    def followed(self) -> bool:
        """Whether several solutions may share a configuration name.

        Planning then follows one solution along a bead.
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
        """Distance from axis 2 to the wrist of the stretched arm, mm."""

    def inverse(self, poses: ArrayLike) -> Array:
        """Return the joint angles of all solutions for flange poses.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (configurations, n, 6) array
            Angles in -pi to pi, rad; NaN out of reach. The first eight solutions are the
            configurations in order. Arms that are `followed` may have more solutions, which
            share the name of one of the first eight.
        """

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return the joint angles of one configuration.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.
        branch : int
            Configuration index.

        Returns
        -------
        (n, 6) array
            Angles in -pi to pi, rad; NaN out of reach.
        """

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse` and their configurations.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        angles : (configurations, n, 6) array
            Angles in -pi to pi, rad.
        words : (configurations, n) int array
            Configuration index of each solution; -1 without a solution.
        """

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the configuration index of joint angles.

        Parameters
        ----------
        q : (..., 6) array_like
            Joint angles, rad.

        Returns
        -------
        (...) array of int
            Configuration indices, 0 to 7.
        """

    def bend(self, q: ArrayLike) -> Array:
        """Return the distance of the arm from a stretched elbow or wrist.

        Parameters
        ----------
        q : (..., 6) array
            Serial angles, rad.

        Returns
        -------
        (...) array
            0 if stretched, 1 at a right angle.
        """
