# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ends of fronts: edges of a wall as exact curves, and their points at a distance from fronts below."""

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
from ...geometry.step_count import step_count
from ...geometry.walls.patch_wall import Rim
from ...geometry.walls.surface import dot
from ...types import Array, Index, Mask


def resample(points: Array, closed: bool, count: int) -> Array:
    """Resample a polyline at equal arc lengths.

    Parameters
    ----------
    points : (n, 3) array
        The polyline, mm; a closed polyline may repeat its first point.
    closed : bool
        Whether the polyline is closed.
    count : int
        Number of segments.

    Returns
    -------
    (count, 3) or (count + 1, 3) array
        Points of a closed or an open polyline, mm; an open polyline includes both ends.
    """
    if closed and (points[0] != points[-1]).any():
        points = np.vstack([points, points[:1]])
    s = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    positions = np.linspace(0.0, s[-1], count + 1)
    resampled = np.column_stack([np.interp(positions, s, column) for column in points.T])
    return resampled[:-1] if closed else resampled


def smooth_points(points: Array, closed: bool, wide: float) -> Array:
    """Smooth a polyline with a Gaussian moving average.

    Parameters
    ----------
    points : (n, 3) array
        The points; a closed line does not repeat its first point.
    closed : bool
        Whether the line is closed; the ends of an open line stay.
    wide : float
        Standard deviation, in points.

    Returns
    -------
    (n, 3) array
        The smooth points.
    """
    reach = min(int(np.ceil(3.0 * wide)), len(points) - 1)
    share = np.exp(-0.5 * (np.arange(-reach, reach + 1) / max(wide, 1e-9)) ** 2)
    share /= share.sum()
    if closed:
        padded = np.vstack([points[-reach:], points, points[:reach]]) if reach else points
    else:
        start, end = points[:1], points[-1:]
        padded = np.vstack(
            [2.0 * start - points[reach:0:-1], points, 2.0 * end - points[-2 : -reach - 2 : -1]]
        )
    return np.column_stack([np.convolve(column, share, mode="valid") for column in padded.T])


def spline(points: Array, closed: bool) -> tuple[Array, Array]:
    """Interpolate a cubic spline through points.

    Parameters
    ----------
    points : (n, 3) array
        The points, mm; a closed line repeats its first point.
    closed : bool
        Whether the curve is periodic.

    Returns
    -------
    w : (n,) array
        Parameters: length along the polyline, mm.
    slope : (n, 3) array
        Derivatives with respect to w.
    """
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return w, CubicSpline(w, points, bc_type="periodic" if closed else "not-a-knot")(w, 1)


class Feet(NamedTuple):
    """Nearest points on fronts for points (n, 3).

    distance: (n,), mm. away: (n, 3) unit vectors away from the nearest points. front: (n,) front of
    each nearest point. w: (n,) parameters on the front. point: (n, 3) nearest points, mm.
    """

    distance: Array
    away: Array
    front: Index
    w: Array
    point: Array

    @classmethod
    def between(cls, points: Array, foot: Array, front: Index, w: Array) -> Feet:
        """Build the feet of points from known nearest points.

        Parameters
        ----------
        points : (n, 3) array
            The points, mm.
        foot : (n, 3) array
            The nearest points on the fronts, mm.
        front : (n,) int array
            The front of each nearest point.
        w : (n,) array
            Parameter of each nearest point.

        Returns
        -------
        Feet
            Distances and directions.
        """
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
    """Find the nearest point on any front for each point.

    A front is searched only for points that are closer to its bounding box than to the best front
    so far. In a layer with many pieces, few fronts are candidates for a point.

    Parameters
    ----------
    fronts : list of SpaceCurve
        The fronts.
    points : (n, 3) array
        Points, mm, in the frame of the fronts.

    Returns
    -------
    Feet
        The feet; at equal distances on the first front.
    """
    low = np.stack([front.beyond_box(points) for front in fronts])
    front = np.argmin(low, axis=0)  # most likely front of each point
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
    """Return the distances of a front from the fronts below.

    Parameters
    ----------
    front : SpaceCurve
        The front.
    below : list of SpaceCurve
        The fronts of the layer below.
    finer : int, optional
        Number of points per arc; 1: nodes only.

    Returns
    -------
    (n,) array
        Distances, mm.
    """
    return nearest_feet(below, front.at(front.refined(finer))[0]).distance


def points_near_fronts(tree: cKDTree, fronts: list[SpaceCurve], reach: float) -> Index:
    """Return the points of a tree within a distance of fronts, and a few points beyond.

    Parameters
    ----------
    tree : cKDTree
        The points.
    fronts : list of SpaceCurve
        The fronts.
    reach : float
        Distance from the fronts, mm.

    Returns
    -------
    (k,) int array
        Indices of the points, ascending.
    """
    samples = []
    for front in fronts:
        count = step_count(front.length, 0.5 * reach, 4)
        samples.append(front.at(np.linspace(front.w[0], front.w[-1], 2 * count))[0])
    hits: Any = tree.query_ball_point(np.vstack(samples), 1.3 * reach)
    numbers: Index = np.unique(np.fromiter(chain.from_iterable(hits), dtype=np.intp))
    return numbers


FINER = 2  # points per arc of a rim at which the distance from the fronts is measured
HALVINGS = 8  # maximum halvings of a stretch in which a rim may cross the distance twice
MAX_CHANGE_RATIO = 1.1  # maximum change of the distance per parameter along a rim
STEPS = 40  # maximum number of Newton or bisection steps
CONVERGED = 1e-11  # in layer heights; convergence tolerance
ON_RIM = 1e-4  # mm; maximum distance of a point on a rim


class _Samples(NamedTuple):
    """Ordered samples of all rims.

    points: (n, 3), mm. rim: (n,) rim indices. w: (n,) parameters. tree: search tree of the points.
    """

    points: Array
    rim: Index
    w: Array
    tree: cKDTree


class _Stretches(NamedTuple):
    """Stretches (n,) of rims.

    rim: rim indices. low, high: parameters of the ends. off_low, off_high: distance of the ends
    from the fronts minus the required distance, mm.
    """

    rim: Index
    low: Array
    high: Array
    off_low: Array
    off_high: Array


@dataclass(frozen=True)
class Rims:
    """Edges of a wall.

    curves: the edges. end: whether layers finish at each edge.
    """

    curves: tuple[SpaceCurve, ...]
    end: tuple[bool, ...]

    @classmethod
    def of(cls, rims: tuple[Rim, ...]) -> Rims:
        """Build the rims from splines through their points."""
        curves = []
        for rim in rims:
            w, slope = spline(rim.points, rim.closed)
            curves.append(SpaceCurve(w, rim.points, slope, slope, rim.closed))
        return cls(tuple(curves), tuple(rim.end for rim in rims))

    @cached_property
    def upper(self) -> Array:
        """Return the points along the edges at which layers finish.

        Returns
        -------
        (k, 3) array
            mm.
        """
        return np.vstack(
            [np.empty((0, 3)), *(curve.points for curve, end in zip(self.curves, self.end) if end)]
        )

    def from_upper(self, points: Array) -> Array:
        """Return the distances of points from the edges at which layers finish.

        Parameters
        ----------
        points : (n, 3) array
            The points, mm.

        Returns
        -------
        (n,) array
            Distances, mm; infinite without such edges.
        """
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

    def points_at_height(
        self, below: list[SpaceCurve], height: float, reach: float, tolerance: float
    ) -> Array:
        """Return the points on the rims at a height from the fronts below.

        Parameters
        ----------
        below : list of SpaceCurve
            The fronts of the layer below.
        height : float
            Distance from these fronts, mm.
        reach : float
            Search distance from these fronts, mm.
        tolerance : float
            Points lower by at most this count as above, mm, so that a front may run along a rim.

        Returns
        -------
        (k, 3) array
            The points, mm.
        """
        if not self.curves:
            return np.empty((0, 3))
        points, rim, w, tree = self._samples
        is_near = np.zeros(len(points), dtype=bool)
        is_near[points_near_fronts(tree, below, reach)] = True
        is_near[1:] |= is_near[:-1]
        sample = np.flatnonzero(is_near)
        if not len(sample):
            return np.empty((0, 3))
        off = nearest_feet(below, points[sample]).distance - height + tolerance
        pair = np.flatnonzero((np.diff(sample) == 1) & (np.diff(rim[sample]) == 0))
        stretch = _Stretches(
            rim[sample[pair]], w[sample[pair]], w[sample[pair + 1]], off[pair], off[pair + 1]
        )
        blocks = []
        for _ in range(HALVINGS):
            crossed = (stretch.off_low > 0.0) != (stretch.off_high > 0.0)
            blocks.append(_Stretches(*(column[crossed] for column in stretch)))
            # a distance changes by at most the length along the rim, which the parameter
            # approximates
            reserve = np.minimum(
                np.abs(stretch.off_low), np.abs(stretch.off_high)
            ) < MAX_CHANGE_RATIO * (stretch.high - stretch.low)
            stretch = _Stretches(*(column[~crossed & reserve] for column in stretch))
            if not len(stretch.rim):
                break
            middle = 0.5 * (stretch.low + stretch.high)
            off = (
                nearest_feet(below, self._evaluate(stretch.rim, middle)[0]).distance
                - height
                + tolerance
            )
            stretch = _Stretches(
                np.tile(stretch.rim, 2),
                np.r_[stretch.low, middle],
                np.r_[middle, stretch.high],
                np.r_[stretch.off_low, off],
                np.r_[off, stretch.off_high],
            )
        crossings = _Stretches(*(np.concatenate(columns) for columns in zip(*blocks)))
        return self._crossings(
            below, height, crossings.rim, crossings.low, crossings.high, crossings.off_low > 0.0
        )

    def _evaluate(self, rim: Index, w: Array) -> tuple[Array, Array]:
        """Return points and derivatives (n, 3) at the positions (rim, w)."""
        points, slope = np.empty((len(w), 3)), np.empty((len(w), 3))
        for k in np.unique(rim):
            on_rim = rim == k
            points[on_rim], slope[on_rim], _ = self.curves[k].at(w[on_rim])
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
        """Solve for the crossings by Newton's method along the rims, bracketed by low and high.

        falls: (n,) whether the distance falls from low to high.
        """
        w = 0.5 * (low + high)
        if not len(w):
            return np.empty((0, 3))
        for _ in range(STEPS):
            points, slope = self._evaluate(rim, w)
            foot = nearest_feet(below, points)
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
        """Return the nearest points on the rims.

        Parameters
        ----------
        points : (n, 3) array
            The points, mm.

        Returns
        -------
        distance : (n,) array
            Distances, mm; infinite without rims.
        nearest : (n, 3) array
            Nearest points, mm.
        along : (n, 3) array
            Unit vectors along the rims at the nearest points.
        """
        if not self.curves:
            return np.full(len(points), np.inf), points, np.zeros_like(points)
        foot = nearest_feet(list(self.curves), points)
        slope = self._evaluate(foot.front, foot.w)[1]
        return foot.distance, foot.point, slope / np.linalg.norm(slope, axis=1, keepdims=True)

    def ends_of(self, front: SpaceCurve) -> bool:
        """Whether an open front has an end on a rim where layers finish, and on no other rim."""
        if front.closed or not any(self.end):
            return False
        ends = front.points[[0, -1]]
        distance = np.full((len(self.curves), 2), np.inf)
        for k, curve in enumerate(self.curves):
            if (curve.beyond_box(ends) < ON_RIM).any():
                distance[k] = curve.nearest(ends)[0]
        end = np.array(self.end)
        elsewhere = distance[~end].min(axis=0, initial=np.inf) < ON_RIM
        return bool(((distance[end].min(axis=0) < ON_RIM) & ~elsewhere).any())


class Line(NamedTuple):
    """Level line of the mesh, see `geometry.mesh.triangle_mesh.LevelLine`.

    ends: (2, 3) ends of the nearby front on rims, mm; NaN where unknown.
    """

    points: Array
    closed: bool
    rims: Array
    ends: Array


def cut_at_rims(lines: list[LevelLine], ends: Array, longest_edge: float) -> list[Line]:
    """Assign points where fronts meet rims to the ends of lines, and cut lines at gaps of the wall.

    Two remaining points near a line mark a gap in the wall that the coarse mesh misses. The line is
    cut there.

    Parameters
    ----------
    lines : list of LevelLine
        Level lines of the mesh.
    ends : (k, 3) array
        Points where fronts meet rims, mm.
    longest_edge : float
        Maximum edge length of the mesh, mm.

    Returns
    -------
    list of Line
        The lines and pieces of lines.
    """
    ended_lines, free = [], np.ones(len(ends), dtype=bool)
    for line in lines:
        line_ends = np.full((2, 3), np.nan)
        if not line.closed and len(ends):
            distance = np.linalg.norm(line.points[[0, -1]][:, None] - ends[None], axis=-1)
            best = np.argmin(distance, axis=1)
            is_near = distance[[0, 1], best] < 2.0 * longest_edge
            if is_near.all() and best[0] == best[1]:  # one point belongs to one end only
                is_near[np.argmax(distance[[0, 1], best])] = False
            line_ends[is_near] = ends[best[is_near]]
            free[best[is_near]] = False
        ended_lines.append(Line(line.points, line.closed, line.rims, line_ends))
    return [
        piece_line
        for line in ended_lines
        for piece_line in _split_line(line, ends[free], longest_edge)
    ]


def _split_line(line: Line, ends: Array, longest_edge: float) -> list[Line]:
    if len(ends) < 2:
        return [line]
    distance, position = (np.asarray(column) for column in cKDTree(line.points).query(ends))
    order = np.argsort(position, kind="stable")
    order = order[distance[order] < longest_edge]
    if len(order) < 2:
        return [line]
    n, count = len(line.points), len(order) // 2
    if line.closed and _total_gap(position[order], n) > _total_gap(position[np.roll(order, -1)], n):
        order = np.roll(order, -1)
    leave, enter = order[0 : 2 * count : 2], order[1 : 2 * count : 2]
    if line.closed:
        stretches = []
        for entry, exit_ in ((enter[i], leave[(i + 1) % count]) for i in range(count)):
            steps = (position[exit_] - position[entry]) % n or n
            stretches.append(
                (line.points[(position[entry] + np.arange(1, steps)) % n], ends[entry], ends[exit_])
            )
    else:
        starts = [0, *(position[enter] + 1)]
        stops = [*position[leave], n]
        first_points, last_points = [line.ends[0], *ends[enter]], [*ends[leave], line.ends[1]]
        stretches = [
            (line.points[i:k], *end_points)
            for i, k, *end_points in zip(starts, stops, first_points, last_points)
        ]
    lines = []
    for inside, first_point, last_point in stretches:
        end_points = np.stack([first_point, last_point])
        is_known = np.isfinite(end_points).all(axis=1)
        points = np.vstack([end_points[:1][is_known[:1]], inside, end_points[1:][is_known[1:]]])
        lines.append(Line(points, False, line.rims, end_points))
    return lines


def _total_gap(positions: Index, n: int) -> int:
    """Return the total number of points in the gaps of a closed line of n points.

    A gap is between the first and second position, the third and fourth, and so on.
    """
    pairs = positions[: len(positions) // 2 * 2].reshape(-1, 2)
    return int(((pairs[:, 1] - pairs[:, 0]) % n).sum())
