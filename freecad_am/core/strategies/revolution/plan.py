# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of revolution: layers of beads or one spiral, with build directions.

Chalvin 2020, sections 2.1 and 6.1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...geometry.curves.profile import Meridian, RevolvedWall
from ...geometry.step_count import largest_step, step_count, turn_segments
from ...issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...parameters.bead_classes import FIRST_LAYER, WALL
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import RevolutionParameters
from ...process import bead_order, classes
from ...slicing import revolution
from ...toolpath import Bead, BeadRole, Layer, MotionRules, Toolpath
from ...types import Array, Index
from .. import estimated_size
from ..clearance.nozzle_check import SEAM
from ..progress import Progress, silent
from . import clearance
from .clearance import Deposit, Tips
from .tilt import Tilting

SPACING_BAND = 0.2  # fraction of the layer height; maximum deviation (Chalvin 2020, section 2.1)


@dataclass(frozen=True, eq=False)
class Slices:
    """Beads of all layers in print order: layer index (m,), radius and height (m,) mm, tangent (m, 2)."""

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
    """Plan the toolpath of a wall of revolution.

    Layers are spaced by arc length or height. The chord error determines the number of points per
    bead. Build directions follow from the mode; they are capped, and tilted back until the nozzle
    is clear. A spiral is one layer with one open bead.

    Parameters
    ----------
    wall : RevolvedWall
        The wall.
    strategy : RevolutionParameters
        Layer height, spacing, path and chord error.
    build : BuildDirectionParameters
        Build direction and its limits.
    process : ProcessParameters
        Speeds, seam and direction.
    nozzle : NozzleParameters
        The nozzle to keep clear.
    platform_diameter : float
        Diameter of the platform, mm; 0 without a platform.
    platform_frame : (4, 4) array or None, optional
        Pose of the platform in part coordinates; None if the feature frame is on it.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        BAD_VALUE, LAYER_HEIGHT, NOT_FOR_FAMILY, OFF_PLATFORM, PARTIAL_TURN, TOO_MANY.

    References
    ----------
    Chalvin 2020, sections 2.1 and 6.1.
    """
    if build.mode == "symmetry-plane":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "symmetry-plane is not for parts of revolution; use local, layer or fixed",
        )
    estimated_size.refuse_absurd(estimated_size.revolution_size(wall, strategy), strategy)
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
                "process.travel_speed, or remove the waiting time",
            )
        layers, plan_issues = spiral_layers(wall, strategy, process, tilting)
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
        bead_width=process.bead_width,
        rules=MotionRules(process.overlap),
    )


def sliced(wall: RevolvedWall, strategy: RevolutionParameters) -> tuple[Slices, list[Issue]]:
    """Slice a wall of revolution into the beads of its layers.

    A bead with a radius of at most the chord error would be a point and is skipped.

    Parameters
    ----------
    wall : RevolvedWall
        The wall.
    strategy : RevolutionParameters
        Layer height, spacing and chord error.

    Returns
    -------
    slices : Slices
        The beads in print order.
    issues : list of Issue
        Notes on the remainder at the top, skipped beads and uneven spacing.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the wall is lower than a layer height.
    """
    meridian = wall.meridian
    along_wall = strategy.spacing == "arc-length"
    levels = revolution.arc_length_levels if along_wall else revolution.iso_height_levels
    layers, remainder = levels(meridian, strategy.layer_height)
    issues = []
    if remainder > 1e-6 * strategy.layer_height:
        measure = "of the wall" if along_wall else "of the height"
        issues.append(
            Issue(
                NOTE,
                "REMAINDER",
                Text(
                    "{:.3g} mm {} at the top, less than a layer, are not deposited",
                    remainder,
                    Word(measure),
                ),
            )
        )
    if not along_wall:
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
    gaps = [revolution.spacing(wall.meridian, a, b) for a, b in pairwise(layers)]
    widest = np.array([gap.max() for gap in gaps])
    narrowest = np.array([gap.min() for gap in gaps])
    over = (1.0 + SPACING_BAND + 1e-9) * layer_height
    under = (1.0 - SPACING_BAND - 1e-9) * layer_height
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
                "{} of {} layers deviate by more than 20 % from the layer height of {:g} mm, the "
                "first of them layer {}; layer {} is {:.4g} mm above the previous layer; for "
                "even layers use spacing: arc-length",
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
    """Build the layers by rotating the beads about the axis; first_tilting: tilting on the first layer."""
    azimuths, rising = [], []
    for index, (layer, radius) in enumerate(zip(slices.layer, slices.radius, strict=True)):
        segments = turn_segments(
            radius, strategy.chord_error, wall.end - wall.start, strategy.min_points
        )
        up = bead_order.rising(process, int(layer) if wall.full else index, wall.full)
        rising.append(up)
        azimuths.append(
            bead_order.closed_azimuths(process, int(layer), segments, up)
            if wall.full
            else bead_order.open_azimuths(wall.start, wall.end, segments, up)
        )
    builds, tools, issues = tilting.resolve(
        slices.radius, slices.height, slices.tangent, azimuths, rising, slices.layer
    )
    if first_tilting.parameters != tilting.parameters:  # no layer with another lean is below
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
        angles[-1] = angles[0]  # first and last point are bit-identical
    n = len(azimuth)
    points = wall.points(np.full(n, slices.radius[index]), np.full(n, slices.height[index]), angles)
    return Bead(
        points,
        wall.directions(build, angles),
        wall.directions(tool, angles),
        azimuth,
        np.full(n, speed),
        wall.full,
        role=BeadRole(bead_class=name),
    )


# ---- The wall as one continuous open bead that rises by a layer height per turn along the wall

PER_TURN = 8  # positions per turn at which the tilt-back is computed


def spiral_layers(
    wall: RevolvedWall, strategy: RevolutionParameters, process: ProcessParameters, tilting: Tilting
) -> tuple[tuple[Layer, ...], list[Issue]]:
    """Return the spiral of a wall as one layer with one open bead.

    The spiral starts with a full turn on the base circle, rises by a layer height per turn along
    the wall, and ends with a full turn at an open top. On a top closed on the axis it ends where
    the radius is half a layer height. The bead's parameter is the angle unwrapped over all turns.

    Parameters
    ----------
    wall : RevolvedWall
        The wall.
    strategy : RevolutionParameters
        Layer height and chord error.
    process : ProcessParameters
        Travel speed, seam and direction.
    tilting : Tilting
        Build directions and clearance.

    Returns
    -------
    layers : tuple of Layer
        The layer.
    issues : list of Issue
        Notes on tilts and on over-deposited turns.

    Raises
    ------
    InputError
        PARTIAL_TURN for a wall that is not a full turn; LAYER_HEIGHT as for layers.

    References
    ----------
    Chalvin 2020, section 6.1.
    """
    if not wall.full:
        raise InputError(
            "PARTIAL_TURN", "strategy.path", "{} is not a full turn; use path: layers", wall.label
        )
    pitch = strategy.layer_height
    revolution.arc_length_levels(wall.meridian, pitch)
    end = _end(wall.meridian, pitch)
    turns = _turn_angles(wall.meridian, end, pitch, strategy)
    s = np.clip(pitch * (turns / (2.0 * math.pi) - 1.0), 0.0, end)
    radius, height, _ = wall.meridian.at(s)
    rising = bead_order.rising(process, 0, True)
    parameter = process.seam.angle + (turns if rising else -turns)
    build, tool, issues = _directions(wall.meridian, turns, s, rising, tilting)
    bead = Bead(
        wall.points(radius, height, parameter),
        wall.directions(build, parameter),
        wall.directions(tool, parameter),
        parameter,
        np.full(len(s), process.for_class(WALL).travel_speed),
        False,
        role=BeadRole(bead_class=WALL),
    )
    ends = _over_itself(turns, end, pitch, wall.meridian.closed_top)
    return (Layer((bead,)),), [*issues, *ends]


def _over_itself(turns: Array, end: float, pitch: float, closed_top: bool) -> list[Issue]:
    """Return notes where the spiral is less than a layer height above its previous turn.

    This is in the turn that rises from the flat first turn, and in the flat last turn at an open top.
    """
    issues = []
    start = int(np.searchsorted(turns, 2.0 * math.pi - 1e-9))
    if end > 0.0 and start < len(turns) - 1:
        text = Text(
            "from here the second turn rises from 0 to {:g} mm above the flat first turn, so the "
            "first half of the second turn is over-deposited; machine the foot, or use path: "
            "layers",
            pitch,
        )
        issues.append(Issue(NOTE, "DEPOSITED_TWICE", text, 0, 0, start))
    last_start = int(np.searchsorted(turns, turns[-1] - 2.0 * math.pi - 1e-9))
    if not closed_top and start < last_start < len(turns) - 1:
        text = Text(
            "from here the flat last turn descends from {:g} to 0 mm above the previous turn, so "
            "the second half of the last turn is over-deposited; machine the top, or use path: "
            "layers",
            pitch,
        )
        issues.append(Issue(NOTE, "DEPOSITED_TWICE", text, 0, 0, last_start))
    return issues


def _end(meridian: Meridian, pitch: float) -> float:
    """Return the arc length at which the spiral ends."""
    if not meridian.closed_top:
        return meridian.length
    low, high = 0.0, meridian.length
    inside = meridian.points[:, 0] > 0.5 * pitch
    if inside.any():
        last_inside = int(np.flatnonzero(inside)[-1])
        low, high = float(meridian.s[last_inside]), float(meridian.s[last_inside + 1])
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if meridian.at([middle])[0][0] > 0.5 * pitch else (low, middle)
    return low


def _turn_angles(
    meridian: Meridian, end: float, pitch: float, strategy: RevolutionParameters
) -> Array:
    """Return the angles (n,) of the spiral's points, rad, from 0.

    Each turn is divided evenly within the chord error, with a point on each kink.
    """
    flat_from = 2.0 * math.pi * (1.0 + end / pitch)
    total = flat_from + (0.0 if meridian.closed_top else 2.0 * math.pi)
    kinks = 2.0 * math.pi * (1.0 + meridian.kinks / pitch)
    stops = np.unique(
        np.r_[np.arange(0.0, total, 2.0 * math.pi), total, flat_from, kinks[kinks < flat_from]]
    )
    stops = stops[np.r_[True, np.diff(stops) > 1e-6]]
    stops[-1] = total
    sections = [
        np.linspace(a, b, _segments(meridian, a, b, pitch, end, strategy) + 1)[:-1]
        for a, b in pairwise(stops)
    ]
    turns: Array = np.concatenate([*sections, [total]])
    return turns


def _segments(
    meridian: Meridian, a: float, b: float, pitch: float, end: float, strategy: RevolutionParameters
) -> int:
    """Return the number of segments between two angles; the curve's second derivative bounds the chord error."""
    rate = pitch / (2.0 * math.pi)
    s = np.clip(rate * (np.linspace(a, b, 17) - 2.0 * math.pi), 0.0, end)
    radius, _, tangent = meridian.at(s)
    bend = np.linalg.norm(np.diff(tangent, axis=0), axis=1)[1:-1] / np.maximum(
        np.diff(s)[1:-1], 1e-12
    )
    # 1.05: the meridian's curvature is sampled, not bounded
    acceleration = math.hypot(radius.max() + 1.05 * bend.max() * rate**2, 2.0 * rate)
    step = min(
        largest_step(acceleration, strategy.chord_error), 2.0 * math.pi / strategy.min_points
    )
    return math.ceil((b - a) / step - 1e-9)


def _directions(
    meridian: Meridian, turns: Array, s: Array, rising: bool, tilting: Tilting
) -> tuple[Array, Array, list[Issue]]:
    """Return build directions and tool axes (n, 3) at angles and arc lengths (n,).

    The tilt-back is computed at PER_TURN positions per turn. In between it is interpolated from the larger of adjacent
    values, so that it is never too small.
    """
    knots = np.linspace(0.0, turns[-1], step_count(turns[-1] * PER_TURN, 2.0 * math.pi) + 1)
    knot_s = np.interp(knots, turns, s)
    radius, height, tangent = meridian.at(knot_s)
    sense = 1.0 if rising else -1.0
    points = meridian.at(s)
    number = np.arange(len(s))

    def tips(where: tuple[Array, Array, Array], turned: Array, moment: Index) -> Tips:
        # deposit of the previous turn belongs to the current layer
        own_moment = np.searchsorted(turns, turned - 2.0 * math.pi - SEAM)
        return Tips(where[0], where[1], sense * turned, moment, own_moment)

    deposit = Deposit(
        points[0],
        points[1],
        sense * turns,
        tilting.build(points[2]),
        number,
        number == 0,
        np.interp(turns, knots, np.arange(len(knots))),
        tilting.size,
    )
    knot_tips = tips((radius, height, tangent), knots, np.searchsorted(turns, knots, side="right"))
    back, issues = tilting.tilt_back(
        tangent, rising, knot_tips, deposit, tips(points, turns, number + 1)
    )
    build, tool = tilting.axes(points[2], np.interp(turns, knots, back), rising)
    return build, tool, issues
