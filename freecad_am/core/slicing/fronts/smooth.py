# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fronts on any wall whose local distance varies within a band, so that they have no corners.

`smooth_spacing` works on the parameters of a surface; this module works on the front. A rounded
copy of the exact front is the datum. Heights are measured from the datum, along the wall and across
the front. For each point, the heights at the exact distance and at the limits of the band are
computed. The smooth front has minimum bending between these limits. See `smoothest_heights`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.step_count import step_count
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...types import Array, Mask
from ..smoothest_heights import AIM, HEAVY, MARGIN, WEIGHTS, lightest, smooth_between
from ..wall_directions import turns_in_wall
from .curve import Slicing, fit_to_wall
from .rims import ON_RIM, local_distances, nearest_feet, resample, smooth_points, spline

PLACES = 8  # points per layer height along a front
MIN_POINTS = 48  # minimum number of points of a front
ROUND = 0.75  # in layer heights; standard deviation of the Gaussian mean that rounds the front
MAX_ROUNDING_SHARE = 1.0 / 16.0  # fraction of the front; maximum of this standard deviation
REACH = 1.5  # in maximum distances; maximum height of the exact front over the rounded front
STEPS = 40  # maximum number of Newton or bisection steps
TOLERANCE_SHARE = 1e-6  # fraction of the height; tolerance of distances
MAX_AHEAD = (
    0.4  # fraction of the distance to the next front of the layer; maximum advance of a front
)
FINER = 4  # points per arc at which the result is measured
ENDS = np.array([0, -1])
SPREAD = 4.0  # in layer heights; length over which the slide of an end is spread
SLIDES = (
    0.3  # minimum component of a rim across the front; on other rims the end of the front stays
)


class SmoothFront(NamedTuple):
    """Front with its maximum turn rate within the wall, rad/mm, and the index of its WEIGHTS entry."""

    curve: SpaceCurve
    turn: float
    weight: int


def turn(wall: PatchWall, curve: SpaceCurve) -> float:
    """Return the maximum turn rate of a front within the wall, rad/mm, with FINER points per arc."""
    w = curve.refined(FINER)
    points, slope, _ = curve.at(w)
    into, out = slope.copy(), slope.copy()
    into[::FINER], out[::FINER] = curve.into, curve.out
    if not curve.closed:
        into[0], out[-1] = out[0], into[-1]
    fine = SpaceCurve(w, points, into, out, curve.closed)
    return float(turns_in_wall(fine, wall.project(points)[1]).max())


def smooth_front(
    slicing: Slicing,
    below: list[SpaceCurve],
    front: SpaceCurve,
    other_fronts: list[SpaceCurve],
    weight: int = HEAVY,
) -> SmoothFront:
    """Smooth an exact front.

    The smooth front stays as close to the layer height as the turn rate limit `smoothing.limit`
    allows. Its ends move along their rims. If the band is too narrow for the limit, the front keeps
    the band.

    Parameters
    ----------
    slicing : Slicing
        Wall, rims, layer height and smoothing.
    below : list of SpaceCurve
        The fronts of the layer below.
    front : SpaceCurve
        The exact front.
    other_fronts : list of SpaceCurve
        Other fronts of the layer, from which the front keeps a distance.
    weight : int, optional
        Index of WEIGHTS at which the search starts, preferably that of the layer below.

    Returns
    -------
    SmoothFront
        The smooth front. The exact front if its turn rate is below the limit, or if no smooth front
        fits the band.
    """
    wall, height, smoothing = slicing.wall, slicing.height, slicing.smoothing
    unsmoothed = SmoothFront(front, turn(wall, front), weight)
    if smoothing is None or unsmoothed.turn <= AIM * smoothing.limit:
        return unsmoothed
    datum = _Datum.of(slicing, front)
    shares = np.array(
        [1.0, 1.0 - smoothing.band * (1.0 - MARGIN), 1.0 + smoothing.band * (1.0 - MARGIN)]
    )
    heights = datum.heights(below, height * shares)
    if heights is None:
        return unsmoothed
    target, low, high = heights
    if other_fronts:
        high = np.minimum(
            high,
            target
            + MAX_AHEAD
            * nearest_feet(other_fronts, datum.points + target[:, None] * datum.across).distance,
        )
    min_distance, max_distance = (1.0 - smoothing.band) * height, (1.0 + smoothing.band) * height

    def trial(index: int) -> SmoothFront | None:
        curve = datum.curve(datum.smooth(target, low, high, float(WEIGHTS[index])))
        distance = local_distances(curve, below, FINER)
        if distance.min() < min_distance or distance.max() > max_distance:
            return None
        return SmoothFront(
            curve, float(turns_in_wall(curve, wall.project(curve.points)[1]).max()), index
        )

    best = lightest(trial, min(weight, HEAVY), AIM * smoothing.limit)
    if best is None or best.turn >= unsmoothed.turn:
        return unsmoothed
    return best._replace(curve=fit_to_wall(wall, best.curve))


@dataclass(frozen=True, eq=False)
class _Datum:
    """Smooth line on a wall with rims.

    points: (n, 3), mm; a closed line does not repeat its first point. across: (n, 3) unit vectors
    in the wall, to the left of the line. bend: (n,) second differences of the points along these
    vectors. sliding: (2,) whether each end of an open line slides along a rim. `across` of a
    sliding end is along the rim, with a component of 1 to the left, and `across` of the
    neighbouring points is adapted gradually. Other ends stay.
    """

    slicing: Slicing
    points: Array
    across: Array
    bend: Array
    closed: bool
    sliding: Mask

    @classmethod
    def of(cls, slicing: Slicing, front: SpaceCurve) -> _Datum:
        """Build the datum: the rounded front with evenly spaced points."""
        height = slicing.height
        count = step_count(front.length * PLACES, height, MIN_POINTS)
        points = resample(front.at(front.refined(FINER))[0], front.closed, count)
        wide = min(ROUND * height / (front.length / count), MAX_ROUNDING_SHARE * count)
        points = resample(smooth_points(points, front.closed, wide), front.closed, count)
        points, normal = slicing.wall.project(points)
        if front.closed:
            previous_points, next_points = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
        else:
            previous_points = np.vstack([2.0 * points[:1] - points[1:2], points[:-1]])
            next_points = np.vstack([points[1:], 2.0 * points[-1:] - points[-2:-1]])
        across = np.cross(normal, next_points - previous_points)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        bend = dot(next_points - 2.0 * points + previous_points, across)
        sliding = np.zeros(2, dtype=bool)
        if not front.closed:
            distance, _, along = slicing.rims.nearest(points[ENDS])
            rate = dot(along, across[ENDS])
            sliding = (distance < ON_RIM) & (np.abs(rate) > SLIDES)
            length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
            share = np.linspace(0.0, length, len(points)) / min(SPREAD * height, 0.5 * length)
            for end, s in ((0, share), (1, share[::-1])):
                if sliding[end]:  # spread the slide of the end along the front over its neighbours
                    slide = along[end] / rate[end] - across[ENDS[end]]
                    across = across + np.maximum(1.0 - s, 0.0)[:, None] * slide
        return cls(slicing, points, across, bend, front.closed, sliding)

    def heights(self, below: list[SpaceCurve], distances: Array) -> Array | None:
        """Return the heights (k, n), mm, over the datum at distances (k,), mm, from the fronts below.

        Returns None if any height is not found.
        """
        targets = np.repeat(distances, len(self.points))
        start, across = (
            np.tile(column, (len(distances), 1)) for column in (self.points, self.across)
        )
        x = np.zeros(len(targets))
        farthest = REACH * distances.max()
        low, high = x - farthest, x + farthest
        todo = np.arange(len(targets))
        for _ in range(STEPS):
            foot = nearest_feet(
                below, self.slicing.wall.project(start[todo] + x[todo, None] * across[todo])[0]
            )
            off = foot.distance - targets[todo]
            above = off > 0.0
            high[todo[above]], low[todo[~above]] = x[todo[above]], x[todo[~above]]
            step = off / np.maximum(dot(foot.away, across[todo]), 0.2)
            new = x[todo] - step
            inside = (new > low[todo]) & (new < high[todo])
            moving = np.abs(off) > TOLERANCE_SHARE * targets[todo]
            x[todo] = np.where(
                moving, np.where(inside, new, 0.5 * (low[todo] + high[todo])), x[todo]
            )
            todo = todo[moving]
            if not len(todo):
                return np.asarray(x.reshape(len(distances), -1))
        return None

    def smooth(self, target: Array, low: Array, high: Array, weight: float) -> Array:
        """Return smooth heights (n,) over the datum between low and high."""
        if self.closed:
            return smooth_between(target, low, high, weight, self.bend)
        target, low, high = target.copy(), low.copy(), high.copy()
        for bound in (target, low, high):
            bound[ENDS[~self.sliding]] = 0.0
        return smooth_between(target, low, high, weight, self.bend[1:-1], False)

    def curve(self, x: Array) -> SpaceCurve:
        """Return the curve at heights (n,) over the datum."""
        points, normal = self.slicing.wall.project(self.points + x[:, None] * self.across)
        if self.closed:
            points, normal = (np.vstack([column, column[:1]]) for column in (points, normal))
        else:
            slid = (
                self.slicing.rims.nearest(points[ENDS])[1] if self.sliding.any() else points[ENDS]
            )
            points[ENDS] = np.where(self.sliding[:, None], slid, self.points[ENDS])
        w, slope = spline(points, self.closed)
        slope -= dot(slope, normal)[:, None] * normal
        return SpaceCurve(w, points, slope, slope, self.closed)
