# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding: layers of beads on faces, stacked along the face normals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..filling.cover import Cover
from ..geometry.curves.outline import estimate_outline
from ..geometry.formatting import place
from ..geometry.mesh.triangle_mesh import Mesh
from ..geometry.regions.region import Region, regions
from ..geometry.walls.patch_wall import CladFaces, PatchWall
from ..geometry.walls.surface import dot
from ..issues import NOTE, InputError, Issue, Text
from ..layers.chart import PART, Chart, Charted, Place, axes
from ..layers.margins import BORDER
from ..layers.parted_chart import borders, flatten, split_flattenable, stretch_of
from ..layers.surface import Slice
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.filled import HELIX, CladdingParameters
from ..parameters.process import ProcessParameters
from ..process.bead_model import BeadModel
from ..process.bead_order import IslandOrder, RankedBead, order_beads
from ..process.cooling_waits import add_waits
from ..process.seams import SeamPlacer
from ..toolpath import Checks, MotionRules, Toolpath
from ..types import Array
from . import helix
from .progress import Progress, silent
from .solids.beads import MadeBead, bead_of, layer_volumes, start_beads, twice_volume
from .solids.filling import Filled, Pictures, bead_width, over_fed, spaced
from .solids.notes import notes

# ---- Layers: each is one layer height above the previous layer, along the face normals. Faces are
# cut once into pieces that can be flattened. Every layer is flattened separately, so the bead
# spacing is correct even on the outermost layer of a curved face.

FOLDED = 0.05  # minimum area ratio of a triangle between a layer and the faces if the layer does not fold
PROBE = 0.15  # fraction of the chart's extent; half length about the centre on which its direction is measured
ROUNDS = 5  # iterations of the rotation; one is not exact on curved faces
HALVES = 4  # 4 HALVES is the maximum number of pieces of a curved border edge


@dataclass(frozen=True, eq=False)
class FaceLayer(Charted):
    """A piece of a layer on faces.

    sheet: the exact faces. feet: (n, 3) chart vertices on the faces, mm. distance: mm above the faces. stretch: maximum
    relative difference between lengths in the chart and in the part.
    """

    sheet: PatchWall
    feet: Array
    distance: float
    stretch: float

    @property
    def look(self) -> float:
        """Typical edge length of the mesh, mm."""
        return self.chart.mesh.typical_edge

    def in_part(self, location: Place) -> tuple[Array, Array]:
        """Return the exact points above the faces, and the face normals."""
        approximate = np.einsum(
            "nk,nkc->nc", location.share, self.feet[self.chart.mesh.faces[location.triangle]]
        )
        feet, normals = self.sheet.project(approximate)
        return feet + self.distance * normals, normals


class Piece(NamedTuple):
    """A piece of a sheet that is flattened as a whole.

    mesh: triangles with vertices (n, 3) on the sheet. normals: (n, 3) unit normals at the vertices.
    """

    mesh: Mesh
    normals: Array


def pieces(sheet: PatchWall, strategy: CladdingParameters) -> list[Piece]:
    """Split a sheet into pieces that can be flattened within the allowed distortion."""
    sheet_pieces = []
    for submesh in split_flattenable(sheet.mesh, strategy.distortion):
        feet, normals = sheet.project(submesh.vertices)
        sheet_pieces.append(Piece(Mesh(feet, submesh.faces), normals))
    return sheet_pieces


def slices(sheet: PatchWall, sheet_piece: Piece, strategy: CladdingParameters) -> Iterator[Slice]:
    """Yield the layers on a piece of the faces, from the faces outwards.

    Parameters
    ----------
    sheet : PatchWall
        The faces.
    sheet_piece : Piece
        A piece that can be flattened.
    strategy : CladdingParameters
        Number of layers, layer height and chord error.

    Yields
    ------
    Slice
        The layers, each on a FaceLayer.

    Raises
    ------
    InputError
        FOLDED if layers extend past the centre of curvature of a hollow.
    """
    mesh = sheet_piece.mesh
    for number in range(strategy.layers):
        distance = number * strategy.layer_height
        layer_mesh = Mesh(mesh.vertices + distance * sheet_piece.normals, mesh.faces)
        _refuse_folded(mesh, layer_mesh, number, sheet.label, strategy)
        flat = flatten(layer_mesh)
        surface = _along_x(
            FaceLayer(
                Chart(layer_mesh, flat.points),
                sheet,
                mesh.vertices,
                distance,
                stretch_of(flat, layer_mesh.areas),
            )
        )
        filled_regions = tuple(
            region.simple(BORDER * strategy.chord_error)
            for region in _regions(surface.chart, strategy.chord_error)
        )
        yield Slice(number, PART, surface, filled_regions)


def _along_x(layer: FaceLayer) -> FaceLayer:
    """Centre the chart of a layer and rotate it so that x at the centre follows the part's X.

    If the layer is normal to X at the centre, the part's Y replaces X.
    """
    flat = layer.chart.flat - layer.chart.flat.mean(axis=0)
    for _ in range(ROUNDS):
        chart = Chart(layer.chart.mesh, flat)
        centres = flat[chart.mesh.faces].mean(axis=1)
        middle = centres[int(np.argmin(np.hypot(*centres.T)))]
        reach = max(PROBE * float(np.ptp(flat[:, 0])), layer.look)
        points, normals = layer.in_part(
            chart.find(middle + reach * np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]))
        )
        axis_x, axis_y = axes(normals[2:])
        direction = points[1] - points[0]
        angle = np.arctan2(axis_y[0] @ direction, axis_x[0] @ direction)
        cos, sin = np.cos(angle), np.sin(angle)
        flat = flat @ np.array([[cos, sin], [-sin, cos]])
    return replace(layer, chart=Chart(layer.chart.mesh, flat))


def _regions(chart: Chart, chord_error: float) -> tuple[Region, ...]:
    """Return the regions of the piece in its chart.

    The borders are smooth curves through the vertices, which are on the edges of the faces.
    """
    return regions([_smooth(chart.flat[border], chord_error) for border in borders(chart.mesh)])


def _smooth(loop: Array, chord_error: float) -> Array:
    """Return a loop (n, 2) with points added on curved edges."""
    points = np.column_stack([np.vstack([loop, loop[:1]]), np.zeros(len(loop) + 1)])
    curve = estimate_outline(points, True)
    segment = np.arange(len(loop))
    bow = np.linalg.norm(curve.at(segment, 0.5)[0] - 0.5 * (points[:-1] + points[1:]), axis=1)
    piece_count = np.clip(np.ceil(np.sqrt(bow / (BORDER * chord_error))), 1, 4 * HALVES).astype(
        np.intp
    )
    segment_number = np.repeat(segment, piece_count)
    number = np.arange(len(segment_number)) - np.repeat(
        np.cumsum(piece_count) - piece_count, piece_count
    )
    smooth_loop: Array = curve.at(segment_number, number / piece_count[segment_number])[0][:, :2]
    return smooth_loop


def _refuse_folded(
    mesh: Mesh, above: Mesh, layer: int, label: str, strategy: CladdingParameters
) -> None:
    share = dot(above.area_vectors, mesh.area_vectors) / np.maximum(
        dot(mesh.area_vectors, mesh.area_vectors), 1e-300
    )
    big = mesh.areas > 0.01 * np.median(mesh.areas)
    if (share[big] > FOLDED).all():
        return
    worst = int(np.argmin(np.where(big, share, np.inf)))
    raise InputError(
        "FOLDED",
        "strategy.layers",
        "layer {} of {} is {:.4g} mm above the faces, the depth of the hollow at {}, and would "
        "fold there; deposit at most {} layer(s), or exclude the hollow face",
        layer,
        label,
        layer * strategy.layer_height,
        place(mesh.vertices[mesh.faces[worst]].mean(axis=0)),
        layer,
    )


# ---- Beads

REPORTED_DISTORTION = 0.02  # minimum relative distortion that is reported


def _stacks(
    clad_faces: CladFaces, strategy: CladdingParameters, process: ProcessParameters, width: float
) -> list[Iterator[tuple[Slice, Filled]]]:
    """Return the layers with their beads, one stack for each piece of the faces."""
    if strategy.pattern == HELIX:
        return [helix.filled_layers(sheet, strategy, process) for sheet in clad_faces.sheets]
    pictures = Pictures(strategy, process, width)
    return [
        _filled_layers(sheet, piece, strategy, pictures, clad_faces.label)
        for sheet in clad_faces.sheets
        for piece in pieces(sheet, strategy)
    ]


def _filled_layers(
    sheet: PatchWall, piece: Piece, strategy: CladdingParameters, pictures: Pictures, label: str
) -> Iterator[tuple[Slice, Filled]]:
    for layer in slices(sheet, piece, strategy):
        yield layer, pictures.filled(layer, label)


def plan(
    clad_faces: CladFaces,
    strategy: CladdingParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
    progress: Progress = silent,
) -> Toolpath:
    """Plan the toolpath of cladding; layer i is i layer heights above the faces.

    Parameters
    ----------
    clad_faces : CladFaces
        The faces.
    strategy : CladdingParameters
        Layers, spacing, filling and order.
    build : BuildDirectionParameters
        Build direction and its limits.
    process : ProcessParameters
        Speeds and bead width.
    model : BeadModel or None
        Bead model that sets the speeds; None to use the travel speed everywhere.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        FOLDED, BEAD_SPACING, NOTHING_TO_DEPOSIT, and NOT_REVOLVED for a helix.
    InfeasibleError
        THIN_REGION.
    """
    strategy = spaced(strategy, process)
    width = bead_width(strategy, process, model)
    stacks = _stacks(clad_faces, strategy, process, width)
    ranked: list[RankedBead] = []
    made_beads: list[MadeBead] = []
    issues: list[Issue] = []
    covers: list[Cover] = []
    stretch = 0.0
    for number, stack in enumerate(stacks):
        order = IslandOrder()
        placer = SeamPlacer(process.seam, strategy.chord_error, width)
        for layer, picture in stack:
            progress(
                (number + layer.number / strategy.layers) / len(stacks), f"layer {layer.number}"
            )
            issues += picture.issues
            if isinstance(layer.surface, FaceLayer):
                stretch = max(stretch, layer.surface.stretch)
            covers.append(picture.cover)
            made_in_layer = start_beads(
                [
                    bead_of(curve, layer, strategy, build, process, model)
                    for curve in picture.curves
                ],
                placer,
                layer.number,
            )
            made_beads += made_in_layer
            beads = order.order_islands(
                [made_bead.bead for made_bead in made_in_layer], picture.islands
            )
            ranked += [
                RankedBead(0, number, layer.number, -rank, bead) for rank, bead in enumerate(beads)
            ]
        issues += placer.issues()
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT",
            clad_faces.label,
            "no bead of {:g} mm or more fits on the faces; use a smaller bead spacing, or "
            "strategy.thin: single",
            strategy.least_bead,
        )
    layers = add_waits(
        order_beads(ranked, strategy.order),
        strategy.wait,
        process.rapid_speed,
        strategy.min_layer_time,
    )
    noted = [
        note
        for note in notes(made_beads, layers, strategy, build, process, model)
        if note.code != "SINGLE_LAYER"
    ]  # the user chose the number of layers
    fed = over_fed(strategy, process, model, width)
    twice: float | None = twice_volume(made_beads, strategy, covers, width)
    if strategy.pattern == HELIX:
        issues.append(helix.note_ends(twice or 0.0))
        twice = None  # the note of the helix replaces the warning, whose remedies are for fills
    issues = [*clad_faces.issues, *_stretched(stretch), *issues, *fed, *noted]
    return Toolpath(
        layers,
        np.eye(4),
        strategy.layer_height,
        strategy.chord_error,
        tuple(issues),
        "cladding",
        clad_faces.surroundings,
        None if model is None else model.law(process.acceleration),
        width,
        checks=Checks(volumes=layer_volumes(strategy, covers), twice=twice),
        rules=MotionRules(process.overlap),
    )


def _stretched(share: float) -> tuple[Issue, ...]:
    if share <= REPORTED_DISTORTION:
        return ()
    return (
        Issue(
            NOTE,
            "DISTORTED",
            Text(
                "doubly curved faces cannot be flattened without distortion: the bead spacing "
                "varies by up to {:.2g} %, within the limit strategy.distortion",
                100.0 * share,
            ),
        ),
    )
