# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common data of all planning methods: cell, branch, limits, thresholds and inverse kinematics."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from ..geometry.frames import TURN
from ..kinematics import jacobian as jac
from ..kinematics.cell import Cell
from ..kinematics.inverse.serial_arm import SerialArm
from ..kinematics.limits import RESERVE, Limits, PoseFrames
from ..parameters.joints import JointParameters
from ..toolpath import MotionRules, Toolpath
from ..types import Array, Index, Mask
from .arm_clearance import ArmKept
from .points import Points, in_pieces, unwrapped, unwrapped_by_turns
from .turns import configurations as following
from .turns.directed import Lock

UNREACHABLE = -np.inf


@dataclass(frozen=True, eq=False)
class LimitRows:
    """m joint limits lower <= matrix q <= upper, without continuous axes; rad or mm."""

    matrix: Array
    lower: Array
    upper: Array
    labels: tuple[str, ...]

    @cached_property
    def mean(self) -> Array:
        """Return the midpoint of each range.

        Returns
        -------
        (m,) array
            rad or mm.
        """
        return 0.5 * (self.lower + self.upper)

    @cached_property
    def half(self) -> Array:
        """Return half the width of each range.

        Returns
        -------
        (m,) array
            rad or mm.
        """
        return 0.5 * (self.upper - self.lower)

    @cached_property
    def plain(self) -> bool:
        """Whether every row limits a single axis."""
        return bool((np.count_nonzero(self.matrix, axis=1) == 1).all())

    def offset(self, joints: Array) -> Array:
        """Return the offset from mid-range as a fraction of half the range.

        Parameters
        ----------
        joints : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., m) array
            -1 and 1 at the limits.
        """
        share: Array = (joints @ self.matrix.T - self.mean) / self.half
        return share

    def margin(self, joints: Array) -> Array:
        """Return the minimum margin over all rows.

        Parameters
        ----------
        joints : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (...) array
            1 at mid-range, 0 at a limit, negative beyond a limit; -inf for NaN joints.
        """
        worst: Array = reduce(
            np.maximum, map(np.abs, self._offsets(joints))
        )  # faster than max(axis=-1)
        return np.where(np.isnan(worst), UNREACHABLE, 1.0 - worst)

    def _offsets(self, joints: Array) -> Iterator[Array]:
        """Yield the `offset` (...) of each row; if all rows are plain, read only the axis that the
        row limits.
        """
        if not self.plain:
            yield from np.moveaxis(self.offset(joints), -1, 0)
            return
        for row, mean, half in zip(self.matrix, self.mean, self.half):
            axis = int(np.flatnonzero(row)[0])
            share = joints[..., axis] * row[axis]
            share -= mean
            share /= half
            yield share


def limit_rows(limits: Limits, reserve: float = 0.0) -> LimitRows:
    """Return the rows of a limit set: single axes, then coupled axes.

    `reserve` (rad) narrows each range at both ends.
    """
    axes = len(limits.lower)
    finite = np.isfinite(limits.lower) & np.isfinite(limits.upper)
    return LimitRows(
        matrix=np.vstack([np.eye(axes)[finite], limits.coefficients.reshape(-1, axes)]),
        lower=np.concatenate([limits.lower[finite], limits.coupled_lower]) + reserve,
        upper=np.concatenate([limits.upper[finite], limits.coupled_upper]) - reserve,
        labels=tuple(
            np.array(limits.labels)[
                np.concatenate([finite, np.ones(len(limits.coupled_lower), bool)])
            ]
        ),
    )


Parts = tuple[
    tuple[Toolpath, Index], ...
]  # toolpath of each feature, and indices of its layers in the full toolpath

# Eq. 17 divides by the stroke. A continuous axis would have zero weight and could rotate without
# cost. This finite stroke is large enough to keep the other axes still on a part of revolution
# (docs/decisions).
CONTINUOUS_STROKE = 1e6 * TURN
CONDITION_FLOOR = 0.02
CONDITION_SHARE = 0.25
# minimum accepted margin: an optimum often lies on a limit of `rows`, RESERVE inside the true limit
MIN_MARGIN = -1e-6


@dataclass(frozen=True)
class Task:
    """A cell, one branch and the planning parameters.

    joined: whether the rotation polynomial of a closed bead must return to its start value, up to
    whole turns. Parts of revolution do not need this, because a limited axis rewinds between
    layers. kept: link clearance check, if requested. lock: the locked rotary axis, if any.
    chord_error: mm. rules: motion rules of the toolpath. parts: toolpath of each feature with its
    layers, for travel speeds and maximum tilts.
    """

    cell: Cell
    branch: int
    parameters: JointParameters
    joined: bool = False
    kept: ArmKept | None = None
    lock: Lock | None = None
    chord_error: float = 0.0
    rules: MotionRules = MotionRules()
    parts: Parts = ()

    @cached_property
    def rows(self) -> LimitRows:
        """Limit rows, narrowed by RESERVE."""
        return limit_rows(self.cell.limits, RESERVE)

    @cached_property
    def given_rows(self) -> LimitRows:
        """Limit rows as given, without RESERVE."""
        return limit_rows(self.cell.limits)

    @cached_property
    def continuous(self) -> Mask:
        """(axes,) bool, True for axes without limits."""
        return self.cell.limits.continuous

    @cached_property
    def unturned(self) -> Mask:
        """(axes,) bool, axes that whole turns do not apply to: continuous and prismatic axes."""
        return np.asarray(self.continuous | self.cell.machine.chain.sliding, dtype=np.bool_)

    def rows_of_axis(self, axis: int) -> tuple[float, float]:
        """Return the limits of one axis, narrowed by RESERVE.

        Parameters
        ----------
        axis : int
            Index of the axis.

        Returns
        -------
        lower, upper : float
            rad or mm.
        """
        return float(self.cell.limits.lower[axis] + RESERVE), float(
            self.cell.limits.upper[axis] - RESERVE
        )

    @cached_property
    def middle(self) -> Array:
        """Return the mid-range value of each axis.

        Returns
        -------
        (axes,) array
            rad or mm; 0 for continuous axes.
        """
        limits = self.cell.limits
        with np.errstate(invalid="ignore"):
            return np.where(self.continuous, 0.0, 0.5 * (limits.lower + limits.upper))

    @cached_property
    def weights(self) -> Array:
        """Return the axis weights in the joint displacement.

        For prismatic axes, one characteristic length counts as 1 rad.

        Returns
        -------
        (axes,) array
            1 / stroke; for prismatic axes also divided by the characteristic length.

        References
        ----------
        Chalvin 2020, eq. 17.
        """
        stroke = np.where(
            self.continuous, CONTINUOUS_STROKE, self.cell.limits.upper - self.cell.limits.lower
        )
        sliding = self.cell.machine.chain.sliding
        return np.asarray(
            np.where(sliding, 1.0 / (stroke * self.parameters.characteristic_length), 1.0 / stroke)
        )

    def rotation(self, points: Points, value: Array) -> tuple[Array, Array]:
        """Convert the planning variable to the rotation about the tool axis.

        Parameters
        ----------
        points : Points
            T points.
        value : (T,) array
            Planning variable: the rotation itself, or RZ as in Chalvin 2020, rad.

        Returns
        -------
        phi : (T,) array
            Rotation about the tool axis, rad.
        rate : (T,) array
            d phi / d value.
        """
        if self.parameters.parameter == "rotation":
            ones: Array = np.ones(len(value))
            return value, ones
        return self.cell.poses.phi_of_rz(points.tool, value)

    @property
    def arm(self) -> SerialArm:
        """Inverse kinematics of the robot arm."""
        arm = self.cell.robot.arm
        assert arm is not None  # resolve() rejects other machines
        return arm

    def raw_joints(self, points: Points, phi: Array, previous: Array | None = None) -> Array:
        """Return the joints of the branch without unwrapping.

        For arms with several solutions per configuration, follow one solution from point to
        point.

        Parameters
        ----------
        points : Points
            T points.
        phi : (..., T) array
            Rotations about the tool axis, rad.
        previous : (T, axes) array or None, optional
            Joints from which such an arm continues; None to follow along the beads.

        Returns
        -------
        (..., T, axes) array
            Joints, rad or mm, not unwrapped; NaN where unreachable.
        """
        if phi.ndim == 1 and not self.arm.followed:
            return self._raw_joints_of_all(points, phi)
        flange = (
            points.frames.flange_poses(phi) if self.arm.followed else points.frames.by_entry(phi)
        )
        if self.arm.followed and previous is not None:
            joints = following.from_before(
                self.arm, flange, self.branch, self._robot_joints(previous)
            )
        elif self.arm.followed:
            rows = flange.reshape(-1, *flange.shape[-3:])
            joints = following.along_beads(self.arm, rows, self.branch, points).reshape(
                *phi.shape, -1
            )
        else:
            joints = self.arm.inverse_branch(flange.reshape(-1, 4, 4), self.branch).reshape(
                *phi.shape, -1
            )
        return joints if points.external is None else append_external(joints, points.external)

    def _raw_joints_of_all(self, points: Points, phi: Array) -> Array:
        """Return `raw_joints` for one rotation (T,), in batches to limit memory."""
        joints = np.empty((self.cell.machine.chain.axes, len(points))).T
        for rows in in_pieces(len(points)):
            robot_joints = self.arm.inverse_branch(
                points.frames.of(rows).by_entry(phi[rows]), self.branch
            )
            joints[rows] = (
                robot_joints
                if points.external is None
                else append_external(robot_joints, points.external[rows])
            )
        return joints

    def inverse(self, flange: Array, nearby_joints: Array | None = None) -> Array:
        """Return the joints of the branch for flange poses.

        Parameters
        ----------
        flange : (N, 4, 4) array
            Flange poses, base frame.
        nearby_joints : (N, axes) array or None, optional
            Start joints for arms with several solutions per configuration; also give the
            external axis values.

        Returns
        -------
        (N, axes) array
            Joints, rad or mm; NaN where unreachable.
        """
        if self.arm.followed and nearby_joints is not None:
            joints = following.from_before(
                self.arm, flange, self.branch, self._robot_joints(nearby_joints)
            )
        else:
            joints = self.arm.inverse_branch(flange, self.branch)
        external = None if nearby_joints is None else self.cell.external_of(nearby_joints)
        return joints if external is None else append_external(joints, external)

    def _robot_joints(self, joints: Array) -> Array:
        """Return the robot joints (..., robot axes) without external axes."""
        return joints[..., : self.cell.robot.chain.axes]

    def joints(self, points: Points, phi: Array) -> Array:
        """Return joints unwrapped along each bead, shifted by the whole turns that best fit the
        limits.

        Parameters
        ----------
        points : Points
            T points.
        phi : (..., T) array
            Rotations about the tool axis, rad.

        Returns
        -------
        (..., T, axes) array
            Joints, rad or mm; NaN where unreachable.
        """
        raw = self.raw_joints(points, phi)
        if phi.ndim > 1 and not np.isnan(raw.max()):
            return self.in_range(unwrapped_by_turns(raw, points), points)
        joints_in_range = self.in_range(unwrapped(raw, points), points)
        # summation over axes depends on memory order; make it contiguous for single plans
        return np.ascontiguousarray(joints_in_range) if phi.ndim == 1 else joints_in_range

    def in_range(self, joints: Array, points: Points) -> Array:
        """Shift each limited axis by whole turns to the middle of its range, bead by bead.

        Parameters
        ----------
        joints : (..., T, axes) array
            Unwrapped joints, rad or mm.
        points : Points
            The T points.

        Returns
        -------
        (..., T, axes) array
            Shifted joints; the input array if no axis shifts.
        """
        leading_axes = tuple(range(joints.ndim - 1))
        distances = np.maximum(
            joints.max(axis=leading_axes) - self.middle, self.middle - joints.min(axis=leading_axes)
        )
        axis_ids = np.flatnonzero(
            ~self.unturned & ~(distances <= 0.5 * TURN)
        )  # skip axes that stay within half a turn, which are most
        low = np.minimum.reduceat(joints[..., axis_ids], points.first, axis=-2)
        high = np.maximum.reduceat(joints[..., axis_ids], points.first, axis=-2)
        turns = np.round((self.middle[axis_ids] - 0.5 * (low + high)) / TURN) * TURN
        if not np.nan_to_num(turns).any():
            return joints
        shifted = joints.copy(order="K")
        shifted[..., axis_ids] += points.spread_to_points(turns)
        return shifted

    def jacobians(self, points: Points, phi: Array, joints: Array) -> Iterator[tuple[slice, Array]]:
        """Yield the robot Jacobians in batches of points, to limit memory.

        Parameters
        ----------
        points : Points
            T points.
        phi : (T,) array
            Rotations about the tool axis, rad.
        joints : (T, axes) array
            Joints, rad or mm.

        Yields
        ------
        rows : slice
            Points of the batch.
        jacobians : (k, 6, 6) array
            Jacobians at the deposition point.
        """
        for rows in in_pieces(len(points)):
            yield rows, self.jacobian_at(points.frames.of(rows), phi[rows], joints[rows])

    def jacobian_at(self, poses: PoseFrames, phi: Array, joints: Array) -> Array:
        """Return the robot Jacobian at the deposition point.

        Parameters
        ----------
        poses : PoseFrames
            Pose frames of N points.
        phi : (N,) array
            Rotations about the tool axis, rad.
        joints : (N, axes) array
            Joints, rad or mm.

        Returns
        -------
        (N, 6, 6) array
            Three rows for translation (mm), three for rotation; base frame.
        """
        return self._jacobian(self._tips_of(poses, phi), joints)

    def _jacobian(self, flange: Array, joints: Array) -> Array:
        result: Array = jac.jacobian(
            self.cell.robot.chain, self._robot_joints(joints), self.cell.deposition_point(flange)
        )
        return result

    def _tips_of(self, poses: PoseFrames, phi: Array) -> Array:
        """Return the flange poses (N, 4, 4) for the deposition point and the rotation axis.

        A stationary torch fixes both, so any pose will do.
        """
        return (
            np.broadcast_to(np.eye(4), (len(phi), 4, 4))
            if self.cell.torch_stands
            else poses.flange_poses(phi)
        )

    def condition(self, points: Points, phi: Array, joints: Array) -> Array:
        """Return the inverse condition number of the scaled Jacobian at the deposition point.

        Parameters
        ----------
        points : Points
            T points.
        phi : (..., T) array
            Rotations about the tool axis, rad.
        joints : (..., T, axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., T) array
            sigma_min / sigma_max; 0 where unreachable.
        """
        if phi.ndim == 1:
            return np.concatenate(
                [
                    self.condition_at(
                        self._tips_of(points.frames.of(rows), phi[rows]), joints[rows]
                    )
                    for rows in in_pieces(len(points))
                ]
            )
        flange = points.frames.flange_poses(phi).reshape(-1, 4, 4)
        return self.condition_at(flange, joints.reshape(-1, joints.shape[-1])).reshape(
            joints.shape[:-1]
        )

    def condition_at(self, flange: Array, joints: Array) -> Array:
        """Return the inverse condition number of the scaled Jacobian for flange poses.

        Parameters
        ----------
        flange : (N, 4, 4) array
            Flange poses, base frame.
        joints : (N, axes) array
            Joints, rad or mm.

        Returns
        -------
        (N,) array
            sigma_min / sigma_max, rounded to 12 digits; 0 where unreachable; NaN for a
            machine without a free coordinate.
        """
        if not self.cell.machine.free:
            return np.full(len(joints), np.nan)
        good = np.flatnonzero(np.isfinite(joints).all(axis=1))
        value = np.zeros(len(joints))
        for slice_of_good in in_pieces(len(good)):
            rows = good[slice_of_good]
            value[rows] = jac.condition(
                self._jacobian(flange[rows], joints[rows]), self.parameters.characteristic_length
            )
        # the last bits depend on the memory alignment of arrays; rounding makes the output of a
        # job reproducible to the byte
        return np.round(value, 12)

    def thresholds(self, points: Points) -> Array:
        """Return the required minimum inverse condition number at each point.

        Parameters
        ----------
        points : Points
            T points.

        Returns
        -------
        (T,) array
            `min_condition` if it is a number; otherwise CONDITION_SHARE of the value at RZ = 0,
            at least CONDITION_FLOOR.

        References
        ----------
        Chalvin 2020, eq. 19.
        """
        min_condition = self.parameters.min_condition
        if not isinstance(min_condition, str):
            return np.full(len(points), float(min_condition))
        tools = [points.tool[rows] for rows in in_pieces(len(points))]
        phi = np.concatenate(
            [self.cell.poses.phi_of_rz(tool, np.zeros(len(tool)))[0] for tool in tools]
        )
        at_zero = self.condition(points, phi, self.raw_joints(points, phi))
        return np.maximum(CONDITION_SHARE * at_zero, CONDITION_FLOOR)

    def rotation_rates(self, poses: PoseFrames, phi: Array, joints: Array) -> tuple[Array, Array]:
        """Return the joint rates with respect to the rotation about the tool axis.

        Parameters
        ----------
        poses : PoseFrames
            Pose frames of N reachable points.
        phi : (N,) array
            Rotations about the tool axis, rad.
        joints : (N, axes) array
            Joints, rad or mm.

        Returns
        -------
        rates : (N, axes) array
            d q / d phi; 0 for external axes.
        matrix : (N, 6, 6) array
            Robot Jacobians at the deposition point.
        """
        flange = self._tips_of(poses, phi)
        matrix = self._jacobian(flange, joints)
        twist = np.zeros((len(joints), 6, 1))
        twist[:, 3:, 0] = self.cell.rotation_axis(flange)
        try:
            rates = np.linalg.solve(matrix, twist)[:, :, 0]
        except np.linalg.LinAlgError:
            rates = (np.linalg.pinv(matrix) @ twist)[:, :, 0]
        if self.cell.external is not None:
            rates = np.pad(rates, ((0, 0), (0, joints.shape[1] - rates.shape[1])))
        return np.asarray(rates, dtype=np.float64), matrix


def append_external(joints: Array, external: Array) -> Array:
    """Append external axis values to robot joints.

    Parameters
    ----------
    joints : (..., N, axes) array
        Robot joints, rad or mm.
    external : (N, k) array
        External axis values, rad or mm.

    Returns
    -------
    (..., N, axes + k) array
        Robot and external joints; external axes are NaN where the robot cannot reach.
    """
    values = np.broadcast_to(external, (*joints.shape[:-1], external.shape[-1]))
    is_unreachable = np.isnan(joints).any(axis=-1, keepdims=True)
    return np.concatenate([joints, np.where(is_unreachable, np.nan, values)], axis=-1)


def condition_margin(condition: Array, threshold: Array) -> Array:
    """Return the relative margin of the inverse condition number above its threshold.

    Parameters
    ----------
    condition : (...) array
        sigma_min / sigma_max.
    threshold : (...) array
        Required minimum.

    Returns
    -------
    (...) array
        1 - threshold / condition: 0 at the threshold, towards 1 far from singularities.
    """
    return np.asarray(1.0 - threshold / np.maximum(condition, 1e-12))
