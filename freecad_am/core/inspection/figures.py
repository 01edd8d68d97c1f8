# SPDX-License-Identifier: LGPL-2.1-or-later
"""Statistics of deviations: spread, sphericity, roundness, circularity at heights, thickness.

After Chalvin 2020, table 2.
"""

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
MIN_EXTENT_RATIO = (
    1e-6  # of the maximum extent; flatter points are collinear or coplanar and have no centre
)
STILL = 1e-13  # fraction of the radius; improvement of the zone at which the iteration ends


@dataclass(frozen=True, eq=False)
class Round:
    """A circle (two coordinates) or sphere (three) fitted to points.

    centre: (d,) mm. radius: mm. inner, outer: minimum and maximum distance of a point from the centre, mm.
    """

    centre: Array
    radius: float
    inner: float
    outer: float

    @property
    def zone(self) -> float:
        """Width of the zone that contains all points, mm."""
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
        The circle or sphere, in the frame of the points.

    Raises
    ------
    InputError
        TOO_FEW_POINTS or FLAT_POINTS if no circle or sphere exists.
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
    """Find the centre with the minimum zone (Chebyshev approximation).

    A trust region method starts at the least-squares centre. Each iteration solves a linear program
    for the step of the centre within a box, which shrinks if the zone does not. The result is a
    local minimum, and the global minimum for points all round.

    Parameters
    ----------
    points : (n, d) array
        Points, mm; d is 2 or 3.
    where : str
        Name for messages.

    Returns
    -------
    Round
        The minimum zone; the radius is the mean of inner and outer radius.

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
    """Return unit vectors; zero for a point at the centre, which may move in any direction."""
    return np.asarray(
        offsets / np.maximum(np.linalg.norm(offsets, axis=1, keepdims=True), np.finfo(float).tiny)
    )


def _round(points: Array, centre: Array, radius: float) -> Round:
    distance = np.linalg.norm(points - centre, axis=1)
    return Round(centre, radius, float(distance.min()), float(distance.max()))


def _algebraic(points: Array, where: str) -> tuple[Array, float]:
    """Fit a circle or sphere by linear equations; return centre and radius (d + 1,) and the extent of the points."""
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


BARS = 40  # maximum number of histogram bars
ZONE_SIZE = 600  # innermost, outermost and evenly distributed points each in the first subset for a minimum zone
ROUND = 1e-3  # fraction of the radius; maximum zone of a planned sphere
MIN_RADIAL_NORMAL = 0.1  # radial component of a normal; a flatter surface has no circle at a height
ALL_ROUND = 0.25  # turns; maximum gap between adjacent points of a circle measured all round


@dataclass(frozen=True, eq=False)
class Spread:
    """Statistics of the deviations that count, mm.

    deviation: standard deviation. least, most: minimum and maximum. within_95: 95 % quantile of the absolute
    deviations. within: fraction within tolerance. edges: (k + 1,) histogram edges. counts: (k,) histogram counts.
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
    """Circularity of count points at a height, mm.

    fitted, zone: least-squares circle and minimum zone in the plane at the height, relative to the part's axis. gap:
    maximum angle between adjacent points, rad.
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
    """Least-squares and minimum-zone spheres, with centres in part coordinates.

    planned: planned radius, mm.
    """

    count: int
    fitted: Round
    zone: Round
    planned: float


@dataclass(frozen=True)
class Thickness:
    """Thickness of a wall measured at count pairs of points on both sides, mm."""

    count: int
    mean: float
    deviation: float
    least: float
    most: float


def summarise(deviation: Array, tolerance: float) -> Spread:
    """Return the statistics of deviations.

    Parameters
    ----------
    deviation : (n,) array
        Deviations, mm; n >= 1.
    tolerance : float
        Tolerance, mm.

    Returns
    -------
    Spread
        Statistics and histogram.
    """
    low, high = float(deviation.min()), float(deviation.max())
    step = _nice(
        max(high - low, 1e-9, 1e-12 * max(-low, high)) / BARS
    )  # large enough for distinct multiples in floating point
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
        Foot points on the planned surface, mm.
    where : str
        Name of the points, for messages.

    Returns
    -------
    Ball or None
        None if the foot points are not on a sphere.

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
    except InputError:  # too few points, or coplanar
        return None


def circle(
    planned: Planned, points: Array, normal: Array, height: float, band: float, where: str
) -> Circle:
    """Return the circularity of points at a height.

    Points in the band are projected to the height along the planned surface. Their radius changes
    like the planned radius: along the meridian on parts of revolution, else along the surface
    slope.

    Parameters
    ----------
    planned : Planned
        The surface with its frame.
    points : (n, 3) array
        Measured points, mm.
    normal : (n, 3) array
        Planned normals at the points.
    height : float
        Height above the base, mm.
    band : float
        Half width of the band, mm.
    where : str
        Name of the points, for messages.

    Returns
    -------
    Circle
        The fitted circle and the minimum zone.

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
    """Return the change (n,) of the planned radius from heights (n,) to a height.

    It is taken from the stretch of the meridian nearest to the measured radius (n,), and 0 if the meridian does not
    reach both heights.
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
    """Return the thickness of a wall measured on both sides.

    Parameters
    ----------
    feet : (n, 3) array
        Foot points on the planned surface, mm.
    deviation : (n,) array
        Deviations of the points, mm.
    outer : (n,) bool array
        Points on the outer side.
    planned : float
        Planned thickness, mm.
    reach : float
        Maximum distance between the foot points of a pair, mm.

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
    """Find the minimum zone like `narrowest`, using a subset of a large set of points.

    The subset grows until its zone contains all points. It is then the minimum zone of all points.

    Parameters
    ----------
    points : (n, d) array
        Points, mm; d is 2 or 3.
    where : str
        Name for messages.

    Returns
    -------
    Round
        The minimum zone, with inner and outer radius over all points.

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
    """Return heights at one sixth, one half and five sixths of the extent of the points.

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
    Chalvin 2020 has 15, 25 and 35 mm for heights of 10 to 40 mm.
    """
    height = (points - planned.frame[:3, 3]) @ planned.frame[:3, 2]
    low, high = float(height.min()), float(height.max())
    return tuple(round(low + share * (high - low), 3) for share in (1.0 / 6.0, 0.5, 5.0 / 6.0))


def warnings_of(circles: Sequence[Circle]) -> list[str]:
    """Return warnings about circles that were not measured all round."""
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
    """Round up to 1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(step))
    return float(
        next(power * nice for nice in (1.0, 2.0, 5.0, 10.0) if power * nice >= step * (1.0 - 1e-9))
    )
