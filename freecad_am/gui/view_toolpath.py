# SPDX-License-Identifier: LGPL-2.1-or-later
"""The toolpath in the 3D view: beads coloured by layer or by what else is chosen, build directions on demand."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from ..core.issues import InputError
from ..core.parameters.strategy import SurfaceParameters
from . import legend
from .colouring import KINDS, Scale, coloured
from .lines import Lines
from .view_base import StageView


class ToolpathView(StageView):
    """Draws the beads from blue at the least to yellow at the most; a single bead is coloured along its way."""

    icon = "toolpath"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "Colouring": ("App::PropertyEnumeration", KINDS, "What the colours of the beads tell."),
        "ShowLegend": ("App::PropertyBool", True, "Show in the corner of the view what the colours mean."),
        "ShowDirections": ("App::PropertyBool", False, "Show the build directions as short lines."),
        "DirectionStep": ("App::PropertyInteger", 8, "Show the build direction of every how many-th point."),
        "DirectionLength": ("App::PropertyLength", 4.0, "Length of the lines that show build directions."),
        "LineWidth": ("App::PropertyFloat", 2.0, "Width of the beads' lines in pixels."),
    }

    source_hidden = True
    scale: Scale | None = None  # of the colours that are shown
    told: tuple[str, str, float] | None = None  # what the colours are of

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
        beads = [bead for _, _, bead in value]
        self.points = np.concatenate([bead.points for bead in beads])
        self.build = np.concatenate([bead.build for bead in beads])
        self.beads.set(self.points, np.array([len(bead) for bead in beads]))
        self.told = None
        if not self.source_hidden:  # a new path lies in the surface of its shape, and its start in that of a wall
            self.source_hidden = True
            for source in (obj.Feature.Source[0], *getattr(obj.Feature, "Further", ())):
                source.ViewObject.Visibility = False
            if hasattr(obj.Feature, "Substrate"):
                obj.Feature.ViewObject.Visibility = False
        if obj.Cell is not None and getattr(obj.Cell.ViewObject, "Proxy", None):
            obj.Cell.ViewObject.Proxy.refresh()

    def style(self, vobj: Any) -> None:
        self._colour(vobj)
        legend.renew_soon()
        self.beads.style.lineWidth = max(1.0, vobj.LineWidth)
        self.directions.show(vobj.ShowDirections)
        if vobj.ShowDirections:
            step = max(1, vobj.DirectionStep)
            start = self.points[::step]
            ends = np.stack([start, start + vobj.DirectionLength.Value * self.build[::step]], axis=1)
            self.directions.set(ends, np.full(len(start), 2))

    def _colour(self, vobj: Any) -> None:
        """Colour the beads anew where that would be other colours."""
        obj = vobj.Object
        band = float(getattr(obj.Feature, "Band", 100.0 * SurfaceParameters().band)) / 100.0
        wanted = (self.drawn, vobj.Colouring, band)
        if len(self.points) and wanted != self.told:
            try:
                toolpath = obj.Proxy.value(obj)
            except InputError:  # within undo; it is drawn once all is back
                return
            colours, self.scale = coloured(toolpath, vobj.Colouring, band)
            self.beads.paint(colours)
            self.told = wanted

    def onChanged(self, vobj: Any, name: str) -> None:
        """A view property has changed."""
        super().onChanged(vobj, name)
        if name == "Visibility":
            legend.renew_soon()
