# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joint limits: of each axis, and of sums of axes coupled by a linkage or a controller; and the
reserve kept from them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..types import Array, ArrayLike, Index, Integers, Mask


@dataclass(frozen=True, eq=False)
class PoseFrames:
    """Flange poses as left . Rz(sign phi) . right; left and right are (n, 4, 4) or (1, 4, 4)."""

    left: Array
    sign: float
    right: Array

    def of(self, rows: slice | Integers) -> PoseFrames:
        """The frames of chosen points."""
        left_frames = self.left if len(self.left) == 1 else self.left[rows]
        right = self.right if len(self.right) == 1 else self.right[rows]
        return PoseFrames(left_frames, self.sign, right)

    def flange_poses(self, phi: Array) -> Array:
        """Return flange poses for rotations.

        Parameters
        ----------
        phi : (..., n) array
            Rotations about the tool axis, rad.

        Returns
        -------
        (..., n, 4, 4) array
            Poses, mm, contiguous.
        """
        return np.ascontiguousarray(self.by_entry(phi))

    def by_entry(self, phi: Array) -> Array:
        """Return the same poses, in the memory order that is fastest to compute.

        Parameters
        ----------
        phi : (..., n) array
            Rotations about the tool axis, rad.

        Returns
        -------
        (..., n, 4, 4) array
            Poses, mm; for carried parts each entry is contiguous over the poses.
        """
        cos, sin = np.cos(phi), self.sign * np.sin(phi)
        if len(self.left) == 1:
            poses, spare = np.empty((4, 4, *phi.shape)), np.empty(phi.shape)
            for column in range(4):
                entry_a, entry_b = np.ascontiguousarray(self.right[:, :2, column].T)
                upper, lower = poses[:2, column]
                np.multiply(cos, entry_a, out=upper)
                upper -= np.multiply(sin, entry_b, out=spare)
                np.multiply(sin, entry_a, out=lower)
                lower += np.multiply(cos, entry_b, out=spare)
                for row in (2, 3):
                    poses[row, column] = self.right[:, row, column]
            return _moved_by(self.left[0], np.moveaxis(poses, (0, 1), (-2, -1)))
        rotated = np.empty((*phi.shape, 4, 4))
        # entry by entry: along axes of length four it takes twice as long
        for row in range(4):
            entry_a, entry_b = np.ascontiguousarray(self.left[:, row, :2].T)
            rotated[..., row, 0] = cos * entry_a + sin * entry_b
            rotated[..., row, 1] = cos * entry_b - sin * entry_a
        rotated[..., :, 2:] = self.left[:, :, 2:]
        turned: Array = (rotated.reshape(-1, 4) @ self.right[0]).reshape(rotated.shape)
        return turned


def _moved_by(frame: Array, poses: Array) -> Array:
    """Return frame @ poses; most cells are upright, so often there is no rotation."""
    if np.array_equal(frame[:3, :3], np.eye(3)):
        poses[..., :3, 3] += frame[:3, 3]
        return poses
    moved: Array = frame @ np.ascontiguousarray(poses)
    return moved


class Smallest(NamedTuple):
    """The smallest margin of each joint vector, rad, and the index of its limit in `Limits.labels`."""

    margin: Array
    label: Index


@dataclass(frozen=True, eq=False)
class Limits:
    """One set of joint limits, rad, on the serial angles.

    `lower` and `upper` (axes,) are infinite where an axis is continuous. Each of the m coupled
    limits holds `coefficients` (m, axes) @ q between `coupled_lower` and `coupled_upper` (m,);
    `labels` names the axes first, then the coupled limits.
    """

    name: str
    lower: Array
    upper: Array
    coefficients: Array
    coupled_lower: Array
    coupled_upper: Array
    labels: tuple[str, ...]
    source: str = ""

    def __post_init__(self) -> None:
        for array in (
            self.lower,
            self.upper,
            self.coefficients,
            self.coupled_lower,
            self.coupled_upper,
        ):
            array.flags.writeable = False

    @property
    def axes(self) -> int:
        """The number of axes."""
        return len(self.lower)

    @property
    def continuous(self) -> Mask:
        """Which axes (axes,) are continuous."""
        without: Mask = ~np.isfinite(self.upper - self.lower)
        return without

    def margin(self, q: ArrayLike) -> Array:
        """Return the distance of joint vectors to the nearer end of every limit.

        Parameters
        ----------
        q : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes + m) array
            Distances, rad or mm; negative outside, infinite for a continuous axis, NaN
            where q is NaN.
        """
        angles = np.asarray(q, float)
        result = np.empty(angles.shape[:-1] + (self.axes + len(self.coupled_lower),))
        np.minimum(angles - self.lower, self.upper - angles, out=result[..., : self.axes])
        coupled = angles @ self.coefficients.T
        np.minimum(
            coupled - self.coupled_lower, self.coupled_upper - coupled, out=result[..., self.axes :]
        )
        return result

    def shares(self, q: Array) -> Array:
        """Return the margins to every limit as shares of half the range.

        Parameters
        ----------
        q : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes + m) array
            `margins` of each axis and then of each coupled limit.
        """
        return np.concatenate(
            [
                margins(q, self.lower, self.upper),
                margins(q @ self.coefficients.T, self.coupled_lower, self.coupled_upper),
            ],
            axis=-1,
        )

    def smallest_share(self, q: Array) -> Array:
        """Return the smallest of the `shares` of each joint vector.

        Computed limit by limit, without an array as large as all shares: allocating memory
        dominates the time.

        Parameters
        ----------
        q : (n, axes) array
            Joints, rad or mm.

        Returns
        -------
        (n,) array
            1 in the middle of all ranges, 0 at a limit, less beyond.
        """
        smallest = np.full(len(q), np.inf)
        for axis, (low, high) in enumerate(zip(self.lower, self.upper, strict=True)):
            np.minimum(smallest, _share(q[:, axis], low, high), out=smallest)
        for row, low, high in zip(
            self.coefficients, self.coupled_lower, self.coupled_upper, strict=True
        ):
            coupled_axes = np.flatnonzero(row)
            coupled = sum((row[axis] * q[:, axis] for axis in coupled_axes), np.zeros(len(q)))
            np.minimum(smallest, _share(coupled, low, high), out=smallest)
        return smallest

    def smallest(self, q: ArrayLike) -> Smallest:
        """Return the smallest margin of joint vectors.

        Parameters
        ----------
        q : (..., axes) array_like
            Joint values, rad or mm.

        Returns
        -------
        Smallest
            The margin (...), rad or mm, NaN where q is, and the number of its limit (...).
        """
        margins = self.margin(q)
        index = np.argmin(margins, axis=-1)
        return Smallest(np.take_along_axis(margins, index[..., None], axis=-1)[..., 0], index)

    def exceeded(self, q: ArrayLike, tolerance: float = 0.0) -> Mask:
        """Return which limits joint vectors exceed.

        Parameters
        ----------
        q : (..., axes) array_like
            Joint values, rad or mm.
        tolerance : float, optional
            Excess that is allowed, rad or mm.

        Returns
        -------
        (..., axes + m) array of bool
            Axes first, then the coupled limits.
        """
        result: Mask = self.margin(q) < -tolerance
        return result


def margins(joints: Array, lower: Array, upper: Array) -> Array:
    """Return the distance to the nearer limit as a share of half the range.

    Parameters
    ----------
    joints : (..., a) array
        Joints, rad or mm.
    lower, upper : (a,) array
        Limits, infinite where an axis is continuous.

    Returns
    -------
    (..., a) array
        1 in the middle and for continuous axes, 0 at a limit, negative beyond it; NaN
        where a joint is NaN.
    """
    share = np.empty_like(joints)
    for axis, (low, high) in enumerate(
        zip(lower, upper, strict=True)
    ):  # temporary arrays of this size are slow to allocate
        share[..., axis] = _share(joints[..., axis], low, high)
    return share


def _share(column: Array, low: float, high: float) -> Array:
    """`margins` of one joint."""
    half = 0.5 * (high - low)
    if np.isfinite(half):
        return np.asarray(np.minimum(column - low, high - column) / (half if half > 0.0 else 1.0))
    return np.where(np.isfinite(column), 1.0, np.minimum(column, -column))


@dataclass(frozen=True)
class Payload:
    """Maximum load of a machine: kg, and distance, mm, of the load's centre of gravity from the
    last axis; infinite if unknown.
    """

    kg: float = math.inf
    from_axis: float = math.inf


# ---- The margin kept free at every limit (docs/decisions/0009)

# rad, and mm of prismatic axes: the last digit of a program, of a degree or mm, must not move an
# axis past its limit
RESERVE = math.radians(0.05)
