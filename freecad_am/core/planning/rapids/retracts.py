# SPDX-License-Identifier: LGPL-2.1-or-later
"""Feasible retracts from the ends of beads: within limits and reach, and clear of singularities.

A retract leads straight from the end of a bead to the retract distance along the tool axis. An
approach is the reverse. The machine interpolates joints, so rows are added where its path would
deviate from the line by more than a tolerance. If the requested retract is infeasible, alternatives
are tried in a fixed order: other heights, directions, rotations about the tool axis and tilts of
the tool axis at the far end.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...geometry.frames import TURN
from ...kinematics import jacobian as jac
from ...kinematics.cell import Cell
from ...kinematics.inverse import spherical_wrist
from ...kinematics.inverse.five_axis import FiveAxis
from ...kinematics.limits import RESERVE
from ...parameters.joints import JointParameters
from ...types import Array, Index, Mask
from ..joint_path import BeadPath
from ..task import CONDITION_FLOOR
from ..turns import configurations as following

LIMIT, UNREACHABLE, SINGULAR = "LIMIT", "UNREACHABLE", "SINGULAR"

_HEIGHTS = (0.75, 0.5, 0.25, 0.1, 1.5, 2.0, 3.0)
DIRECTIONS = tuple(range(1, 10))
_TURNS = tuple(
    math.radians(sign * turn)
    for turn in (5, 15, 30, 60, 90, 120, 180, 240, 360)
    for sign in (1, -1)
)
# tilts of the tool axis at the far end, and number of sides that it tilts to
LEANS_RAD = (0.0, math.radians(5.0), math.radians(15.0))
SIDES = 8
_LEANS = tuple(range(1, 1 + SIDES * (len(LEANS_RAD) - 1)))


class Choice(NamedTuple):
    """A retract from a bead, relative to the requested one.

    share: fraction of the requested height. direction: index of the direction. turn: rotation about
    the tool axis on the way, rad. lean: index of the added tilt: 0 for none, then SIDES tilts for
    each angle.
    """

    share: float = 1.0
    direction: int = 0
    turn: float = 0.0
    lean: int = 0


DEFAULT_CHOICE = Choice()


def groups(direction: int, thorough: bool) -> tuple[tuple[Choice, ...], ...]:
    """Return the retracts to try, in order of preference.

    Parameters
    ----------
    direction : int
        Index of the requested direction.
    thorough : bool
        Whether to try other heights and directions, not only rotations and tilts.

    Returns
    -------
    tuple[tuple[Choice, ...], ...]
        Groups of retracts; each group is checked at once.
    """
    if not thorough:
        return (
            (Choice(1.0, direction),),
            tuple(Choice(1.0, direction, turn) for turn in _TURNS),
            tuple(Choice(1.0, direction, 0.0, lean) for lean in _LEANS),
        )
    other_directions = tuple(k for k in DIRECTIONS if k != direction)
    return (
        (Choice(1.0, direction),),
        tuple(Choice(share, direction) for share in _HEIGHTS),
        tuple(
            Choice(share, alternative)
            for alternative in other_directions
            for share in (1.0, *_HEIGHTS)
        ),
        tuple(Choice(share, direction, turn) for share in (1.0, 0.5, 0.1, 2.0) for turn in _TURNS),
        tuple(
            Choice(share, direction, 0.0, lean) for share in (1.0, 0.5, 0.1, 2.0) for lean in _LEANS
        ),
        tuple(
            Choice(share, alternative, turn)
            for alternative in other_directions
            for share in (1.0, 0.25)
            for turn in _TURNS
        ),
        tuple(
            Choice(share, direction, turn, lean)
            for share in (1.0, 0.25)
            for turn in _TURNS
            for lean in _LEANS
        ),
    )


class Ways(NamedTuple):
    """Retracts from bead ends.

    end: (k,) end indices. height: (k,) mm. direction: (k, 3). turn: (k,) rotation about the tool
    axis, rad. lean: (k, 3) vectors added to the tool axes at the far end.
    """

    end: Index
    height: Array
    direction: Array
    turn: Array
    lean: Array

    def of(self, rows: Index) -> Ways:
        """Return selected retracts."""
        return Ways(*(column[rows] for column in self))  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Leg:
    """A feasible retract from a bead.

    joints: (m, axes) at the ends of its moves, outwards, unwrapped from the bead. position: (m, 3)
    tip positions there, mm. height: mm. choice: difference from the requested retract.
    """

    joints: Array
    position: Array
    height: float
    choice: Choice


@dataclass(frozen=True)
class Failure:
    """The reason why the requested retract is infeasible.

    kind: LIMIT, UNREACHABLE or SINGULAR. label: index of the limit in `Limits.labels`. value,
    bound: axis value and its limit, rad or mm, or condition and its minimum.
    """

    kind: str
    label: int = 0
    value: float = 0.0
    bound: float = 0.0


@dataclass(frozen=True, eq=False)
class Ends:
    """The first (even) and last (odd) points of all beads, n = twice the bead count.

    point, tool, build: (n, 3) points, tool axes and build directions. phi: (n,) rotations, rad.
    joints: (n, axes).
    """

    point: Array
    tool: Array
    build: Array
    phi: Array
    joints: Array

    @classmethod
    def of(cls, beads: Sequence[BeadPath]) -> Ends:
        """Return the ends of all beads of a joint path."""
        both_ends = [0, -1]
        return cls(
            np.concatenate([path.bead.points[both_ends] for path in beads]),
            np.concatenate([path.bead.tool[both_ends] for path in beads]),
            np.concatenate([path.bead.build[both_ends] for path in beads]),
            np.concatenate([path.phi[both_ends] for path in beads]),
            np.concatenate([path.joints[both_ends] for path in beads]),
        )


# maximum deviation of the tip from the straight path, mm: 1/20 of the usual distance to a wall
STRAY_MM = 0.5
# maximum number of moves in a retract, and maximum rotation about the tool axis per move, rad
MOST_MOVES = 64
MOVE_TURN_RAD = math.radians(60.0)
BETWEEN = np.array([0.25, 0.5, 0.75])
# distance to limits, rad, that the requested retract keeps: rounding to the last digit of a
# program loses this much; alternatives keep RESERVE
LAST_DIGIT_RAD = math.radians(0.001)
ROUNDING_RAD = 1e-9
# a direction must lead away from the bead: minimum cosine of its angle to the tool axis
AWAY = 0.2
SAME_DIRECTION = 1e-6


@dataclass(frozen=True)
class Retracts:
    """Finds retracts from bead ends. branch: of the robot; None for a five-axis machine."""

    cell: Cell
    ends: Ends
    branch: int | None
    parameters: JointParameters

    @cached_property
    def directions(self) -> Array:
        """Return the candidate directions of retracts.

        These are the tool axis, the build direction, the platform normal, the bisectors of each
        pair of them, and the tool axis tilted to four sides.

        Returns
        -------
        (10, n, 3) array
            Unit vectors in the part frame; NaN for a direction that leads back to the bead or
            equals an earlier direction.
        """
        tool, build = self.ends.tool, self.ends.build
        normal = np.broadcast_to(self.cell.poses.mount[:3, 2], tool.shape)
        sides = (tool + self._sides(2.0 * np.pi * k / 4) for k in range(4))
        directions: Array = np.stack(
            [tool, tool + build, build, tool + normal, normal, build + normal, *sides]
        )
        size = np.linalg.norm(directions, axis=2, keepdims=True)
        directions[1:] = np.where(
            size > SAME_DIRECTION, directions / np.maximum(size, SAME_DIRECTION), np.nan
        )[1:]
        for k in range(1, len(directions)):
            separation = np.linalg.norm(directions[:k] - directions[k], axis=2)
            useless = np.nanmin(separation, axis=0) < SAME_DIRECTION
            directions[k, useless | ~((directions[k] * tool).sum(axis=1) > AWAY)] = np.nan
        return directions

    @cached_property
    def _across(self) -> tuple[Array, Array]:
        """Two unit vectors (n, 3) normal to each tool axis; the platform defines the first."""
        tool = self.ends.tool
        x, y = self.cell.poses.mount[:3, 0], self.cell.poses.mount[:3, 1]
        # a threshold away from a tie, so that rounding does not decide
        across = np.cross(tool, np.where((np.abs(tool @ x) < 0.8)[:, None], x, y))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        return across, np.cross(tool, across)

    def _sides(self, angle: float) -> Array:
        """Return unit vectors (n, 3) normal to the tool axes, at `angle` (rad) to the first one."""
        across, across_both = self._across
        side: Array = math.cos(angle) * across + math.sin(angle) * across_both
        return side

    @cached_property
    def leaning(self) -> Array:
        """Return the candidate tilts of the tool axis at the far end of a retract.

        Returns
        -------
        (1 + leans, n, 3) array
            Vectors to add to the tool axes; the first is zero.
        """
        sides = [self._sides(2.0 * np.pi * k / SIDES) for k in range(SIDES)]
        return np.stack(
            [0.0 * sides[0], *(math.tan(angle) * side for angle in LEANS_RAD[1:] for side in sides)]
        )

    @cached_property
    def sound(self) -> Mask:
        """(n,) whether the bead end is within reach and limits.

        Otherwise the bead has an issue already.
        """
        reachable = np.flatnonzero(np.isfinite(self.ends.joints).all(axis=1))
        sound = np.zeros(len(self.ends.phi), dtype=bool)
        sound[reachable] = (
            self.cell.limits.margin(self.ends.joints[reachable]) >= -ROUNDING_RAD
        ).all(axis=1)
        return sound

    @cached_property
    def floor(self) -> float:
        """The minimum condition on rapids."""
        requested = self.parameters.min_condition
        return CONDITION_FLOOR if isinstance(requested, str) else float(requested)

    def find_legs(
        self,
        end_numbers: Index,
        height: Array,
        direction: int = 0,
        tolerance: float = STRAY_MM,
        thorough: bool = True,
    ) -> tuple[list[Leg | None], list[Failure | None]]:
        """Return the legs from bead ends along a direction.

        An infeasible leg is replaced by the nearest alternative.

        Parameters
        ----------
        end_numbers : (k,) int array
            Indices of the bead ends.
        height : (k,) array
            Requested heights, mm.
        direction : int, optional
            Index in `directions`.
        tolerance : float, optional
            Maximum deviation of the tip from the straight line, mm.
        thorough : bool, optional
            Whether to try all alternatives; otherwise only rotations and tilts.

        Returns
        -------
        legs : list of Leg or None
            None if no alternative is feasible.
        failures : list of Failure or None
            Reason why the requested leg is infeasible; None if it is feasible.
        """
        legs: list[Leg | None] = [None] * len(end_numbers)
        failures: list[Failure | None] = [None] * len(end_numbers)
        # use the requested retract wherever it is feasible
        is_default = True
        for reserve in (RESERVE, LAST_DIGIT_RAD) if thorough else (RESERVE,):
            for group in groups(direction, thorough):
                rows = np.array([k for k, leg in enumerate(legs) if leg is None], dtype=np.intp)
                if not len(rows):
                    return legs, failures
                reserved = self.reserve_of_limits(LAST_DIGIT_RAD if is_default else reserve)
                for k, leg in zip(
                    rows.tolist(),
                    self._first(end_numbers[rows], height[rows], group, tolerance, reserved),
                ):
                    legs[k] = leg
                if is_default:
                    failed = [k for k in rows.tolist() if legs[k] is None]
                    for k, why in zip(
                        failed,
                        self._explain_failures(
                            end_numbers[failed], height[failed], direction, reserved
                        ),
                    ):
                        failures[k] = why
                is_default = False
        return legs, failures

    def asked(self, end_numbers: Index, height: Array) -> list[Leg]:
        """Return the requested retracts, feasible or not.

        Parameters
        ----------
        end_numbers : (k,) array of int
            Indices of the bead ends.
        height : (k,) array
            Retract heights, mm.

        Returns
        -------
        list of Leg
            Retracts; joints are NaN out of reach.
        """
        joints, position = self._courses(self._ways(end_numbers, height, (DEFAULT_CHOICE,)), 1)
        return [
            Leg(joints[k], position[k], float(height[k]), DEFAULT_CHOICE)
            for k in range(len(end_numbers))
        ]

    def _first(
        self,
        end_numbers: Index,
        height: Array,
        group: Sequence[Choice],
        tolerance: float,
        reserved: Array,
    ) -> list[Leg | None]:
        """Return the first feasible retract of a group for each end."""
        count = len(group)
        candidates = self._ways(end_numbers, height, group)
        legs: list[Leg | None] = [None] * len(end_numbers)
        best = np.full(len(end_numbers), count)
        pending = np.flatnonzero(self._possible(candidates))
        moves = 1
        while len(pending) and moves <= MOST_MOVES:
            # refine a retract until it fails; skip retracts that rank below a feasible one
            ready = pending[(np.abs(candidates.turn[pending]) <= MOVE_TURN_RAD * moves)]
            pending = pending[np.abs(candidates.turn[pending]) > MOVE_TURN_RAD * moves]
            joints, position = self._courses(candidates.of(ready), moves)
            able = np.flatnonzero(self.fits(joints[:, -1:], reserved))
            stray = self._stray(candidates.of(ready[able]), joints[able]) > tolerance
            pending = np.union1d(pending, ready[able[stray]])
            able = able[~stray]
            for k in able[self.fits(joints[able], reserved)].tolist():
                number, choice = divmod(int(ready[k]), count)
                if choice < best[number]:
                    best[number] = choice
                    legs[number] = Leg(
                        joints[k], position[k], float(candidates.height[ready[k]]), group[choice]
                    )
            pending = pending[pending % count < best[pending // count]]
            moves *= 2
        return legs

    def _ways(self, end_numbers: Index, height: Array, group: Sequence[Choice]) -> Ways:
        """Return all retracts of a group for all ends, in order of ends."""
        count = len(group)
        end = np.repeat(end_numbers, count)
        column = {
            name: np.tile([getattr(choice, name) for choice in group], len(end_numbers))
            for name in Choice._fields
        }
        return Ways(
            end,
            np.repeat(height, count) * column["share"],
            self.directions[column["direction"], end],
            column["turn"],
            self.leaning[column["lean"], end],
        )

    def _possible(self, candidates: Ways) -> Mask:
        """Return which retracts lead away from the bead and keep the rotation range.

        A five-axis machine cannot rotate or tilt the tool.
        """
        turned = (candidates.turn != 0.0) | (candidates.lean != 0.0).any(axis=1)
        possible: Mask = np.isfinite(candidates.direction).all(axis=1)
        if self.branch is None:
            return np.asarray(possible & ~turned)
        low, high = self.parameters.rotation_range
        if high - low >= TURN - 1e-9:
            return possible
        phi = self.ends.phi[candidates.end] + candidates.turn
        return np.asarray(possible & (~turned | (phi >= low) & (phi <= high)))

    def _courses(self, candidates: Ways, moves: int) -> tuple[Array, Array]:
        """Return the joints and tip positions at the ends of `moves` equal moves.

        joints: (k, moves, axes), unwrapped, NaN out of reach. tip: (k, moves, 3), mm.
        """
        share = np.arange(1, moves + 1) / moves
        point, tool, joints = (
            column[candidates.end] for column in (self.ends.point, self.ends.tool, self.ends.joints)
        )
        tip = (
            point[:, None]
            + (share[:, None] * candidates.height[:, None, None]) * candidates.direction[:, None]
        )
        tools = np.repeat(tool, moves, axis=0)
        lean = (share[:, None] * candidates.lean[:, None]).reshape(-1, 3)
        leans = (lean != 0.0).any(axis=1)
        tools[leans] += lean[leans]
        tools[leans] /= np.linalg.norm(tools[leans], axis=1, keepdims=True)
        shape = (len(point), moves, joints.shape[1])
        if self.branch is None:
            five = FiveAxis(self.cell.machine.chain)
            above, _ = self.cell.poses.to_flange(tip.reshape(-1, 3), tools)
            return five.place_points(
                np.repeat(joints[:, list(five.turning)], moves, axis=0),
                above,
                self.cell.poses.station,
            ).reshape(shape), tip
        arm, robot_axes = self.cell.robot.arm, self.cell.robot.chain.axes
        assert arm is not None
        phi = self.ends.phi[candidates.end, None] + share * candidates.turn[:, None]
        # external axes do not move on retracts
        external = np.repeat(joints[:, None], moves, axis=1)
        flange = self.cell.flange_poses(
            tip.reshape(-1, 3), tools, phi.ravel(), external.reshape(-1, shape[2])
        )
        if arm.followed:
            raw = following.step_by_step(
                arm, flange.reshape(*shape[:2], 4, 4), self.branch, joints[:, :robot_axes]
            )
        else:
            raw = arm.inverse_branch(flange, self.branch).reshape(*shape[:2], robot_axes)
        raw = np.concatenate([raw, external[..., robot_axes:]], axis=2)
        previous = np.concatenate([joints[:, None], raw[:, :-1]], axis=1)
        return raw + TURN * np.cumsum(np.round((previous - raw) / TURN), axis=1), tip

    def _stray(self, candidates: Ways, joints: Array) -> Array:
        """Return the maximum deviation (k,) of the tip from the straight path, mm."""
        course = np.concatenate([self.ends.joints[candidates.end, None], joints], axis=1)
        between = course[:, :-1, None] + BETWEEN[:, None] * np.diff(course, axis=1)[:, :, None]
        chain = self.cell.machine.chain
        tip, _ = self.cell.tip_in_part(chain.forward(between.reshape(-1, chain.axes)))
        offset = (
            tip.reshape(len(course), joints.shape[1] * len(BETWEEN), 3)
            - self.ends.point[candidates.end, None]
        )
        along = np.clip(
            (offset * candidates.direction[:, None]).sum(axis=2), 0.0, candidates.height[:, None]
        )
        deviation: Array = np.linalg.norm(
            offset - along[..., None] * candidates.direction[:, None], axis=2
        ).max(axis=1, initial=0.0)
        return deviation

    def fits(self, joints: Array, reserved: Array) -> Mask:
        """Return which retracts keep reach, limits, reserve and condition in all rows.

        Parameters
        ----------
        joints : (k, m, axes) array
            Joint values of the m rows of k retracts, rad or mm.
        reserved : (limits,) array
            Minimum distance to each limit, rad or mm.

        Returns
        -------
        (k,) array of bool
            True if all rows are feasible.
        """
        with np.errstate(invalid="ignore"):
            fits: Mask = (self.cell.limits.margin(joints) >= reserved - ROUNDING_RAD).all(
                axis=(1, 2)
            )
        within_limits = np.flatnonzero(fits)
        if len(within_limits):
            fits[within_limits] = (
                (self.condition(joints[within_limits].reshape(-1, joints.shape[2])) >= self.floor)
                .reshape(len(within_limits), joints.shape[1])
                .all(axis=1)
            )
        return fits

    def condition(self, joints: Array) -> Array:
        """Return the inverse condition number of the robot.

        Parameters
        ----------
        joints : (n, axes) array
            Joints, rad or mm.

        Returns
        -------
        (n,) array
            sigma_min / sigma_max, rounded as for deposit rows; infinite for a five-axis machine.
        """
        if not self.cell.machine.free:
            return np.full(len(joints), np.inf)
        chain = self.cell.robot.chain
        joints = joints[:, : chain.axes]
        point = self.cell.deposition_point(chain.forward(joints))
        value = jac.condition(
            jac.jacobian(chain, joints, point), self.parameters.characteristic_length
        )
        return np.round(value, 12)

    @cached_property
    def _least(self) -> Array:
        """(axes + m,) minimum reserve: RESERVE for prismatic axes, because program text has as many
        decimals for mm as for degrees; 0 for other limits.
        """
        limits = self.cell.limits
        sliding = np.concatenate(
            [self.cell.machine.chain.sliding, np.zeros(len(limits.coupled_lower), dtype=bool)]
        )
        return np.where(sliding, RESERVE, 0.0)

    def reserve_of_limits(self, reserve: float) -> Array:
        """Return the reserve to keep from each limit.

        Parameters
        ----------
        reserve : float
            Requested reserve, rad or mm.

        Returns
        -------
        (axes + m,) array
            The reserve of each limit, at least its minimum.
        """
        return np.maximum(self._least, reserve)

    def _explain_failures(
        self, end_numbers: Index, height: Array, direction: int, reserved: Array
    ) -> list[Failure]:
        """Return the reason why each requested leg fails."""
        failures = []
        joints = self._courses(self._ways(end_numbers, height, (Choice(1.0, direction),)), 1)[0][
            :, 0
        ]
        limits = self.cell.limits
        for row in joints:
            if not np.isfinite(row).all():
                failures.append(Failure(UNREACHABLE))
                continue
            margin = limits.margin(row) - reserved
            worst = int(margin.argmin())
            if margin[worst] >= 0.0:
                value = float(self.condition(row[None])[0])
                # its path may be infeasible even if its end is feasible
                failures.append(
                    Failure(SINGULAR, 0, value, self.floor)
                    if value < self.floor
                    else Failure(UNREACHABLE)
                )
                continue
            values = np.concatenate([row, limits.coefficients @ row])
            lower, upper = (
                np.concatenate(bounds)
                for bounds in (
                    (limits.lower, limits.coupled_lower),
                    (limits.upper, limits.coupled_upper),
                )
            )
            low = values[worst] - lower[worst] < upper[worst] - values[worst]
            failures.append(
                Failure(LIMIT, worst, float(values[worst]), float((lower if low else upper)[worst]))
            )
        return failures


def branch_of(words: Sequence[str]) -> int | None:
    """Return the branch index of a joint path; None for a five-axis machine."""
    return spherical_wrist.branch_index(words) if words else None
