# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field of layers on faces: each a layer height above the one before, along the faces' normals.

Faces are cut into pieces that can be laid flat once; every layer lays its own surface flat, so that beads are as far apart
as they are measured there, on the outermost layer of a bent face too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...geometry.curves.outline import estimate_outline
from ...geometry.formatting import place
from ...geometry.mesh.triangle_mesh import Mesh
from ...geometry.on_hub import Base
from ...geometry.plane import Plane
from ...geometry.regions.region import Region, regions
from ...geometry.walls.patch_wall import PatchWall
from ...geometry.walls.surface import dot
from ...issues import InputError
from ...parameters.filled import CladdingParameters
from ...types import Array
from ..charts.chart import Chart, Place
from ..charts.charted import Charted, axes
from ..charts.flattening import flattened
from ..charts.parted import borders, parted, stretch_of
from ..margins import BORDER
from ..surface import Slice

PART = Base("the part", Plane(), np.eye(4))  # charts are in its coordinates
FOLDED = 0.05  # share of its area that a triangle keeps in a layer that does not fold
PROBE = (
    0.15  # of the extent of a picture, about the middle of it, along which its direction is told
)
ROUNDS = 5  # of turning it: between bent ends the way is not the picture's
HALVES = 4  # of an edge of a border, where that bows


@dataclass(frozen=True, eq=False)
class FaceLayer(Charted):
    """A piece of a layer on faces. sheet: these, exactly. feet: (n, 3) mm, the vertices of the chart on them. distance: mm
    above them. stretch: the largest share by which lengths of the picture differ from those in the part."""

    sheet: PatchWall
    feet: Array
    distance: float
    stretch: float

    @property
    def look(self) -> float:
        """A usual edge of the mesh."""
        return self.chart.mesh.typical_edge

    def in_part(self, place: Place) -> tuple[Array, Array]:
        """The exact places above the faces, and their normals."""
        near = np.einsum(
            "nk,nkc->nc", place.share, self.feet[self.chart.mesh.faces[place.triangle]]
        )
        feet, normals = self.sheet.project(near)
        return feet + self.distance * normals, normals


class Piece(NamedTuple):
    """Of a sheet, what is laid flat as one: vertices (n, 3) on it and unit normals (n, 3) there, and how they are joined."""

    mesh: Mesh
    normals: Array


def pieces(sheet: PatchWall, strategy: CladdingParameters) -> list[Piece]:
    """A sheet in pieces that can be laid flat within the distortion allowed."""
    made = []
    for part in parted(sheet.mesh, strategy.distortion):
        feet, normals = sheet.project(part.vertices)
        made.append(Piece(Mesh(feet, part.faces), normals))
    return made


def slices(sheet: PatchWall, piece: Piece, strategy: CladdingParameters) -> Iterator[Slice]:
    """The layers of a piece outwards, each on a FaceLayer. InputError FOLDED where they reach over a hollow's middle."""
    mesh = piece.mesh
    for number in range(strategy.layers):
        distance = number * strategy.layer_height
        here = Mesh(mesh.vertices + distance * piece.normals, mesh.faces)
        _refuse_folded(mesh, here, number, sheet.label, strategy)
        flat = flattened(here)
        surface = _along_x(
            FaceLayer(
                Chart(here, flat.points),
                sheet,
                mesh.vertices,
                distance,
                stretch_of(flat, here.areas),
            )
        )
        found = tuple(
            one.simple(BORDER * strategy.chord_error)
            for one in _regions(surface.chart, strategy.chord_error)
        )
        yield Slice(number, PART, surface, found)


def _along_x(layer: FaceLayer) -> FaceLayer:
    """The layer with its picture about the origin, turned so that its x runs as the part's X does in the middle of it, or as
    Y does where it looks along X there."""
    flat = layer.chart.flat - layer.chart.flat.mean(axis=0)
    for _ in range(ROUNDS):
        chart = Chart(layer.chart.mesh, flat)
        centres = flat[chart.mesh.faces].mean(axis=1)
        middle = centres[int(np.argmin(np.hypot(*centres.T)))]
        reach = max(PROBE * float(np.ptp(flat[:, 0])), layer.look)
        points, normals = layer.in_part(
            chart.find(middle + reach * np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]))
        )
        first, second = axes(normals[2:])
        way = points[1] - points[0]
        angle = np.arctan2(second[0] @ way, first[0] @ way)
        cos, sin = np.cos(angle), np.sin(angle)
        flat = flat @ np.array([[cos, sin], [-sin, cos]])
    return replace(layer, chart=Chart(layer.chart.mesh, flat))


def _regions(chart: Chart, chord_error: float) -> tuple[Region, ...]:
    """What of the picture is the piece. Its borders are smooth through the vertices, which lie on the edges of the faces."""
    return regions([_smooth(chart.flat[border], chord_error) for border in borders(chart.mesh)])


def _smooth(loop: Array, chord_error: float) -> Array:
    """A loop (n, 2) with points between those of edges that bow."""
    points = np.column_stack([np.vstack([loop, loop[:1]]), np.zeros(len(loop) + 1)])
    curve = estimate_outline(points, True)
    segment = np.arange(len(loop))
    bow = np.linalg.norm(curve.at(segment, 0.5)[0] - 0.5 * (points[:-1] + points[1:]), axis=1)
    parts = np.clip(np.ceil(np.sqrt(bow / (BORDER * chord_error))), 1, 4 * HALVES).astype(np.intp)
    of = np.repeat(segment, parts)
    number = np.arange(len(of)) - np.repeat(np.cumsum(parts) - parts, parts)
    found: Array = curve.at(of, number / parts[of])[0][:, :2]
    return found


def _refuse_folded(
    mesh: Mesh, above: Mesh, layer: int, label: str, strategy: CladdingParameters
) -> None:
    share = dot(above.area_vectors, mesh.area_vectors) / np.maximum(
        dot(mesh.area_vectors, mesh.area_vectors), 1e-300
    )
    big = mesh.areas > 0.01 * np.median(mesh.areas)
    if (share[big] > FOLDED).all():
        return
    at = int(np.argmin(np.where(big, share, np.inf)))
    raise InputError(
        "FOLDED",
        "strategy.layers",
        "layer {} of {} would lie {:.4g} mm above the faces, as far as a hollow reaches at {}, "
        "and fold there; lay at most {} layer(s), or leave out what is so hollow",
        layer,
        label,
        layer * strategy.layer_height,
        place(mesh.vertices[mesh.faces[at]].mean(axis=0)),
        layer,
    )
