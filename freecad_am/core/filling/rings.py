# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed curves by arc length, and the places where two of them run side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.plane_curve import arcs, nearest
from ..types import Array, Index

MARK = 0.25  # of the reach, distance between samples of a ring in the search for adjacent rings


class AdjacentRings(NamedTuple):
    """Two rings by number, and arcs (n,) mm of the first that are near the second."""

    from_ring: int
    to_ring: int
    arcs: Array


class Ring:
    """A closed curve (n, 2), and its occupied intervals of arc length, mm."""

    def __init__(self, points: Array) -> None:
        self.points = points
        self.arc = arcs(points, True)
        self.length = float(self.arc[-1])
        self._whole = np.vstack([points, points[:1]])
        self._taken: list[tuple[float, float]] = []

    def points_at(self, arcs: Array) -> Array:
        """Return the points at arc lengths.

        Parameters
        ----------
        arcs : (n,) array
            Arc lengths from the first point, mm, any number of times round.

        Returns
        -------
        (n, 2) array
            Points, mm.
        """
        arcs = np.remainder(arcs, self.length)
        return np.stack([np.interp(arcs, self.arc, self._whole[:, k]) for k in (0, 1)], axis=1)

    def way(self, arcs: Array, step: float) -> Array:
        """Return the directions of the ring at arc lengths.

        Parameters
        ----------
        arcs : (n,) array
            Arc lengths, mm.
        step : float
            Length of ring that a direction is the mean of, mm.

        Returns
        -------
        (n, 2) array
            Unit vectors along the ring.
        """
        ahead = self.points_at(arcs + 0.5 * step) - self.points_at(arcs - 0.5 * step)
        return np.asarray(ahead / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None])

    def foot(self, points: Array) -> tuple[Array, Array]:
        """Find the places of the ring nearest to points.

        Parameters
        ----------
        points : (n, 2) array
            Points, mm.

        Returns
        -------
        arcs : (n,) array
            Arc lengths of the nearest places, mm.
        distances : (n,) array
            Distances of the points from them, mm.
        """
        feet = nearest(self.points, points, closed=True)
        return self.arc[feet.edge] + feet.share * np.diff(self.arc)[feet.edge], feet.distance

    def piece(self, start: float, end: float, sense: int) -> Array:
        """Return the points of the ring from one arc length to another.

        Parameters
        ----------
        start, end : float
            Arc lengths, mm, any number of times round.
        sense : int
            1 with the ring, -1 against it.

        Returns
        -------
        (m, 2) array
            Points in the order of travel, both ends included, mm.
        """
        if sense < 0:
            return self.piece(end, start, 1)[::-1]
        span = (end - start) % self.length
        inner = np.remainder(self.arc[:-1] - start, self.length)
        order = np.argsort(inner, kind="stable")
        between = order[
            (inner[order] > 1e-9 * self.length) & (inner[order] < span - 1e-9 * self.length)
        ]
        return np.vstack(
            [
                self.points_at(np.array([start])),
                self.points[between],
                self.points_at(np.array([end])),
            ]
        )

    def is_free(self, start: float, end: float) -> bool:
        """Whether nothing of the arc from start to end is taken."""
        return not any(
            (low - start) % self.length < end - start or (start - low) % self.length < high - low
            for low, high in self._taken
        )

    def take(self, start: float, end: float) -> None:
        """Occupy the arc from start to end."""
        self._taken.append((start, end))


def side_by_side(rings: Sequence[Ring], reach: float) -> list[AdjacentRings]:
    """All pairs of rings that come nearer to each other than `reach` mm, both ways round."""
    marks = [np.arange(0.0, ring.length, MARK * reach) for ring in rings]
    points = np.vstack([ring.points_at(arcs) for ring, arcs in zip(rings, marks)])
    number: Index = np.repeat(np.arange(len(rings)), [len(arcs) for arcs in marks])
    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    pairs = pairs[number[pairs[:, 0]] != number[pairs[:, 1]]]
    pairs = np.vstack([pairs, pairs[:, ::-1]])
    key = np.unique(
        np.stack([number[pairs[:, 0]], number[pairs[:, 1]], pairs[:, 0]], axis=1), axis=0
    )
    all_arcs = np.concatenate(marks)
    cuts = np.flatnonzero((np.diff(key[:, :2], axis=0) != 0).any(axis=1)) + 1
    return [
        AdjacentRings(int(lot[0, 0]), int(lot[0, 1]), all_arcs[lot[:, 2]])
        for lot in np.split(key, cuts)
        if len(lot)
    ]


def crossed(line: Array, polyline: Array) -> bool:
    """Return whether a straight line crosses a polyline.

    Parameters
    ----------
    line : (2, 2) array
        Ends of the line, mm.
    polyline : (n, 2) array
        An open polyline, mm.

    Returns
    -------
    bool
        True if an edge crosses the line, its ends included.
    """
    direction = line[1] - line[0]
    side = direction[0] * (polyline[:, 1] - line[0, 1]) - direction[1] * (
        polyline[:, 0] - line[0, 0]
    )
    k = np.flatnonzero((side[:-1] > 0.0) != (side[1:] > 0.0))
    points = polyline[k] + (side[k] / (side[k] - side[k + 1]))[:, None] * (
        polyline[k + 1] - polyline[k]
    )
    share = (points - line[0]) @ direction / max(float(direction @ direction), 1e-300)
    return bool(((share >= 0.0) & (share <= 1.0)).any())
