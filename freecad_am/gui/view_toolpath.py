# SPDX-License-Identifier: LGPL-2.1-or-later
"""The toolpath in the 3D view: beads coloured by layer, build directions on demand."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from . import colours
from .lines import Lines
from .view_base import StageView


class ToolpathView(StageView):
    """Draws the beads from blue at the platform to yellow at the top; a single bead is coloured along its way."""

    icon = "toolpath"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "ShowDirections": ("App::PropertyBool", False, "Show the build directions as short lines."),
        "DirectionStep": ("App::PropertyInteger", 8, "Show the build direction of every how many-th point."),
        "DirectionLength": ("App::PropertyLength", 4.0, "Length of the lines that show build directions."),
        "LineWidth": ("App::PropertyFloat", 2.0, "Width of the beads' lines in pixels."),
    }

    source_hidden = True

    def __init__(self, vobj: Any) -> None:
        super().__init__(vobj)
        self.source_hidden = False

    def scene(self, root: Any) -> None:
        self.beads = Lines()
        self.directions = Lines(1.0, (0.86, 0.2, 0.55))
        self.points = self.build = np.zeros((0, 3))
        root.addChild(self.beads.node)
        root.addChild(self.directions.node)

    def draw(self, obj: Any, value: Any) -> None:
        layers = np.array([layer for layer, _, _ in value])
        beads = [bead for _, _, bead in value]
        counts = np.array([len(bead) for bead in beads])
        self.points = np.concatenate([bead.points for bead in beads])
        self.build = np.concatenate([bead.build for bead in beads])
        if len(beads) > 1:
            share = np.repeat(layers / max(1, layers[-1]), counts)
        else:
            share = np.linspace(0.0, 1.0, len(self.points))
        self.beads.set(self.points, counts, colours.ramp(share))
        if not self.source_hidden:  # a new path lies in the surface of its shape
            self.source_hidden = True
            obj.Feature.Source[0].ViewObject.Visibility = False
        if obj.Cell is not None and getattr(obj.Cell.ViewObject, "Proxy", None):
            obj.Cell.ViewObject.Proxy.refresh()

    def style(self, vobj: Any) -> None:
        self.beads.style.lineWidth = max(1.0, vobj.LineWidth)
        self.directions.show(vobj.ShowDirections)
        if vobj.ShowDirections:
            step = max(1, vobj.DirectionStep)
            start = self.points[::step]
            ends = np.stack([start, start + vobj.DirectionLength.Value * self.build[::step]], axis=1)
            self.directions.set(ends, np.full(len(start), 2))
