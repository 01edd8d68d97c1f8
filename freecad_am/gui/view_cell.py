# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in the 3D view, as the part sees it: platform under it, nozzle where the deposit ends."""

from __future__ import annotations

from typing import Any

import numpy as np
from pivy import coin

from ..core.geometry import frames
from ..objects.stage import stage_of
from .lines import placed, turned
from .view_base import StageView

_LEAST_THICKNESS = 1.0


class CellView(StageView):
    """Draws platform and nozzle in part coordinates; without a toolpath the platform lies at the origin."""

    icon = "cell"

    def scene(self, root: Any) -> None:
        self.platform, self.nozzle = coin.SoSeparator(), coin.SoSeparator()
        looks = (((0.55, 0.58, 0.62), 0.2, self.platform), ((0.8, 0.82, 0.85), 0.0, self.nozzle))
        for colour, transparency, node in looks:
            material, group = coin.SoMaterial(), coin.SoSeparator()
            material.diffuseColor.setValue(*colour)
            material.transparency = transparency
            group.addChild(material)
            group.addChild(node)
            root.addChild(group)

    def draw(self, obj: Any, value: Any) -> None:
        toolpath = _toolpath_of(obj)
        mount, tip, axis = np.eye(4), np.zeros(3), np.array([0.0, 0.0, 1.0])
        if toolpath is not None:
            last = toolpath.layers[-1].beads[-1]
            tip, axis = last.points[-1], last.tool[-1]
            by_part = value.mount == "part" or (value.mount == "auto" and toolpath.family != "revolution")
            mount = np.eye(4) if by_part else toolpath.frame
        self.platform.removeAllChildren()
        if value.platform_diameter > 0.0:
            radius = 0.5 * value.platform_diameter
            thick = value.platform if isinstance(value.platform, float) else _LEAST_THICKNESS
            low = -max(_LEAST_THICKNESS, thick)
            self.platform.addChild(placed(mount))
            self.platform.addChild(turned([(0.0, low), (radius, low), (radius, 0.0), (0.0, 0.0)]))
        nozzle = value.nozzle
        tip_radius = 0.5 * nozzle.diameter
        top_radius = tip_radius + nozzle.length * np.tan(nozzle.half_angle)
        self.nozzle.removeAllChildren()
        self.nozzle.addChild(placed(frames.pose(frames.smallest_rotation([0.0, 0.0, 1.0], axis), tip)))
        self.nozzle.addChild(turned([(0.0, 0.0), (tip_radius, 0.0), (top_radius, nozzle.length), (0.0, nozzle.length)]))


def _toolpath_of(obj: Any) -> Any:
    for follower in obj.InList:
        stage = stage_of(follower)
        if stage is not None and stage.kind == "toolpath" and follower.Key:
            return stage.value(follower)
    return None
