# SPDX-License-Identifier: LGPL-2.1-or-later
"""The platform that a cell has, as a body in part coordinates."""

from __future__ import annotations

from ...core.geometry.obstacles import Body, disc
from ...core.kinematics.cell import mounted
from ...core.parameters.cell import CellParameters
from ...core.toolpath import Toolpath


def platforms(cell: CellParameters | None, toolpath: Toolpath) -> tuple[Body, ...]:
    """The platform under a toolpath; none without a cell, or where the cell has none."""
    if cell is None or cell.platform_diameter <= 0.0:
        return ()
    return (disc(cell.platform_diameter, mounted(cell, toolpath.frame, toolpath.family)),)
