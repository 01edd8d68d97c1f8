# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rapids around an obstacle that no retract distance avoids: through via points, found by sampling."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from ...kinematics.cell import Cell
from ...types import Array, Mask
from ..reserve import RESERVE
from .attempts import Attempt
from .clearance import Moves
from .retract_ways import Leg
from .retracts import Retracts
from .way_round import Ranges, way_round

# largest turn of an endless axis in one rapid move, rad: such an axis takes the shorter way, so half a turn is in doubt
LARGEST_TURN = np.radians(170.0)
MAX_FAILED_DETOURS = 3  # ways for which none is found, after which no more are looked for: looking takes seconds, and the job is none
KNOWN = 8  # ways found before that are tried first

Legs = dict[int, Leg | None]


class LedRound:
    """Finds ways round. clear: whether nothing is met on moves. ways: the numbers of those that are led round."""

    def __init__(self, cell: Cell, retracts: Retracts, clear: Callable[[Moves], Mask]) -> None:
        self.cell, self.retracts, self.clear = cell, retracts, clear
        self.ways: list[int] = []
        self._lost = 0
        self._known: list[
            Array
        ] = []  # places of the last ways found, there and back: the next one often leads the same way

    def find_detour(
        self,
        ends: Mapping[int, Array],
        legs: Mapping[int, Leg | None],
        attempts: Sequence[Attempt],
        deposited: int,
    ) -> tuple[Legs, Array] | None:
        """Return legs off the ends of beads, with the joints (axes,) at the ends by their number, and the via
        points (m, axes) of a path between them, with `deposited` points printed; None without one. legs:
        the legs tried before.
        """
        if not ends or self._lost >= MAX_FAILED_DETOURS:
            return None
        new_legs: Legs = {}
        far_ends: list[Array] = []
        for end, joints in ends.items():
            off = self._find_leg(end, joints, legs[end], attempts, deposited)
            if off is not None:
                new_legs[end] = off[0]
                far_ends.append(off[1])
        via_points = (
            self._between(far_ends[0], far_ends[1], deposited)
            if len(far_ends) == len(ends)
            else None
        )
        if via_points is None:
            self._lost += 1
            return None
        self._known = [via_points, via_points[::-1], *self._known][:KNOWN]
        return new_legs, via_points

    def _find_leg(
        self,
        end: int,
        joints: Array,
        tried_leg: Leg | None,
        attempts: Sequence[Attempt],
        deposited: int,
    ) -> tuple[Leg | None, Array] | None:
        """Return a clear leg off the end of a bead, None where it needs none, and its far joints; None without
        any.
        """
        if tried_leg is None and self._clear(joints[None], joints[None], deposited)[0]:
            return None, joints
        for leg in self._others(end, tried_leg, attempts):
            rows = np.vstack([joints, leg.joints])
            if self._clear(rows[:-1], rows[1:], deposited).all():
                return leg, leg.joints[-1]
        return None

    def _others(
        self, end: int, tried_leg: Leg | None, attempts: Sequence[Attempt]
    ) -> Iterator[Leg]:
        """The leg tried before, and those of all attempts."""
        if tried_leg is not None:
            yield tried_leg
        for attempt in attempts:
            legs, _ = self.retracts.find_legs(
                np.array([end]),
                np.array([attempt.height]),
                attempt.direction,
                attempt.tolerance,
                thorough=False,
            )
            if legs[0] is not None:
                yield legs[0]

    def _between(self, start: Array, goal: Array, deposited: int) -> Array | None:
        """The places of a way round."""
        for via_points in self._known:
            route = np.vstack([start, via_points, goal])
            if self._clear(route[:-1], route[1:], deposited).all():
                return via_points
        return way_round(
            start,
            goal,
            self._ranges(start, goal),
            lambda a, b: self._clear(a, b, deposited),
            self._fits,
        )

    def _clear(self, start: Array, end: Array, deposited: int) -> Mask:
        """(k,) whether moves can be driven, and meet nothing."""
        continuous = self.cell.limits.continuous
        short: Mask = (np.abs(end - start)[:, continuous] <= LARGEST_TURN).all(axis=1)
        rows = np.flatnonzero(short)
        short[rows] = self.clear(
            Moves(start[rows], end[rows], np.full(len(rows), deposited, dtype=np.intp))
        )
        return short

    def _ranges(self, start: Array, goal: Array) -> Ranges:
        """Robots move within their limits, axes without end half a turn further than both ends, external axes no
        further than from one to the other."""
        limits, robot_axes = self.cell.limits, self.cell.robot.chain.axes
        lowest, highest = np.minimum(start, goal), np.maximum(start, goal)
        reserve = self.retracts.reserve_of_limits(RESERVE)[: limits.axes]
        low = np.where(limits.continuous, lowest - np.pi, limits.lower + reserve)
        high = np.where(limits.continuous, highest + np.pi, limits.upper - reserve)
        low[robot_axes:], high[robot_axes:] = lowest[robot_axes:], highest[robot_axes:]
        return Ranges(low, high, self.cell.machine.max_speed)

    def _fits(self, joints: Array) -> Mask:
        """(k,) whether joints keep limits and condition, and are of the configuration of the beads."""
        fits = self.retracts.fits(joints[:, None], self.retracts.reserve_of_limits(RESERVE))
        arm, branch = self.cell.robot.arm, self.retracts.branch
        rows = np.flatnonzero(fits)
        if branch is not None and arm is not None and len(rows):
            fits[rows] = arm.branch_of(joints[rows, : self.cell.robot.chain.axes]) == branch
        return fits
