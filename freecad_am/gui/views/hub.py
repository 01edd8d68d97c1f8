# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on a hub in the 3D view: the base surfaces, and the contours of their first layers."""

from __future__ import annotations

from typing import Any, ClassVar

from ..nodes.hub import HubNodes
from .base import StageView


class SolidView(StageView):
    """Draws the base plane of solids and their contours on it."""

    icon = "solid"

    def scene(self, root: Any) -> None:
        self.wall = HubNodes(pickable=True)
        root.addChild(self.wall.switch)

    def draw(self, obj: Any, value: Any) -> None:
        self.wall.set_solids(value)


class HubView(StageView):
    """Draws the base of solids and their contours on it."""

    icon = "solids_on_hub"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowBases": (
            "App::PropertyBool",
            True,
            "Tint the cylinders and cones below solids.",
        ),
    }

    def scene(self, root: Any) -> None:
        self.wall = HubNodes(pickable=True)
        root.addChild(self.wall.switch)

    def draw(self, obj: Any, value: Any) -> None:
        self.wall.set_solids(value)

    def style(self, vobj: Any) -> None:
        self.wall.faces.show(vobj.ShowBases)
