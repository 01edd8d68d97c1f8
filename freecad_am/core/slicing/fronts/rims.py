# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where fronts end: the edges of a wall as exact curves, and the points on them at a distance from the fronts below."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.mesh.triangle_mesh import LevelLine
from ...geometry.walls.patch_wall import Rim
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask
from .even_line import spline
from .feet import feet, within

FINER = 2  # places per arc of a rim at which the distance from the fronts is taken
HALVINGS = 8  # of the stretches between them in which a rim may come and go
SLACK = 1.1
STEPS = 40
CONVERGED = 1e-11  # of the height
ON_RIM = 1e-4  # mm


class _Samples(NamedTuple):
    """Points (n, 3) all over the rims: rim (n,) and parameter w (n,), in order; tree of the points."""

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
        curves = []
        for rim in rims:
            w, slope = spline(rim.points, rim.closed)
            curves.append(SpaceCurve(w, rim.points, slope, slope, rim.closed))
        return cls(tuple(curves), tuple(rim.end for rim in rims))

    @cached_property
    def upper(self) -> Array:
        """Points (k, 3) along the edges at which layers finish."""
        return np.vstack(
            [np.empty((0, 3)), *(curve.points for curve, end in zip(self.curves, self.end) if end)]
        )

    def from_upper(self, points: Array) -> Array:
        """Distances (n,) mm of points (n, 3) from those along the edges at which layers finish; infinite without any."""
        return (
            np.asarray(self._upper_tree.query(points)[0])
            if len(self.upper)
            else np.full(len(points), np.inf)
        )

    @cached_property
    def _upper_tree(self) -> cKDTree:
        return cKDTree(self.upper)

    @cached_property
    def _samples(self) -> _Samples:
        refined = [curve.refined(FINER) for curve in self.curves]
        points = np.vstack([curve.at(w)[0] for curve, w in zip(self.curves, refined)])
        rim = np.repeat(np.arange(len(refined)), [len(w) for w in refined])
        return _Samples(points, rim, np.concatenate(refined), cKDTree(points))

    def reached(
        self, below: list[SpaceCurve], height: float, reach: float, tolerance: float
    ) -> Array:
        """Points (k, 3) on the rims at `height` mm from the fronts below.

        reach: mm from these fronts in which they are sought. Differences of the distance below `tolerance` mm count as
        above, so that a front may lie on a rim.
        """
        if not self.curves:
            return np.empty((0, 3))
        points, rim, w, tree = self._samples
        near = np.zeros(len(points), dtype=bool)
        near[within(tree, below, reach)] = True
        near[1:] |= near[:-1]
        at = np.flatnonzero(near)
        if not len(at):
            return np.empty((0, 3))
        off = feet(below, points[at]).distance - height + tolerance
        pair = np.flatnonzero((np.diff(at) == 1) & (np.diff(rim[at]) == 0))
        stretch = _Stretches(rim[at[pair]], w[at[pair]], w[at[pair + 1]], off[pair], off[pair + 1])
        found = []
        for _ in range(HALVINGS):
            crossed = (stretch.off_low > 0.0) != (stretch.off_high > 0.0)
            found.append(_Stretches(*(column[crossed] for column in stretch)))
            # a distance changes by no more than the way along the rim, whose parameter is about its length
            reserve = np.minimum(np.abs(stretch.off_low), np.abs(stretch.off_high)) < SLACK * (
                stretch.high - stretch.low
            )
            stretch = _Stretches(*(column[~crossed & reserve] for column in stretch))
            if not len(stretch.rim):
                break
            middle = 0.5 * (stretch.low + stretch.high)
            off = feet(below, self._at(stretch.rim, middle)[0]).distance - height + tolerance
            stretch = _Stretches(
                np.tile(stretch.rim, 2),
                np.r_[stretch.low, middle],
                np.r_[middle, stretch.high],
                np.r_[stretch.off_low, off],
                np.r_[off, stretch.off_high],
            )
        every = _Stretches(*(np.concatenate(columns) for columns in zip(*found)))
        return self._crossings(below, height, every.rim, every.low, every.high, every.off_low > 0.0)

    def _at(self, rim: Index, w: Array) -> tuple[Array, Array]:
        """Points and derivatives (n, 3) at the places (rim, w)."""
        points, slope = np.empty((len(w), 3)), np.empty((len(w), 3))
        for k in np.unique(rim):
            own = rim == k
            points[own], slope[own], _ = self.curves[k].at(w[own])
        return points, slope

    def _crossings(
        self,
        below: list[SpaceCurve],
        height: float,
        rim: Index,
        low: Array,
        high: Array,
        falls: Mask,
    ) -> Array:
        """Newton along the rims, kept between the last places known on either side of the height."""
        w = 0.5 * (low + high)
        if not len(w):
            return np.empty((0, 3))
        for _ in range(STEPS):
            points, slope = self._at(rim, w)
            foot = feet(below, points)
            off = foot.distance - height
            past = (off > 0.0) != falls
            low, high = np.where(past, low, w), np.where(past, w, high)
            rate = dot(foot.away, slope)
            new = w - off / np.where(np.abs(rate) > 1e-9, rate, np.inf)
            new = np.where((new <= low) | (new >= high), 0.5 * (low + high), new)
            if np.abs(off).max() < CONVERGED * height or (high - low).max() < CONVERGED * height:
                break
            w = new
        return points

    def nearest(self, points: Array) -> tuple[Array, Array, Array]:
        """Distance (n,) mm of points (n, 3) from the rims, nearest points (n, 3), unit vectors (n, 3) along the rim."""
        if not self.curves:
            return np.full(len(points), np.inf), points, np.zeros_like(points)
        foot = feet(list(self.curves), points)
        slope = self._at(foot.front, foot.w)[1]
        return foot.distance, foot.point, slope / np.linalg.norm(slope, axis=1, keepdims=True)

    def ends_of(self, front: SpaceCurve) -> bool:
        """Whether an open front is cut off: one of its ends lies where layers finish, and on no other rim."""
        if front.closed or not any(self.end):
            return False
        ends = front.points[[0, -1]]
        distance, end = (
            np.stack([curve.nearest(ends)[0] for curve in self.curves]),
            np.array(self.end),
        )
        elsewhere = distance[~end].min(axis=0, initial=np.inf) < ON_RIM
        return bool(((distance[end].min(axis=0) < ON_RIM) & ~elsewhere).any())


class Line(NamedTuple):
    """A level line of the mesh, see `geometry.mesh.triangle_mesh.LevelLine`. ends: (2, 3) where the front near it ends on
    rims, not a number where that is not known."""

    points: Array
    closed: bool
    rims: Array
    ends: Array


def cut_at_rims(lines: list[LevelLine], ends: Array, longest_edge: float) -> list[Line]:
    """The lines with their ends among the points (k, 3) where fronts meet rims.

    Between two further points that lie near a line the wall has a gap that the mesh is too coarse to show: the line is
    cut there. longest_edge: of the mesh, mm.
    """
    found, free = [], np.ones(len(ends), dtype=bool)
    for line in lines:
        own = np.full((2, 3), np.nan)
        if not line.closed and len(ends):
            distance = np.linalg.norm(line.points[[0, -1]][:, None] - ends[None], axis=-1)
            best = np.argmin(distance, axis=1)
            near = distance[[0, 1], best] < 2.0 * longest_edge
            if near.all() and best[0] == best[1]:  # one point is the end of one end
                near[np.argmax(distance[[0, 1], best])] = False
            own[near] = ends[best[near]]
            free[best[near]] = False
        found.append(Line(line.points, line.closed, line.rims, own))
    return [part for line in found for part in _parts(line, ends[free], longest_edge)]


def _parts(line: Line, ends: Array, longest_edge: float) -> list[Line]:
    if len(ends) < 2:
        return [line]
    distance, at = (np.asarray(column) for column in cKDTree(line.points).query(ends))
    order = np.argsort(at, kind="stable")
    order = order[distance[order] < longest_edge]
    if len(order) < 2:
        return [line]
    n, count = len(line.points), len(order) // 2
    if line.closed and _gaps(at[order], n) > _gaps(at[np.roll(order, -1)], n):
        order = np.roll(order, -1)
    leave, enter = order[0 : 2 * count : 2], order[1 : 2 * count : 2]
    if line.closed:
        parts = []
        for one, other in ((enter[i], leave[(i + 1) % count]) for i in range(count)):
            steps = (at[other] - at[one]) % n or n
            parts.append((line.points[(at[one] + np.arange(1, steps)) % n], ends[one], ends[other]))
    else:
        starts = [0, *(at[enter] + 1)]
        stops = [*at[leave], n]
        first_points, last_points = [line.ends[0], *ends[enter]], [*ends[leave], line.ends[1]]
        parts = [
            (line.points[i:k], *both)
            for i, k, *both in zip(starts, stops, first_points, last_points)
        ]
    found = []
    for inside, first_point, last_point in parts:
        both = np.stack([first_point, last_point])
        known = np.isfinite(both).all(axis=1)
        points = np.vstack([both[:1][known[:1]], inside, both[1:][known[1:]]])
        found.append(Line(points, False, line.rims, both))
    return found


def _gaps(at: Index, n: int) -> int:
    """Length of what a closed line loses between its first and second point, its third and fourth, and so on."""
    pairs = at[: len(at) // 2 * 2].reshape(-1, 2)
    return int(((pairs[:, 1] - pairs[:, 0]) % n).sum())
