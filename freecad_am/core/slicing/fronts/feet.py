# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nearest of all places on fronts, and what lies within a distance of them."""

from __future__ import annotations

from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.step_count import step_count
from ...types import Array, Index, Mask


class Feet(NamedTuple):
    """Of points (n, 3): distances (n,) mm to fronts, unit vectors away from the nearest points on them (n, 3), and where
    these lie: front (n,), parameter w (n,), point (n, 3)."""

    distance: Array
    away: Array
    front: Index
    w: Array
    point: Array

    @classmethod
    def between(cls, points: Array, foot: Array, front: Index, w: Array) -> Feet:
        """Of points (n, 3) with their nearest ones foot (n, 3) at the places (front, w)."""
        away = points - foot
        distance = np.linalg.norm(away, axis=1)
        return cls(distance, away / np.maximum(distance, 1e-300)[:, None], front, w, foot)

    def of(self, which: Mask | Index | slice) -> Feet:
        """Those of some of the points."""
        return Feet(
            self.distance[which],
            self.away[which],
            self.front[which],
            self.w[which],
            self.point[which],
        )


def feet(fronts: list[SpaceCurve], points: Array) -> Feet:
    """The nearest of all places on the fronts for each point (n, 3).

    A front is looked at for those points alone to which its box is nearer than any place found: where a layer is in many
    pieces, few of these come into question for a point.
    """
    low = np.stack([front.beyond_box(points) for front in fronts])
    front = np.argmin(low, axis=0)  # those that are likely
    distance, foot, w = np.empty(len(points)), np.empty((len(points), 3)), np.empty(len(points))
    for piece in np.unique(front):
        own = np.flatnonzero(front == piece)
        distance[own], foot[own], w[own] = fronts[piece].nearest(points[own])
    asked = low <= distance
    asked[front, np.arange(len(points))] = False
    for piece in np.flatnonzero(asked.any(axis=1)):
        some = np.flatnonzero(asked[piece] & (low[piece] <= distance))
        found = fronts[piece].nearest(points[some])
        # of places at the same distance that on the first front
        nearer = (found[0] < distance[some]) | (
            (found[0] == distance[some]) & (piece < front[some])
        )
        own = some[nearer]
        distance[own], foot[own], w[own] = (each[nearer] for each in found)
        front[own] = piece
    return Feet.between(points, foot, front, w)


def local_distances(front: SpaceCurve, below: list[SpaceCurve], finer: int = 1) -> Array:
    """Distance (n,) mm from a front to the nearest point of those below, at its nodes and `finer` - 1 places between."""
    return feet(below, front.at(front.refined(finer))[0]).distance


def within(tree: cKDTree, fronts: list[SpaceCurve], reach: float) -> Index:
    """The numbers (k,) of those of a tree's points that lie within `reach` mm of the fronts, and of some more."""
    samples = []
    for front in fronts:
        count = step_count(front.length, 0.5 * reach, 4)
        samples.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    found: Any = tree.query_ball_point(np.vstack(samples), 1.3 * reach)
    near: Index = np.unique(np.fromiter(chain.from_iterable(found), dtype=np.intp))
    return near
