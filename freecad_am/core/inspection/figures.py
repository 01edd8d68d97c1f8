# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of deviations: their spread, sphericity, roundness, circularity at heights, thickness
(Chalvin 2020, table 2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, linprog
from scipy.spatial import cKDTree

from ..geometry.curves.profile import Meridian
from ..issues import InputError, Text, Word
from ..types import Array, Integers, Mask
from .planned import Planned

ROUNDS = 60
MIN_EXTENT_RATIO = 1e-6  # of the largest extent; collinear or coplanar points have no centre
STILL = 1e-13  # of the radius


@dataclass(frozen=True, eq=False)
class Round:
    """A circle (two coordinates) or sphere (three) fitted to points.

    centre: (d,) mm. radius: mm. inner, outer: mm, the smallest and largest distance of a point from the centre.
    """

    centre: Array
    radius: float
    inner: float
    outer: float

    @property
    def zone(self) -> float:
        """Width of the zone that holds all points, mm."""
        return self.outer - self.inner


def least_squares_round(points: Array, where: str) -> Round:
    """Fit the circle or sphere with the least sum of squared distances.

    Parameters
    ----------
    points : (n, d) array
        Points, mm; d is 2 for a circle and 3 for a sphere.
    where : str
        Name for messages.

    Returns
    -------
    Round
        In the frame of the points.

    Raises
    ------
    InputError
        TOO_FEW_POINTS or FLAT_POINTS if none exists.
    """
    start, scale = _algebraic(points, where)

    def residuals(unknown: Array) -> Array:
        return np.asarray(np.linalg.norm(points - unknown[:-1], axis=1) - unknown[-1])

    def slopes(unknown: Array) -> Array:
        offsets = points - unknown[:-1]
        return np.column_stack([-_unit(offsets), np.full(len(points), -1.0)])

    solution = least_squares(
        residuals, start, slopes, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15, x_scale=scale
    ).x
    return _round(points, solution[:-1], float(solution[-1]))


def narrowest(points: Array, where: str) -> Round:
    """Find the centre about which the zone of points is narrowest.

    Found from the least-squares centre by linear programs for the change of the centre, each within
    a box about the last centre that shrinks when the zone does not (Chebyshev approximation by
    trust region); the narrowest zone near it, which is the global one for points all round.

    Parameters
    ----------
    points : (n, d) array
        Points, mm; d is 2 or 3.
    where : str
        Name for messages.

    Returns
    -------
    Round
        Its radius is the middle of the zone.

    Raises
    ------
    InputError
        TOO_FEW_POINTS or FLAT_POINTS if no circle or sphere exists.
    """
    best = least_squares_round(points, where)
    reach = max(best.zone, STILL * best.radius)
    dimension = points.shape[1]
    for _ in range(ROUNDS):
        offsets = points - best.centre
        distance, slope = np.linalg.norm(offsets, axis=1), -_unit(offsets)
        # unknown: change of the centre, inner and outer radius; inner <= distance + slope . change <= outer
        none, ones = np.zeros((len(points), 1)), np.ones((len(points), 1))
        rows = np.block([[-slope, ones, none], [slope, none, -ones]])
        limits = np.concatenate([distance, -distance])
        cost = np.concatenate([np.zeros(dimension), [-1.0, 1.0]])
        bounds = [(-reach, reach)] * dimension + [(None, None)] * 2
        step = linprog(cost, A_ub=rows, b_ub=limits, bounds=bounds, method="highs")
        if step.status != 0 or step.x is None:
            break
        trial = _round(points, best.centre + step.x[:dimension], 0.0)
        promised = best.zone - (step.x[-1] - step.x[-2])
        if trial.zone < best.zone:
            best = trial
        else:
            reach *= 0.25
        if reach <= STILL * best.outer or promised <= STILL * best.outer:
            break
    return Round(best.centre, 0.5 * (best.inner + best.outer), best.inner, best.outer)


def _unit(offsets: Array) -> Array:
    """Unit vectors; zero for a point at the centre, which may move anywhere."""
    return np.asarray(
        offsets / np.maximum(np.linalg.norm(offsets, axis=1, keepdims=True), np.finfo(float).tiny)
    )


def _round(points: Array, centre: Array, radius: float) -> Round:
    distance = np.linalg.norm(points - centre, axis=1)
    return Round(centre, radius, float(distance.min()), float(distance.max()))


def _algebraic(points: Array, where: str) -> tuple[Array, float]:
    """Centre and radius (d + 1,) from the linear equations of the circle or sphere, and the extent of the points."""
    dimension = points.shape[1]
    name = "circle" if dimension == 2 else "sphere"
    if len(points) < dimension + 1:
        raise InputError(
            "TOO_FEW_POINTS",
            where,
            "{} points do not define a {}; measure at least {}",
            len(points),
            Word(name),
            dimension + 1,
        )
    middle = points.mean(axis=0)
    local = points - middle
    spread = np.linalg.svd(local, compute_uv=False)
    if spread[-1] <= MIN_EXTENT_RATIO * spread[0]:
        shape = "line" if dimension == 2 else "plane"
        raise InputError(
            "FLAT_POINTS",
            where,
            "all points are in one {}, and no {} fits; measure over a wider arc",
            Word(shape),
            Word(name),
        )
    system = np.column_stack([2.0 * local, np.ones(len(points))])
    solved = np.linalg.lstsq(system, (local**2).sum(axis=1), rcond=None)[0]
    centre, constant = solved[:-1], solved[-1]
    radius = np.sqrt(constant + centre @ centre)
    return np.concatenate([centre + middle, [radius]]), float(np.ptp(points, axis=0).max())


BARS = 40  # of a histogram at most
ZONE_SIZE = 600  # points from each end and from all over that a narrowest zone is begun with
ROUND = 1e-3  # of the radius: a planned zone within this is a sphere
MIN_RADIAL_NORMAL = 0.1  # of a normal along the radius: a flatter surface has no circle at a height
ALL_ROUND = 0.25  # turns between neighbours on a circle beyond which it is not measured all round


@dataclass(frozen=True, eq=False)
class Spread:
    """The deviations that count: number, mean, standard deviation, root mean square, extremes, and the 95 % quantile of their
    amounts, mm; the share within tolerance. edges: (k + 1,) mm of the bars of a histogram with counts (k,).
    """

    count: int
    mean: float
    deviation: float
    rms: float
    least: float
    most: float
    within_95: float
    within: float
    edges: Array
    counts: Integers


@dataclass(frozen=True)
class Circle:
    """Circularity of count points at a height, mm: the least-squares circle and the narrowest zone in the plane there, relative to
    the part's axis. gap: the largest angle between neighbours, rad.
    """

    height: float
    count: int
    fitted: Round
    zone: Round
    gap: float

    @property
    def eccentricity(self) -> float:
        """Distance of the fitted circle's centre from the axis, mm."""
        return float(np.hypot(*self.fitted.centre))


@dataclass(frozen=True)
class Ball:
    """The least-squares and minimum-zone spheres, with centres in part coordinates. planned:
    planned radius, mm.
    """

    count: int
    fitted: Round
    zone: Round
    planned: float


@dataclass(frozen=True)
class Thickness:
    """A wall measured on both sides, at count pairs of points, mm."""

    count: int
    mean: float
    deviation: float
    least: float
    most: float


def summarise(deviation: Array, tolerance: float) -> Spread:
    """Return the figures of deviations.

    Parameters
    ----------
    deviation : (n,) array
        mm, n >= 1.
    tolerance : float
        mm.

    Returns
    -------
    Spread
        Figures and histogram.
    """
    low, high = float(deviation.min()), float(deviation.max())
    step = _nice(
        max(high - low, 1e-9, 1e-12 * max(-low, high)) / BARS
    )  # so that its multiples are apart
    first_bar, last_bar = np.floor(low / step), max(np.floor(low / step) + 1, np.ceil(high / step))
    edges = step * np.arange(first_bar, last_bar + 1)
    edges[0], edges[-1] = min(edges[0], low), max(edges[-1], high)
    amount = np.abs(deviation)
    return Spread(
        len(deviation),
        float(deviation.mean()),
        float(deviation.std()),
        float(np.sqrt((deviation**2).mean())),
        low,
        high,
        float(np.quantile(amount, 0.95)),
        float((amount <= tolerance).mean()),
        edges,
        np.histogram(deviation, edges)[0].astype(np.int64),
    )


def ball(points: Array, feet: Array, where: str) -> Ball | None:
    """Return the sphericity of points.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    feet : (n, 3) array
        Their feet on the planned surface, mm.
    where : str
        Name of the points, for messages.

    Returns
    -------
    Ball or None
        None if the feet are not on a sphere.

    References
    ----------
    Chalvin 2020, table 2.
    """
    try:
        planned = least_squares_round(feet, where)
        if planned.zone > ROUND * planned.radius:
            return None
        return Ball(
            len(points), least_squares_round(points, where), zone_of(points, where), planned.radius
        )
    except InputError:  # too few, or in a plane
        return None


def circle(
    planned: Planned, points: Array, normal: Array, height: float, band: float, where: str
) -> Circle:
    """Return the circularity of points at a height.

    Points in the band are moved to the height by the change of the planned radius, along the
    meridian of a part of revolution, else along the slope of the planned surface, so that a
    point at the height does not move.

    Parameters
    ----------
    planned : Planned
        The surface with its frame.
    points : (n, 3) array
        Measured points, mm.
    normal : (n, 3) array
        Planned normals there.
    height : float
        Height above the base, mm.
    band : float
        Half width of the band, mm.
    where : str
        Name of the points, for messages.

    Returns
    -------
    Circle
        The fitted circle and the narrowest zone.

    Raises
    ------
    InputError
        FEW_POINTS for fewer than four points in the band.

    References
    ----------
    Chalvin 2020, table 2.
    """
    local = (points - planned.frame[:3, 3]) @ planned.frame[:3, :3]
    in_band = np.abs(local[:, 2] - height) <= band
    local, side = local[in_band], normal[in_band] @ planned.frame[:3, :3]
    radius = np.hypot(local[:, 0], local[:, 1])
    if planned.wall is not None:
        grown = _radius_change(planned.wall.meridian, local[:, 2], radius, height)
    else:
        outward = (local[:, :2] * side[:, :2]).sum(axis=1) / np.maximum(radius, 1e-9)
        slope = np.where(
            np.abs(outward) > MIN_RADIAL_NORMAL,
            -side[:, 2] / np.where(np.abs(outward) > MIN_RADIAL_NORMAL, outward, 1.0),
            0.0,
        )
        grown = slope * (height - local[:, 2])
    slid = local[:, :2] * (1.0 + grown / np.maximum(radius, 1e-9))[:, None]
    if len(slid) < 4:
        raise InputError(
            "FEW_POINTS",
            where,
            "only {} points are within {:g} mm of the height {:g} mm; measure more points there, "
            "choose other heights, or a wider band",
            len(slid),
            band,
            height,
        )
    angle = np.sort(np.arctan2(slid[:, 1], slid[:, 0]))
    gap = float(np.diff(angle, append=angle[0] + 2.0 * np.pi).max())
    return Circle(height, len(slid), least_squares_round(slid, where), zone_of(slid, where), gap)


def _radius_change(meridian: Meridian, heights: Array, radius: Array, height: float) -> Array:
    """Change (n,) of the planned radius between heights (n,) and a height, on the stretch of the meridian nearest to the measured
    radius (n,); 0 if it does not reach both.
    """
    end_arcs = meridian.s_at_height([height])[0]
    grown = np.zeros(len(heights))
    if not len(end_arcs):
        return grown
    end = meridian.at(end_arcs)[0]
    for k, arcs in enumerate(meridian.s_at_height(heights)):
        if len(arcs):
            radii = meridian.at(arcs)[0]
            nearest = int(np.argmin(np.abs(radii - radius[k])))
            grown[k] = end[np.argmin(np.abs(end_arcs - arcs[nearest]))] - radii[nearest]
    return grown


def thickness(
    feet: Array, deviation: Array, outer: Mask, planned: float, reach: float
) -> Thickness | None:
    """Return the thickness of a wall that was measured on both sides.

    Parameters
    ----------
    feet : (n, 3) array
        Feet of the points on the planned surface, mm.
    deviation : (n,) array
        Deviations of the points, mm.
    outer : (n,) bool array
        Points of the outer side.
    planned : float
        Planned thickness, mm.
    reach : float
        Largest distance between the feet of a pair, mm.

    Returns
    -------
    Thickness or None
        The planned thickness plus both deviations; None without pairs.
    """
    outer_rows, inner_rows = np.flatnonzero(outer), np.flatnonzero(~outer)
    if not len(outer_rows) or not len(inner_rows):
        return None
    found_at = cKDTree(feet[inner_rows]).query(feet[outer_rows])
    off, partner = np.asarray(found_at[0]), np.asarray(found_at[1])
    met = off <= reach
    if not met.any():
        return None
    thicknesses = planned + deviation[outer_rows[met]] + deviation[inner_rows[partner[met]]]
    return Thickness(
        int(met.sum()),
        float(thicknesses.mean()),
        float(thicknesses.std()),
        float(thicknesses.min()),
        float(thicknesses.max()),
    )


def zone_of(points: Array, where: str) -> Round:
    """Find the narrowest zone of points as `narrowest`, on a subset of many.

    The subset grows until its zone holds every point, which makes it the narrowest zone of the
    whole.

    Parameters
    ----------
    points : (n, d) array
        Points, mm; d is 2 or 3.
    where : str
        Name for messages.

    Returns
    -------
    Round
        Its inner and outer radii are over all points.

    Raises
    ------
    InputError
        TOO_FEW_POINTS or FLAT_POINTS if no circle or sphere exists.
    """
    if len(points) <= 4 * ZONE_SIZE:
        return narrowest(points, where)
    distance = np.linalg.norm(points - least_squares_round(points, where).centre, axis=1)
    order = np.argsort(distance)
    evenly = np.linspace(0, len(points) - 1, ZONE_SIZE).astype(np.intp)
    sample = np.unique(np.r_[order[:ZONE_SIZE], order[-ZONE_SIZE:], evenly])
    for _ in range(20):
        zone = narrowest(points[sample], where)
        distance = np.linalg.norm(points - zone.centre, axis=1)
        if np.ptp(distance) <= zone.zone + 1e-9 * zone.outer:
            break
        order = np.argsort(distance)
        sample = np.unique(np.r_[sample, order[:ZONE_SIZE], order[-ZONE_SIZE:]])
    inner, outer = float(distance.min()), float(distance.max())
    return Round(zone.centre, 0.5 * (inner + outer), inner, outer)


def default_heights(planned: Planned, points: Array) -> tuple[float, ...]:
    """Return a sixth, a half and five sixths of the height of points.

    Parameters
    ----------
    planned : Planned
        The surface with its frame.
    points : (n, 3) array
        Measured points, mm.

    Returns
    -------
    tuple of float
        Heights above the base, mm.

    Notes
    -----
    The paper has 15, 25 and 35 mm for heights of 10 to 40 mm.
    """
    height = (points - planned.frame[:3, 3]) @ planned.frame[:3, 2]
    low, high = float(height.min()), float(height.max())
    return tuple(round(low + share * (high - low), 3) for share in (1.0 / 6.0, 0.5, 5.0 / 6.0))


def warnings_of(circles: Sequence[Circle]) -> list[str]:
    """Warnings about circles that were not measured all round."""
    return [
        Text(
            "the circle at {:g} mm was not measured all around: neighbouring points are {:.0f} "
            "deg apart",
            circle.height,
            np.degrees(circle.gap),
        )
        for circle in circles
        if circle.gap > 2.0 * np.pi * ALL_ROUND
    ]


def _nice(step: float) -> float:
    """The next of 1, 2, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(step))
    return float(
        next(power * nice for nice in (1.0, 2.0, 5.0, 10.0) if power * nice >= step * (1.0 - 1e-9))
    )
