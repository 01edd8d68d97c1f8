# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measured points in the 3D view, registered to the part and coloured by deviation, with a legend."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from pivy import coin

from ...core.inspection.bands import PAST_EDGES, bands, colours
from ...core.inspection.inspect import Inspected
from ...objects.fields import preferences
from ..in_language import marked
from ..nodes.lines import fill, unshaded
from ..path import legend
from ..path.colouring import Scale
from ..views.base import StageView


class InspectionView(StageView):
    """Draws points green within tolerance, red for excess material and blue for missing material."""

    icon = "inspect"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "PointSize": ("App::PropertyFloat", 4.0, "Size of the points in pixels."),
        "ShowLegend": (
            "App::PropertyBool",
            True,
            "Show the legend of the colours in the corner of the view.",
        ),
    }
    scale: Scale | None = None

    def scene(self, root: Any) -> None:
        self.look, self.material = coin.SoDrawStyle(), coin.SoMaterial()
        self.coordinates, self.points = coin.SoCoordinate3(), coin.SoPointSet()
        binding, group = coin.SoMaterialBinding(), coin.SoSeparator()
        binding.value = coin.SoMaterialBinding.PER_VERTEX
        for child in (unshaded(), self.look, self.material, binding, self.coordinates, self.points):
            group.addChild(child)
        self.legend = legend.Legend()
        root.addChild(group)
        root.addChild(self.legend.node)

    def draw(self, obj: Any, value: Inspected) -> None:
        fill(self.coordinates.point, value.points.astype(np.float32))
        fill(
            self.material.diffuseColor,
            colours(value.deviation, value.counted, value.tolerance).astype(np.float32),
        )
        self.points.numPoints = len(value.points)
        self.scale = scale_of(value)

    def style(self, vobj: Any) -> None:
        self.look.pointSize = max(1.0, vobj.PointSize)
        legend.renew_soon()

    def onChanged(self, vobj: Any, name: str) -> None:
        """Handle a changed view property."""
        super().onChanged(vobj, name)
        if name == "Visibility":
            legend.renew_soon()


def scale_of(value: Inspected) -> Scale:
    """Return the legend of an inspection: its bands, outermost first."""
    factor, unit = preferences.scale_of(value.tolerance, "mm")
    classes = tuple(
        (band.text, band.colour)
        for band in reversed(bands(float(f"{factor * value.tolerance:.3g}")))
    )
    if not value.counted.all():
        classes += ((marked("beyond the edges"), PAST_EDGES),)
    return Scale(
        marked("deviation"),
        unit,
        0.0,
        0.0,
        (),
        factor * value.spread.least,
        factor * value.spread.most,
        classes=classes,
    )
