# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inverse kinematics of machines with three prismatic and two revolute axes in any order
(Dai 2020, section 3).

The chain runs from the torch to the table (see the machine files), so table, head and mixed
machines are one case. The two revolute axes turn the tool direction in the part to the torch
direction, regardless of prismatic axes between them. The prismatic axes then move the point to the
torch tip.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...types import Array, Mask
from ..chain import Chain
from . import rotary_pair

SLIDING, TURNING = 3, 2  # number of prismatic and revolute axes


def is_five_axis(sliding: Mask) -> bool:
    """Whether axes are those of a five-axis machine, in any order.

    Parameters
    ----------
    sliding : (n,) array of bool
        Which axes are prismatic.

    Returns
    -------
    bool
        True for three prismatic and two revolute axes.
    """
    return (int(sliding.sum()), len(sliding)) == (SLIDING, SLIDING + TURNING)


class Solutions(NamedTuple):
    """Axis values in both branches.

    axes: (2, n, 5) rad in (-pi, pi] and mm; NaN where no rotation reaches the direction. free:
    (n, 2) whether the first or second revolute axis may have any value, because the direction is
    along it. Its value is then 0, and the prismatic axes match it.
    """

    axes: Array
    free: Mask


@dataclass(frozen=True, eq=False)
class FiveAxis:
    """A chain of three prismatic and two revolute joints. Raises ValueError for any other chain."""

    chain: Chain
    turning: tuple[int, int] = field(init=False)
    sliding: tuple[int, int, int] = field(init=False)

    def __post_init__(self) -> None:
        slides = self.chain.sliding
        if not is_five_axis(slides):
            raise ValueError("a five-axis machine has three axes that slide and two that turn")
        object.__setattr__(self, "turning", tuple(np.flatnonzero(~slides).tolist()))
        object.__setattr__(self, "sliding", tuple(np.flatnonzero(slides).tolist()))

    @property
    def pole(self) -> Array:
        """Return the axis of the revolute joint next to the flange.

        Returns
        -------
        (3,) array
            Unit vector in the flange frame. Tool directions along this axis, in either sense,
            leave the joint free.
        """
        _, second, source, _ = self._pair(np.eye(3), np.array([0.0, 0.0, 1.0]))
        return np.asarray(source @ second)

    def turns(self, tools: Array, torch: Array) -> rotary_pair.Turns:
        """Return the rotations that turn tool directions (n, 3) on the flange to the torch.

        torch: (3,) torch direction in base_link. All are unit vectors.
        """
        first_axis, second_axis, source, target = self._pair(tools, torch)
        return rotary_pair.solve_turns(first_axis, second_axis, source, target)

    def inverse(self, points: Array, tools: Array, station: Array) -> Solutions:
        """Return the axis values that hold points and tool directions at the torch.

        Parameters
        ----------
        points : (n, 3) array
            Points in the flange frame, mm.
        tools : (n, 3) array
            Tool directions in the flange frame, unit vectors.
        station : (4, 4) array
            Torch tip in base_link, with Z into the torch.

        Returns
        -------
        Solutions
            Axis values of both branches.

        References
        ----------
        Dai 2020, section 3.
        """
        turns = self.turns(tools, station[:3, 2])
        turned = np.stack([turns.first_turn, turns.second_turn], axis=-1)
        axes = np.stack([self.place_points(branch, points, station) for branch in turned])
        return Solutions(axes, np.stack([turns.first_free, turns.second_free], axis=1))

    def locked(
        self, axis: int, angle: Array | float, tools: Array, torch: Array
    ) -> rotary_pair.Locked:
        """Solve for four axes, with a given angle of one revolute axis.

        The other revolute axis turns the tools as close as possible to the torch.

        Parameters
        ----------
        axis : int
            Index of the locked axis, 0 or 1.
        angle : float or (n,) array
            Angle of the locked axis, rad.
        tools : (n, 3) array
            Tool directions in the flange frame, unit vectors.
        torch : (3,) array
            Direction into the torch in base_link.

        Returns
        -------
        rotary_pair.Locked
            Angle of the other axis, and residual.
        """
        first_axis, second_axis, source, target = self._pair(tools, torch)
        lock = rotary_pair.lock_first if axis == 0 else rotary_pair.lock_second
        return lock(first_axis, second_axis, angle, source, target)

    def best_lock(self, axis: int, tools: Array, torch: Array, low: float, high: float) -> float:
        """Return the lock angle with the smallest maximum residual.

        Parameters
        ----------
        axis : int
            Index of the locked axis, 0 or 1.
        tools : (n, 3) array
            Tool directions in the flange frame, unit vectors.
        torch : (3,) array
            Direction into the torch in base_link.
        low, high : float
            Range of the angle, rad.

        Returns
        -------
        float
            The angle, rad.
        """
        first_axis, second_axis, source, target = self._pair(tools, torch)
        return rotary_pair.minimise_residual(
            first_axis, second_axis, axis, source, target, low, high
        )

    def place_points(self, turned: Array, points: Array, station: Array) -> Array:
        """Add the prismatic axis values that move points to the torch tip.

        Parameters
        ----------
        turned : (n, 2) array
            Angles of the revolute axes, rad; NaN gives a row of NaN.
        points : (n, 3) array
            Points in the flange frame, mm.
        station : (4, 4) array
            Torch tip in base_link.

        Returns
        -------
        (n, 5) array
            Values of all axes, rad or mm.
        """
        axes = np.zeros((len(points), 5))
        axes[:, self.turning] = turned
        reachable = np.isfinite(turned).all(axis=1)
        joint_frames = self.chain.frames(axes[reachable])
        points_now = (
            np.einsum("nij,nj->ni", joint_frames.flange[:, :3, :3], points[reachable])
            + joint_frames.flange[:, :3, 3]
        )
        slide_directions = np.swapaxes(joint_frames.directions[:, self.sliding], 1, 2)
        slides = np.full((len(points), 3), np.nan)
        slides[reachable] = np.linalg.solve(
            slide_directions, (station[:3, 3] - points_now)[..., None]
        )[..., 0]
        axes[:, self.sliding] = slides
        axes[~reachable] = np.nan
        return axes

    def _pair(self, tools: Array, torch: Array) -> tuple[Array, Array, Array, Array]:
        """Return axes, sources (n, 3) and target (3,) for `rotary_pair`, in the frame of the first
        revolute joint.

        Let A, B, C be the rotations at zero before, between and after the joints. Then
        A Rot(d1) B Rot(d2) C tool = torch is equivalent to
        Rot(d1) Rot(B d2) (B C tool) = A^T torch.
        """
        first_joint, second_joint = self.turning
        rotations = self.chain.origins[:, :3, :3]
        rotation_before = _product(rotations[: first_joint + 1])
        rotation_between = _product(rotations[first_joint + 1 : second_joint + 1])
        rotation_after = _product(rotations[second_joint + 1 :]) @ self.chain.flange[:3, :3]
        source = tools @ (rotation_between @ rotation_after).T
        return (
            self.chain.directions[first_joint],
            rotation_between @ self.chain.directions[second_joint],
            source,
            rotation_before.T @ torch,
        )


def _product(rotations: Array) -> Array:
    result = np.eye(3)
    for rotation in rotations:
        result = result @ rotation
    return result
