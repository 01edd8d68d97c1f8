# SPDX-License-Identifier: LGPL-2.1-or-later
"""A feature in the 3D view: meridian and axis, or faces and first layer of a wall on a substrate."""

from __future__ import annotations

from typing import Any, ClassVar

from ...objects.families.registry import stage_family
from .. import icons
from ..nodes.lines import MeridianNodes
from ..nodes.wall import WallNodes, first_curves
from .base import StageView


class FeatureView(StageView):
    """Draws the meridian at the start angle and the axis, or faces and first layer of a wall on a
    substrate.
    """

    icon = "feature"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowFaces": ("App::PropertyBool", True, "Tint the faces of a wall on a substrate."),
    }

    def complete(self, vobj: Any) -> None:
        """Add missing view properties of a wall on a substrate; parts of revolution have none."""
        if hasattr(vobj.Object, "Substrate"):
            super().complete(vobj)

    def scene(self, root: Any) -> None:
        self.revolved, self.wall = MeridianNodes(), WallNodes(pickable=True)
        for node in (self.revolved.switch, self.wall.switch):
            root.addChild(node)

    def draw(self, obj: Any, value: Any) -> None:
        if stage_family(obj.Proxy).has_axis:
            self.revolved.set_wall(value)
            return
        self.revolved.clear()
        self.wall.set_first(first_curves(value))
        self.wall.set_faces(obj.Source[0], value.faces)

    def style(self, vobj: Any) -> None:
        self.wall.faces.show(getattr(vobj, "ShowFaces", False))

    def getIcon(self) -> str:
        """Return the icon of the family, with a badge for problems."""
        family = "wall_on_part" if hasattr(self.obj, "Substrate") else self.icon
        return icons.badge_path(family, getattr(self.obj, "Status", ""))
