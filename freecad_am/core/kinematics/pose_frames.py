# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flange poses as functions of the rotation about the tool, which is all that varies in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..types import Array, Integers


@dataclass(frozen=True, eq=False)
class PoseFrames:
    """Flange poses as left . Rz(sign phi) . right; left and right are (n, 4, 4) or (1, 4, 4)."""

    left: Array
    sign: float
    right: Array

    def of(self, chosen: slice | Integers) -> PoseFrames:
        """The frames of chosen points."""
        left = self.left if len(self.left) == 1 else self.left[chosen]
        right = self.right if len(self.right) == 1 else self.right[chosen]
        return PoseFrames(left, self.sign, right)

    def at(self, phi: Array) -> Array:
        """(..., n, 4, 4) flange poses for rotations phi (..., n)."""
        return np.ascontiguousarray(self.by_entry(phi))

    def by_entry(self, phi: Array) -> Array:
        """The same, of parts that the flange carries with each entry of all poses together in memory, which is sooner filled
        and looked at entry by entry."""
        cos, sin = np.cos(phi), self.sign * np.sin(phi)
        if len(self.left) == 1:
            poses, spare = np.empty((4, 4, *phi.shape)), np.empty(phi.shape)
            for column in range(4):
                first, second = np.ascontiguousarray(self.right[:, :2, column].T)
                upper, lower = poses[:2, column]
                np.multiply(cos, first, out=upper)
                upper -= np.multiply(sin, second, out=spare)
                np.multiply(sin, first, out=lower)
                lower += np.multiply(cos, second, out=spare)
                for row in (2, 3):
                    poses[row, column] = self.right[:, row, column]
            return _moved_by(self.left[0], np.moveaxis(poses, (0, 1), (-2, -1)))
        rotated = np.empty((*phi.shape, 4, 4))
        # entry by entry too: along axes of four it takes twice as long
        for row in range(4):
            first, second = np.ascontiguousarray(self.left[:, row, :2].T)
            rotated[..., row, 0] = cos * first + sin * second
            rotated[..., row, 1] = cos * second - sin * first
        rotated[..., :, 2:] = self.left[:, :, 2:]
        turned: Array = (rotated.reshape(-1, 4) @ self.right[0]).reshape(rotated.shape)
        return turned


def _moved_by(frame: Array, poses: Array) -> Array:
    """frame @ poses; most cells stand upright, so the rotation is often none at all."""
    if np.array_equal(frame[:3, :3], np.eye(3)):
        poses[..., :3, 3] += frame[:3, 3]
        return poses
    moved: Array = frame @ np.ascontiguousarray(poses)
    return moved
