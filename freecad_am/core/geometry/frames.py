# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotations, poses and angles as arrays: (..., 3, 3) rotations, (..., 4, 4) poses, mm and rad.

A pose maps coordinates of its own frame to coordinates of its parent frame. Leading dimensions are
arbitrary, so one call serves a single pose or a hundred thousand.
"""

from __future__ import annotations

import math

import numpy as np

from ..types import Array, ArrayLike


def pose(rotation: ArrayLike, origin: ArrayLike) -> Array:
    """Build poses from rotations and origins.

    Parameters
    ----------
    rotation : (..., 3, 3) array
        Rotations.
    origin : (..., 3) array
        Origins, mm.

    Returns
    -------
    (..., 4, 4) array
        Poses.
    """
    rotation, origin = np.asarray(rotation, float), np.asarray(origin, float)
    lead = np.broadcast_shapes(rotation.shape[:-2], origin.shape[:-1])
    result = np.zeros(lead + (4, 4))
    result[..., :3, :3] = rotation
    result[..., :3, 3] = origin
    result[..., 3, 3] = 1.0
    return result


def inverse(poses: ArrayLike) -> Array:
    """Return the inverse of rigid poses.

    Parameters
    ----------
    poses : (..., 4, 4) array
        Poses.

    Returns
    -------
    (..., 4, 4) array
        Inverse poses.
    """
    poses = np.asarray(poses, float)
    turned = np.swapaxes(poses[..., :3, :3], -1, -2)
    return pose(turned, -(turned @ poses[..., :3, 3:])[..., 0])


def transform_point(poses: Array, point: Array) -> Array:
    """Return a point transformed by poses.

    One product over the rows of all poses takes a third of the time of k products. The last digit
    may differ.

    Parameters
    ----------
    poses : (k, 4, 4) array
        Poses.
    point : (3,) array
        The point, mm.

    Returns
    -------
    (k, 3) array
        Transformed points, mm.
    """
    rows = np.ascontiguousarray(poses).reshape(-1, 4)
    return np.asarray((rows @ np.append(point, 1.0)).reshape(-1, 4)[:, :3])


def rotate_vector(poses: Array, vector: Array) -> Array:
    """Return a vector rotated by poses, computed as in `transform_point`.

    Parameters
    ----------
    poses : (k, 4, 4) array
        Poses.
    vector : (3,) array
        The vector.

    Returns
    -------
    (k, 3) array
        The rotated vectors.
    """
    rows = np.ascontiguousarray(poses).reshape(-1, 4)
    return np.asarray((rows @ np.append(vector, 0.0)).reshape(-1, 4)[:, :3])


def about_x(angle: ArrayLike) -> Array:
    """Return rotations about X.

    Parameters
    ----------
    angle : (...) array
        Angles, rad.

    Returns
    -------
    (..., 3, 3) array
        Rotations.
    """
    return rotation_about((1.0, 0.0, 0.0), angle)


def about_y(angle: ArrayLike) -> Array:
    """Return rotations about Y.

    Parameters
    ----------
    angle : (...) array
        Angles, rad.

    Returns
    -------
    (..., 3, 3) array
        Rotations.
    """
    return rotation_about((0.0, 1.0, 0.0), angle)


def about_z(angle: ArrayLike) -> Array:
    """Return rotations about Z.

    Parameters
    ----------
    angle : (...) array
        Angles, rad.

    Returns
    -------
    (..., 3, 3) array
        Rotations.
    """
    return rotation_about((0.0, 0.0, 1.0), angle)


def rotation_about(axis: ArrayLike, angle: ArrayLike) -> Array:
    """Return right-handed rotations about axes.

    Parameters
    ----------
    axis : (..., 3) array
        Unit vectors.
    angle : (...) array
        Angles, rad.

    Returns
    -------
    (..., 3, 3) array
        Rotations.
    """
    axis, angle = np.asarray(axis, float), np.asarray(angle, float, order="C")
    sine, cosine = np.sin(angle), np.cos(angle)
    versine = 1.0 - cosine
    x, y, z = axis[..., 0], axis[..., 1], axis[..., 2]
    result = np.empty(np.broadcast_shapes(axis.shape[:-1], angle.shape) + (3, 3))
    result[..., 0, 0] = x * x * versine + cosine
    result[..., 1, 1] = y * y * versine + cosine
    result[..., 2, 2] = z * z * versine + cosine
    result[..., 0, 1] = x * y * versine - z * sine
    result[..., 1, 0] = x * y * versine + z * sine
    result[..., 0, 2] = x * z * versine + y * sine
    result[..., 2, 0] = x * z * versine - y * sine
    result[..., 1, 2] = y * z * versine - x * sine
    result[..., 2, 1] = y * z * versine + x * sine
    return result


def bryant(six: ArrayLike) -> Array:
    """Build poses from positions and Bryant angles, R = Rx(RX) Ry(RY) Rz(RZ).

    Parameters
    ----------
    six : (..., 6) array
        x, y, z in mm and RX, RY, RZ in rad.

    Returns
    -------
    (..., 4, 4) array
        Poses.

    References
    ----------
    Chalvin 2020, eqs. 9 and 11.
    """
    six = np.asarray(six, float)
    return pose(about_x(six[..., 3]) @ about_y(six[..., 4]) @ about_z(six[..., 5]), six[..., :3])


def to_bryant(rotation: ArrayLike) -> Array:
    """Return the Bryant angles RX, RY and RZ of rotations.

    If RY is +-pi/2, RX and RZ are not unique (gimbal lock) and RX is 0. RZ is computed with the
    resulting RX, so the three angles reproduce the rotation also near gimbal lock.

    Parameters
    ----------
    rotation : (..., 3, 3) array
        Rotations.

    Returns
    -------
    (..., 3) array
        RX and RZ in -pi to pi, RY in -pi/2 to pi/2, rad.
    """
    entries = np.moveaxis(np.asarray(rotation, float), (-2, -1), (0, 1))
    # make each entry contiguous, see `columns`
    rotation = np.moveaxis(np.array(entries, order="C"), (0, 1), (-2, -1))
    rx = np.arctan2(-rotation[..., 1, 2], rotation[..., 2, 2])
    locked = np.hypot(rotation[..., 1, 2], rotation[..., 2, 2]) < 1e-12
    rx = np.where(locked, 0.0, rx)
    second = np.arctan2(rotation[..., 0, 2], np.hypot(rotation[..., 1, 2], rotation[..., 2, 2]))
    sine, cosine = np.sin(rx), np.cos(rx)
    third = np.arctan2(
        cosine * rotation[..., 1, 0] + sine * rotation[..., 2, 0],
        cosine * rotation[..., 1, 1] + sine * rotation[..., 2, 1],
    )
    return np.stack((rx, second, third), axis=-1)


def from_rpy(origin: ArrayLike, rpy: ArrayLike) -> Array:
    """Build poses from origins, roll, pitch and yaw, R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF.

    Parameters
    ----------
    origin : (..., 3) array
        Origins, mm.
    rpy : (..., 3) array
        Roll, pitch and yaw, rad.

    Returns
    -------
    (..., 4, 4) array
        Poses.
    """
    rpy = np.asarray(rpy, float)
    return pose(about_z(rpy[..., 2]) @ about_y(rpy[..., 1]) @ about_x(rpy[..., 0]), origin)


def smallest_rotation(start: ArrayLike, end: ArrayLike) -> Array:
    """Return the rotations with the smallest angle between unit vectors.

    For opposite vectors this rotation is not unique: the result is a half turn about an axis normal
    to both.

    Parameters
    ----------
    start, end : (..., 3) array
        Unit vectors.

    Returns
    -------
    (..., 3, 3) array
        Rotations that take `start` to `end`.

    Notes
    -----
    Composed of two reflections, first in the plane normal to `start`, then in the plane normal to
    the bisector. This keeps full precision up to the half turn.
    """
    start, end = np.broadcast_arrays(np.asarray(start, float), np.asarray(end, float))
    bisector = start + end
    length = np.linalg.norm(bisector, axis=-1, keepdims=True)
    opposite = length[..., 0] <= 1e-14
    bisector = bisector / np.where(length > 1e-14, length, 1.0)
    if opposite.any():
        bisector[opposite] = _normal_to(start[opposite])
    # cancellation in the sum of nearly opposite vectors spoils its component along `start`, which
    # is half its length
    along = (bisector * start).sum(axis=-1, keepdims=True)
    bisector = bisector + (0.5 * length - along) * start
    bisector /= np.linalg.norm(bisector, axis=-1, keepdims=True)
    return _reflection(bisector) @ _reflection(start)


def _normal_to(vectors: Array) -> Array:
    """Return unit vectors normal to unit vectors (..., 3), and to their least aligned axes."""
    smallest_axis = np.eye(3)[np.argmin(np.abs(vectors), axis=-1)]
    normal = np.cross(vectors, smallest_axis)
    result: Array = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return result


def _reflection(normals: Array) -> Array:
    """Return reflections (..., 3, 3) in planes through the origin with unit normals (..., 3)."""
    twice = 2.0 * normals
    result = np.empty((*normals.shape, 3))
    # entry by entry, many times as fast as operations along axes of length three
    for row in range(3):
        for column in range(row, 3):
            entry = (1.0 if row == column else 0.0) - twice[..., row] * normals[..., column]
            result[..., row, column] = result[..., column, row] = entry
    return result


def unit(vectors: Array) -> Array:
    """Scale vectors to unit length.

    Parameters
    ----------
    vectors : (..., 3) array
        Vectors; zero vectors stay zero.

    Returns
    -------
    (..., 3) array
        Unit vectors.
    """
    result: Array = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)
    return result


# ---- Angles, rad

TURN = 2.0 * math.pi


def shortest(angles: Array) -> Array:
    """Wrap angles to -pi to pi.

    Parameters
    ----------
    angles : (...) array
        Angles, rad.

    Returns
    -------
    (...) array
        Wrapped angles, rad.
    """
    brought: Array = angles - TURN * np.round(angles / TURN)
    return brought
