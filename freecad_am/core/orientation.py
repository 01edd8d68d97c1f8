# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conversions from rotation matrices to angles, quaternions and rotation vectors, and back.

Posts share these formulas and add the pendant's letters.

Rotations are (n, 3, 3), numbers (n, 3) or (n, 4), angles in rad. Program readers deliberately have
separate formulas, to detect errors here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .geometry import frames
from .types import Array


@dataclass(frozen=True, eq=False)
class Orientation:
    """A pair of inverse conversions.

    numbers: from rotations (n, 3, 3) to numbers. rotations: from numbers to rotations. degrees:
    whether pendants show degrees.
    """

    numbers: Callable[[Array], Array]
    rotations: Callable[[Array], Array]
    degrees: bool = True


@dataclass(frozen=True)
class Pendant:
    """How a controller's pendant shows orientations.

    maker: manufacturer. letters: labels of the orientation values, after X Y Z. digits: number of
    decimals.
    """

    maker: str
    letters: tuple[str, ...]
    orientation: Orientation
    digits: int = 4


def _from_bryant(angles: Array) -> Array:
    return np.asarray(
        frames.about_x(angles[..., 0])
        @ frames.about_y(angles[..., 1])
        @ frames.about_z(angles[..., 2])
    )


def about_fixed(rotation: Array, still: str) -> Array:
    """Return the angles about the fixed X, Y and Z axes for rotations Rz Ry Rx.

    If the angle about Y is a right angle (gimbal lock), only the sum or the difference of the
    angles about X and Z is defined.

    Parameters
    ----------
    rotation : (n, 3, 3) array
        Rotation matrices.
    still : str
        'x' or 'z': the axis whose angle is 0 in gimbal lock.

    Returns
    -------
    (n, 3) array
        Angles about X, Y and Z, rad.
    """
    # contiguous entries: numpy's arctan2 of strided arrays is not bit-identical on all machines
    entry = np.array(rotation.transpose(1, 2, 0), order="C")
    across = np.hypot(entry[0, 0], entry[1, 0])
    upright = across > 1e-9
    locked_x = np.arctan2(-entry[1, 2], entry[1, 1]) if still == "z" else 0.0
    locked_z = np.arctan2(-entry[0, 1], entry[1, 1]) if still == "x" else 0.0
    x = np.where(upright, np.arctan2(entry[2, 1], entry[2, 2]), locked_x)
    z = np.where(upright, np.arctan2(entry[1, 0], entry[0, 0]), locked_z)
    return np.stack((x, np.arctan2(-entry[2, 0], across), z), axis=1)


def _from_fixed(angles: Array) -> Array:
    return np.asarray(
        frames.about_z(angles[..., 2])
        @ frames.about_y(angles[..., 1])
        @ frames.about_x(angles[..., 0])
    )


def quaternions(rotation: Array) -> Array:
    """Return the unit quaternions of rotations.

    Each quaternion is computed from its largest component, so that rotations near 180 deg are
    accurate too.

    Parameters
    ----------
    rotation : (n, 3, 3) array
        Rotation matrices.

    Returns
    -------
    (n, 4) array
        Quaternions, scalar component first and not negative.
    """
    r = np.ascontiguousarray(rotation)
    trace = r[:, 0, 0] + r[:, 1, 1] + r[:, 2, 2]
    squares = np.stack([1.0 + trace, *(1.0 - trace + 2.0 * r[:, k, k] for k in range(3))], axis=1)
    wx, wy, wz = r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]
    xy, xz, yz = r[:, 1, 0] + r[:, 0, 1], r[:, 0, 2] + r[:, 2, 0], r[:, 2, 1] + r[:, 1, 2]
    # row k is the quaternion times four times its component k
    rows = np.stack([
        np.stack([squares[:, 0], wx, wy, wz], axis=1), np.stack([wx, squares[:, 1], xy, xz], axis=1),
        np.stack([wy, xy, squares[:, 2], yz], axis=1), np.stack([wz, xz, yz, squares[:, 3]], axis=1),
    ], axis=1)  # fmt: skip
    found = rows[np.arange(len(r)), np.argmax(squares, axis=1)]
    unit: Array = (
        found
        * np.where(found[:, :1] < 0.0, -1.0, 1.0)
        / np.linalg.norm(found, axis=1, keepdims=True)
    )
    return unit


def _from_quaternions(numbers: Array) -> Array:
    vector = numbers[..., 1:]
    return _about(vector, 2.0 * np.arctan2(np.linalg.norm(vector, axis=-1), numbers[..., 0]))


def _vectors(rotation: Array) -> Array:
    """Return rotation vectors, (n, 3) rad, of at most pi length."""
    found = quaternions(rotation)
    sine = np.linalg.norm(found[:, 1:], axis=1)
    turn = 2.0 * np.arctan2(sine, np.ascontiguousarray(found[:, 0]))
    vectors: Array = (
        found[:, 1:] * np.where(sine > 1e-12, turn / np.maximum(sine, 1e-300), 2.0)[:, None]
    )
    return vectors


def _from_vectors(vectors: Array) -> Array:
    return _about(vectors, np.linalg.norm(vectors, axis=-1))


def _about(axes: Array, angles: Array) -> Array:
    """Return the rotations by angles (n,) about axes (n, 3) of any length; identity for zero axes."""
    return np.asarray(
        frames.rotation_about(frames.unit(axes), np.where(axes.any(axis=-1), angles, 0.0))
    )


def _reversed(numbers: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda given: numbers(given)[..., ::-1]


# R = Rx Ry Rz, as for poses in this package; R = Rz Ry Rx, angle about X first or angle about Z first
MOVING_XYZ = Orientation(frames.to_bryant, _from_bryant)
FIXED_XYZ = Orientation(lambda rotation: about_fixed(rotation, "x"), _from_fixed)
MOVING_ZYX = Orientation(
    _reversed(lambda rotation: about_fixed(rotation, "z")),
    lambda angles: _from_fixed(angles[..., ::-1]),
)
QUATERNION = Orientation(quaternions, _from_quaternions, False)
ROTATION_VECTOR = Orientation(_vectors, _from_vectors, False)
