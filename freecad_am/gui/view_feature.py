# SPDX-License-Identifier: LGPL-2.1-or-later
"""The feature in the 3D view: meridian and axis, or the first layer of a wall on a substrate."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.geometry.surface_wall import SurfaceWall
from .lines import DASHED, Lines
from .view_base import StageView


class FeatureView(StageView):
    """Draws the meridian at the start of the turn, and the axis; of a wall on a substrate the first layer."""

    icon = "feature"

    def scene(self, root: Any) -> None:
        self.meridian = Lines(3.0, (0.96, 0.47, 0.0))
        self.axis = Lines(2.0, (0.96, 0.47, 0.0), DASHED)
        root.addChild(self.meridian.node)
        root.addChild(self.axis.node)

    def draw(self, obj: Any, value: Any) -> None:
        if isinstance(value, SurfaceWall):
            self.meridian.set(np.concatenate([value.first, value.first[:1]]), [len(value.first) + 1])
            self.axis.set(np.zeros((0, 3)), [])
            return
        radius, height = value.meridian.points.T
        points = value.points(radius, height, np.full(len(radius), value.start))
        low, high = float(height.min()), float(height.max())
        over = 0.1 * max(high - low, float(radius.max()))
        ends = np.array([low - over, high + over])
        self.meridian.set(points, [len(points)])
        self.axis.set(value.points(np.zeros(2), ends, np.zeros(2)), [2])
