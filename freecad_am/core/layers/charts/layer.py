# SPDX-License-Identifier: LGPL-2.1-or-later
"""A piece of a curved layer through a solid as a surface to fill."""

from __future__ import annotations

from dataclasses import dataclass

from ...types import Array
from ..curved.geodesic import GeodesicField
from .chart import Place
from .charted import Charted

CHORD = 1.0  # steps of the grid; edges are looked at so often


@dataclass(frozen=True, eq=False)
class ChartLayer(Charted):
    """chart: of the piece, where the part was cut. distance: mm through the part at which its beads lie. It is stretched by
    no more than `geodesic.Piece.stretch`."""

    field: GeodesicField
    distance: float

    @property
    def look(self) -> float:
        """A step of the grid."""
        return CHORD * self.field.grid.step

    @property
    def bends_freely(self) -> bool:
        """It bends as ways through the part lead round corners."""
        return True

    def in_part(self, place: Place) -> tuple[Array, Array]:
        """Through the chart onto the cut, and along the way through the part to where beads lie."""
        cut = self.chart.at(place)
        return self.field.onto(cut, self.distance), self.field.directions(cut)
