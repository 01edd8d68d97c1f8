# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves laid as beads as they are, once or several times one over the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry.angles import TURN
from ..geometry.curves.bead_curves import BeadCurve, Curves
from ..geometry.formatting import place
from ..issues import InputError
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import CurvesParameters
from ..process import classes
from ..slicing.directions.wall import lean_tool
from ..toolpath import Bead, Layer, Toolpath
from ..types import Array
from .progress import Progress, silent

ALONG = np.cos(
    np.radians(5.0)
)  # a bead runs along the direction in which it is laid if the angle between them is less


STEP = 1.01  # layer heights that a bead may climb straight up, but for what slicers round
TURNED_BACK = 0.05  # of the shorter segment: a mean of two segments that is less says nothing


def plan(
    given: Curves,
    strategy: CurvesParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    progress: Progress = silent,
) -> Toolpath:
    """The toolpath of curves, in part coordinates: layer k is that of the curves k layer heights further along the
    directions in which they are laid. InputError ALONG_DIRECTION."""
    fixed = np.array(strategy.way())
    numbers = sorted({curve.layer for curve in given.curves})
    layers: list[Layer] = []
    for again in range(strategy.repeat):
        progress(again / strategy.repeat, f"layer {len(layers)}")
        for number in numbers:
            beads = [
                _classed(
                    curve,
                    fixed,
                    strategy.layer_height,
                    again,
                    (len(layers), k),
                    build,
                    process,
                    given.label,
                )
                for k, curve in enumerate(given.curves)
                if curve.layer == number
            ]
            layers.append(Layer(tuple(beads)))
    return Toolpath(
        tuple(layers),
        np.eye(4),
        strategy.layer_height,
        strategy.chord_error,
        given.issues,
        process.overlap,
        "curves",
        given.surroundings,
        bead_width=process.bead_width,
    )


def _classed(
    curve: BeadCurve,
    fixed: Array,
    height: float,
    again: int,
    place: tuple[int, int],
    build: BuildDirectionParameters,
    process: ProcessParameters,
    label: str,
) -> Bead:
    """The bead at a place, layer and number in it, as its class is laid."""
    name = classes.wall_bead_class(place[0])
    own = classes.leaning(build, process, name), process.for_class(name)
    return replace(_bead(curve, fixed, height, again, sum(place), *own, label), bead_class=name)


def _tangents(points: Array, away: Array) -> Array:
    """Unit vectors (n, 3) along a bead at its points. Where it turns back, so that the mean of the segments before and after a
    point vanishes or runs along the direction (n, 3) in which the bead is laid, the segment after the point counts."""
    segments = np.diff(points, axis=0)
    segments /= np.linalg.norm(segments, axis=1, keepdims=True)
    if len(points) == 2:
        return np.repeat(segments, 2, axis=0)
    mean = np.gradient(points, axis=0)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    turned = size[:, 0] < TURNED_BACK * np.minimum(np.r_[steps, steps[-1]], np.r_[steps[0], steps])
    forward = mean / np.where(size > 0.0, size, 1.0)
    turned |= np.abs((forward * away).sum(axis=1)) > ALONG
    forward[turned] = np.vstack([segments, segments[-1:]])[turned]
    return np.asarray(forward)


def _steps_along(points: Array, away: Array, height: float) -> Array:
    """Cosine (n - 1,) between each segment and the direction in which it is laid; 0 of steps of up to a layer height, with which
    a bead climbs onto itself."""
    segments = np.diff(points, axis=0)
    lengths = np.linalg.norm(segments, axis=1)
    cosines = np.abs((segments * away[:-1]).sum(axis=1)) / lengths
    return np.where(lengths > STEP * height, cosines, 0.0)


def _bead(
    curve: BeadCurve,
    fixed: Array,
    height: float,
    again: int,
    index: int,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    label: str,
) -> Bead:
    away = np.tile(fixed, (len(curve.points), 1))
    if curve.directions is not None and build.mode == "local":
        away = curve.directions
    points = curve.points + again * height * away
    if process.direction == "alternate" and index % 2:
        points, away = points[::-1], away[::-1]
    forward = _tangents(points, away)
    along = np.abs((forward * away).sum(axis=1))
    along[:-1] = np.maximum(along[:-1], _steps_along(points, away, height))
    worst = int(along.argmax())
    if along[worst] > ALONG:
        raise InputError(
            "ALONG_DIRECTION",
            label,
            "a bead runs along the direction in which it is laid, at {}: the nozzle would be in "
            "its own way; give another strategy.direction, faces, or directions in the table",
            place(points[worst]),
        )
    across = np.cross(forward, away)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    tool = lean_tool(away, np.cross(away, across), across, build.lead, build.tilt)
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    if curve.closed:
        points, away, tool = (np.vstack([rows[:-1], rows[:1]]) for rows in (points, away, tool))
    return Bead(
        points,
        away,
        tool,
        TURN * way / way[-1],
        np.full(len(points), process.travel_speed),
        curve.closed,
    )
