# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where fronts end: the edges of a wall as exact curves, and the places on them at a distance from the fronts below."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import LevelLine
from ...geometry.walls.patch_wall import Rim
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .curve import feet

FINER = 2  # places per arc of a rim at which the distance from the fronts is taken
HALVINGS = 8  # of the stretches between them in which a rim may come and go
SLACK = 1.1
STEPS = 40
CONVERGED = 1e-11  # of the height
ON_RIM = 1e-4  # mm


class _Samples(NamedTuple):
    """Places all over the rims: points (n, 3), rim (n,) and parameter w (n,), in order; tree of the points."""

    points: Array
    rim: Index
    w: Array
    tree: cKDTree


class _Stretches(NamedTuple):
    """Stretches (n,) of rims: from low to high, how far their ends lie above the distance asked for."""

    rim: Index
    low: Array
    high: Array
    off_low: Array
    off_high: Array


@dataclass(frozen=True)
class Rims:
    """curves: the edges of a wall. end: whether layers finish there."""

    curves: tuple[SpaceCurve, ...]
    end: tuple[bool, ...]

    @classmethod
    def of(cls, rims: tuple[Rim, ...]) -> Rims:
        """Smooth curves through the points of the rims."""
        return cls(tuple(_through(rim.points, rim.closed) for rim in rims), tuple(rim.end for rim in rims))

    @cached_property
    def _samples(self) -> _Samples:
        places = [curve.refined(FINER) for curve in self.curves]
        points = np.vstack([curve.at(w)[0] for curve, w in zip(self.curves, places)])
        rim = np.repeat(np.arange(len(places)), [len(w) for w in places])
        return _Samples(points, rim, np.concatenate(places), cKDTree(points))

    def reached(self, fronts: list[SpaceCurve], height: float, spots: Array, reach: float, same: float) -> Array:
        """Places (k, 3) on the rims at `height` mm from the fronts.

        spots: (m, 3) points among which every place within `reach` of the fronts has one nearer than that. Differences
        of the distance below `same` mm count as above, so that a front may lie on a rim.
        """
        if not self.curves:
            return np.empty((0, 3))
        points, rim, w, tree = self._samples
        near = np.zeros(len(points), dtype=bool)
        found: Any = tree.query_ball_point(spots, 1.3 * reach)
        near[np.fromiter(chain.from_iterable(found), dtype=np.intp)] = True
        near[1:] |= near[:-1]
        at = np.flatnonzero(near)
        if not len(at):
            return np.empty((0, 3))
        off = feet(fronts, points[at]).distance - height + same
        pair = np.flatnonzero((np.diff(at) == 1) & (np.diff(rim[at]) == 0))
        stretch = _Stretches(rim[at[pair]], w[at[pair]], w[at[pair + 1]], off[pair], off[pair + 1])
        found = []
        for _ in range(HALVINGS):
            crossed = (stretch.off_low > 0.0) != (stretch.off_high > 0.0)
            found.append(_Stretches(*(column[crossed] for column in stretch)))
            # a distance changes by no more than the way along the rim, whose parameter is about its length
            reserve = np.minimum(np.abs(stretch.off_low), np.abs(stretch.off_high)) < SLACK * (stretch.high - stretch.low)
            stretch = _Stretches(*(column[~crossed & reserve] for column in stretch))
            if not len(stretch.rim):
                break
            middle = 0.5 * (stretch.low + stretch.high)
            off = feet(fronts, self._at(stretch.rim, middle)[0]).distance - height + same
            stretch = _Stretches(
                np.tile(stretch.rim, 2), np.r_[stretch.low, middle], np.r_[middle, stretch.high],
                np.r_[stretch.off_low, off], np.r_[off, stretch.off_high],
            )
        every = _Stretches(*(np.concatenate(columns) for columns in zip(*found)))
        return self._crossings(fronts, height, every.rim, every.low, every.high, every.off_low > 0.0)

    def _at(self, rim: Index, w: Array) -> tuple[Array, Array]:
        """Points and derivatives (n, 3) at the places (rim, w)."""
        point, slope = np.empty((len(w), 3)), np.empty((len(w), 3))
        for k in np.unique(rim):
            mine = rim == k
            point[mine], slope[mine], _ = self.curves[k].at(w[mine])
        return point, slope

    def _crossings(
        self, fronts: list[SpaceCurve], height: float, rim: Index, low: Array, high: Array, falls: Mask
    ) -> Array:
        """Newton along the rims, kept between the last places known above and below."""
        at = 0.5 * (low + high)
        if not len(at):
            return np.empty((0, 3))
        for _ in range(STEPS):
            point, slope = self._at(rim, at)
            below = feet(fronts, point)
            off = below.distance - height
            upper = (off > 0.0) != falls
            low, high = np.where(upper, low, at), np.where(upper, at, high)
            rate = dot(below.away, slope)
            new = at - off / np.where(np.abs(rate) > 1e-9, rate, np.inf)
            new = np.where((new <= low) | (new >= high), 0.5 * (low + high), new)
            if np.abs(off).max() < CONVERGED * height or (high - low).max() < CONVERGED * height:
                break
            at = new
        return point

    def nearest(self, points: Array) -> tuple[Array, Array, Array]:
        """Distance (n,) mm of points (n, 3) from the rims, nearest places (n, 3), unit vectors (n, 3) along the rim."""
        if not self.curves:
            return np.full(len(points), np.inf), points, np.zeros_like(points)
        place = feet(list(self.curves), points)
        slope = self._at(place.front, place.w)[1]
        return place.distance, place.point, slope / np.linalg.norm(slope, axis=1, keepdims=True)

    def ends_of(self, front: SpaceCurve) -> bool:
        """Whether an open front is cut off: one of its ends lies where layers finish, and on no other rim."""
        if front.closed or not any(self.end):
            return False
        ends = front.points[[0, -1]]
        off = np.stack([curve.nearest(ends)[0] for curve in self.curves])
        final = np.array(self.end)
        aside = off[~final].min(axis=0, initial=np.inf) < ON_RIM
        return bool(((off[final].min(axis=0) < ON_RIM) & ~aside).any())


class Line(NamedTuple):
    """A level line of the mesh, see `geometry.mesh.triangle_mesh.LevelLine`. ends: (2, 3) where the front near it ends on
    rims, not a number where that is not known."""

    points: Array
    closed: bool
    rims: Array
    ends: Array


def cut_at_rims(lines: list[LevelLine], places: Array, far: float) -> list[Line]:
    """The lines with their ends among the places (k, 3) where fronts meet rims.

    Between two further places that lie near a line the wall has a gap that the mesh is too coarse to show: the line is
    cut there. far: length of the mesh's longest edge, mm.
    """
    found, free = [], np.ones(len(places), dtype=bool)
    for line in lines:
        ends = np.full((2, 3), np.nan)
        if not line.closed and len(places):
            distance = np.linalg.norm(line.points[[0, -1]][:, None] - places[None], axis=-1)
            best = np.argmin(distance, axis=1)
            near = distance[[0, 1], best] < 2.0 * far
            if near.all() and best[0] == best[1]:  # one place is the end of one end
                near[np.argmax(distance[[0, 1], best])] = False
            ends[near] = places[best[near]]
            free[best[near]] = False
        found.append(Line(line.points, line.closed, line.rims, ends))
    return [piece for line in found for piece in _pieces(line, places[free], far)]


def _pieces(line: Line, places: Array, far: float) -> list[Line]:
    if len(places) < 2:
        return [line]
    distance, at = (np.asarray(one) for one in cKDTree(line.points).query(places))
    order = np.argsort(at, kind="stable")
    order = order[distance[order] < far]
    if len(order) < 2:
        return [line]
    n, count = len(line.points), len(order) // 2
    if line.closed and _gaps(at[order], n) > _gaps(at[np.roll(order, -1)], n):
        order = np.roll(order, -1)
    leave, enter = order[0 : 2 * count : 2], order[1 : 2 * count : 2]
    pieces = []
    if line.closed:
        stretches = [(enter[i], leave[(i + 1) % count]) for i in range(count)]
        for one, other in stretches:
            steps = (at[other] - at[one]) % n or n
            inside = line.points[(at[one] + np.arange(1, steps)) % n]
            pieces.append((inside, places[one], places[other]))
    else:
        starts = [0, *(at[enter] + 1)]
        stops = [*at[leave], n]
        begins, ends = [line.ends[0], *places[enter]], [*places[leave], line.ends[1]]
        pieces = [(line.points[i:k], *both) for i, k, *both in zip(starts, stops, begins, ends)]
    found = []
    for inside, begin, end in pieces:
        both = np.stack([begin, end])
        known = np.isfinite(both).all(axis=1)
        points = np.vstack([both[:1][known[:1]], inside, both[1:][known[1:]]])
        found.append(Line(points, False, line.rims, both))
    return found


def _gaps(at: Index, n: int) -> int:
    """Length of what a closed line loses between its first and second place, its third and fourth, and so on."""
    pairs = at[: len(at) // 2 * 2].reshape(-1, 2)
    return int(((pairs[:, 1] - pairs[:, 0]) % n).sum())


def _through(points: Array, closed: bool) -> SpaceCurve:
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    slope = CubicSpline(w, points, bc_type="periodic" if closed else "not-a-knot")(w, 1)
    return SpaceCurve(w, points, slope, slope, closed)
