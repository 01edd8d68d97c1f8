# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nearest of all places on fronts, and what lies within a distance of them."""

from __future__ import annotations

from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
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
        return Feet(self.distance[which], self.away[which], self.front[which], self.w[which], self.point[which])


def feet(fronts: list[SpaceCurve], points: Array) -> Feet:
    """The nearest of all places on the fronts for each point (n, 3)."""
    distance, foot, w = (np.stack(column) for column in zip(*(front.nearest(points) for front in fronts)))
    front, row = np.argmin(distance, axis=0), np.arange(len(points))
    return Feet.between(points, foot[front, row], front, w[front, row])


def local_distances(front: SpaceCurve, below: list[SpaceCurve], finer: int = 1) -> Array:
    """Distance (n,) mm from a front to the nearest point of those below, at its nodes and `finer` - 1 places between."""
    return feet(below, front.at(front.refined(finer))[0]).distance


def within(tree: cKDTree, fronts: list[SpaceCurve], reach: float) -> Index:
    """The numbers (k,) of those of a tree's points that lie within `reach` mm of the fronts, and of some more."""
    samples = []
    for front in fronts:
        count = max(4, int(np.ceil(front.length / (0.5 * reach))))
        samples.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    found: Any = tree.query_ball_point(np.vstack(samples), 1.3 * reach)
    near: Index = np.unique(np.fromiter(chain.from_iterable(found), dtype=np.intp))
    return near
