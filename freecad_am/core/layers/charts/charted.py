# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common base of layers on charts: pictures on the plane with minimal distortion."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...geometry.step_count import step_counts
from ...types import Array, Index
from ..surface import Wrapped
from .chart import Chart, Place

MIN_HORIZONTAL = (
    0.9  # of 1; a normal nearer to X than that takes Y for what its first direction follows
)

Same = TypeVar("Same", bound="Charted")


@dataclass(frozen=True, eq=False)
class Charted:
    """A layer on a chart of one of its pieces.

    As `LayerSurface`; distances and angles in its picture are those in the part, except for
    the stretch.
    """

    chart: Chart

    @property
    @abstractmethod
    def look(self) -> float:
        """Length of edge, mm, between tests for bending."""

    @abstractmethod
    def in_part(self, location: Place) -> tuple[Array, Array]:
        """Return the points (n, 3) in the part of beads at locations of the chart, and the unit
        normals (n, 3) there.
        """

    @property
    def period(self) -> None:
        """None: nothing goes around the layer; pieces that would are cut."""
        return None

    @property
    def bends_freely(self) -> bool:
        """It bends as the faces do."""
        return False

    def unroll(self, points: Array) -> Array:
        """(n, 2) mm, the nearest places of the chart."""
        return self.chart.flat[np.asarray(self.chart.mesh.tree.query(points)[1], dtype=np.intp)]

    def wrap(self, flat: Array) -> Wrapped:
        """Return a curve through the chart at the position of its beads."""
        location = self.chart.find(flat)
        points, normals = self.in_part(location)
        axis_x, axis_y = self.axes(normals)
        x = self.chart.heading(location)
        return Wrapped(
            points,
            normals,
            -np.unwrap(np.arctan2((x * axis_y).sum(axis=1), (x * axis_x).sum(axis=1))),
        )

    def heights(self, flat: Array) -> None:
        """The layer height everywhere."""

    def for_sheet(self: Same, flat: Array, sheet: float) -> Same:
        """Return the same surface: it does not overlap itself."""
        return self

    def plane_rotation(self, azimuth: float) -> float:
        """Return 0: the plane has only one orientation."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Return the number of pieces that the bend of each edge, sampled every `look` mm, requires."""
        edge = np.diff(flat, axis=0)
        length = np.linalg.norm(edge, axis=1)
        looks = step_counts(length, self.look, 2)
        edge_number = np.repeat(np.arange(len(edge)), looks + 1)
        share = (
            np.arange(len(edge_number)) - np.repeat(np.cumsum(looks + 1) - looks - 1, looks + 1)
        ) / looks[edge_number]
        points = self.in_part(
            self.chart.find(flat[edge_number] + share[:, None] * edge[edge_number])
        )[0]
        inner = (
            np.flatnonzero(
                (edge_number[1:-1] == edge_number[:-2]) & (edge_number[1:-1] == edge_number[2:])
            )
            + 1
        )
        bend = (
            np.linalg.norm(points[inner - 1] - 2.0 * points[inner] + points[inner + 1], axis=1)
            / 8.0
        )
        max_bend = np.zeros(len(edge))
        np.maximum.at(max_bend, edge_number[inner], bend)
        count = np.maximum(np.ceil(looks * np.sqrt(max_bend / chord_error) - 1e-9), 1.0)
        return np.asarray(count.astype(np.intp))

    def axes(self, normals: Array) -> tuple[Array, Array]:
        """As `axes`."""
        return axes(normals)


def axes(normals: Array) -> tuple[Array, Array]:
    """Return the part's X (n, 3) projected onto layers with unit normals (n, 3), and the
    direction to its left.

    Where a normal is along X, the part's Y replaces X.
    """
    steep: Array = np.abs(normals[:, :1]) < MIN_HORIZONTAL
    along = np.where(steep, np.eye(3)[0], np.eye(3)[1])
    axis_x = along - (along * normals).sum(axis=1)[:, None] * normals
    axis_x /= np.linalg.norm(axis_x, axis=1, keepdims=True)
    return axis_x, np.cross(normals, axis_x)
