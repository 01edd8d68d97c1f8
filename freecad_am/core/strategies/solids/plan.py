# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: cut by a field of layers, filled, laid in order, at speeds that hold the bead's width (Dai 2020)."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np

from ...filling.cover import Cover
from ...geometry.beyond_hub import solids_beyond
from ...geometry.on_hub import SolidsOnHub
from ...issues import InputError, Issue
from ...layers.field import Stack, stacks
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...process.order import RankedBead, as_below, island_by_island, ordered, waited
from ...toolpath import Toolpath
from ...types import Array
from .. import size
from ..progress import Progress, silent
from .beads import MadeBead, bead_of
from .filling import Pictures, bead_width, spaced
from .notes import lean_notes, notes
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
    THIN_REGION."""
    planes, at = solids.on_planes(), None
    _refuse_mode(planes, strategy, build)
    strategy = spaced(strategy, process)
    found = size.of_solids(solids, strategy, strategy.bead_spacing)
    size.refuse_absurd(found, strategy, None if strategy.bead_overlap is None else process.bead_width)
    together = sum(len(group.bodies) for group in solids.groups) if strategy.order == "feature" else 1
    expected = max(1.0, found.layers / together)  # of a stack
    nominal = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, nominal)
    ranked: list[RankedBead] = []
    made: list[MadeBead] = []
    mended: list[Issue] = []
    covers: list[Cover] = []
    heights: dict[int, list[float]] = {}  # least and largest of each layer in all stacks, where it is not as high everywhere
    lots = _lots(solids, strategy)
    for done, (group, solid, stack) in enumerate(lots):
        below: Array | None = None  # middles of the islands of the layer before
        before: Counter[int] = Counter()  # beads of the pieces that a curved layer has had
        for count, layer in enumerate(stack.slices):
            through = min(1.0, count / expected) if layer.before is None else layer.before
            progress((done + through) / len(lots), f"{stack.name} layer {layer.number}")
            filled = pictures.filled(layer, stack.name)
            mended += [*layer.issues, *filled.issues]
            if layer.heights is not None:
                heights.setdefault(layer.number, []).extend(layer.heights[::2])
            share = 1.0 if layer.heights is None else layer.heights[1] / strategy.layer_height
            covers.append(Cover(*(share * area for area in filled.cover)))
            here = [bead_of(curve, layer, strategy, build, process, model) for curve in filled.curves]
            made += here
            beads, ranks = [one.bead for one in here], [curve.ring for curve in filled.curves]
            if planes:
                if strategy.min_layer_time > 0.0 and beads:
                    order, below = as_below(beads, filled.islands, below)
                else:
                    order = island_by_island(beads, filled.islands, at)
                ranks = (-solid * FEWER - before[layer.number] - np.argsort(order)).tolist()
                before[layer.number] += len(beads)
                at = beads[order[-1]].points[-1] if order else at
            ranked += [RankedBead(group, solid, layer.number, *one) for one in zip(ranks, beads, strict=True)]
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT", solids.label, "no bead of {:g} mm or more finds room in any layer; use a smaller bead "
            "spacing, or thin = single", strategy.least_bead,
        )
    layers = waited(ordered(ranked, strategy.order), strategy.wait, process.rapid_speed, strategy.min_layer_time)
    issues = (*solids.issues, *notes(made, layers, mended, strategy, process, model), *lean_notes(made, layers, build))
    return Toolpath(
        layers, solids.frame, strategy.layer_height, strategy.chord_error, issues, process.overlap,
        "solid" if planes else "developable",
        solids.surroundings, None if model is None else model.law(process.acceleration), nominal,
        volumes=volumes(None if strategy.margin else solids_beyond(solids), strategy, covers),
        twice=twice(made, strategy, covers, nominal),
        uneven=np.array([(number, min(both), max(both)) for number, both in sorted(heights.items())]) if heights else None,
    )


def _lots(solids: SolidsOnHub, strategy: FilledParameters) -> list[tuple[int, int, Stack]]:
    """The stacks of all groups, each with the number of its group, and its own in that."""
    return [(number, solid, stack) for number, group in enumerate(solids.groups)
            for solid, stack in enumerate(stacks(group, solids.surroundings, strategy))]


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


def without_axis_limits(build: BuildDirectionParameters) -> BuildDirectionParameters:
    """The same with tool axes that may point anywhere: on a hub they do, and the machine turns it."""
    return replace(build, max_tilt=np.pi)
