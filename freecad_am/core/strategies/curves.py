# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves deposited unchanged as beads, in one or several layers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..geometry.curves.bead_curves import BeadCurve, Curves
from ..geometry.formatting import place
from ..geometry.frames import TURN
from ..issues import InputError
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import CurvesParameters
from ..process import classes
from ..slicing.wall_directions import lean_tool
from ..toolpath import Bead, BeadRole, Layer, MotionRules, Toolpath
from ..types import Array
from .progress import Progress, silent

ALONG = np.cos(
    np.radians(5.0)
)  # a bead runs along its deposit direction if the angle between them is smaller


STEP = 1.01  # layer heights; maximum vertical step of a bead, including the rounding of slicers
# fraction of the shorter segment; minimum length of the mean of two segments for a reliable direction
TURNED_BACK = 0.05


def plan(
    curves_: Curves,
    strategy: CurvesParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    progress: Progress = silent,
) -> Toolpath:
    """Plan the toolpath of curves.

    Layer k contains the curves offset by k layer heights along their deposit directions.

    Parameters
    ----------
    curves_ : Curves
        The curves.
    strategy : CurvesParameters
        Layer height, repetitions and direction.
    build : BuildDirectionParameters
        Build direction and its limits.
    process : ProcessParameters
        Speeds.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        ALONG_DIRECTION for a curve along its deposit direction.
    """
    fixed = np.array(strategy.direction) / math.hypot(*strategy.direction)
    numbers = sorted({curve.layer for curve in curves_.curves})
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
                    curves_.label,
                )
                for k, curve in enumerate(curves_.curves)
                if curve.layer == number
            ]
            layers.append(Layer(tuple(beads)))
    return Toolpath(
        tuple(layers),
        np.eye(4),
        strategy.layer_height,
        strategy.chord_error,
        curves_.issues,
        "curves",
        curves_.surroundings,
        bead_width=process.bead_width,
        rules=MotionRules(process.overlap),
    )


def _classed(
    curve: BeadCurve,
    fixed: Array,
    height: float,
    again: int,
    key: tuple[int, int],
    build: BuildDirectionParameters,
    process: ProcessParameters,
    label: str,
) -> Bead:
    """Return the bead at a key (layer index, bead index), with the settings of its class."""
    name = classes.wall_bead_class(key[0])
    class_settings = classes.leaning(build, process, name), process.for_class(name)
    bead = _bead(curve, fixed, height, again, sum(key), *class_settings, label)
    return replace(bead, role=BeadRole(bead_class=name))


def _tangents(points: Array, directions: Array) -> Array:
    """Return the unit tangents (n, 3) at the points of a bead.

    A tangent is the mean of the adjacent segments. Where the bead reverses, this mean vanishes or runs along the
    deposit direction (n, 3), and the segment after the point is used.
    """
    segments = np.diff(points, axis=0)
    segments /= np.linalg.norm(segments, axis=1, keepdims=True)
    if len(points) == 2:
        return np.repeat(segments, 2, axis=0)
    mean = np.gradient(points, axis=0)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    turned = size[:, 0] < TURNED_BACK * np.minimum(np.r_[steps, steps[-1]], np.r_[steps[0], steps])
    forward = mean / np.where(size > 0.0, size, 1.0)
    turned |= np.abs((forward * directions).sum(axis=1)) > ALONG
    forward[turned] = np.vstack([segments, segments[-1:]])[turned]
    return np.asarray(forward)


def _steps_along(points: Array, directions: Array, height: float) -> Array:
    """Return the cosine (n - 1,) between each segment and its deposit direction.

    It is 0 for steps of up to a layer height, by which a bead climbs onto itself.
    """
    segments = np.diff(points, axis=0)
    lengths = np.linalg.norm(segments, axis=1)
    cosines = np.abs((segments * directions[:-1]).sum(axis=1)) / lengths
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
    directions = np.tile(fixed, (len(curve.points), 1))
    if curve.directions is not None and build.mode == "local":
        directions = curve.directions
    points = curve.points + again * height * directions
    if process.direction == "alternate" and index % 2:
        points, directions = points[::-1], directions[::-1]
    forward = _tangents(points, directions)
    along = np.abs((forward * directions).sum(axis=1))
    along[:-1] = np.maximum(along[:-1], _steps_along(points, directions, height))
    worst = int(along.argmax())
    if along[worst] > ALONG:
        raise InputError(
            "ALONG_DIRECTION",
            label,
            "a bead runs parallel to its tool direction, at {}, so the nozzle would hit the "
            "bead; set another strategy.direction, choose faces, or give directions in the table",
            place(points[worst]),
        )
    across = np.cross(forward, directions)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    tool = lean_tool(directions, np.cross(directions, across), across, build.lead, build.tilt)
    arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    if curve.closed:
        points, directions, tool = (
            np.vstack([rows[:-1], rows[:1]]) for rows in (points, directions, tool)
        )
    return Bead(
        points,
        directions,
        tool,
        TURN * arc / arc[-1],
        np.full(len(points), process.travel_speed),
        curve.closed,
    )
