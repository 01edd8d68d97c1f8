# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on an existing part: a wall in, layers of beads with build directions out (Chalvin 2019)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry.surface import dot
from ..geometry.surface_wall import Array, Placed, SurfaceWall
from ..issues import NOTE, WARNING, InputError, Issue
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import SurfaceParameters
from ..slicing import constant_distance, iso_parameter, smooth_spacing
from ..slicing.curve_points import within_chord
from ..slicing.first_layer import on_polyline
from ..slicing.wall_layer import WallLayer, local_distances
from ..toolpath import Bead, Layer, Toolpath
from . import surface_directions
from .surface_end import Stretch, trimmed

TURN = 2.0 * np.pi
FINER = 4  # places per arc of a layer at which its distance from the one below is measured


def plan(
    wall: SurfaceWall, strategy: SurfaceParameters, build: BuildDirectionParameters, process: ProcessParameters
) -> Toolpath:
    """The toolpath of a wall around a closed direction, in part coordinates.

    The first layer lies where the wall leaves the substrate; closed beads start at the seam's angle around the wall. The
    polynomial's variable is the arc length of the bead, one turn (2 pi) from end to end. Raises InputError 'NOT_YET',
    'LAYER_HEIGHT', 'BAND', 'NOT_AROUND', 'TOO_LOW', 'NO_SYMMETRY_PLANE', 'NO_DIRECTION'.
    """
    surface_directions.refuse(wall, build)
    surface = wall.surface()
    curves = sliced(wall, surface, strategy)
    issues = _spacing_issues(curves, strategy) + _corner_notes(surface, curves, strategy)
    stretches, notes = _stretches(wall, surface, curves, strategy)
    layers, found = _layers(wall, surface, stretches, strategy, build, process)
    return Toolpath(
        layers, np.eye(4), strategy.layer_height, strategy.chord_error, (*issues, *notes, *found), process.overlap, "surface"
    )


def sliced(wall: SurfaceWall, surface: Placed, strategy: SurfaceParameters) -> list[WallLayer]:
    """The fronts from the substrate up, the last of them at or past the end of the wall somewhere."""
    first = on_polyline(surface, wall.first, label=wall.label)
    if strategy.spacing == "smooth":
        found = smooth_spacing.layers(
            surface, first, strategy.layer_height, wall.end, strategy.band, strategy.bead_turn, label=wall.label
        )
        return [first, *(smoothed.layer for smoothed in found)]
    rule = constant_distance.layers if strategy.spacing == "constant-distance" else iso_parameter.layers
    return rule(surface, first, strategy.layer_height, wall.end, label=wall.label)


def _stretches(
    wall: SurfaceWall, surface: Placed, fronts: list[WallLayer], strategy: SurfaceParameters
) -> tuple[list[list[Stretch]], list[Issue]]:
    """What is deposited of each front: all of it, or what lies below the end of the wall."""
    pieces = [trimmed(surface, front, wall.end) for front in fronts]
    whole = [len(some) == 1 and some[0].closed for some in pieces]
    count = whole.index(False) if False in whole else len(whole)
    if count == 0:
        raise InputError("TOO_LOW", wall.label, "its end does not lie above the substrate all around; make it longer")
    if strategy.end == "whole":
        left = float(((wall.end - fronts[count - 1].u) * _pace(surface, fronts[count - 1])).max())
        note = Issue(NOTE, "REMAINDER", f"up to {left:.4g} mm of the wall are left above the last whole layer", count - 1)
        return pieces[:count], [note] if left > 1e-6 * strategy.layer_height else []
    kept = [[piece for piece in some if piece.length(front.curve) > 0.5 * strategy.layer_height]
            for front, some in zip(fronts, pieces, strict=True)]
    dropped = sum(map(len, pieces)) - sum(map(len, kept))
    issues = []
    if dropped:
        text = f"{dropped} bead(s) at the end shorter than half a layer height are left out"
        issues.append(Issue(NOTE, "SHORT_BEADS", text))
    while not kept[-1]:
        kept.pop()
    return kept, issues


def _pace(surface: Placed, front: WallLayer) -> Array:
    pace: Array = np.linalg.norm(surface.derivatives(front.u, front.v)[1], axis=1)
    return pace


def _layers(
    wall: SurfaceWall, surface: Placed, stretches: list[list[Stretch]], strategy: SurfaceParameters,
    build: BuildDirectionParameters, process: ProcessParameters,
) -> tuple[tuple[Layer, ...], list[Issue]]:
    side = _outside(surface, stretches[0][0])
    layers, number, most, where = [], 0, 0.0, 0
    for index, pieces in enumerate(stretches):
        beads = []
        for piece in pieces:
            start = process.seam.angle + index * process.seam.step
            w = _places(piece, start, strategy.chord_error)
            points, along, tangents = _along(surface, piece, w, side)
            if _backwards(piece.closed, points, along, process, index, number):
                points, along, tangents = points[::-1], _reversed(along), -tangents[::-1, ::-1]
            up, tool, back = surface_directions.directions(wall, along, build)
            if back > most:
                most, where = back, index
            beads.append(_bead(points, tangents, up, tool, piece.closed, process.travel_speed))
            number += 1
        layers.append(Layer(tuple(beads)))
    return tuple(layers), surface_directions.cap_note(most, where)


def _places(piece: Stretch, start: float, chord_error: float) -> Array:
    curve = piece.front.curve
    if not piece.closed:
        return within_chord(curve, piece.low, piece.high, chord_error)
    low = float(curve.wrapped(np.array([start]))[0])
    return within_chord(curve, low, low + curve.period, chord_error)


@dataclass(frozen=True)
class _Side:
    """Which way the normal of derivatives points out of the wall: 1 or -1."""

    sign: float


def _outside(surface: Placed, piece: Stretch) -> _Side:
    front = piece.front
    point, rise, turn = surface.derivatives(front.u, front.v)
    out = dot(np.cross(rise, turn), point - point[:-1].mean(axis=0))
    return _Side(float(np.sign(out.sum())))


def _along(surface: Placed, piece: Stretch, w: Array, side: _Side) -> tuple[Array, surface_directions.Along, Array]:
    """Points of a bead, the directions there - at a corner those halfway between its two sides - and its tangents
    (n, 2, 3) arriving at and leaving each point."""
    curve = piece.front.curve
    points, leaving, _ = curve.at(w)
    if piece.closed:
        points[-1] = points[0]  # the last point is the first, to the bit
    arriving = leaving.copy()
    corners = curve.corners
    if len(corners):
        node = np.clip(np.searchsorted(curve.w[corners], curve.wrapped(w) - 1e-12), 0, len(corners) - 1)
        at = np.abs(curve.w[corners][node] - curve.wrapped(w)) < 1e-9 * curve.period
        arriving[at], leaving[at] = curve.into[corners[node[at]]], curve.out[corners[node[at]]]
    if not piece.closed:
        arriving[0], leaving[-1] = leaving[0], arriving[-1]
    u, v = surface.inverse(points)
    _, rise, turn = surface.derivatives(u, v)
    normal = _unit(np.cross(rise, turn)) * side.sign
    up, forward = np.zeros_like(points), np.zeros_like(points)
    tangents = _unit(np.stack([arriving, leaving], axis=1))
    for tangent in (tangents[:, 0], tangents[:, 1]):
        up += _unit(rise - dot(rise, tangent)[:, None] * tangent)
        forward += tangent
    return points, surface_directions.Along(_unit(forward), _unit(up), normal), tangents


def _backwards(
    closed: bool, points: Array, along: surface_directions.Along, process: ProcessParameters, layer: int, number: int
) -> bool:
    """Whether a bead runs against rising v. Counter-clockwise is meant against the build direction."""
    if not closed:
        return process.direction == "alternate" and number % 2 == 1
    turning = np.cross(points[:-1], points[1:]).sum(axis=0) @ along.up.mean(axis=0)
    wanted = process.direction != "clockwise" if process.direction != "alternate" else layer % 2 == 0
    return bool((turning > 0.0) != wanted)


def _reversed(along: surface_directions.Along) -> surface_directions.Along:
    return surface_directions.Along(-along.forward[::-1], along.up[::-1], along.out[::-1])


def _bead(points: Array, tangents: Array, up: Array, tool: Array, closed: bool, speed: float) -> Bead:
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(points, up, tool, TURN * length / length[-1], np.full(len(points), speed), closed, None, tangents)


def _spacing_issues(fronts: list[WallLayer], strategy: SurfaceParameters) -> list[Issue]:
    """What the local distance is, and a warning where it is not what was asked for."""
    if len(fronts) < 2:
        return []
    found = [local_distances(above, below, FINER)[1] for below, above in zip(fronts[:-1], fronts[1:])]
    least, most = min(d.min() for d in found), max(d.max() for d in found)
    height = strategy.layer_height
    exact = strategy.spacing == "constant-distance"
    # between the points, where arcs stand for the front, ten times the tolerance is allowed
    allowed = 10.0 * strategy.tolerance if exact else strategy.band * height
    text = f"the local distance between layers is {least:.6g} to {most:.6g} mm"
    if max(height - least, most - height) <= allowed:
        return [Issue(NOTE, "SPACING", text)]
    worst = int(np.argmax([np.abs(d - height).max() for d in found])) + 1
    advice = "a larger strategy.tolerance says that this will do" if exact else "spacing: constant-distance is even"
    return [Issue(WARNING, "SPACING", f"{text}, the layer height {height:g} mm; {advice}", worst)]


def _corner_notes(surface: Placed, fronts: list[WallLayer], strategy: SurfaceParameters) -> list[Issue]:
    """Corners that fronts have formed, for a robot slows down there; where there are none, the sharpest turn."""
    cornered = [index for index, front in enumerate(fronts) if len(front.curve.corners)]
    if not cornered:
        rates = [float(smooth_spacing.turns_in_wall(surface, front).max()) for front in fronts]
        # the first layer is the substrate's
        over = [index for index, rate in enumerate(rates) if index and rate > strategy.bead_turn]
        if strategy.spacing == "smooth" and over:
            return [Issue(
                WARNING, "TURN",
                f"a band of {100.0 * strategy.band:g} % does not suffice: within the wall {len(over)} of {len(fronts)} "
                f"layers turn by more than {np.degrees(strategy.bead_turn):.3g} deg/mm, first layer {over[0]}, by up to "
                f"{np.degrees(max(rates[1:])):.3g} deg/mm. The robot slows down there; a wider strategy.band rounds them",
                int(np.argmax(rates[1:])) + 1,
            )]
        text = f"no layer has a corner; within the wall they turn by up to {np.degrees(max(rates)):.3g} deg/mm"
        return [Issue(NOTE, "TURN", text, int(np.argmax(rates)))]
    turns = [float(front.curve.turns.max()) for front in fronts]
    return [Issue(
        NOTE, "CORNERS",
        f"{len(cornered)} of {len(fronts)} fronts have corners, first layer {cornered[0]}; the sharpest turns by "
        f"{np.degrees(max(turns)):.3g} deg. The robot slows down there", int(np.argmax(turns)),
    )]


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
