# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses as pendants write them: the place in mm, and a rotation in degrees in the way of each maker, or as a quaternion."""

from __future__ import annotations

import numpy as np

from ...geometry import frames
from ...types import Array

FANUC, KUKA, STAUBLI, ZYZ, QUATERNION = "W P R", "A B C", "RX RY RZ", "O A T", "q1 q2 q3 q4"
# how a pose's rotation is written -> its figures, and who writes it so
CONVENTIONS = {
    FANUC: ("W P R", "FANUC, Yaskawa (Rx Ry Rz): about X, Y, Z of the base"),
    KUKA: ("A B C", "KUKA: about Z, Y, X, each as the one before turned it"),
    STAUBLI: ("RX RY RZ", "Stäubli: about X, Y, Z, each as the one before turned it"),
    ZYZ: ("O A T", "Kawasaki: about Z, Y, Z, each as the one before turned it"),
    QUATERNION: ("q1 q2 q3 q4", "ABB: quaternion, the scalar first"),
}


def rotation(convention: str, figures: Array) -> Array:
    """The rotations (..., 3, 3) of figures (..., 3) deg, or (..., 4) of a quaternion of any length."""
    figures = np.asarray(figures, float)
    if convention == QUATERNION:
        return _from_quaternion(figures)
    angle_a, angle_b, angle_c = np.moveaxis(np.radians(figures), -1, 0)
    if convention == FANUC:
        return np.asarray(
            frames.about_z(angle_c) @ frames.about_y(angle_b) @ frames.about_x(angle_a)
        )
    if convention == KUKA:
        return np.asarray(
            frames.about_z(angle_a) @ frames.about_y(angle_b) @ frames.about_x(angle_c)
        )
    if convention == STAUBLI:
        return np.asarray(
            frames.about_x(angle_a) @ frames.about_y(angle_b) @ frames.about_z(angle_c)
        )
    return np.asarray(frames.about_z(angle_a) @ frames.about_y(angle_b) @ frames.about_z(angle_c))


def flange_poses(convention: str, figures: Array, base: Array, tool: Array) -> Array:
    """Return the flange poses (n, 4, 4) in base_link for displayed poses (n, 6 or 7), mm and
    deg.

    These are poses of a `tool` (4, 4) on the flange, in the manufacturer's `base` frame (4,
    4).
    """
    figures = np.asarray(figures, float)
    poses = frames.pose(rotation(convention, figures[:, 3:]), figures[:, :3])
    result: Array = base @ poses @ frames.inverse(tool)
    return result


def figures_of(convention: str, poses: Array) -> Array:
    """Poses (n, 4, 4) as a pendant shows them, (n, 6 or 7) mm and deg."""
    turned = np.asarray(poses, float)[:, :3, :3]
    if convention == QUATERNION:
        angles = _to_quaternion(turned)
    elif convention == STAUBLI:
        angles = np.degrees(frames.to_bryant(turned))
    elif convention == ZYZ:
        angles = np.degrees(_to_zyz(turned))
    else:
        wpr = -np.degrees(frames.to_bryant(np.swapaxes(turned, -1, -2)))
        angles = wpr if convention == FANUC else wpr[:, ::-1]
    return np.column_stack((poses[:, :3, 3], angles)) + 0.0


def _from_quaternion(q: Array) -> Array:
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)),
        (2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)),
        (2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _to_quaternion(turned: Array) -> Array:
    """Return unit quaternions (n, 4), scalar first and not negative, by the formula that divides
    by the largest component.
    """
    diagonal = np.diagonal(turned, axis1=1, axis2=2)
    squares = (
        np.column_stack(
            (diagonal.sum(axis=1), 2.0 * diagonal - diagonal.sum(axis=1, keepdims=True))
        )
        + 1.0
    )
    (_, b, c), (d, _, f), (g, h, _) = np.moveaxis(turned, 0, -1)
    products = np.array(
        [
            [squares[:, 0], h - f, c - g, d - b],
            [h - f, squares[:, 1], b + d, c + g],
            [c - g, b + d, squares[:, 2], f + h],
            [d - b, c + g, f + h, squares[:, 3]],
        ]
    )
    q = products[np.argmax(squares, axis=1), :, np.arange(len(turned))]
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    result: Array = q * np.where(q[:, :1] < 0.0, -1.0, 1.0)
    return result


def _to_zyz(turned: Array) -> Array:
    """Return O A T (n, 3) rad, A from 0 to pi; O is 0 where A is 0 or pi."""
    locked = np.hypot(turned[:, 0, 2], turned[:, 1, 2]) < 1e-12
    angle_o = np.where(locked, 0.0, np.arctan2(turned[:, 1, 2], turned[:, 0, 2]))
    angle_a = np.arctan2(np.hypot(turned[:, 0, 2], turned[:, 1, 2]), turned[:, 2, 2])
    # the frame's Y as O turned it
    across = np.column_stack((-np.sin(angle_o), np.cos(angle_o), np.zeros_like(angle_o)))
    angle_t = np.arctan2(
        np.einsum("ni,ni->n", across, turned[:, :, 0]),
        np.einsum("ni,ni->n", across, turned[:, :, 1]),
    )
    return np.column_stack((angle_o, angle_a, angle_t))
