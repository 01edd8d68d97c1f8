# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves printed as beads, in the 3D view."""

from __future__ import annotations

from typing import Any

from ..nodes.wall import WallNodes
from .base import StageView


class CurvesView(StageView):
    """Draws the curves."""

    icon = "curves"

    def scene(self, root: Any) -> None:
        self.wall = WallNodes(pickable=True)
        root.addChild(self.wall.switch)

    def draw(self, obj: Any, value: Any) -> None:
        self.wall.set_first([curve.points for curve in value.curves])
