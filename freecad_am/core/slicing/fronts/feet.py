# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nearest points on fronts, and points within a distance of fronts."""

from __future__ import annotations

from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.step_count import step_count
from ...types import Array, Index, Mask


class Feet(NamedTuple):
    """Nearest points on fronts for points (n, 3).

    Distances (n,) mm, unit vectors away from the nearest points (n, 3), and those: front
    (n,), parameter w (n,), point (n, 3).
    """

    distance: Array
    away: Array
    front: Index
    w: Array
    point: Array

    @classmethod
    def between(cls, points: Array, foot: Array, front: Index, w: Array) -> Feet:
        """Return the feet of points (n, 3), given the nearest points foot (n, 3) at (front, w)."""
        offset = points - foot
        distance = np.linalg.norm(offset, axis=1)
        return cls(distance, offset / np.maximum(distance, 1e-300)[:, None], front, w, foot)

    def select(self, rows: Mask | Index | slice) -> Feet:
        """Return the feet of selected points."""
        return Feet(
            self.distance[rows],
            self.away[rows],
            self.front[rows],
            self.w[rows],
            self.point[rows],
        )


def nearest_feet(fronts: list[SpaceCurve], points: Array) -> Feet:
    """Return the nearest point on any of the fronts for each point (n, 3).

    A front is searched only for points whose distance from its box is smaller than their best
    distance: with a layer in many pieces, few of them are candidates for a point.
    """
    low = np.stack([front.beyond_box(points) for front in fronts])
    front = np.argmin(low, axis=0)  # the likely fronts
    distance, foot, w = np.empty(len(points)), np.empty((len(points), 3)), np.empty(len(points))
    for front_number in np.unique(front):
        rows = np.flatnonzero(front == front_number)
        distance[rows], foot[rows], w[rows] = fronts[front_number].nearest(points[rows])
    may_be_nearer = low <= distance
    may_be_nearer[front, np.arange(len(points))] = False
    for front_number in np.flatnonzero(may_be_nearer.any(axis=1)):
        candidates = np.flatnonzero(may_be_nearer[front_number] & (low[front_number] <= distance))
        nearest = fronts[front_number].nearest(points[candidates])
        # at equal distances the first front counts
        nearer = (nearest[0] < distance[candidates]) | (
            (nearest[0] == distance[candidates]) & (front_number < front[candidates])
        )
        rows = candidates[nearer]
        distance[rows], foot[rows], w[rows] = (values[nearer] for values in nearest)
        front[rows] = front_number
    return Feet.between(points, foot, front, w)


def local_distances(front: SpaceCurve, below: list[SpaceCurve], finer: int = 1) -> Array:
    """Return the distances (n,) mm of a front from the fronts below, at its nodes and `finer` -
    1 points between.
    """
    return nearest_feet(below, front.at(front.refined(finer))[0]).distance


def points_near_fronts(tree: cKDTree, fronts: list[SpaceCurve], reach: float) -> Index:
    """Return the numbers (k,) of a tree's points within `reach` mm of the fronts, and a few
    more.
    """
    samples = []
    for front in fronts:
        count = step_count(front.length, 0.5 * reach, 4)
        samples.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    hits: Any = tree.query_ball_point(np.vstack(samples), 1.3 * reach)
    numbers: Index = np.unique(np.fromiter(chain.from_iterable(hits), dtype=np.intp))
    return numbers
