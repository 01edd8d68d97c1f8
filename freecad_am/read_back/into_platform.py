# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a text has the nozzle deposit below the platform that its machine deposits on: nothing of a plan is asked."""

from __future__ import annotations

import numpy as np

from ..core.geometry import frames
from ..core.issues import Text
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from .finding import Finding, error_at

ROUNDED = 0.1  # mm that digits of a program, and joints between its points, may take


def into_platform(motion: Motion, cell: Cell) -> list[Finding]:
    """INTO_PLATFORM with the lowest place, where the nozzle's tip is below the platform, within its edge, while it deposits.
    motion: what the text drives; what is not reached is not looked at."""
    rows = np.flatnonzero(motion.deposit & motion.reachable)
    to_platform = frames.inverse(cell.mount)
    points = motion.position[rows] @ to_platform[:3, :3].T + to_platform[:3, 3]
    below = (points[:, 2] < -ROUNDED) & (
        np.hypot(points[:, 0], points[:, 1]) < 0.5 * cell.platform_diameter
    )
    if not below.any():
        return []
    low, count = int(np.where(below, points[:, 2], np.inf).argmin()), int(below.sum())
    text = Text(
        (
            "the nozzle deposits at 1 point below the platform, by {1:.3g} mm; correct its height, "
            "or the platform of the cell"
        )
        if count == 1
        else (
            "the nozzle deposits at {0} points below the platform, here {1:.3g} mm; correct "
            "their heights, or the platform of the cell"
        ),
        count,
        -points[low, 2],
    )
    return [error_at("INTO_PLATFORM", text, motion, int(rows[low]))]
