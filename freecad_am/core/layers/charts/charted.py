# SPDX-License-Identifier: LGPL-2.1-or-later
"""What layers on charts have in common: pictures on the plane with as little distortion as there can be."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...geometry.step_count import step_counts
from ...types import Array, Index
from ..surface import Wrapped
from .chart import Chart, Place

STEEP = 0.9  # of 1; a normal nearer to X than that takes Y for what its first direction follows

Same = TypeVar("Same", bound="Charted")


@dataclass(frozen=True, eq=False)
class Charted:
    """chart: of a piece of a layer. As `LayerSurface`; distances and angles in its picture are those in the part but for
    what it is stretched by."""

    chart: Chart

    @property
    @abstractmethod
    def look(self) -> float:
        """Mm of an edge after which it is looked at whether it bends."""

    @abstractmethod
    def in_part(self, place: Place) -> tuple[Array, Array]:
        """Where in the part (n, 3) beads lie at places of the chart, and the unit normals (n, 3) there."""

    @property
    def period(self) -> None:
        """Nothing goes round it: what would is cut in pieces."""
        return None

    @property
    def bends_freely(self) -> bool:
        """It bends as the faces do."""
        return False

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm, the nearest places of the chart."""
        return self.chart.flat[np.asarray(self.chart.mesh.tree.query(points)[1], dtype=np.intp)]

    def wrap(self, flat: Array) -> Wrapped:
        """Through the chart to where beads lie."""
        place = self.chart.find(flat)
        points, normals = self.in_part(place)
        first, second = self.axes(normals)
        x = self.chart.heading(place)
        return Wrapped(
            points,
            normals,
            -np.unwrap(np.arctan2((x * second).sum(axis=1), (x * first).sum(axis=1))),
        )

    def heights(self, flat: Array) -> None:
        """The layer height everywhere."""

    def followed(self: Same, flat: Array, sheet: float) -> Same:
        """The same: it does not lie on itself."""
        return self

    def turned(self, azimuth: float) -> float:
        """It lies one way alone."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """As many as what the edge bends by, looked at every so many mm, asks for."""
        edge = np.diff(flat, axis=0)
        length = np.linalg.norm(edge, axis=1)
        looks = step_counts(length, self.look, 2)
        of = np.repeat(np.arange(len(edge)), looks + 1)
        share = (
            np.arange(len(of)) - np.repeat(np.cumsum(looks + 1) - looks - 1, looks + 1)
        ) / looks[of]
        points = self.in_part(self.chart.find(flat[of] + share[:, None] * edge[of]))[0]
        inner = np.flatnonzero((of[1:-1] == of[:-2]) & (of[1:-1] == of[2:])) + 1
        bend = (
            np.linalg.norm(points[inner - 1] - 2.0 * points[inner] + points[inner + 1], axis=1)
            / 8.0
        )
        most = np.zeros(len(edge))
        np.maximum.at(most, of[inner], bend)
        count = np.maximum(np.ceil(looks * np.sqrt(most / chord_error) - 1e-9), 1.0)
        return np.asarray(count.astype(np.intp))

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """As `axes`."""
        return axes(normals)


def axes(normals: Array) -> tuple[Array, Array]:
    """The part's X (n, 3) as it runs where a layer has these unit normals (n, 3), its Y where it looks along X; and to the
    left of it."""
    steep: Array = np.abs(normals[:, :1]) < STEEP
    along = np.where(steep, np.eye(3)[0], np.eye(3)[1])
    first = along - (along * normals).sum(axis=1)[:, None] * normals
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(normals, first)
