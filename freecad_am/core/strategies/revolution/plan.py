# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of revolution: a wall in, layers of beads with build directions out (Chalvin 2020, sections 2.1 and 6.1)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...geometry.curves.profile import RevolvedWall
from ...geometry.step_count import turn_segments
from ...issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...parameters.bead_classes import FIRST_LAYER, WALL
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import RevolutionParameters
from ...process import classes, order
from ...slicing import arc_length, iso_height
from ...toolpath import Bead, Layer, Toolpath
from ...types import Array, Index
from .. import size
from ..progress import Progress, silent
from . import clearance, spiral
from .tilt import Tilting

SPACING_BAND = 0.2  # of the layer height (Chalvin 2020, section 2.1)


@dataclass(frozen=True, eq=False)
class Slices:
    """The beads of every layer in the order of deposit: layer index (m,), radius and height (m,) mm, tangent (m, 2)."""

    layer: Index
    radius: Array
    height: Array
    tangent: Array


def plan(
    wall: RevolvedWall,
    strategy: RevolutionParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    nozzle: NozzleParameters,
    platform_diameter: float,
    platform_frame: Array | None = None,
    progress: Progress = silent,
) -> Toolpath:
    """The toolpath of a wall of revolution, in part coordinates.

    Layers by arc length or height; points per bead from the chord error; build directions from the mode, capped and
    tilted back until the nozzle is clear. A spiral is one layer with one open bead.

    Parameters
    ----------
    platform_diameter
        mm, 0 without a platform.
    platform_frame
        (4, 4) pose of the platform in part coordinates; None if the feature frame is on it.

    Raises
    ------
    InputError
        'BAD_VALUE', 'LAYER_HEIGHT', 'NOT_FOR_FAMILY', 'OFF_PLATFORM', 'PARTIAL_TURN', 'TOO_MANY'.
    """
    if build.mode == "symmetry-plane":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "symmetry-plane is not for parts of revolution; use local, layer or fixed",
        )
    size.refuse_absurd(size.revolution_size(wall, strategy), strategy)
    progress(0.0, "cutting layers")
    under = clearance.under(wall, platform_diameter, platform_frame)
    leaning_build = classes.leaning(build, process, WALL)
    tilting = Tilting(wall, strategy, leaning_build, nozzle, under, process.bead_width)
    issues: list[Issue] = []
    if strategy.path == "spiral":
        if strategy.min_layer_time > 0.0:
            raise InputError(
                "BAD_VALUE",
                "strategy.min_layer_time",
                "a spiral has no layers to wait between; use path: layers, a slower "
                "process.travel_speed, or remove it",
            )
        layers, plan_issues = spiral.layers(wall, strategy, process, tilting)
    else:
        slices, issues = sliced(wall, strategy)
        progress(
            0.2,
            Text("build directions of {} layers, with nozzle clearance", slices.layer[-1] + 1),
        )
        first_tilting = replace(tilting, parameters=classes.leaning(build, process, FIRST_LAYER))
        layers, plan_issues = _layers(wall, slices, strategy, process, tilting, first_tilting)
    progress(0.9, "checking")
    issues = [*wall.issues, *clearance.overhanging(wall, under), *issues, *plan_issues]
    return Toolpath(
        layers,
        wall.frame,
        strategy.layer_height,
        strategy.chord_error,
        tuple(issues),
        process.overlap,
        bead_width=process.bead_width,
    )


def sliced(wall: RevolvedWall, strategy: RevolutionParameters) -> tuple[Slices, list[Issue]]:
    """The beads of every layer, and notes on the remainder at the top, skipped beads and uneven spacing.

    A bead whose radius is no more than the chord error is a point, and is skipped.
    """
    meridian = wall.meridian
    rule = arc_length if strategy.spacing == "arc-length" else iso_height
    layers, remainder = rule.layers(meridian, strategy.layer_height)
    issues = []
    if remainder > 1e-6 * strategy.layer_height:
        measure = "of the wall" if rule is arc_length else "of the height"
        issues.append(
            Issue(
                NOTE,
                "REMAINDER",
                Text("{:.3g} mm {} remain at the top, less than a layer", remainder, Word(measure)),
            )
        )
    if rule is iso_height:
        issues += _spacing_issues(wall, layers, strategy.layer_height)
    flat = np.concatenate(layers)
    number = np.repeat(np.arange(len(layers)), [len(layer) for layer in layers])
    radius, height, tangent = meridian.at(flat)
    is_kept = radius > strategy.chord_error
    if not is_kept.all():
        issues.append(
            Issue(
                NOTE,
                "POINT_BEADS",
                Text(
                    "{} bead(s) with a radius up to the chord error ({:g} mm) are omitted",
                    int((~is_kept).sum()),
                    strategy.chord_error,
                ),
                int(number[~is_kept][0]),
            )
        )
    renumbered = np.unique(number[is_kept], return_inverse=True)[1]
    return Slices(renumbered, radius[is_kept], height[is_kept], tangent[is_kept]), issues


def _spacing_issues(wall: RevolvedWall, layers: list[Array], layer_height: float) -> list[Issue]:
    gaps = [iso_height.spacing(wall.meridian, a, b) for a, b in pairwise(layers)]
    widest = np.array([gap.max() for gap in gaps])
    narrowest = np.array([gap.min() for gap in gaps])
    over, under = (
        (1.0 + SPACING_BAND + 1e-9) * layer_height,
        (1.0 - SPACING_BAND - 1e-9) * layer_height,
    )
    uneven = np.flatnonzero((widest > over) | (narrowest < under))
    if len(uneven) == 0:
        return []
    worst = int(
        uneven[
            np.argmax(np.maximum(widest[uneven] - layer_height, layer_height - narrowest[uneven]))
        ]
    )
    return [
        Issue(
            WARNING,
            "SPACING",
            Text(
                "{} of {} layers deviate by more than 20 % from the layer height of {:g} mm, "
                "first layer {}; layer {} is {:.4g} mm above the previous one; layers along the "
                "wall (spacing: arc-length) are even",
                len(uneven),
                len(layers),
                layer_height,
                int(uneven[0]) + 1,
                worst + 1,
                widest[worst],
            ),
            worst + 1,
        )
    ]


def _layers(
    wall: RevolvedWall,
    slices: Slices,
    strategy: RevolutionParameters,
    process: ProcessParameters,
    tilting: Tilting,
    first_tilting: Tilting,
) -> tuple[tuple[Layer, ...], list[Issue]]:
    """One layer per index, its beads turned about the axis. first_tilting: the lean of the tool on the first layer."""
    azimuths, rising = [], []
    for index, (layer, radius) in enumerate(zip(slices.layer, slices.radius, strict=True)):
        segments = turn_segments(
            radius, strategy.chord_error, wall.end - wall.start, strategy.min_points
        )
        up = order.rising(process, int(layer) if wall.full else index, wall.full)
        rising.append(up)
        azimuths.append(
            order.closed_azimuths(process, int(layer), segments, up)
            if wall.full
            else order.open_azimuths(wall.start, wall.end, segments, up)
        )
    builds, tools, issues = tilting.resolve(
        slices.radius, slices.height, slices.tangent, azimuths, rising, slices.layer
    )
    if first_tilting.parameters != tilting.parameters:  # below it is nothing that leans another way
        count = int((slices.layer == 0).sum())
        below, below_tools, first_issues = first_tilting.resolve(
            slices.radius[:count],
            slices.height[:count],
            slices.tangent[:count],
            azimuths[:count],
            rising[:count],
            slices.layer[:count],
        )
        builds, tools = [*below, *builds[count:]], [*below_tools, *tools[count:]]
        issues = [*first_issues, *(issue for issue in issues if issue.layer != 0)]
    beads: list[list[Bead]] = [[] for _ in range(int(slices.layer[-1]) + 1)]
    for index, azimuth in enumerate(azimuths):
        name = classes.wall_bead_class(int(slices.layer[index]))
        speed = process.for_class(name).travel_speed
        bead = _bead(wall, slices, index, azimuth, builds[index], tools[index], speed, name)
        beads[int(slices.layer[index])].append(bead)
    return tuple(Layer(tuple(layer)) for layer in beads), issues


def _bead(
    wall: RevolvedWall,
    slices: Slices,
    index: int,
    azimuth: Array,
    build: Array,
    tool: Array,
    speed: float,
    name: str,
) -> Bead:
    angles = azimuth.copy()
    if wall.full:
        angles[-1] = angles[0]  # the last point is the first, to the bit
    n = len(azimuth)
    points = wall.points(np.full(n, slices.radius[index]), np.full(n, slices.height[index]), angles)
    return Bead(
        points,
        wall.directions(build, angles),
        wall.directions(tool, angles),
        azimuth,
        np.full(n, speed),
        wall.full,
        bead_class=name,
    )
