# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls on an existing part without a closed parameter: several faces, open shells, openings, branches.

Layers are fronts of constant local distance (slicing.fronts), which split, merge, close and end at rims. Every bead is on
beads of the layer below, so layers are printed in order. Within a layer, the bead that begins nearest to the last end
point comes next.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...issues import NOTE, InputError, Issue, Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.process import ProcessParameters
from ...parameters.strategy import SurfaceParameters
from ...slicing.curve_points import sample_within_chord
from ...slicing.fronts import layers as slicing
from ...slicing.fronts.curve import Smoothing
from ...slicing.fronts.rims import Rims, local_distances, nearest_feet
from ...slicing.fronts.smooth import turn
from ...toolpath import Bead, Layer, MotionRules, Toolpath
from ...types import Array
from .. import estimated_size
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

ANGLES_PER_ARC = 4  # samples per arc of a front at which the angle is evaluated
HALVINGS = 40
ACROSS = 0.1  # minimum length of X projected normal to a unit axis; otherwise Y is the reference


class Middle(NamedTuple):
    """Centre of a closed front, with the reference for angles.

    centre: (3,). axis: (3,) unit axis about which the front runs counter-clockwise. reference: (3,) direction of angle
    0. start: (3,) first point of the front.
    """

    centre: Array
    axis: Array
    reference: Array
    start: Array


def seam(piece: Piece, angle: float, middles: dict[int, Middle]) -> float:
    """Return the parameter at which a closed front begins.

    At the first front, angle 0 is the part's X, or Y if X is along the axis. From front to front,
    the smallest rotation between the axes carries this direction. If several positions have the
    seam angle, the position nearest to the seam below is used.

    Parameters
    ----------
    piece : Piece
        The front.
    angle : float
        Angle of the seam about the front's centre, rad.
    middles : dict[int, Middle]
        Centres of the fronts below by id; this front's centre is added.

    Returns
    -------
    float
        The parameter.
    """
    curve = piece.curve
    w = curve.refined(ANGLES_PER_ARC)[:-1]
    points = curve.at(w)[0]
    ahead = np.roll(points, -1, axis=0)
    length = np.linalg.norm(ahead - points, axis=1)
    centre = (length[:, None] * 0.5 * (points + ahead)).sum(axis=0) / length.sum()
    axis = np.cross(points - centre, ahead - centre).sum(axis=0)
    axis /= np.linalg.norm(axis)
    below = next((middles[id(parent)] for parent in piece.parents if id(parent) in middles), None)
    reference = _carry_reference(below, axis) if below is not None else _reference(axis)
    # in a frame rotated by the seam angle, the front crosses X from below at the seam
    x = np.cos(angle) * reference + np.sin(angle) * np.cross(axis, reference)
    y = np.cross(axis, x)
    sideways = (points - centre) @ y
    next_sideways = np.roll(sideways, -1)
    out = (points - centre) @ x
    crossing = np.flatnonzero((sideways <= 0.0) & (next_sideways > 0.0) & (out > 0.0))
    if not len(crossing):
        crossing = np.array(
            [int(np.argmax(out / np.maximum(np.linalg.norm(points - centre, axis=1), 1e-300)))]
        )
    if below is not None:
        crossing = crossing[
            [int(np.argmin(np.linalg.norm(points[crossing] - below.start, axis=1)))]
        ]
    k = int(crossing[0])
    low, high = w[k], w[k + 1] if k + 1 < len(w) else curve.w[-1]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        side = float((curve.at(np.array([middle]))[0][0] - centre) @ y)
        low, high = (middle, high) if side <= 0.0 else (low, middle)
    start = 0.5 * (low + high)
    middles[id(piece)] = Middle(centre, axis, reference, curve.at(np.array([start]))[0][0])
    return float(start)


def _reference(axis: Array) -> Array:
    for direction in np.eye(3)[:2]:
        flat = direction - (direction @ axis) * axis
        length = np.linalg.norm(flat)
        if length > ACROSS:
            return np.asarray(flat / length)
    raise AssertionError("an axis is along X or along Y, not both")


def _carry_reference(below: Middle, axis: Array) -> Array:
    """Return the reference of the front below, rotated with the axis."""
    cosine = float(below.axis @ axis)
    if cosine < -1.0 + ACROSS:
        return _reference(axis)
    turn = np.cross(below.axis, axis)
    carried = (
        cosine * below.reference
        + np.cross(turn, below.reference)
        + turn * (turn @ below.reference) / (1.0 + cosine)
    )
    flat = carried - (carried @ axis) * axis
    return np.asarray(flat / np.sqrt(dot(flat, flat)))


# ---- Tree of a wall's fronts: splits, merges, and cuts by an end of the wall

SAMPLES = 100  # number of sample points along a front that determine its parents
LEAST_COMMON = 2  # minimum number of samples on a parent; with fewer, fronts only touch at an end


@dataclass(eq=False)
class Piece:
    """A front, or a bead that closes a gap between fronts (closing).

    parents: supporting fronts of the layer below, largest contact first. cut: whether the front ends at an upper edge of
    the wall.
    """

    curve: SpaceCurve
    parents: list[Piece]
    cut: bool
    children: list[Piece] = field(default_factory=list)
    closing: bool = False


def tree(fronts: list[list[SpaceCurve]], rims: Rims) -> list[list[Piece]]:
    """Return the pieces of each layer."""
    layers: list[list[Piece]] = []
    for layer in fronts:
        below = layers[-1] if layers else []
        pieces = [Piece(front, _parents(front, below), rims.ends_of(front)) for front in layer]
        for piece in pieces:
            for parent in piece.parents:
                parent.children.append(piece)
        layers.append(pieces)
    return layers


def _parents(front: SpaceCurve, below: list[Piece]) -> list[Piece]:
    if len(below) < 2:
        return list(below)
    points = front.at(
        np.linspace(front.w[0], front.w[-1], SAMPLES + 1)[:-1] + 0.5 * front.period / SAMPLES
    )[0]
    count = np.bincount(
        nearest_feet([piece.curve for piece in below], points).front, minlength=len(below)
    )
    order = np.argsort(-count, kind="stable")
    return [below[k] for k in order if count[k] >= LEAST_COMMON]


def events(layers: list[list[Piece]]) -> list[Issue]:
    """Return a note for each layer in which fronts split or merge."""
    issues = []
    for index, layer in enumerate(layers[1:], 1):
        splits = Counter(
            len(piece.children) for piece in layers[index - 1] if len(piece.children) > 1
        )
        merges = Counter(len(piece.parents) for piece in layer if len(piece.parents) > 1)
        for code, counts, singular, plural in (
            (
                "SPLIT",
                splits,
                "a front splits in {} at layer {}",
                "{2} fronts split in {0} each at layer {1}",
            ),
            (
                "MERGE",
                merges,
                "{} fronts merge at layer {}",
                "{0} fronts merge, in {2} places, at layer {1}",
            ),
        ):
            issues += [
                Issue(
                    NOTE, code, Text(singular if count == 1 else plural, size, index, count), index
                )
                for size, count in sorted(counts.items())
            ]
    return issues


def uncut_pieces(layers: list[list[Piece]]) -> list[list[Piece]]:
    """Return the uncut pieces that are entirely supported by uncut pieces."""
    kept_layers: list[list[Piece]] = []
    for layer in layers:
        below = set(kept_layers[-1]) if kept_layers else set()
        uncut = [piece for piece in layer if not piece.cut and below.issuperset(piece.parents)]
        if not uncut:
            break
        kept_layers.append(uncut)
    return _pruned(kept_layers)


def drop_short_pieces(layers: list[list[Piece]], shortest: float) -> tuple[list[list[Piece]], int]:
    """Remove short pieces without a piece above.

    Parameters
    ----------
    layers : list[list[Piece]]
        The pieces of each layer.
    shortest : float
        Minimum length of a kept piece, mm.

    Returns
    -------
    layers : list of list of Piece
        The remaining pieces, without empty layers.
    count : int
        Number of removed pieces.
    """
    dropped: set[Piece] = set()
    for layer in reversed(layers):
        dropped.update(
            piece
            for piece in layer
            if piece.curve.length < shortest and dropped.issuperset(piece.children)
        )
    kept_layers = [[piece for piece in layer if piece not in dropped] for layer in layers]
    return _pruned([layer for layer in kept_layers if layer]), len(dropped)


def _pruned(layers: list[list[Piece]]) -> list[list[Piece]]:
    """Remove links to pieces that are not in the layers."""
    remaining = {piece for layer in layers for piece in layer}
    for piece in remaining:
        piece.children = [child for child in piece.children if child in remaining]
    return layers


FINER = 4  # samples per arc of a front at which the distance from the layer below is measured
FINDING = 0.7  # fraction of the planning time spent on slicing

# cache of the last slicing of each wall: slicing takes most of the time and does not depend on directions
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
    """Plan the toolpath of a wall with any connected smooth pieces.

    Closed beads start at the seam angle about the wall's centreline, which runs through the
    centres of the closed beads. Angle 0 is the part's X, carried along the centreline without
    twist. Counter-clockwise is seen against the build direction of a tube. On any wall it keeps
    the layer below on the right, seen from outside.

    Parameters
    ----------
    wall : PatchWall
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
        NO_PARAMETER, LAYER_HEIGHT, TOO_LOW, TOO_MANY, NO_SYMMETRY_PLANE, NO_DIRECTION,
        TURN_LIMIT.
    """
    _refuse(strategy)
    estimated_size.refuse_absurd(estimated_size.fronts_size(wall, strategy), strategy)
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
        "surface",
        bead_width=process.bead_width,
        rules=MotionRules(process.overlap),
    )


def _sliced(
    wall: PatchWall, height: float, smoothing: Smoothing | None, progress: Progress
) -> slicing.Sliced:
    """Return the layers of a wall, from the cache if possible."""
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
    """Report corners of the fronts, and how sharply smooth fronts turn."""
    issues = corner_notes(
        [np.concatenate([front.turns[front.corners] for front in layer]) for layer in fronts]
    )
    if issues and strategy.spacing != "smooth":
        return issues
    rates = []
    for layer in fronts:
        has_corners = any(len(front.corners) for front in layer)
        rates.append(np.inf if has_corners else max(turn(wall, front) for front in layer))
    return issues + turn_notes(rates, strategy)


def _deposited_pieces(
    pieces: list[list[Piece]], rims: Rims, strategy: SurfaceParameters, label: str
) -> tuple[list[list[Piece]], list[Issue]]:
    """Return the deposited pieces: all, or only whole pieces below the first piece cut by the wall's end."""
    if strategy.end != "whole":
        kept_layers, dropped = drop_short_pieces(pieces, 0.5 * strategy.layer_height)
        return kept_layers, short_note(dropped)
    kept_layers = uncut_pieces(pieces)
    if not kept_layers:
        raise InputError(
            "TOO_LOW", label, "the end of the wall cuts the first layer; make the wall longer"
        )
    top_curves = [piece.curve for layer in kept_layers for piece in layer if not piece.children]
    remainder = (
        float(nearest_feet(top_curves, rims.upper).distance.max())
        if top_curves and len(rims.upper)
        else 0.0
    )
    text = Text(
        "up to {:.4g} mm of the wall above the last whole layer are not deposited", remainder
    )
    note = Issue(NOTE, "REMAINDER", text, len(kept_layers) - 1)
    return kept_layers, [note] if remainder > 1e-4 * strategy.layer_height else []


def _close(
    pieces: list[list[Piece]], closing: list[list[SpaceCurve]], full: list[int]
) -> list[Issue]:
    """Append closing beads to layers whose layer below is complete; return a note."""
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
                "{} bead(s) close gaps between merging fronts, closer to the fronts than a layer "
                "height; the first is in layer {}",
                count,
                first_layer,
            ),
            first_layer,
        )
    ]


@dataclass(frozen=True, eq=False)
class _Way:
    """One way to run a piece: start parameter, whether against the curve, and first point (3,)."""

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
            )  # between nodes, arcs deviate minimally from the surface
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
    """Return the ways to run a piece; fronts are counter-clockwise, see `slicing.fronts.layers.start`."""
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
    """Return the run that begins nearest to the last point (3,), or the first run without a last point.

    Closing beads come after the fronts beside the gap.
    """
    candidates = [runs_ for runs_ in open_runs if not runs_[0].piece.closing] or open_runs
    if last_point is None:
        return candidates[0][0]
    all_runs = [run for runs_ in candidates for run in runs_]
    return all_runs[
        int(np.argmin([float(np.linalg.norm(run.start_point - last_point)) for run in all_runs]))
    ]
