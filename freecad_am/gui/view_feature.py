# SPDX-License-Identifier: LGPL-2.1-or-later
"""The feature in the 3D view: meridian and axis, or faces and first layer of a wall on a substrate."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from ..core.geometry.profile import RevolvedWall
from . import icons
from .lines import DASHED, Lines
from .view_base import StageView
from .wall_nodes import WallNodes, first_curves

NOTHING = np.zeros((0, 3))


class FeatureView(StageView):
    """Draws the meridian at the start of the turn, and the axis; of a wall on a substrate faces and first layer."""

    icon = "feature"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowFaces": ("App::PropertyBool", True, "Tint the faces of a wall on a substrate."),
    }

    def complete(self, vobj: Any) -> None:
        """Add the view properties a wall on a substrate lacks; there are none for parts of revolution."""
        if hasattr(vobj.Object, "Substrate"):
            super().complete(vobj)

    def scene(self, root: Any) -> None:
        self.meridian = Lines(3.0, (0.96, 0.47, 0.0))
        self.axis = Lines(2.0, (0.96, 0.47, 0.0), DASHED)
        self.wall = WallNodes(pickable=True)
        for node in (self.meridian.node, self.axis.node, self.wall.switch):
            root.addChild(node)

    def draw(self, obj: Any, value: Any) -> None:
        if not isinstance(value, RevolvedWall):
            self.meridian.set(NOTHING, [])
            self.axis.set(NOTHING, [])
            self.wall.set_first(first_curves(value))
            self.wall.set_faces(obj.Source[0], value.faces)
            return
        radius, height = value.meridian.points.T
        points = value.points(radius, height, np.full(len(radius), value.start))
        low, high = float(height.min()), float(height.max())
        over = 0.1 * max(high - low, float(radius.max()))
        ends = np.array([low - over, high + over])
        self.meridian.set(points, [len(points)])
        self.axis.set(value.points(np.zeros(2), ends, np.zeros(2)), [2])

    def style(self, vobj: Any) -> None:
        self.wall.faces.show(getattr(vobj, "ShowFaces", False))

    def getIcon(self) -> str:
        """That of its family, with a badge unless all is well."""
        family = "wall_on_part" if hasattr(self.obj, "Substrate") else self.icon
        return icons.with_badge(family, getattr(self.obj, "Status", ""))
