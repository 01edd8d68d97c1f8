# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inverse kinematics of a chain of joint frames, chosen by the arrangement of its axes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...geometry import frames
from ...geometry.formatting import format_differing
from ...geometry.frames import shortest
from ...issues import InputError, Text
from ...types import Array, ArrayLike, Index
from ..chain import Chain
from ..jacobian import jacobian
from . import opw_recognition
from .offset_wrist import OffsetWristArm
from .opw_recognition import NEAR_MM, PARALLEL_TOLERANCE, POSITION, ROTATION, clean
from .parallel_axes import ParallelAxesArm
from .serial_arm import SerialArm

CHUNK = 2048
WORDS = 8  # configurations
STEPS, AGAIN = 16, 4  # most Newton steps, and steps after which the Jacobian is recomputed
START_SHIFT_MM = 5.0  # mm
TINY = 1e-9
LENGTH = 500.0  # mm that weigh as much as 1 rad
CONVERGED = 1e-11  # error as an angle (5e-9 mm) below which another step is not worth its time
SINGULAR = 2e-10  # rounding error near a singularity
DAMPING = 1e-14


@dataclass(frozen=True, eq=False)
class CalibratedArm:
    """Inverse kinematics of an arm that deviates from its nominal geometry.

    `chain` is the real arm, `nominal` the closed form of its nominal geometry. The configurations
    are those that the closed form assigns to the same angles. Within some millimetres of the
    stretched arm and some tenths of a degree of the wrist singularity, solutions that exist for
    only one of the two arms are omitted.
    """

    nominal: SerialArm
    chain: Chain

    @property
    def followed(self) -> bool:
        """Whether several solutions may share a configuration, as in the closed form."""
        return self.nominal.followed

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distances of axis 2 ahead of axis 1 and above base_link, mm, from the closed form."""
        return self.nominal.shoulder

    @property
    def reach(self) -> float:
        """Distance from axis 2 to the wrist of the stretched arm in mm, from the closed form."""
        return self.nominal.reach

    def inverse(self, poses: ArrayLike) -> Array:
        """Return joint angles in all configurations for flange poses.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        (8 or 16, n, 6) array
            Angles in -pi to pi, rad; as many solutions as the closed form has, NaN where out
            of reach.
        """
        return self.solutions(poses)[0]

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Return the joint angles (n, 6) of one configuration; otherwise as `inverse`."""
        targets = np.ascontiguousarray(poses, float)
        return self._solve_words(targets, branch)

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """Return all solutions of `inverse` with their configurations.

        Parameters
        ----------
        poses : (n, 4, 4) array
            Flange poses in base_link, mm.

        Returns
        -------
        angles : (8 or 16, n, 6) array
            Angles in -pi to pi, rad.
        words : (8 or 16, n) int array
            The configuration of each solution, -1 where there is none.
        """
        targets = np.ascontiguousarray(poses, float)
        if not self.nominal.followed:
            solved = np.stack([self._solve_words(targets, words) for words in range(WORDS)])
            return solved, np.where(np.isnan(solved[..., 0]), -1, np.arange(WORDS)[:, None])
        starts, words = self.nominal.solutions(targets)
        solved = np.stack([self._from(start, targets, word) for start, word in zip(starts, words)])
        return solved, np.where(np.isnan(solved[..., 0]), -1, words)

    def branch_of(self, q: ArrayLike) -> Index:
        """Return the configuration (...) of joint angles `q` (..., 6)."""
        return self.nominal.branch_of(q)

    def bend(self, q: ArrayLike) -> Array:
        """Return how far angles `q` (..., 6) are from a stretched wrist or elbow: (...) values, 0
        where stretched, 1 at a right angle.
        """
        return self.nominal.bend(q)

    def _solve_words(self, poses: Array, words: int) -> Array:
        """Return the angles (n, 6) of one configuration for the poses (n, 4, 4); NaN where there is
        no solution.
        """
        result = self._from(self.nominal.inverse_branch(poses, words), poses, words)
        # where the closed form just fails to reach, start from its solution for a point slightly
        # nearer to the shoulder, or farther from axis 1
        for inwards, outwards in ((START_SHIFT_MM, 0.0), (0.0, START_SHIFT_MM)):
            unsolved = np.flatnonzero(np.isnan(result[:, 0]))
            if not len(unsolved):
                break
            moved = poses[unsolved].copy()
            position = moved[:, :3, 3]
            ahead = position * (1.0, 1.0, 0.0)
            position += outwards * ahead / np.linalg.norm(ahead + TINY, axis=1, keepdims=True)
            towards = position - (0.0, 0.0, self.shoulder[1])
            position -= inwards * towards / np.linalg.norm(towards + TINY, axis=1, keepdims=True)
            result[unsolved] = self._from(
                self.nominal.inverse_branch(moved, words), poses[unsolved], words
            )
        return result

    def _from(self, start: Array, poses: Array, words: int | Index) -> Array:
        """Return the solutions (n, 6) for the poses near `start` (n, 6); NaN where there is none
        in this configuration, or in these configurations (n,).
        """
        result = np.full(start.shape, np.nan)
        reached = np.flatnonzero(np.isfinite(start[:, 0]))
        for begin in range(0, len(reached), CHUNK):
            rows = reached[begin : begin + CHUNK]
            result[rows] = self._newton(start[rows].copy(), poses[rows])
        result = shortest(result)
        result[self.nominal.branch_of(np.nan_to_num(result)) != words] = np.nan
        return result

    def _newton(self, q: Array, poses: Array) -> Array:
        off = np.full(len(q), np.inf)
        open_ = np.arange(len(q))
        back = np.empty((len(q), 6, 6))
        for step in range(STEPS):
            flange, targets = self.chain.forward(q[open_]), poses[open_]
            error = np.empty((len(open_), 6))
            error[:, :3] = (targets[:, :3, 3] - flange[:, :3, 3]) / LENGTH
            turned = targets[:, :3, :3] @ np.swapaxes(flange[:, :3, :3], 1, 2)
            for row, (following, column) in enumerate(((1, 2), (2, 0), (0, 1))):
                error[:, 3 + row] = 0.5 * (
                    turned[:, column, following] - turned[:, following, column]
                )
            off[open_] = np.sqrt(np.einsum("ni,ni->n", error, error))
            unconverged = off[open_] > CONVERGED
            if not unconverged.any():
                break
            open_, error = open_[unconverged], error[unconverged]
            if step % AGAIN == 0:
                back[open_] = self._inverse_rates(q[open_], flange[unconverged, :3, 3])
            rates = np.einsum("nij,nj->ni", back[open_], error)
            q[open_] += rates / np.maximum(
                1.0, np.abs(rates).max(axis=1, keepdims=True)
            )  # at most 1 rad at a time
        q[~(off < SINGULAR)] = np.nan
        return q

    def _inverse_rates(self, q: Array, points: Array) -> Array:
        """Return matrices (n, 6, 6) that convert an error of the flange at `points` (n, 3) to
        angles.

        They are slightly damped, so that they stay finite near singularities.
        """
        rates = np.array(jacobian(self.chain, q, points))
        rates[:, :3] /= LENGTH
        across = np.swapaxes(rates, 1, 2)
        product = across @ rates
        product[:, range(6), range(6)] += DAMPING
        inverse: Array = np.linalg.solve(product, across)
        return inverse


QUARTER = 0.5 * math.pi
NEARLY_SQUARE = math.radians(
    0.25
)  # tolerance of a rounded or measured right angle; manufacturers do not tilt axes by so little
EXACT = 1e-12  # rad; floating-point rounding error
ROUNDING_MM = (
    0.0,
    0.001,
    0.01,
    0.1,
)  # mm to which lengths are rounded, tried in this order: tilted frames shift axes that should meet
LOCKED = 0.02  # cosine of the pitch, below which roll and yaw are not distinguished
MAX_LOST_SHARE = 0.1  # share of poses near singularities that only one of an arm and its nominal closed form reaches


def arm_of(chain: Chain) -> SerialArm:
    """Return the inverse kinematics of a chain in a base_link whose Z is axis 1, as
    `opw_recognition.rooted` returns it.

    Raises InputError NO_CLOSED_FORM, which names the property of the geometry that prevents it,
    and the deviation.
    """
    try:
        return _exact(chain)
    except InputError:
        if square_up(chain) is None:
            raise
    arm = CalibratedArm(_nearest(chain), chain)
    if not _agrees(arm, chain, MAX_LOST_SHARE):
        raise opw_recognition.refused(
            Text(
                "the axes are up to {:.3g} deg off right angles, and the inverse solutions do "
                "not reproduce the poses",
                math.degrees(off_square(chain)),
            )
        )
    return arm


def off_square(chain: Chain) -> float:
    """Return the largest angle (rad) between a frame or an axis of a chain and its nearest right
    angle.
    """
    rows = [*chain.origins[:, :3, :3], chain.flange[:3, :3]]
    turns = [_angle(rotation, _square_rotation(rotation)) for rotation in rows]
    axes = [
        math.asin(min(1.0, float(np.linalg.norm(np.cross(axis, _square_axis(axis))))))
        for axis in chain.directions
    ]
    return max(*turns, *axes)


def _nearest(chain: Chain) -> SerialArm:
    """Return the closed form of a nearly square chain with rounded lengths.

    If there is none, raises the InputError NO_CLOSED_FORM of the chain whose angles alone are
    squared.
    """
    reason: InputError | None = None
    for step in ROUNDING_MM:
        nominal = square_up(chain, step)
        assert nominal is not None  # checked by the caller
        try:
            return _exact(nominal)
        except InputError as error:
            reason = reason or error
    assert reason is not None
    raise reason


def square_up(chain: Chain, step: float = 0.0) -> Chain | None:
    """Return the chain with nearly square frames and axes made square, and lengths rounded to a
    multiple of `step` (mm).

    Its base_link has axis 1 as Z. Returns None if there is nothing to square.
    """
    if chain.axes != 6 or chain.sliding.any() or off_square(chain) < EXACT:
        return None
    origins, flange = chain.origins.copy(), chain.flange.copy()
    origins[:, :3, :3] = [_square_rotation(rotation) for rotation in origins[:, :3, :3]]
    flange[:3, :3] = _square_rotation(flange[:3, :3])
    axes = np.stack([_square_axis(axis) for axis in chain.directions])
    if step:
        for pose in (*origins, flange):
            pose[:3, 3] = np.round(pose[:3, 3] / step) * step
    return opw_recognition.rooted(Chain(origins, axes, flange, chain.sliding))[0]


def _square_rotation(rotation: Array) -> Array:
    """Return the rotation (3, 3) of quarter turns near the given one, or, if none is near, the
    given one with nearly square roll, pitch and yaw made square.
    """
    nearest = np.round(rotation)
    if _is_rotation(nearest) and _angle(rotation, nearest) < NEARLY_SQUARE:
        return np.asarray(nearest)
    rpy = np.array(-frames.to_bryant(rotation.T))
    if abs(math.cos(rpy[1])) < LOCKED:
        return rotation
    quarters = np.round(rpy / QUARTER) * QUARTER
    return frames.from_rpy(
        (0.0, 0.0, 0.0), np.where(np.abs(rpy - quarters) < NEARLY_SQUARE, quarters, rpy)
    )[:3, :3]


def _square_axis(axis: Array) -> Array:
    nearest = np.round(axis)
    is_square = np.linalg.norm(axis - nearest) < NEARLY_SQUARE and np.abs(nearest).sum() == 1.0
    return np.asarray(nearest if is_square else axis)


def _is_rotation(matrix: Array) -> bool:
    return bool(
        np.array_equal(matrix @ matrix.T, np.eye(3)) and round(float(np.linalg.det(matrix))) == 1
    )


def _angle(rotation: Array, reference: Array) -> float:
    return 2.0 * math.asin(min(1.0, float(np.linalg.norm(rotation - reference)) / math.sqrt(8.0)))


def _exact(chain: Chain) -> SerialArm:
    """Return the closed form of the chain as it is. Raises InputError NO_CLOSED_FORM."""
    try:
        return opw_recognition.recognise(chain)
    except InputError as error:
        if chain.axes != 6 or chain.sliding.any() or error.where == opw_recognition.FLANGE:
            raise
        return _other_wrists(chain)


def _other_wrists(chain: Chain) -> SerialArm:
    return parallel_axes(chain) or offset_wrist(chain)


def parallel_axes(chain: Chain) -> ParallelAxesArm | None:
    """Return the closed form of a chain of six revolute joints whose axes 2, 3 and 4 are
    parallel; None for other chains.
    """
    at_rest = chain.frames(np.zeros(6))
    z, p = at_rest.directions, at_rest.origins
    if not _upright(z, p) or not (_parallel(z[1], z[2]) and _parallel(z[1], z[3])):
        return None
    if not all(
        _square(z[first_axis], z[second_axis])
        for first_axis, second_axis in ((0, 1), (3, 4), (4, 5))
    ):
        return None
    meeting = _meeting(p[4], z[4], p[5], z[5])
    if meeting is None:
        return None
    normal = _normal(z[1], meeting)
    ahead = np.cross(normal, (0.0, 0.0, 1.0))
    plane = np.stack([ahead, (0.0, 0.0, 1.0)])
    shoulder, elbow, four, centre = (plane @ point for point in (p[1], p[2], p[3], meeting))
    upper, fore = elbow - shoulder, four - elbow
    if min(np.hypot(*upper), np.hypot(*fore)) < NEAR_MM:
        return None
    turn1 = math.atan2(ahead[1], ahead[0] + 0.0)
    turn2, turn23, turn234 = (math.atan2(*segment) for segment in (upper, fore, plane @ z[4]))
    sine, cosine = math.sin(turn234), math.cos(turn234)
    wrist_offset = centre - four
    six = z[5] if float(z[5] @ normal) > -PARALLEL_TOLERANCE else -z[5]
    bent = math.atan2(float(six @ np.cross(z[4], normal)), float(six @ normal))
    wrist_frame = np.eye(4)
    wrist_frame[:3, :3] = np.stack([z[4], np.cross(six, z[4]), six], axis=1)
    wrist_frame[:3, 3] = meeting
    arm = ParallelAxesArm(
        ahead=float(shoulder[0]),
        above=float(shoulder[1]),
        upper=float(np.hypot(*upper)),
        fore=float(np.hypot(*fore)),
        wrist=(
            float(wrist_offset[0] * cosine - wrist_offset[1] * sine),
            float(wrist_offset[0] * sine + wrist_offset[1] * cosine),
        ),
        offset=float(normal @ meeting),
        tip=frames.inverse(wrist_frame) @ at_rest.flange,
        signs=(_sign(z[0, 2]), *(_sign(axis @ normal) for axis in z[1:4]), 1, _sign(six @ z[5])),
        zeros=tuple(
            clean(turn) for turn in (turn1, turn2, turn23 - turn2, turn234 - turn23, bent, 0.0)
        ),
    )
    return arm if _agrees(arm, chain) else None


def offset_wrist(chain: Chain) -> OffsetWristArm:
    """Return the inverse kinematics of a chain of six revolute joints with a non-spherical wrist.

    Raises InputError NO_CLOSED_FORM with the condition that is not met.
    """
    at_rest = chain.frames(np.zeros(6))
    z, p = at_rest.directions, at_rest.origins
    if not _upright(z, p):
        raise opw_recognition.refused("axis 1 is not the Z of the base frame")
    for first_axis, second_axis in ((0, 1), (2, 3)):
        if not _square(z[first_axis], z[second_axis]):
            off = math.degrees(math.acos(min(1.0, abs(float(z[first_axis] @ z[second_axis])))))
            raise opw_recognition.refused(
                Text(
                    "axes {} and {} are {} deg apart, not 90 deg",
                    first_axis + 1,
                    second_axis + 1,
                    format_differing(off, 90.0),
                )
            )
    if not _parallel(z[1], z[2]):
        raise opw_recognition.refused("axes 2 and 3 are not parallel")
    point = None if _parallel(z[3], z[4]) else _meeting(p[3], z[3], p[4], z[4])
    if point is None:
        raise opw_recognition.refused("the wrist is not spherical, and axes 4 and 5 do not meet")
    normal = _normal(z[1], point)
    ahead = np.cross(normal, (0.0, 0.0, 1.0))
    plane = np.stack([ahead, (0.0, 0.0, 1.0)])
    shoulder, elbow, centre = (plane @ position for position in (p[1], p[2], point))
    if abs(offset := float(normal @ point)) > NEAR_MM:
        raise opw_recognition.refused(
            Text("the wrist is not spherical, and axis 4 passes {:.6g} mm off axis 1", abs(offset))
        )
    upper, fore = elbow - shoulder, centre - elbow
    wrist_offset = point - p[5] - z[5] * float(z[5] @ (point - p[5]))
    if min(np.hypot(*upper), np.hypot(*fore), np.linalg.norm(wrist_offset)) < NEAR_MM:
        raise opw_recognition.refused("two consecutive axes coincide")
    turn3 = math.atan2(*fore)
    arm = OffsetWristArm(
        chain=chain,
        above=float(shoulder[1]),
        upper=float(np.hypot(*upper)),
        fore=float(np.hypot(*fore)),
        turns=(math.atan2(ahead[1], ahead[0]), math.atan2(*upper), turn3),
        signs=(_sign(z[0, 2]), _sign(z[1] @ normal), _sign(z[2] @ normal)),
        lean=math.atan2(*(plane @ z[3])) - turn3,
        point=point,
        flips=(True,) * 4,
        ahead=float(shoulder[0]) if abs(shoulder[0]) > NEAR_MM else 0.0,
    )
    arm = replace(arm, flips=_flips(arm))
    if not _agrees(arm, chain):
        raise opw_recognition.refused(
            "the inverse solutions do not reproduce the poses", "give the geometry with more digits"
        )
    return arm


def _flips(arm: OffsetWristArm) -> tuple[bool, bool, bool, bool]:
    """Return whether most solutions with q5 < 0 pass zero upwards, for each shoulder and elbow."""
    q = np.random.default_rng(7).uniform(-math.pi, math.pi, (512, 6))
    words = arm.branch_of(q)
    back, elbow_left = words >> 2, (words >> 1 & 1) == words >> 2
    rising, bent = (words & 1).astype(bool), q[:, 4] < 0.0
    flips = [np.mean((rising == bent)[2 * back + elbow_left == kind]) > 0.5 for kind in range(4)]
    return bool(flips[0]), bool(flips[1]), bool(flips[2]), bool(flips[3])


def _agrees(arm: SerialArm, chain: Chain, lost_share: float = 0.0) -> bool:
    """Return whether the arm recovers random joint angles of the chain from their poses.

    A share `lost_share` of them may be missing. This catches wrong signs and zeros.
    """
    q = np.random.default_rng(6).uniform(-math.pi, math.pi, (32, 6))
    poses = chain.forward(q)
    angles = arm.inverse(poses)
    poses_back = chain.forward(np.nan_to_num(angles))
    solved = np.isfinite(angles).all(axis=2)
    off = np.where(solved[..., None, None], np.abs(poses_back - poses), 0.0)
    angle_errors = np.abs(np.exp(1j * angles) - np.exp(1j * q)).max(axis=2)
    return bool(
        off[..., :3, 3].max() < POSITION
        and off[..., :3, :3].max() < ROTATION * 10.0
        and (
            np.nanmin(np.where(np.isnan(angle_errors), np.inf, angle_errors), axis=0) < 1e-5
        ).mean()
        >= 1.0 - lost_share
    )


def _upright(z: Array, p: Array) -> bool:
    """Return whether axis 1 is the Z of base_link."""
    foot = p[0] - z[0] * float(z[0] @ p[0])
    return bool(np.hypot(z[0, 0], z[0, 1]) < PARALLEL_TOLERANCE and np.linalg.norm(foot) < NEAR_MM)


def _normal(axis: Array, wrist: Array) -> Array:
    """Return the normal of the arm's plane, parallel to an axis, for which the wrist is ahead.

    If the wrist is on axis 1, the normal points along the axis.
    """
    flat: Array = np.array([axis[0], axis[1], 0.0]) / np.hypot(axis[0], axis[1])
    ahead = float(np.cross(flat, (0.0, 0.0, 1.0)) @ wrist)
    return -flat if ahead < -NEAR_MM else flat


def _sign(value: float) -> int:
    return 1 if value > 0.0 else -1


def _parallel(direction: Array, reference: Array) -> bool:
    return float(np.linalg.norm(np.cross(direction, reference))) < PARALLEL_TOLERANCE


def _square(direction: Array, reference: Array) -> bool:
    return abs(float(direction @ reference)) < PARALLEL_TOLERANCE


def _meeting(p: Array, z: Array, q: Array, w: Array) -> Array | None:
    """Return the point (3,) where two non-parallel lines meet; None if they are skew."""
    across = np.cross(z, w)
    size = float(across @ across)
    if size < PARALLEL_TOLERANCE or abs(float((q - p) @ across)) / math.sqrt(size) > NEAR_MM:
        return None
    meeting: Array = p + z * (float(np.cross(q - p, w) @ across) / size)
    return meeting
