# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding: faces covered with layers of beads, one over the other along their normals."""

from __future__ import annotations

import numpy as np

from ..filling.cover import Cover
from ..geometry.walls.patch_wall import CladFaces
from ..issues import NOTE, InputError, Issue, Text
from ..layers.on_faces import FaceLayer, pieces, slices
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.filled import CladdingParameters
from ..parameters.process import ProcessParameters
from ..process.bead_model import BeadModel
from ..process.order import IslandOrder, RankedBead, add_waits, order_beads
from ..toolpath import Bead, Checks, MotionRules, Toolpath
from .progress import Progress, silent
from .solids.beads import MadeBead, bead_of, layer_volumes, twice_volume
from .solids.filling import Pictures, bead_width, over_fed, spaced
from .solids.notes import notes

REPORTED_DISTORTION = 0.02  # distortion that is reported


def plan(
    clad_faces: CladFaces,
    strategy: CladdingParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
    progress: Progress = silent,
) -> Toolpath:
    """Return the toolpath of cladding: layer i is i layer heights above the faces.

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
        Bead model that sets the speeds; None if the travel speed applies everywhere.
    progress : callable, optional
        Receives share and text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        FOLDED, BEAD_SPACING, NOTHING_TO_DEPOSIT.
    InfeasibleError
        THIN_REGION.
    """
    strategy = spaced(strategy, process)
    width = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, width)
    sheet_pieces = [
        (sheet, piece) for sheet in clad_faces.sheets for piece in pieces(sheet, strategy)
    ]
    ranked: list[RankedBead] = []
    made_beads: list[MadeBead] = []
    issues: list[Issue] = []
    covers: list[Cover] = []
    stretch = 0.0
    for number, (sheet, piece) in enumerate(sheet_pieces):
        order = IslandOrder()
        for layer in slices(sheet, piece, strategy):
            progress(
                (number + layer.number / strategy.layers) / len(sheet_pieces),
                f"layer {layer.number}",
            )
            picture = pictures.filled(layer, clad_faces.label)
            issues += picture.issues
            assert isinstance(layer.surface, FaceLayer)
            stretch = max(stretch, layer.surface.stretch)
            covers.append(picture.cover)
            beads: list[Bead] = []
            for curve in picture.curves:
                made_beads.append(bead_of(curve, layer, strategy, build, process, model))
                beads.append(made_beads[-1].bead)
            beads = order.order_islands(beads, picture.islands)
            ranked += [
                RankedBead(0, number, layer.number, -rank, bead) for rank, bead in enumerate(beads)
            ]
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT",
            clad_faces.label,
            "no bead of {:g} mm or more fits on its faces; use a smaller bead spacing, or thin = "
            "single",
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
    ]  # as asked
    fed = over_fed(strategy, process, model, width)
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
        checks=Checks(
            volumes=layer_volumes(strategy, covers),
            twice=twice_volume(made_beads, strategy, covers, width),
        ),
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
                "varies by up to {:.2g} %; strategy.distortion limits it",
                100.0 * share,
            ),
        ),
    )
