# SPDX-License-Identifier: LGPL-2.1-or-later
"""A piece of a curved layer through a solid as a surface to fill."""

from __future__ import annotations

from dataclasses import dataclass

from ...types import Array
from ..curved.geodesic import GeodesicField
from .chart import Charted, Place

CHORD = 1.0  # steps of the grid between tests of an edge


@dataclass(frozen=True, eq=False)
class ChartLayer(Charted):
    """A layer on the chart of a piece, where the part was cut.

    distance: mm through the part to its beads. Its stretch is at most
    `geodesic.Piece.stretch`.
    """

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

    def in_part(self, location: Place) -> tuple[Array, Array]:
        """Map the chart onto the cut, and from there through the part to the position of the beads."""
        cut = self.chart.to_part(location)
        return self.field.onto(cut, self.distance), self.field.directions(cut)
