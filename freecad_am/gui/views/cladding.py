# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces covered with layers of beads, in the 3D view."""

from __future__ import annotations

from typing import Any

from ...core.layers.parted_chart import borders
from ..nodes.wall import WallNodes
from .base import StageView


class CladdingView(StageView):
    """Tints the faces and draws the borders of each sheet."""

    icon = "cladding"

    def scene(self, root: Any) -> None:
        self.wall = WallNodes(pickable=True)
        root.addChild(self.wall.switch)

    def draw(self, obj: Any, value: Any) -> None:
        self.wall.set_first(borders_of(value))
        self.wall.set_faces(obj.Source[0], value.faces)


def borders_of(value: Any) -> list[Any]:
    """Return the borders (k, 3) of each sheet of faces, with the first point repeated."""
    return [
        sheet.vertices[[*border, border[0]]]
        for sheet in value.sheets
        for border in borders(sheet.mesh)
    ]
