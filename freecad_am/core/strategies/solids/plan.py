# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: cut by a field of layers, filled, laid in order, at speeds that hold the bead's width (Dai 2020)."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from ...filling.cover import Cover
from ...geometry.developable import Developable
from ...geometry.on_hub import SolidsOnHub, downwards, upright
from ...issues import InputError, Issue
from ...layers.field import pieces
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...process.order import RankedBead, ordered, waited
from ...toolpath import Toolpath
from ...types import Array
from .. import size
from ..progress import Progress, silent
from .beads import Wrapped, bead_of
from .filling import Pictures, bead_width, naming, spaced
from .islands import as_below, island_by_island
from .lean_notes import lean_notes
from .notes import notes
from .volumes import twice, volumes

FEWER = 1_000_000  # beads that a layer of a solid has
LEVEL = 1e-6  # mm, and of the cosine of an angle


def plan(
    solids: SolidsOnHub, strategy: FilledParameters, build: BuildDirectionParameters, process: ProcessParameters,
    model: BeadModel | None, progress: Progress = silent,
) -> Toolpath:
    """The toolpath of solids, in part coordinates; layer i lies i layer heights from what they stand on.

    model: sets the speeds, None for the travel speed everywhere. progress(fraction, text) may raise to cancel. Raises
    InputError APEX_INSIDE, TOO_FAR_ROUND, BEAD_SPACING, NOTHING_TO_DEPOSIT, NOT_FOR_FAMILY, TOO_MANY, InfeasibleError
    THIN_REGION.
    """
    planes, at = on_planes(solids), None
    _refuse_mode(planes, strategy, build)
    strategy = spaced(strategy, process)
    expected = _layers_of_a_piece(solids, strategy, process)
    nominal = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, nominal)
    ranked: list[RankedBead] = []
    made: list[Wrapped] = []
    mended: list[Issue] = []
    covers: list[Cover] = []
    uneven: dict[int, tuple[float, float]] = {}
    found = [(group, one.base, number, piece) for group, one in enumerate(solids.groups)
             for number, piece in enumerate(pieces(one, solids.surroundings, strategy))]
    for done, (group, base, number, piece) in enumerate(found):
        below: Array | None = None  # middles of the islands of the layer before
        before: Counter[int] = Counter()  # beads of the pieces that a curved layer has had
        for count, layer in enumerate(piece.slices):
            mended += layer.issues
            progress((done + min(1.0, count / expected)) / len(found), f"{piece.name} layer {layer.layer}")
            with naming(piece.name, layer.layer):
                beads = pictures.filled(layer, piece.centre, base)
            mended += beads.issues
            share = 1.0 if layer.heights is None else layer.heights[1] / strategy.layer_height
            covers.append(Cover(*(share * area for area in beads.cover)))
            if layer.heights is not None:
                uneven[layer.layer] = _both(uneven.get(layer.layer), layer.heights)
            here = [bead_of(curve, layer, base, strategy, build, process, model) for curve in beads.curves]
            made += here
            ranks = [curve.ring for curve in beads.curves]
            if planes:
                if strategy.min_layer_time > 0.0 and here:
                    order, below = as_below([one.bead for one in here], beads.islands, below)
                else:
                    order = island_by_island([one.bead for one in here], beads.islands, at)
                ranks = (-number * FEWER - before[layer.layer] - np.argsort(order)).tolist()
                before[layer.layer] += len(here)
                at = here[order[-1]].bead.points[-1] if order else at
            ranked += [RankedBead(group, number, layer.layer, rank, one.bead) for rank, one in zip(ranks, here, strict=True)]
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT", solids.label, "no bead of {:g} mm or more finds room in any layer; use a smaller bead "
            "spacing, or thin = single", strategy.least_bead,
        )
    course = ordered(ranked, strategy.order)
    layers = waited(course, strategy.wait, process.rapid_speed, strategy.min_layer_time)
    issues = (*solids.issues, *notes(made, layers, mended, strategy, process, model), *lean_notes(made, layers, build))
    return Toolpath(
        layers, _frame(solids, planes), strategy.layer_height, strategy.chord_error, issues, process.overlap,
        "solid" if planes else "developable",
        solids.surroundings, None if model is None else model.law(process.acceleration), nominal,
        volumes=volumes(solids, strategy, covers), twice=twice(made, strategy, covers, nominal),
        uneven=np.array([(layer, *uneven[layer]) for layer in sorted(uneven)]) if uneven else None,
    )


def _layers_of_a_piece(solids: SolidsOnHub, strategy: FilledParameters, process: ProcessParameters) -> float:
    """About how many layers a piece has, at least one. InputError TOO_MANY."""
    found = size.of_solids(solids, strategy, strategy.bead_spacing)
    size.refuse_absurd(found, strategy, None if strategy.bead_overlap is None else process.bead_width)
    together = sum(len(one.bodies) for one in solids.groups) if strategy.order == "feature" else 1
    return max(1.0, found.layers / together)


def _both(known: tuple[float, float] | None, heights: tuple[float, float, float]) -> tuple[float, float]:
    """The least and the largest height of a layer in several pieces."""
    low, _, high = heights
    return (low, high) if known is None else (min(low, known[0]), max(high, known[1]))


def _refuse_mode(planes: bool, strategy: FilledParameters, build: BuildDirectionParameters) -> None:
    if getattr(strategy, "layers", "planes") != "planes" and build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", "{} is not for curved layers, which grow along their normals; use "
            "local", build.mode,
        )
    if planes:
        if build.mode == "symmetry-plane":
            raise InputError(
                "NOT_FOR_FAMILY", "build_direction.mode", "symmetry-plane is for walls; plane layers grow along their "
                "normal: use local or fixed",
            )
    elif build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", "{} is not for solids on a hub, which grow along its normals; use "
            "local", build.mode,
        )


def on_planes(solids: SolidsOnHub) -> bool:
    """Whether the layers are planes, one above the other, so that nothing deposited before stands above a layer."""
    return not any(isinstance(group.base.surface, Developable) for group in solids.groups)


def clear_by_itself(toolpath: Toolpath, solids: SolidsOnHub) -> bool:
    """Whether nothing can stand above the tip of the nozzle: layers are planes, each wholly below the next, the tool stands
    upright on them, and what is around ends below the first."""
    up, origin = solids.groups[0].base.frame[:3, 2], solids.groups[0].base.frame[:3, 3]
    before = -np.inf
    for _, _, bead in toolpath:
        height = float((bead.points[0] - origin) @ up)
        if height < before - LEVEL or (bead.tool @ up).min() < 1.0 - LEVEL:
            return False
        before = height
    return all(float(((body.vertices - origin) @ up).max()) < LEVEL for body in solids.surroundings)


def _frame(solids: SolidsOnHub, planes: bool) -> Array:
    """The frame of the feature (interface.md, mount): Z the axis of the first base, upwards in the part; origin where the
    lowest end of the solids is; X the part's X seen along Z. Of planes Z is the stacking direction, wherever it points."""
    base = solids.groups[0].base
    if planes:
        return base.frame
    z = base.frame[:3, 2]
    z = -z if downwards(z) else z
    vertices = np.vstack([body.vertices for group in solids.groups for body in group.bodies])
    low = float(((vertices - base.frame[:3, 3]) @ z).min())
    return upright(base.frame[:3, 3] + low * z, z)


def without_axis_limits(build: BuildDirectionParameters) -> BuildDirectionParameters:
    """The same with tool axes that may point anywhere: on a hub they do, and the machine turns it."""
    return replace(build, max_tilt=np.pi)
