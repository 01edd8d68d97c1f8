# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids, and closed pieces of meshes, without a layer cut: thinner than a layer, or between two cuts.

Regions covered by the beads of other solids are deposited all the same, such as a thin sheet below a thick one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...collision.inside import inside_of
from ...geometry.curves.guide import Guide
from ...geometry.curves.plane_curve import divide_edges
from ...geometry.developable import Developable, Plane
from ...geometry.formatting import place
from ...geometry.mesh.solid import SolidMesh, connected_pieces
from ...geometry.obstacles import Body
from ...geometry.on_hub import Group, SolidsOnHub
from ...geometry.step_count import step_counts
from ...issues import WARNING, Issue, Text
from ...layers.plane_field import CLEARANCE_SHARE, EXACT
from ...parameters.filled import FilledParameters
from ...process.order import RankedBead
from ...toolpath import Bead
from ...types import Array

PLACES = 4000  # in the box about a piece, at which it is looked whether beads cover it
MIN_SAMPLES, MAX_SAMPLES = 3, 60  # sample points along one axis
LEAST_SHARE = 0.05  # of a piece, which is no more than rounding at its borders
STEPS = 4  # to the width of a bead, of points along it
MAX_NAMED = 8
MM3 = 1000.0  # in a cm3


class Uncut(NamedTuple):
    """A solid, or a closed piece, without a layer cut: its name, its volume and the volume that no bead covers, mm3, a point (3,) in
    it in part coordinates, and its height across the layers, mm.
    """

    name: str
    volume: float
    bare: float
    point: Array
    height: float


def uncut(
    solids: SolidsOnHub, strategy: FilledParameters, ranked: Sequence[RankedBead], width: float
) -> list[Uncut]:
    """Return the pieces of solids without a layer cut that beads do not cover either.

    Curved layers are not checked: they reach everything connected with their start.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids.
    strategy : FilledParameters
        Layer height and cut.
    ranked : sequence of RankedBead
        The beads.
    width : float
        Width of beads without their own, mm.

    Returns
    -------
    list of Uncut
        Pieces with more than LEAST_SHARE uncovered.
    """
    if strategy.has_curved_layers:
        return []
    missed = []
    for number, group in enumerate(solids.groups):
        for piece in (piece for body in group.bodies for piece in _pieces(body)):
            levels = _levels(group, piece.vertices[np.unique(piece.triangles)])
            if _is_cut(float(levels.min()), float(levels.max()), strategy):
                continue
            group_beads = [bead for bead in ranked if bead.group == number]
            missed_piece = _missed(group, piece, strategy, group_beads, width)
            if missed_piece.bare > LEAST_SHARE * missed_piece.volume:
                missed.append(missed_piece)
    return missed


def issues(missed: Sequence[Uncut], strategy: FilledParameters) -> list[Issue]:
    """One warning that names them, the largest first."""
    if not missed:
        return []
    named = [
        Text(
            "{} at {} ({:.3g} mm high, {:.4g} of its {:.4g} cm3)",
            piece.name,
            place(piece.point),
            piece.height,
            piece.bare / MM3,
            piece.volume / MM3,
        )
        for piece in sorted(missed, key=lambda piece: -piece.bare)[:MAX_NAMED]
    ]
    return [
        Issue(
            WARNING,
            "NOT_DEPOSITED",
            Text(
                "{} solid(s) fit between the cuts of two layers, {:g} mm apart, and get no bead, "
                "{:.4g} cm3 in total: {}{}; set strategy.layer_height to at most their height, "
                "or fuse them with the adjacent solid",
                len(missed),
                strategy.layer_height,
                sum(piece.bare for piece in missed) / MM3,
                Text.joined(", ", named),
                "" if len(missed) <= MAX_NAMED else ", ...",
            ),
        )
    ]


def _pieces(body: Body) -> Iterator[Body]:
    """The closed pieces of a body, without the walls of hollows in it."""
    triangles = np.asarray(body.triangles, dtype=np.intp)
    label = connected_pieces(triangles)
    volume = SolidMesh(body.vertices, triangles).volume
    for number in range(int(label.max(initial=-1)) + 1):
        piece_triangles = triangles[label == number]
        if SolidMesh(body.vertices, piece_triangles).volume * volume > 0.0:
            yield Body(body.name, body.vertices, piece_triangles)


def _levels(group: Group, points: Array) -> Array:
    """How far (n,) mm points (n, 3) of the part are from where the layers of a group begin, across the layers."""
    surface, inside = group.base.surface, group.base.inside(points)
    if isinstance(surface, Plane):
        height: Array = inside[:, 2]
        return height
    assert isinstance(surface, (Guide, Developable))
    return surface.distance(inside)


def _is_cut(low: float, high: float, strategy: FilledParameters) -> bool:
    """Whether a layer is cut between two levels, mm; a cut in a face of a solid is moved aside as `plane_field` does it."""
    aside = CLEARANCE_SHARE * strategy.chord_error
    share = strategy.share_of_cut
    if share == 1.0:  # at the top
        low, high = low + 2.0 * aside, high + 2.0 * aside
    first_layer = max(0, int(np.ceil((low - aside) / strategy.layer_height - share - EXACT)))
    return (first_layer + share) * strategy.layer_height < high - aside


def _missed(
    group: Group,
    piece: Body,
    strategy: FilledParameters,
    ranked: Sequence[RankedBead],
    width: float,
) -> Uncut:
    """The volume that beads leave of a piece."""
    corners = piece.vertices[np.unique(piece.triangles)]
    points = _places_in(piece, corners)
    levels = _levels(group, points)
    layer = np.floor(levels / strategy.layer_height + EXACT)
    covered = np.zeros(len(points), dtype=bool)
    reach = 0.5 * width / strategy.fill_density
    for number in np.unique(layer):
        beads = [bead.bead for bead in ranked if bead.layer == number]
        if beads:
            rows = np.flatnonzero(layer == number)
            rise = levels[rows] - number * strategy.layer_height
            distance = cKDTree(_sample_beads(beads, width / STEPS)).query(points[rows])[0]
            covered[rows] = distance**2 - rise**2 <= reach**2 + (0.5 * width / STEPS) ** 2
    volume = abs(SolidMesh(piece.vertices, np.asarray(piece.triangles, dtype=np.intp)).volume)
    bare = points[~covered] if (~covered).any() else points
    middle = bare[int(((bare - bare.mean(axis=0)) ** 2).sum(axis=1).argmin())]
    high = float(np.ptp(_levels(group, corners)))
    return Uncut(piece.name, volume, volume * float((~covered).mean()), middle, high)


def _places_in(piece: Body, corners: Array) -> Array:
    """Points (n, 3) in a piece, evenly in the box about its corners (k, 3); the middles of its triangles where none is in it."""
    low, size = corners.min(axis=0), np.maximum(np.ptp(corners, axis=0), 1e-9)
    step = float((np.prod(size) / PLACES) ** (1.0 / 3.0))
    count = np.clip(np.rint(size / step), MIN_SAMPLES, MAX_SAMPLES).astype(np.intp)
    axes = [low[k] + size[k] * (np.arange(count[k]) + 0.5) / count[k] for k in range(3)]
    grid = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    inside = inside_of(piece)
    inside_points = grid[inside.holds(grid)] if inside is not None else grid[:0]
    middles: Array = piece.corners().mean(axis=1)
    return inside_points if len(inside_points) else middles


def _sample_beads(beads: Sequence[Bead], step: float) -> Array:
    """Points (n, 3) along the middles of beads, no more than `step` mm apart."""
    points = []
    for bead in beads:
        lengths = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        points.append(divide_edges(bead.points, step_counts(lengths, step))[0])
    return np.concatenate(points)
