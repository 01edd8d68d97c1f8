# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on an existing part: layers of beads with build directions (Chalvin 2019)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.frames import unit
from ...geometry.walls.surface import dot
from ...geometry.walls.surface_wall import Placed, SurfaceWall
from ...issues import NOTE, InputError, Issue, Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import SurfaceParameters
from ...slicing.curve_points import sample_within_chord
from ...slicing.first_layer import interpolate_polyline
from ...slicing.tubes import constant_distance, iso_parameter, smooth_spacing
from ...slicing.tubes.smooth_spacing import WallLayer, local_distances
from ...toolpath import Layer, MotionRules, Toolpath
from ...types import Array, Mask
from .. import estimated_size
from ..progress import Progress, silent
from .beads import (
    Along,
    BeadSettings,
    Traced,
    corner_notes,
    directions_along,
    notes,
    short_note,
    spacing_issues,
    symmetry_plane,
    traced,
    turn_notes,
)

FINER = 4  # samples per arc of a layer at which the distance from the layer below is measured


def plan(
    wall: SurfaceWall,
    strategy: SurfaceParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    progress: Progress = silent,
) -> Toolpath:
    """Plan the toolpath of a wall around a closed direction.

    The first layer is where the wall meets the substrate. Closed beads start at the seam angle
    around the wall. The variable of the polynomial is the arc length of the bead, scaled to
    one turn (2 pi).

    Parameters
    ----------
    wall : SurfaceWall
        The wall.
    strategy : SurfaceParameters
        Layer height, spacing and chord error.
    build : BuildDirectionParameters
        Build direction and its limits.
    process : ProcessParameters
        Speeds, seam and direction.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        NOT_YET, LAYER_HEIGHT, BAND, NOT_AROUND, TOO_LOW, TOO_MANY, NO_SYMMETRY_PLANE,
        NO_DIRECTION.

    References
    ----------
    Chalvin 2019.
    """
    estimated_size.refuse_absurd(estimated_size.tube_size(wall, strategy), strategy)
    settings = BeadSettings(build, process, symmetry_plane(wall, build), wall.label)
    surface = wall.surface()
    progress(0.0, "finding layers")
    curves = sliced(wall, surface, strategy)
    stretches, omitted = _stretches(wall, surface, curves, strategy)
    curves = curves[: len(stretches)]  # only deposited layers are reported
    progress(0.5, Text("measuring {} layers", len(curves)))
    distances = [
        local_distances(above, below, FINER)[1]
        for below, above in zip(curves[:-1], curves[1:], strict=True)
    ]
    issues = spacing_issues(distances, strategy) + _corner_notes(
        surface, curves, stretches, strategy
    )
    progress(0.7, "build directions")
    layers, departures = _layers(surface, stretches, strategy, settings)
    return Toolpath(
        layers,
        np.eye(4),
        strategy.layer_height,
        strategy.chord_error,
        (*issues, *omitted, *departures),
        "surface",
        bead_width=process.bead_width,
        rules=MotionRules(process.overlap),
    )


def sliced(wall: SurfaceWall, surface: Placed, strategy: SurfaceParameters) -> list[WallLayer]:
    """Slice a wall into fronts, from the substrate up.

    Parameters
    ----------
    wall : SurfaceWall
        The wall.
    surface : Placed
        Surface of the wall.
    strategy : SurfaceParameters
        Layer height, spacing, band and maximum turn rate.

    Returns
    -------
    list of WallLayer
        The fronts; the last front reaches or passes the end of the wall at some point.
    """
    first_layer = interpolate_polyline(surface, wall.first, label=wall.label)
    if strategy.spacing == "smooth":
        smoothed_layers = smooth_spacing.layers(
            surface,
            first_layer,
            strategy.layer_height,
            wall.end,
            strategy.band,
            strategy.bead_turn,
            label=wall.label,
        )
        return [first_layer, *(smoothed.layer for smoothed in smoothed_layers)]
    rule = (
        constant_distance.layers
        if strategy.spacing == "constant-distance"
        else iso_parameter.layers
    )
    return rule(surface, first_layer, strategy.layer_height, wall.end, label=wall.label)


def _stretches(
    wall: SurfaceWall, surface: Placed, fronts: list[WallLayer], strategy: SurfaceParameters
) -> tuple[list[list[Stretch]], list[Issue]]:
    """Return the deposited stretches of each front: the whole front, or the stretches below the wall's end."""
    stretches = [trimmed(surface, front, wall.end) for front in fronts]
    is_whole = [
        len(layer_stretches) == 1 and layer_stretches[0].closed for layer_stretches in stretches
    ]
    count = is_whole.index(False) if False in is_whole else len(is_whole)
    if count == 0:
        raise InputError(
            "TOO_LOW",
            wall.label,
            "the end of the wall is not above the substrate all around; make the wall longer",
        )
    if strategy.end == "whole":
        remainder = float(
            ((wall.end - fronts[count - 1].u) * _rate(surface, fronts[count - 1])).max()
        )
        note = Issue(
            NOTE,
            "REMAINDER",
            Text(
                "up to {:.4g} mm of the wall above the last whole layer are not deposited",
                remainder,
            ),
            count - 1,
        )
        return stretches[:count], [note] if remainder > 1e-6 * strategy.layer_height else []
    kept_layers = [
        [
            stretch
            for stretch in layer_stretches
            if stretch.length(front.curve) > 0.5 * strategy.layer_height
        ]
        for front, layer_stretches in zip(fronts, stretches, strict=True)
    ]
    dropped = sum(map(len, stretches)) - sum(map(len, kept_layers))
    while not kept_layers[-1]:
        kept_layers.pop()
    return kept_layers, short_note(dropped)


def _rate(surface: Placed, front: WallLayer) -> Array:
    rate: Array = np.linalg.norm(surface.derivatives(front.u, front.v)[1], axis=1)
    return rate


def _layers(
    surface: Placed,
    stretches: list[list[Stretch]],
    strategy: SurfaceParameters,
    settings: BeadSettings,
) -> tuple[tuple[Layer, ...], list[Issue]]:
    side = _outside(surface, stretches[0][0])
    process, layers, number, keyed_directions = settings.process, [], 0, []
    for index, layer in enumerate(stretches):
        beads = []
        for stretch in layer:
            start = process.seam.angle + index * process.seam.step
            trace = traced(
                stretch.front.curve,
                _parameters(stretch, start, strategy.chord_error),
                stretch.closed,
            )
            vectors = _wall_directions(surface, trace, side)
            if _backwards(trace, vectors, process, index, number):
                trace, vectors = trace.reversed(), vectors.reversed()
            bead, directions = settings.bead(trace, vectors, index)
            beads.append(bead)
            keyed_directions.append((index, directions))
            number += 1
        layers.append(Layer(tuple(beads)))
    return tuple(layers), notes(keyed_directions)


def _parameters(stretch: Stretch, start: float, chord_error: float) -> Array:
    curve = stretch.front.curve
    if not stretch.closed:
        return sample_within_chord(curve, stretch.low, stretch.high, chord_error)
    low = float(curve.wrap(np.array([start]))[0])
    return sample_within_chord(curve, low, low + curve.period, chord_error)


@dataclass(frozen=True)
class _Side:
    """Sign, 1 or -1, that makes the normal from derivatives point out of the wall."""

    sign: float


def _outside(surface: Placed, stretch: Stretch) -> _Side:
    front = stretch.front
    point, rise, turn = surface.derivatives(front.u, front.v)
    out = dot(np.cross(rise, turn), point - point[:-1].mean(axis=0))
    return _Side(float(np.sign(out.sum())))


def _wall_directions(surface: Placed, trace: Traced, side: _Side) -> Along:
    u, v = surface.inverse(trace.points)
    _, rise, turn = surface.derivatives(u, v)
    return directions_along(trace, unit(np.cross(rise, turn)) * side.sign, rise)


def _backwards(
    trace: Traced, vectors: Along, process: ProcessParameters, layer: int, number: int
) -> bool:
    """Whether a bead runs against rising v; counter-clockwise is seen against the build direction."""
    if not trace.closed:
        return process.direction == "alternate" and number % 2 == 1
    turning = np.cross(trace.points[:-1], trace.points[1:]).sum(axis=0) @ vectors.up.mean(axis=0)
    is_counter_clockwise = (
        process.direction != "clockwise" if process.direction != "alternate" else layer % 2 == 0
    )
    return bool((turning > 0.0) != is_counter_clockwise)


def _corner_notes(
    surface: Placed,
    fronts: list[WallLayer],
    stretches: list[list[Stretch]],
    strategy: SurfaceParameters,
) -> list[Issue]:
    """Report corners of deposited fronts, where a robot slows down; without corners, the sharpest turn."""
    turns = [_corners(front.curve, layer) for front, layer in zip(fronts, stretches, strict=True)]
    if not any(map(len, turns)):
        return turn_notes(
            [float(smooth_spacing.turns_in_wall(surface, front).max()) for front in fronts],
            strategy,
        )
    return corner_notes(turns)


def _corners(curve: SpaceCurve, stretches: list[Stretch]) -> Array:
    """Return the turn angles (k,) at the corners of a front on its stretches, rad."""
    w = curve.w[curve.corners]
    on = [
        np.mod(w - stretch.low, curve.period) <= stretch.high - stretch.low for stretch in stretches
    ]
    turns: Array = curve.turns[curve.corners][np.any(on, axis=0)] if stretches else np.empty(0)
    return turns


# ---- Fronts below the end of a wall: whole, or open stretches that end flush with the wall

SAME_END = 1e-6  # mm; maximum height above the end of a point on the end
SAMPLES_PER_ARC = 8  # samples per arc that are classified as above or below the end
HALVINGS = 48


@dataclass(frozen=True)
class Stretch:
    """A part of a front between two parameters; a closed stretch is the whole front."""

    front: WallLayer
    low: float
    high: float
    closed: bool

    def length(self, curve: SpaceCurve) -> float:
        """Return the length of the stretch, mm."""
        points = curve.at(np.linspace(self.low, self.high, 200))[0]
        return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def trimmed(surface: Placed, front: WallLayer, end: float) -> list[Stretch]:
    """Return the stretches of a front below the end of the wall.

    Parameters
    ----------
    surface : Placed
        The wall.
    front : WallLayer
        The front.
    end : float
        End of the wall in u.

    Returns
    -------
    list of Stretch
        The stretches in parameter order; empty if the whole front is above the end.
    """
    curve = front.curve
    w = curve.refined(SAMPLES_PER_ARC)
    inside = _below(surface, front, w, end)
    if inside.all():
        return [Stretch(front, float(w[0]), float(w[-1]), True)]
    if not inside.any():
        return []
    start = int(np.flatnonzero(~inside)[0])
    count = len(w) - 1
    order = np.r_[start:count, 0 : start + 1]
    w = w[order] + np.where(np.arange(count + 1) >= count - start, curve.period, 0.0)
    inside = inside[order]
    enters = np.flatnonzero(~inside[:-1] & inside[1:])
    leaves = np.flatnonzero(inside[:-1] & ~inside[1:])
    low = _crossing(surface, front, w[enters], w[enters + 1], end, True)
    high = _crossing(surface, front, w[leaves], w[leaves + 1], end, False)
    return [Stretch(front, float(a), float(b), False) for a, b in zip(low, high, strict=True)]


def _below(surface: Placed, front: WallLayer, w: Array, end: float) -> Mask:
    """Return which positions (n,) of a front are below the end.

    If u is an angle, as along a bend, the surface determines u only up to whole turns. The front then gives the turn.
    """
    u, v = surface.inverse(front.curve.at(w)[0])
    rate = np.linalg.norm(surface.derivatives(u, v)[1], axis=1)
    if surface.rise_period is not None:
        about = front.heights(surface, front.curve.wrap(w))[0]
        u = u + surface.rise_period * np.round((about - u) / surface.rise_period)
    below: Mask = (u - end) * rate <= SAME_END
    return below


def _crossing(
    surface: Placed, front: WallLayer, low: Array, high: Array, end: float, entering: bool
) -> Array:
    """Return where the front crosses the end between two parameters, on the side below the end."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        below = _below(surface, front, middle, end) == entering
        low, high = np.where(below, low, middle), np.where(below, middle, high)
    return high if entering else low
