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

    def of(self, rows: slice | Integers) -> PoseFrames:
        """The frames of chosen points."""
        left_frames = self.left if len(self.left) == 1 else self.left[rows]
        right = self.right if len(self.right) == 1 else self.right[rows]
        return PoseFrames(left_frames, self.sign, right)

    def flange_poses(self, phi: Array) -> Array:
        """Return flange poses (..., n, 4, 4) for rotations phi (..., n)."""
        return np.ascontiguousarray(self.by_entry(phi))

    def by_entry(self, phi: Array) -> Array:
        """Return the same poses; for carried parts each entry of all poses is contiguous in memory.

        Filling and reading entry by entry is faster.
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
        # entry by entry too: along axes of four it takes twice as long
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
