# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath in the 3D view: beads coloured by layer or another quantity, optionally with build
directions.
"""

from __future__ import annotations

from typing import Any, ClassVar

from ...core.parameters.process import ProcessParameters
from ...core.parameters.strategy import SurfaceParameters
from ...core.types import Array
from ...objects.toolpath import features_of
from ..path.colouring import KINDS, Scale, coloured
from ..path.path_view import OPTIONS, PathView
from ..path.pieces import Rows


class ToolpathView(PathView):
    """Draws the beads from blue (minimum) to yellow (maximum); a single bead is coloured along its
    path.
    """

    icon = "toolpath"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "Colouring": (
            "App::PropertyEnumeration",
            KINDS,
            "Quantity shown by the colours of the beads.",
        ),
        **OPTIONS,
    }
    source_hidden = True

    def __init__(self, vobj: Any) -> None:
        super().__init__(vobj)
        self.source_hidden = False

    def rows_of(self, obj: Any, value: Any) -> Rows:
        entries = list(value)
        beads, layers = [bead for _, _, bead in entries], [layer for layer, _, _ in entries]
        return Rows.of(beads, layers, width_of(obj), lambda: value.layer_height)

    def draw(self, obj: Any, value: Any) -> None:
        super().draw(obj, value)
        if (
            not self.source_hidden
        ):  # a new path lies on the surface of its shape, and its start on the wall's surface
            self.source_hidden = True
            for feature in features_of(obj):
                for source in (feature.Source[0], *getattr(feature, "Further", ())):
                    source.ViewObject.Visibility = False
                if hasattr(feature, "Substrate"):
                    feature.ViewObject.Visibility = False
        _show_cell(obj)

    def updateData(self, obj: Any, name: str) -> None:
        """Handle a changed property of the object.

        Another cell may leave the toolpath unchanged, so it is drawn at the toolpath's location.
        """
        super().updateData(obj, name)
        if name == "Cell" and not obj.Document.Restoring:
            _show_cell(obj)

    def coloured(self, obj: Any, kind: str) -> tuple[Array, Scale]:
        return coloured(obj.Proxy.value(obj), kind, band_of(obj))

    def colours_depend_on(self, obj: Any) -> tuple[Any, ...]:
        return (band_of(obj),)


def _show_cell(obj: Any) -> None:
    """Draw the cell of a toolpath."""
    if obj.Cell is not None and getattr(obj.Cell.ViewObject, "Proxy", None):
        obj.Cell.ViewObject.Proxy.refresh()


def band_of(obj: Any) -> float:
    """Return the tolerance of the layer distance for a toolpath's feature, as a fraction of the
    layer height.
    """
    return float(getattr(obj.Feature, "Band", 100.0 * SurfaceParameters().band)) / 100.0


def width_of(obj: Any) -> float:
    """Return the width, mm, of a toolpath's beads without a width: the bead spacing, or the
    reported width.
    """
    spacing = getattr(obj.Feature, "BeadSpacing", None)
    return (
        float((obj.BeadWidth if spacing is None else spacing).Value)
        or ProcessParameters().bead_width
    )
