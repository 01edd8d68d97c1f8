# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joint limits of single axes and of coupled axes, and the reserve kept from them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..types import Array, ArrayLike, Index, Integers, Mask


@dataclass(frozen=True, eq=False)
class PoseFrames:
    """Flange poses left Rz(sign phi) right, with left and right (n, 4, 4) or (1, 4, 4)."""

    left: Array
    sign: float
    right: Array

    def of(self, rows: slice | Integers) -> PoseFrames:
        """Return the pose frames of selected points."""
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
        """Return flange poses for rotations, in the memory order that is fastest to compute.

        Parameters
        ----------
        phi : (..., n) array
            Rotations about the tool axis, rad.

        Returns
        -------
        (..., n, 4, 4) array
            Poses, mm. If the part is carried, each matrix entry is contiguous over the poses.
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
        # entry by entry: looping over matrix axes of length four takes twice as long
        for row in range(4):
            entry_a, entry_b = np.ascontiguousarray(self.left[:, row, :2].T)
            rotated[..., row, 0] = cos * entry_a + sin * entry_b
            rotated[..., row, 1] = cos * entry_b - sin * entry_a
        rotated[..., :, 2:] = self.left[:, :, 2:]
        turned: Array = (rotated.reshape(-1, 4) @ self.right[0]).reshape(rotated.shape)
        return turned


def _moved_by(frame: Array, poses: Array) -> Array:
    """Return frame @ poses; skip the rotation for an upright frame, the usual case."""
    if np.array_equal(frame[:3, :3], np.eye(3)):
        poses[..., :3, 3] += frame[:3, 3]
        return poses
    moved: Array = frame @ np.ascontiguousarray(poses)
    return moved


class Smallest(NamedTuple):
    """Minimum margin of each joint vector.

    margin: (...) rad or mm. label: (...) index of the limit in `Limits.labels`.
    """

    margin: Array
    label: Index


@dataclass(frozen=True, eq=False)
class Limits:
    """One set of joint limits on the serial joint values, rad or mm.

    lower, upper: (axes,), infinite for a continuous axis. Each of the m coupled limits keeps
    `coefficients` (m, axes) @ q between `coupled_lower` and `coupled_upper` (m,). labels: names of
    the axes, then of the coupled limits.
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
        """(axes,) bool, True for continuous axes."""
        without: Mask = ~np.isfinite(self.upper - self.lower)
        return without

    def margin(self, q: ArrayLike) -> Array:
        """Return the distance of joint vectors to the nearer end of each limit.

        Parameters
        ----------
        q : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes + m) array
            Distances, rad or mm; negative beyond a limit, infinite for a continuous axis, NaN for
            NaN joints.
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
        """Return the margin to each limit as a fraction of half the range.

        Parameters
        ----------
        q : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., axes + m) array
            `margins` of the axes, then of the coupled limits.
        """
        return np.concatenate(
            [
                margins(q, self.lower, self.upper),
                margins(q @ self.coefficients.T, self.coupled_lower, self.coupled_upper),
            ],
            axis=-1,
        )

    def smallest_share(self, q: Array) -> Array:
        """Return the minimum of `shares` for each joint vector.

        It is computed limit by limit, because allocating the array of all shares would dominate
        the time.

        Parameters
        ----------
        q : (n, axes) array
            Joints, rad or mm.

        Returns
        -------
        (n,) array
            1 at mid-range of all limits, 0 at a limit, negative beyond a limit.
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
        """Return the minimum margin of joint vectors.

        Parameters
        ----------
        q : (..., axes) array_like
            Joint values, rad or mm.

        Returns
        -------
        Smallest
            Margins (...), rad or mm, NaN for NaN joints, and the indices (...) of their limits.
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
            Allowed excess, rad or mm.

        Returns
        -------
        (..., axes + m) array of bool
            True for exceeded limits: axes first, then coupled limits.
        """
        result: Mask = self.margin(q) < -tolerance
        return result


def margins(joints: Array, lower: Array, upper: Array) -> Array:
    """Return the distance to the nearer limit as a fraction of half the range.

    Parameters
    ----------
    joints : (..., a) array
        Joints, rad or mm.
    lower, upper : (a,) array
        Limits; infinite for continuous axes.

    Returns
    -------
    (..., a) array
        1 at mid-range and for continuous axes, 0 at a limit, negative beyond a limit; NaN for
        NaN joints.
    """
    share = np.empty_like(joints)
    for axis, (low, high) in enumerate(
        zip(lower, upper, strict=True)
    ):  # column by column, because large temporary arrays are slow to allocate
        share[..., axis] = _share(joints[..., axis], low, high)
    return share


def _share(column: Array, low: float, high: float) -> Array:
    """Return `margins` of one joint."""
    half = 0.5 * (high - low)
    if np.isfinite(half):
        return np.asarray(np.minimum(column - low, high - column) / (half if half > 0.0 else 1.0))
    return np.where(np.isfinite(column), 1.0, np.minimum(column, -column))


@dataclass(frozen=True)
class Payload:
    """Maximum load of a machine.

    kg: mass. from_axis: distance of the centre of gravity from the last axis, mm. Infinite if
    unknown.
    """

    kg: float = math.inf
    from_axis: float = math.inf


# ---- Reserve at each limit (docs/decisions/0009)

# rad, or mm for prismatic axes; rounding to the last digit of a program, in deg or mm, must not
# exceed a limit
RESERVE = math.radians(0.05)
