# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on an existing part without a closed parameter: several faces, open shells, openings, branches.

Layers are fronts of constant local distance (slicing.fronts), which split, merge, close and end at rims. Every bead of a
layer is on beads of the layer below, so layers follow each other; within a layer the bead that begins nearest to the last end
comes next.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.patch_wall import PatchWall
from ...issues import NOTE, InputError, Issue, Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import SurfaceParameters
from ...slicing.curve_points import sample_within_chord
from ...slicing.fronts import layers as slicing
from ...slicing.fronts.curve import Smoothing
from ...slicing.fronts.rims import Rims, local_distances, nearest_feet
from ...slicing.fronts.smooth import turn
from ...toolpath import Bead, Layer, Toolpath
from ...types import Array
from .. import size
from ..progress import Progress, silent
from .beads import (
    BeadSettings,
    corner_notes,
    directions_along,
    notes,
    short_note,
    spacing_issues,
    symmetry_plane,
    traced,
    turn_notes,
)
from .front_seams import Middle, seam
from .front_tree import Piece, drop_short_pieces, events, tree, uncut_pieces

FINER = 4  # places per arc of a front at which its distance from the layer below is measured
FINDING = 0.7  # of the time goes into finding the layers

# of walls their layers as last asked for, which take most of the time, and which directions do not change
_SLICED: WeakKeyDictionary[PatchWall, tuple[tuple[float, Smoothing | None], slicing.Sliced]] = (
    WeakKeyDictionary()
)


def plan(
    wall: PatchWall,
    strategy: SurfaceParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    progress: Progress = silent,
) -> Toolpath:
    """The toolpath of a wall of any connected smooth pieces, in part coordinates.

    Closed beads start at the seam's angle about the middle line of the wall, which runs through the centres of the closed
    beads, from the X of the part carried along it without twist. Counter-clockwise is meant as seen against the
    build direction of a tube; on any wall it keeps the layer below on the right, seen from outside. Raises InputError
    'NO_PARAMETER', 'LAYER_HEIGHT', 'TOO_LOW', 'TOO_MANY', 'NO_SYMMETRY_PLANE', 'NO_DIRECTION', 'TURN_LIMIT'.
    """
    _refuse(strategy)
    size.refuse_absurd(size.fronts_size(wall, strategy), strategy)
    settings = BeadSettings(build, process, symmetry_plane(wall, build), wall.label)
    height = strategy.layer_height
    smoothing = (
        Smoothing(strategy.band, strategy.bead_turn) if strategy.spacing == "smooth" else None
    )
    sliced = _sliced(wall, height, smoothing, progress)
    pieces = tree(sliced.fronts, sliced.rims)
    full = [len(layer) for layer in pieces]
    pieces, omitted = _deposited_pieces(pieces, sliced.rims, strategy, wall.label)
    fronts = [[piece.curve for piece in layer] for layer in pieces]  # only deposited layers count
    distances = [
        np.concatenate([local_distances(front, below, FINER) for front in layer])
        for below, layer in zip(sliced.fronts, fronts[1:])
    ]
    issues = spacing_issues(distances, strategy) + _turns(wall, fronts, strategy) + events(pieces)
    issues += omitted + _close(pieces, sliced.closing, full)
    progress(FINDING, "build directions")
    layers, departures = _layers(wall, pieces, strategy.chord_error, settings)
    return Toolpath(
        layers,
        wall.frame,
        height,
        strategy.chord_error,
        (*issues, *departures),
        process.overlap,
        "surface",
        bead_width=process.bead_width,
    )


def _sliced(
    wall: PatchWall, height: float, smoothing: Smoothing | None, progress: Progress
) -> slicing.Sliced:
    """The layers of a wall, as they were found before where they were."""
    if wall not in _SLICED or _SLICED[wall][0] != (height, smoothing):
        layers = slicing.slice_layers(
            wall, height, smoothing, lambda share, text: progress(FINDING * share, text)
        )
        _SLICED[wall] = (height, smoothing), layers
    return _SLICED[wall][1]


def _refuse(strategy: SurfaceParameters) -> None:
    if strategy.spacing == "iso-parameter":
        raise InputError(
            "NO_PARAMETER",
            "strategy.spacing",
            "the wall has no closed parameter for layers to follow (several faces, openings, a "
            "side or a slanted end); use constant-distance or smooth",
        )


def _turns(
    wall: PatchWall, fronts: list[list[SpaceCurve]], strategy: SurfaceParameters
) -> list[Issue]:
    """Corners that the fronts have formed, and how sharply smooth ones turn."""
    issues = corner_notes(
        [np.concatenate([front.turns[front.corners] for front in layer]) for layer in fronts]
    )
    if issues and strategy.spacing != "smooth":
        return issues
    rates = [
        np.inf
        if any(len(front.corners) for front in layer)
        else max(turn(wall, front) for front in layer)
        for layer in fronts
    ]
    return issues + turn_notes(rates, strategy)


def _deposited_pieces(
    pieces: list[list[Piece]], rims: Rims, strategy: SurfaceParameters, label: str
) -> tuple[list[list[Piece]], list[Issue]]:
    """The pieces that are deposited: all, or those below the first that an end of the wall cuts off."""
    if strategy.end != "whole":
        kept_layers, dropped = drop_short_pieces(pieces, 0.5 * strategy.layer_height)
        return kept_layers, short_note(dropped)
    kept_layers = uncut_pieces(pieces)
    if not kept_layers:
        raise InputError("TOO_LOW", label, "its end cuts the first layer; make it longer")
    top_curves = [piece.curve for layer in kept_layers for piece in layer if not piece.children]
    remainder = (
        float(nearest_feet(top_curves, rims.upper).distance.max())
        if top_curves and len(rims.upper)
        else 0.0
    )
    text = Text("up to {:.4g} mm of the wall remain above the last whole layer", remainder)
    note = Issue(NOTE, "REMAINDER", text, len(kept_layers) - 1)
    return kept_layers, [note] if remainder > 1e-4 * strategy.layer_height else []


def _close(
    pieces: list[list[Piece]], closing: list[list[SpaceCurve]], full: list[int]
) -> list[Issue]:
    """Append the closing beads to the pieces of their layers if the layer below is complete, with a note."""
    count, first_layer = 0, 0
    for index, curves in enumerate(closing):
        if not curves or index > len(pieces) or len(pieces[index - 1]) < full[index - 1]:
            continue
        if index == len(pieces):
            if index < len(full):
                break
            pieces.append([])
        pieces[index] += [Piece(curve, [], False, closing=True) for curve in curves]
        first_layer = first_layer or index
        count += len(curves)
    if not count:
        return []
    return [
        Issue(
            NOTE,
            "CLOSING",
            Text(
                "{} bead(s) close gaps between merging fronts, closer to them than a layer "
                "height; the first in layer {}",
                count,
                first_layer,
            ),
            first_layer,
        )
    ]


@dataclass(frozen=True, eq=False)
class _Way:
    """One way to run a piece: from which parameter on, whether against its curve, and its first point (3,)."""

    piece: Piece
    start: float
    backwards: bool
    start_point: Array


def _layers(
    wall: PatchWall, pieces: list[list[Piece]], chord_error: float, settings: BeadSettings
) -> tuple[tuple[Layer, ...], list[Issue]]:
    process, layers, keyed_directions, last_point = settings.process, [], [], None
    middles: dict[int, Middle] = {}
    for index, layer in enumerate(pieces):
        angle = process.seam.angle + index * process.seam.step
        open_runs = [_ways(piece, angle, middles, process, index) for piece in layer]
        beads: list[Bead] = []
        while open_runs:
            run = _nearest(open_runs, last_point)
            open_runs = [runs for runs in open_runs if runs[0].piece is not run.piece]
            curve = run.piece.curve
            trace = traced(
                curve,
                sample_within_chord(curve, run.start, run.start + curve.period, chord_error),
                curve.closed,
            )
            points, normal = wall.project(
                trace.points
            )  # arcs are off it between their nodes, if by next to nothing
            if curve.closed:
                points[-1] = points[0]
            trace = trace._replace(points=points)
            vectors = directions_along(
                trace, normal, np.cross(normal, trace.tangents.sum(axis=1))
            )  # up is on the left
            if run.backwards:
                trace, vectors = trace.reversed(), vectors.reversed()
            bead, directions = settings.bead(trace, vectors, index, run.piece.closing)
            beads.append(bead)
            keyed_directions.append((index, directions))
            last_point = trace.points[-1]
        layers.append(Layer(tuple(beads)))
    return tuple(layers), notes(keyed_directions)


def _ways(
    piece: Piece, angle: float, middles: dict[int, Middle], process: ProcessParameters, layer: int
) -> list[_Way]:
    """The ways in which a piece may be run. Fronts are counter-clockwise, see `slicing.fronts.layers.start`."""
    curve = piece.curve
    if curve.closed:
        start = seam(piece, angle, middles)
        clockwise = process.direction == "clockwise" or (
            process.direction == "alternate" and layer % 2 == 1
        )
        return [_Way(piece, start, clockwise, curve.at(np.array([start]))[0][0])]
    runs = [_Way(piece, float(curve.w[0]), False, curve.points[0])]
    if process.direction == "alternate":
        runs.append(_Way(piece, float(curve.w[0]), True, curve.points[-1]))
    return runs


def _nearest(open_runs: list[list[_Way]], last_point: Array | None) -> _Way:
    """The run that begins nearest to the last point (3,), initially the first; gaps are closed once the fronts about them are there."""
    candidates = [runs_ for runs_ in open_runs if not runs_[0].piece.closing] or open_runs
    if last_point is None:
        return candidates[0][0]
    all_runs = [run for runs_ in candidates for run in runs_]
    return all_runs[
        int(np.argmin([float(np.linalg.norm(run.start_point - last_point)) for run in all_runs]))
    ]
