# SPDX-License-Identifier: LGPL-2.1-or-later
"""A piece of a curved layer as a surface to fill: its picture has as little distortion as there can be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .chart import Chart
from .geodesic import GeodesicField
from .surface import Array, Index, Wrapped

STEEP = 0.9  # of 1; a normal nearer to X than that takes Y for what its first direction follows
CHORD = 1.0  # steps of the grid; edges are looked at so often


@dataclass(frozen=True, eq=False)
class ChartLayer:
    """chart: of the piece, where the part was cut. distance: mm through the part at which its beads lie. As
    `LayerSurface`; distances and angles in its picture are those in the part but for `geodesic.Piece.stretch`."""

    chart: Chart
    field: GeodesicField
    distance: float

    @property
    def alike(self) -> tuple[float, ...]:
        """Regions with the same borders are filled alike, whatever their charts."""
        return ()

    @property
    def period(self) -> None:
        """Nothing goes round it: what would is cut in pieces."""
        return None

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm, the nearest places of the chart."""
        return self.chart.flat[np.asarray(self.chart.mesh.tree.query(points)[1], dtype=np.intp)]

    def wrap(self, flat: Array) -> Wrapped:
        """Through the chart onto the cut, and along the way through the part to where beads lie."""
        place = self.chart.find(flat)
        cut = self.chart.at(place)
        normals = self.field.directions(cut)
        points = self.field.onto(cut, self.distance)
        first, second = self.axes(normals)
        x = self.chart.heading(place)
        return Wrapped(points, normals, -np.unwrap(np.arctan2((x * second).sum(axis=1), (x * first).sum(axis=1))))

    def heights(self, flat: Array) -> None:
        """The layer height everywhere."""

    def followed(self, flat: Array, sheet: float) -> ChartLayer:
        """The same: it does not lie on itself."""
        return self

    def turned(self, azimuth: float) -> float:
        """It lies one way alone."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """As many as what the edge bends by, looked at every step of the grid, asks for."""
        edge = np.diff(flat, axis=0)
        length = np.linalg.norm(edge, axis=1)
        looks = np.maximum(np.ceil(length / (CHORD * self.field.grid.step)), 2.0).astype(np.intp)
        of = np.repeat(np.arange(len(edge)), looks + 1)
        share = (np.arange(len(of)) - np.repeat(np.cumsum(looks + 1) - looks - 1, looks + 1)) / looks[of]
        points = self.field.onto(self.chart.wrap(flat[of] + share[:, None] * edge[of]), self.distance)
        inner = np.flatnonzero((of[1:-1] == of[:-2]) & (of[1:-1] == of[2:])) + 1
        bend = np.linalg.norm(points[inner - 1] - 2.0 * points[inner] + points[inner + 1], axis=1) / 8.0
        most = np.zeros(len(edge))
        np.maximum.at(most, of[inner], bend)
        count = np.maximum(np.ceil(looks * np.sqrt(most / chord_error) - 1e-9), 1.0)
        return np.asarray(count.astype(np.intp))

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """The part's X as it runs in the layer, its Y where the layer looks along X; and to the left of it."""
        along = np.where((np.abs(normals[:, 0]) < STEEP)[:, None], np.eye(3)[0], np.eye(3)[1])
        first = along - (along * normals).sum(axis=1)[:, None] * normals
        first /= np.linalg.norm(first, axis=1, keepdims=True)
        return first, np.cross(normals, first)
