# SPDX-License-Identifier: LGPL-2.1-or-later
"""Alignment of measured points with the plan, and statistics of the deviations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..issues import NOTE, WARNING, InputError, Issue, Text
from ..parameters.inspection import AXIS, BEST, BOTH, NONE, SHIFT, InspectionParameters
from ..types import Array, Mask
from . import figures
from .figures import Ball, Circle, Spread, Thickness
from .planned import Planned, sided
from .point_file import Measured
from .registration import (
    EQUAL_RATIO,
    LEAST_POINTS,
    Registration,
    Surface,
    as_measured,
    by_extents,
    by_pairs,
    mean_square,
    refuse_too_few,
    register,
    roughly,
)

Report = Callable[[float, str], None]

PREDICTED = "predicted deposit"  # replaces the file name if nothing was measured
UNLIKE = (
    8.0  # size ratio of part to points that suggests a wrong unit; cm, inch and m give 10 or more
)
SHIFTS = np.vstack([np.zeros((3, 3)), np.eye(3)])


@dataclass(frozen=True, eq=False)
class Inspected:
    """Measured points aligned with the part.

    points: (n, 3) mm in part coordinates, on the touched surface, one probe radius from the centre
    of the ball. deviation: (n,) mm from the planned surface, positive for excess. counted: (n,)
    False for points past the edges of the plan, which the statistics ignore. fitted: (n,) False for
    uncounted points and for points excluded from the fit. motion: (4, 4) from measuring to part
    coordinates. free: motions without influence on the deviations. tolerance: mm. file, against:
    names of the measured and the planned object. laid: (m, 5) pieces of a predicted deposit: centre,
    mm, layer, and height of the surface above the piece, mm; None for a measurement.
    """

    points: Array
    deviation: Array
    counted: Mask
    fitted: Mask
    motion: Array
    free: tuple[str, ...]
    tolerance: float
    file: str
    against: str
    spread: Spread
    ball: Ball | None
    circles: tuple[Circle, ...]
    thickness: Thickness | None
    issues: tuple[Issue, ...]
    laid: Array | None = None


def inspect(
    measured: Measured, planned: Planned, parameters: InspectionParameters, report: Report
) -> Inspected:
    """Align measured points with the planned surface and evaluate the deviations.

    Parameters
    ----------
    measured : Measured
        The points.
    planned : Planned
        The surface in part coordinates.
    parameters : InspectionParameters
        Fit, probe, tolerance and heights.
    report : Report
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Inspected
        Points, deviations and statistics.

    Raises
    ------
    InputError
        For unsuitable points or parameters.
    InfeasibleError
        NOT_SETTLED if the fit does not converge.
    """
    refuse_too_few(measured.points, measured.label)
    report(0.05, "fitting the points to the part")
    registration, within, distances = _aligned(measured, planned, parameters)
    report(0.6, "sphericity and circularity")
    aligned = measured.points @ registration.motion[:3, :3].T + registration.motion[:3, 3]
    distance, normal = distances(aligned)
    deviation = distance - parameters.probe_radius
    points = aligned - parameters.probe_radius * normal
    # points with a larger deviation than all fitted points were excluded from the fit
    fitted = within & (
        np.abs(deviation) <= np.abs(registration.distance[registration.used]).max() + 1e-9
    )
    inside_points, where = points[within], measured.label
    ball = figures.ball(
        inside_points, inside_points - deviation[within, None] * normal[within], where
    )
    issues = [
        *measured.issues,
        *_unlike(measured.points, planned),
        *_issues(registration, planned, within, fitted, ball is not None),
    ]
    # only walls of revolution are known to be round
    levels = parameters.levels() or (
        () if planned.wall is None else figures.default_heights(planned, inside_points)
    )
    circles = []
    for height in levels:
        try:
            circles.append(
                figures.circle(
                    planned, inside_points, normal[within], height, parameters.band, where
                )
            )
        except InputError as error:
            if parameters.heights:
                issues.append(Issue(WARNING, error.code, error.message))
    issues += [Issue(WARNING, "NOT_ALL_ROUND", text) for text in figures.warnings_of(circles)]
    report(0.8, "figures")
    return Inspected(
        points,
        deviation,
        within,
        fitted,
        registration.motion,
        registration.free,
        parameters.tolerance,
        where,
        planned.name,
        figures.summarise(deviation[within], parameters.tolerance),
        ball,
        tuple(circles),
        _thickness(aligned, deviation, within, planned, parameters),
        tuple(issues),
    )


def _aligned(
    measured: Measured, planned: Planned, parameters: InspectionParameters
) -> tuple[Registration, Mask, Surface]:
    """Return the fit, which points are within the edges, and the surface used for the fit."""
    radius, trim, where = parameters.probe_radius, parameters.trim, measured.label
    points = measured.points
    sample = points[np.unique(np.linspace(0, len(points) - 1, planned.max_points).astype(np.intp))]
    exact = sided(planned.exact, parameters.side, parameters.thickness)
    if parameters.fit == NONE:
        start = _by_pairs(parameters, where)
    else:
        nearest = sided(planned.nearest, parameters.side, parameters.thickness)
        start = _start_motion(sample, nearest, exact, planned, parameters, where)
    for _ in range(2):  # a second fit, because the first changes which points are past the edges
        on_part = sample[planned.within_edges(sample @ start[:3, :3].T + start[:3, 3])]
        if len(on_part) < LEAST_POINTS:
            raise InputError(
                "NOT_ON_PART",
                where,
                "only {} of the points match {}; choose the measured object, correct the unit, "
                "or give initial pairs of points",
                len(on_part),
                planned.name,
            )
        if parameters.fit == NONE:
            distance, _ = exact(on_part)
            registration = Registration(
                start, on_part, distance - radius, np.ones(len(on_part), dtype=np.bool_), ()
            )
        else:
            registration = register(
                on_part,
                exact,
                start[None],
                where,
                trim,
                radius,
                _allowed(planned, parameters),
                planned.free,
            )
            start = registration.motion
    return registration, planned.within_edges(points @ start[:3, :3].T + start[:3, 3]), exact


def _start_motion(
    points: Array,
    nearest: Surface,
    exact: Surface,
    planned: Planned,
    parameters: InspectionParameters,
    where: str,
) -> Array:
    """Return the initial motion (4, 4).

    Pairs of points define the motion if given. Otherwise it starts from the measured attitude, if that fits about as
    well as the best of many attitudes. Translations come first, so that the motion has no component without influence
    on the deviations.
    """
    trim, radius = parameters.trim, parameters.probe_radius
    if parameters.start_pairs():
        start = _by_pairs(parameters, where)[None]
        return roughly(points, nearest, start, trim, radius, _allowed(planned, parameters))
    if parameters.fit != BEST:
        return roughly(points, nearest, as_measured(), trim, radius, _allowed(planned, parameters))
    start = roughly(points, exact, as_measured(), trim, radius, SHIFTS, planned.free)
    start = roughly(points, exact, start[None], trim, radius, None, planned.free)
    best_attitude = roughly(points, nearest, by_extents(points, planned.spread), trim, radius)
    sample = points[:: max(1, len(points) // 400)]
    measured_square, second = (
        mean_square(sample, nearest, motion_, trim, radius) for motion_ in (start, best_attitude)
    )
    return (
        start
        if measured_square <= EQUAL_RATIO * second + planned.chord**2 + 1e-18
        else best_attitude
    )


def _by_pairs(parameters: InspectionParameters, where: str) -> Array:
    """Return the motion (4, 4) from pairs of points; identity without pairs."""
    pairs = parameters.start_pairs()
    if not pairs:
        return np.eye(4)
    return np.asarray(
        by_pairs(
            np.array([measured_point for measured_point, _ in pairs]),
            np.array([planned_point for _, planned_point in pairs]),
            where,
        )[0]
    )


def _allowed(planned: Planned, parameters: InspectionParameters) -> Array | None:
    """Return the motions that the fit may make, in the form that `register` takes."""
    if parameters.fit == SHIFT:
        return SHIFTS
    if parameters.fit == AXIS:
        axis, origin = planned.frame[:3, 2], planned.frame[:3, 3]
        turn, shift = np.r_[axis, np.cross(origin, axis)], np.r_[np.zeros(3), axis]
        return np.column_stack([turn, shift])
    return None


def _thickness(
    aligned: Array,
    deviation: Array,
    within: Mask,
    planned: Planned,
    parameters: InspectionParameters,
) -> Thickness | None:
    if parameters.side != BOTH:
        return None
    raw, normal = planned.exact(aligned[within])
    feet = aligned[within] - raw[:, None] * normal
    return figures.thickness(
        feet, deviation[within], raw >= 0.0, parameters.thickness, max(parameters.band, 0.5)
    )


def _unlike(points: Array, planned: Planned) -> list[Issue]:
    """Warn if the points (n, 3) are much smaller than the part.

    The unit is then probably wrong, and a small cloud fits anywhere.
    """
    measured, part_size = (
        float(np.linalg.norm(np.ptp(cloud, axis=0))) for cloud in (points, planned.spread)
    )
    if measured * UNLIKE > part_size:
        return []
    return [
        Issue(
            WARNING,
            "SMALL",
            Text(
                "the points extend over {:.3g} mm, {} over {:.3g} mm; check the unit of the file",
                measured,
                planned.name,
                part_size,
            ),
        )
    ]


def _issues(
    registration: Registration, planned: Planned, within: Mask, fitted: Mask, is_ball: bool
) -> list[Issue]:
    free = (
        ("a rotation about the centre of the sphere",)
        if is_ball and len(registration.free) == 3
        else registration.free
    )
    issues = [
        Issue(
            NOTE,
            "FREE_MOTION",
            Text("{} changes no deviation, so the points do not determine it", text),
        )
        for text in free
    ]
    past = int((~within).sum())
    if past:
        issues.append(
            Issue(
                NOTE,
                "PAST_EDGES",
                Text("{} points beyond the edges of {} are ignored", past, planned.name),
            )
        )
    out = int((within & ~fitted).sum())
    if out:
        text = Text(
            "the fit excludes the {} farthest points, but the results include all points", out
        )
        issues.append(Issue(NOTE, "LEFT_OUT", text))
    if planned.chord > 0.0 and planned.exact is planned.nearest:
        issues.append(
            Issue(
                NOTE,
                "CHORD",
                Text("{} is a mesh with an accuracy of {:g} mm", planned.name, planned.chord),
            )
        )
    return issues
