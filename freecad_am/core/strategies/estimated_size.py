# SPDX-License-Identifier: LGPL-2.1-or-later
"""Estimated size of a toolpath before planning: report large toolpaths, reject absurd ones.

Counts are accurate to a third for round and even parts. If bead lengths vary widely, counts tend to be too low.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.profile import RevolvedWall
from ..geometry.developable import Plane
from ..geometry.formatting import at_least, count
from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.mesh.refine import Edges
from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, SolidsOnHub
from ..issues import NOTE, InputError, Issue, Text, Word
from ..layers.curved_field import step_of
from ..parameters.filled import CladdingParameters, FilledParameters, SolidParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import (
    MOST_LAYERS,
    LayerParameters,
    RevolutionParameters,
    SurfaceParameters,
)
from ..types import Array, Index

if TYPE_CHECKING:
    from ..geometry.walls.patch_wall import CladFaces, PatchWall
    from ..geometry.walls.surface_wall import SurfaceWall

# Memory per point, measured at a million points: 0.3 kB for the toolpath, 0.6 kB with joint path and document, 1.5 kB at
# the peak. This limit needs more than 70 GB and is fifty times the largest known job
MOST_POINTS = 50_000_000
MOST_BEADS = 2_500_000  # a bead with few points needs the memory of about 20 points
LARGE_CODE = "LARGE"
LARGE_SECONDS, LARGE_GIGABYTES = (
    30.0,
    1.0,
)  # minimum time, s, and memory of a job reported as large; the time is half of an acceptable wait
GIGABYTES_A_POINT = 1.5e-6  # peak memory per point over all stages
GIGABYTES_A_VERTEX = 9e-6  # peak memory per mesh vertex of a wall; measured 8.7e-6 to 9.6e-6 with 9,000 to 35,000 vertices
# points per mesh edge of a bead on a mesh wall, for any chord error; measured: 1.5 on smooth walls
# to 4.4 on a wall with folds
POINTS_AN_EDGE = 2.5
# CPU seconds for a point on a mesh; measured: 0.41 to 0.56 ms for the toolpath
SECONDS_A_MESH_POINT = 7e-4
# beads of solids in plane layers: chords keep to this share of the chord error (`beads.NEEDLESS`);
# points of contours inside those of the border; share of the border along links; points of a line,
# and of one whose width tapers at its ends
CHORD_SHARE, INNER_FACTOR, LINKED_SHARE = 0.12, 1.5, 0.6
POINTS_A_LINE, POINTS_A_TAPERED_LINE = 4.0, 40.0
MIN_CHORDS = 24  # minimum number of points of a bead on a wall
PLACES = 181  # number of samples along meridians and tubes
MAX_SAMPLES = 20_000  # maximum number of sampled vertices for the extent of a wall
# CPU seconds for a layer in all stages, independent of its points; measured with 25 points
SECONDS_A_LAYER = 0.05
# CPU seconds for filling unequal layers, per square of the bead spacing, measured
SECONDS_A_SQUARE = 1.5e-4
SECONDS_A_TILT = 9e-3  # CPU seconds to search a tilt at a point, measured
# CPU seconds to compute layers, per mm of folds in a mesh; measured: from 0.0018 where layers run
# along the folds of an even mesh to 0.011 where they cross folds of an uneven mesh at all angles
SECONDS_A_FOLD = 5e-3
SECONDS_A_NODE = 5e-5  # CPU seconds per grid node of curved layers, measured; a third if planar
# CPU seconds for a point in all stages, measured; walls on parts march from layer to layer, and
# layers of cladding are flattened for filling
_SECONDS_A_POINT: dict[type, float] = {
    RevolutionParameters: 5.5e-5,
    SurfaceParameters: 2e-3,
    CladdingParameters: 1.5e-3,
    SolidParameters: 1e-4,  # 2.6e-5 where layers are equal, up to 1.5e-4 where they differ
    FilledParameters: 2.5e-4,
}


@dataclass(frozen=True)
class Size:
    """Estimated numbers of layers and points of a toolpath.

    beads: number of beads of solids in plane layers, 0 if not estimated. squares: number of bead-spacing squares in all layers, if each layer is filled separately. nodes: number of grid
    nodes for curved layers. folds: length of folds in the mesh of a wall, mm. vertices: number of mesh vertices, 0 for
    exact walls.
    """

    layers: float
    points: float
    squares: float = 0.0
    nodes: float = 0.0
    folds: float = 0.0
    vertices: float = 0.0
    beads: float = 0.0

    @property
    def gigabytes(self) -> float:
        """Peak memory over all stages, GB."""
        return self.points * GIGABYTES_A_POINT + self.vertices * GIGABYTES_A_VERTEX


def revolution_size(wall: RevolvedWall, strategy: RevolutionParameters) -> Size:
    """Estimate the size of a part of revolution; the turns of a spiral count as layers."""
    meridian, turn = wall.meridian, wall.end - wall.start
    radius, height, tangent = meridian.at(np.linspace(0.0, meridian.length, PLACES))
    step = 4.0 * np.arcsin(
        np.sqrt(np.minimum(1.0, 0.5 * strategy.chord_error / np.maximum(radius, 1e-9)))
    )
    segments = np.maximum(turn / step, strategy.min_points * min(1.0, turn / (2.0 * math.pi)))
    cut = np.ones(PLACES) if strategy.spacing == "arc-length" else np.abs(tangent[:, 1])
    high = meridian.length if strategy.spacing == "arc-length" else float(np.ptp(height))
    return Size(
        high / strategy.layer_height,
        meridian.length * float((cut * segments).mean()) / strategy.layer_height,
    )


def wall_size(wall: SurfaceWall | PatchWall, strategy: SurfaceParameters) -> Size:
    """Estimate the size of a wall on an existing part."""
    return tube_size(wall, strategy) if wall.closes_around else fronts_size(wall, strategy)


def tube_size(wall: SurfaceWall, strategy: SurfaceParameters) -> Size:
    """Estimate the size of a wall around a closed direction."""
    surface = wall.surface()
    v = np.linspace(0.0, wall.period, PLACES)
    top = surface.point(np.full(PLACES, wall.end), v)[:-1]
    low, angle = surface.inverse(wall.first[:: max(1, len(wall.first) // PLACES)])
    share = np.linspace(0.0, 1.0, PLACES)[:, None]
    lines = surface.point(
        low + share * (wall.end - low), np.broadcast_to(angle, (PLACES, len(angle)))
    )
    layers = (
        float(np.linalg.norm(np.diff(lines, axis=0), axis=2).sum(axis=0).mean())
        / strategy.layer_height
    )
    chords = 0.5 * (
        _chords(wall.first, True, strategy.chord_error)[0]
        + _chords(top, True, strategy.chord_error)[0]
    )
    return Size(layers, layers * max(MIN_CHORDS, chords))


def fronts_size(wall: PatchWall, strategy: SurfaceParameters) -> Size:
    """Estimate the size of a wall of any connected pieces."""
    corners = wall.vertices[wall.triangles[~wall.behind[wall.triangles].any(axis=1)]]
    area = 0.5 * float(np.linalg.norm(doubled_areas(corners), axis=1).sum())
    points = wall.vertices[~wall.behind]
    tree = cKDTree(np.vstack([curve.points for curve in wall.first]))
    distance = np.max(tree.query(points[:: max(1, len(points) // MAX_SAMPLES)])[0], initial=0.0)
    layers = float(distance) / strategy.layer_height
    # beads are as curved as the first beads or as a circle around the whole wall, whichever is less
    chords = [_chords(curve.points, curve.closed, strategy.chord_error) for curve in wall.first]
    per_mm = sum(count for count, _ in chords) / sum(length for _, length in chords)
    per_mm = min(
        per_mm,
        1.0 / math.sqrt(4.0 * strategy.chord_error * np.linalg.norm(np.ptp(wall.vertices, axis=0))),
    )
    if wall.mesh_vertices:  # beads on a mesh have a point at every crossed edge
        per_mm = max(per_mm, POINTS_AN_EDGE / wall.mesh.typical_edge)
    return Size(
        layers,
        max(MIN_CHORDS * layers, per_mm * area / strategy.layer_height),
        folds=wall.folds,
        vertices=wall.mesh_vertices,
    )


def solids_size(
    solids: SolidsOnHub, strategy: FilledParameters, spacing: float | None = None
) -> Size:
    """Estimate the size of the toolpath of solids on a hub.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids.
    strategy : FilledParameters
        Layer height, spacing, margin and chord error.
    spacing : float or None, optional
        Distance between beads, mm. None uses the parameter; if an overlap replaces it, points are
        not estimated.

    Returns
    -------
    Size
        Layers, points and grid nodes.
    """
    if spacing is None:
        spacing = strategy.bead_spacing if strategy.bead_overlap is None else math.inf
    layers = points = beads = squares = nodes = 0.0
    for group in solids.groups:
        heights, volume = [], 0.0
        for body in group.bodies:
            distances = group.base.surface.distance(group.base.inside(body.vertices))
            height, depth = max(0.0, float(distances.max())), max(0.0, -float(distances.min()))
            heights.append(height + strategy.margin)
            solid = abs(SolidMesh(body.vertices, body.triangles).volume)
            volume += solid
            length = (
                solid
                * float(
                    np.prod(1.0 + 2.0 * strategy.margin / np.ptp(body.vertices, axis=0))
                )  # grown by the margin
                * height
                / max(height + depth, 1e-9)
                / strategy.layer_height
                / spacing
            )
            if isinstance(group.base.surface, Plane):
                plane_points, plane_beads = _plane_size(body, group.base, length, strategy)
                points += plane_points
                beads += plane_beads
            else:
                # beads run around the hub for half of their length, with half of the chord error for
                # their chords; and they end
                extent = float(np.linalg.norm(np.ptp(body.vertices, axis=0)))
                bend = group.base.surface.bend(height, extent)
                points += length * max(
                    0.5 / math.sqrt(4.0 * strategy.chord_error * bend), 2.0 / extent
                )
            if strategy.margin > 0.0:  # the margin rounds the regions, so no two layers are equal
                squares += length / spacing
        layers += (
            sum(heights) if strategy.order == "feature" else max(heights, default=0.0)
        ) / strategy.layer_height
        if strategy.has_curved_layers:
            nodes += volume / step_of(volume, strategy.layer_height) ** 3
    return Size(layers, points, squares, nodes, beads=beads)


def _plane_size(
    body: Body, base: Base, length: float, strategy: FilledParameters
) -> tuple[float, float]:
    """Estimate the points and beads of a solid in plane layers, filled by beads of a total length, mm.

    Beads along the border have a point at each corner of the border and on its arcs. Contours farther inside have fewer:
    of a disc whose radius shrinks evenly, an arc has two thirds of the points and half of the length. Arcs around corners
    of holes are not counted.
    """
    vertices = base.inside(body.vertices)
    height = float(np.ptp(vertices[:, 2]))
    corners, sides = _borders(vertices, body.triangles, CHORD_SHARE * strategy.chord_error)
    corners += height  # a border repeats its first point
    if sides <= 0.0:
        return 0.0, 0.0
    if strategy.rounds_alone:
        # contours shrink evenly to the middle, so their mean length is half of the border's
        return INNER_FACTOR * length * corners / sides, 2.0 * length * height / sides
    around = sides / strategy.layer_height  # mm, one wall in all layers
    walls = min(strategy.rounds * around, length)
    chord = (
        math.pi * length * strategy.bead_spacing / around
    )  # mean length of lines across (Cauchy)
    lines = max(length - walls, 0.0) / chord
    along_border = walls / around + (LINKED_SHARE if strategy.fill == "zigzag" else 0.0)
    a_line = POINTS_A_TAPERED_LINE if strategy.adapts_widths else POINTS_A_LINE
    points = along_border * corners / strategy.layer_height + a_line * lines
    return points, lines + walls * height / sides


def _borders(vertices: Array, triangles: Index, chord_error: float) -> tuple[float, float]:
    """Return the points and the length of the borders of all sections of a mesh, each integrated over the height.

    Points are in mm and lengths in mm^2. An edge of the mesh is a corner of the sections that it crosses, or part of an
    arc that needs fewer points.
    """
    triangles = np.asarray(triangles, dtype=np.intp)
    areas = 0.5 * doubled_areas(vertices[triangles])
    edges = Edges(triangles)
    ends, faces = edges.ends[edges.count == 2], edges.faces[edges.count == 2]
    high = np.abs(vertices[ends[:, 1], 2] - vertices[ends[:, 0], 2])
    sections = np.hypot(areas[:, 0], areas[:, 1])  # length of sections times height
    first, second = (areas[faces[:, k], :2] for k in (0, 1))
    turn = np.abs(
        np.arctan2(
            first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0], (first * second).sum(axis=1)
        )
    )
    wide = sections[faces].sum(axis=1) / np.maximum(high, 1e-300)
    share = np.sqrt(turn * wide / (8.0 * chord_error))
    return float(high @ np.minimum(share, 1.0)), float(sections.sum())


def cladding_size(faces: CladFaces, strategy: CladdingParameters) -> Size:
    """Estimate the size of layers on faces; points are not estimated if an overlap replaces the bead spacing."""
    spacing = strategy.bead_spacing if strategy.bead_overlap is None else math.inf
    high = strategy.layers * strategy.layer_height
    points = sum(
        weight * _sheet_points(sheet, share * high, strategy.chord_error)
        for sheet in faces.sheets
        for share, weight in ((0.0, 1 / 6), (0.5, 2 / 3), (1.0, 1 / 6))  # Simpson's rule
    )
    return Size(strategy.layers, strategy.layers * points / spacing)


def _sheet_points(sheet: PatchWall, high: float, chord_error: float) -> float:
    """Estimate the points, times bead spacing in mm, of a layer at a height above a sheet.

    The estimate is larger around a rod and smaller in a trough. Beads are assumed to bend like the triangle edges, with
    a quarter of the chord error for their chords.
    """
    feet, normals = sheet.project(sheet.vertices)
    corner, normal = (feet + high * normals)[sheet.triangles], normals[sheet.triangles]
    sides = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2)
    turned = np.linalg.norm(normal - np.roll(normal, 1, axis=1), axis=2)
    dense = np.sqrt(turned / np.maximum(sides, 1e-300) / (2.0 * chord_error)).mean(axis=1)
    area = 0.5 * np.linalg.norm(doubled_areas(corner), axis=1)
    extent = float(np.ptp(corner, axis=(0, 1)).max())
    return float((area * np.maximum(dense, 2.0 / extent)).sum())


def refuse_absurd(size: Size, strategy: LayerParameters, width: float | None = None) -> None:
    """Reject a toolpath of absurd size.

    Parameters
    ----------
    size : Size
        The estimated size.
    strategy : LayerParameters
        The layer parameters.
    width : float or None, optional
        Bead width, mm, if width and overlap define the bead spacing; None otherwise.

    Raises
    ------
    InputError
        TOO_MANY for more than MOST_LAYERS, MOST_BEADS or MOST_POINTS. The message names the parameter
        farthest below its usual value.
    """
    height = strategy.layer_height
    if size.layers > MOST_LAYERS:
        raise InputError(
            "TOO_MANY",
            "strategy.layer_height",
            "{:g} mm gives about {} layers, above the limit of {:,}; use at least {:g} mm",
            height,
            count(size.layers),
            MOST_LAYERS,
            at_least(height * size.layers / MOST_LAYERS),
        )
    if size.beads > MOST_BEADS:
        cause = max(
            (candidate for candidate in _causes(strategy, width) if candidate.power == 1.0),
            key=lambda candidate: candidate.usual / candidate.value,
        )
        raise InputError(
            "TOO_MANY",
            cause.key,
            "{:g} mm gives about {} beads, above the limit of {:,}; use at least {:g} mm",
            cause.value,
            count(size.beads),
            MOST_BEADS,
            at_least(cause.value * size.beads / MOST_BEADS),
        )
    over = size.points / MOST_POINTS
    if over > 1.0:
        cause = max(
            _causes(strategy, width),
            key=lambda candidate: (candidate.usual / candidate.value) ** candidate.power,
        )
        enough = at_least(cause.value * over ** (1.0 / cause.power))
        raise InputError(
            "TOO_MANY",
            cause.key,
            "{:g} mm gives about {} points, above the limit of {:,}; use at least {:g} mm",
            cause.value,
            count(size.points),
            MOST_POINTS,
            enough,
        )


def size_issues(size: Size, strategy: LayerParameters) -> tuple[Issue, ...]:
    """Return notes on a toolpath that takes long to plan.

    Parameters
    ----------
    size : Size
        The estimated size.
    strategy : LayerParameters
        The layer parameters.

    Returns
    -------
    tuple of Issue
        A note LARGE at or above LARGE_SECONDS or LARGE_GIGABYTES, and another if the shape takes
        longer than the points.

    Raises
    ------
    InputError
        As for `refuse_absurd`.
    """
    refuse_absurd(size, strategy)
    a_point = next(
        seconds for kind, seconds in _SECONDS_A_POINT.items() if isinstance(strategy, kind)
    )
    a_point = SECONDS_A_MESH_POINT if size.vertices else a_point
    seconds = max(
        size.points * a_point, size.layers * SECONDS_A_LAYER, size.squares * SECONDS_A_SQUARE
    )
    gigabytes = size.gigabytes
    shapes = _shape_issues(size, max(seconds, LARGE_SECONDS))
    if gigabytes < LARGE_GIGABYTES and (shapes or seconds < LARGE_SECONDS):
        return shapes
    return (
        *shapes,
        Issue(
            NOTE,
            LARGE_CODE,
            Text(
                "planning about {} points in {} layers takes about {:g} min of processor time "
                "and {:g} GB of memory; raise strategy.layer_height or strategy.chord_error to "
                "reduce both",
                count(size.points),
                count(size.layers),
                at_least(seconds / 60.0),
                at_least(gigabytes),
            ),
        ),
    )


def _shape_issues(size: Size, seconds: float) -> tuple[Issue, ...]:
    """Return a note LARGE if computing the shape takes longer than a time, s, independent of the points."""
    grids, folds = size.nodes * SECONDS_A_NODE, size.folds * SECONDS_A_FOLD
    if grids > seconds:
        return (
            Issue(
                NOTE,
                LARGE_CODE,
                Text(
                    "the search for curved layers on a grid of about {} nodes takes about {:g} "
                    "min of processor time; use a larger strategy.layer_height, or layers: "
                    "planes, to save time",
                    count(size.nodes),
                    at_least(grids / 60.0),
                ),
            ),
        )
    if folds > seconds:
        return (
            Issue(
                NOTE,
                LARGE_CODE,
                Text(
                    "facets meet at sharp angles along about {} mm of edges, and computing "
                    "layers around these edges takes about {:g} min of processor time; use a "
                    "larger strategy.layer_height, or a mesh with rounded edges, to save time",
                    count(size.folds),
                    at_least(folds / 60.0),
                ),
            ),
        )
    return ()


def tilting_issues(points: int, times: int = 1) -> tuple[Issue, ...]:
    """Return a note LARGE if the search for nozzle tilts takes long.

    Parameters
    ----------
    points : int
        Number of points searched.
    times : int, optional
        Maximum number of searches if the tool rotates too fast.

    Returns
    -------
    tuple of Issue
        One note, or none.
    """
    seconds = points * times * SECONDS_A_TILT
    if seconds < LARGE_SECONDS:
        return ()
    minutes = Text("{:g} min of processor time", at_least(seconds / 60.0))
    if times > 1:
        return (
            Issue(
                NOTE,
                LARGE_CODE,
                Text(
                    "with tilts for clearance the tool turns faster than "
                    "build_direction.max_turn on beads of {} points, and the search for slower "
                    "tilts takes up to {}; use a larger build_direction.max_turn, a slimmer "
                    "nozzle, or clearance: none, to avoid the search",
                    count(points),
                    Word(minutes),
                ),
            ),
        )
    return (
        Issue(
            NOTE,
            LARGE_CODE,
            Text(
                "at the requested tool axes the nozzle touches beads of {} points, and the "
                "search for clear tilts takes about {}, several times as long where the tool "
                "would turn too fast; use a smaller build_direction.lead and "
                "build_direction.tilt, or clearance: none, to avoid the search",
                count(points),
                Word(minutes),
            ),
        ),
    )


def remedy_issues(
    points: int, seconds_per_point: float, longest: float = math.inf
) -> tuple[Issue, ...]:
    """Return a note LARGE if the search for a remedy of an infeasible job takes long.

    Parameters
    ----------
    points : int
        Number of points to plan again.
    seconds_per_point : float
        Planning time per point, s.
    longest : float, optional
        Time after which the search stops, s.

    Returns
    -------
    tuple of Issue
        One note, or none.
    """
    seconds = min(points * seconds_per_point, longest)
    if seconds < LARGE_SECONDS:
        return ()
    return (
        Issue(
            NOTE,
            LARGE_CODE,
            Text(
                "the job is infeasible; the search for a feasible change takes up to {:g} min of "
                "processor time",
                at_least(seconds / 60.0),
            ),
        ),
    )


class _Cause(NamedTuple):
    """A parameter in mm, its usual value, and the power by which the number of points decreases with it."""

    key: str
    value: float
    usual: float
    power: float = 1.0


def _causes(strategy: LayerParameters, width: float | None) -> list[_Cause]:
    usual = type(strategy)()
    causes = [
        _Cause("strategy.layer_height", strategy.layer_height, usual.layer_height),
        _Cause("strategy.chord_error", strategy.chord_error, usual.chord_error, 0.5),
    ]
    if width is not None:
        causes.append(_Cause("process.bead_width", width, ProcessParameters().bead_width))
    elif isinstance(strategy, FilledParameters):
        causes.append(
            _Cause("strategy.bead_spacing", strategy.bead_spacing, FilledParameters().bead_spacing)
        )
    return causes


def _chords(points: Array, closed: bool, chord_error: float) -> tuple[float, float]:
    """Estimate the number of chords of a smooth curve through points (m, 3) within the chord error; also return its length."""
    chord = np.diff(np.vstack([points, points[:1]]) if closed else points, axis=0)
    chord = chord[np.linalg.norm(chord, axis=1) > 0.0]
    length = np.linalg.norm(chord, axis=1)
    cosine = np.einsum("ij,ij->i", chord[:-1], chord[1:]) / (length[:-1] * length[1:])
    turn = np.arccos(np.clip(cosine, -1.0, 1.0))
    return float(
        np.sqrt(turn * 0.5 * (length[:-1] + length[1:]) / (8.0 * chord_error)).sum()
    ), float(length.sum())
