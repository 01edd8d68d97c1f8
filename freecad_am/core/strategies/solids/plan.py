# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: cut by a field of layers, filled, ordered and deposited at speeds that hold the bead's width (Dai 2020)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...filling.cover import Cover
from ...geometry.on_hub import SolidsOnHub
from ...issues import InputError, Issue
from ...layers import field
from ...layers.field import Stack
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...process.order import Course, IslandOrder, RankedBead, add_waits, order_beads
from ...toolpath import Bead, Toolpath
from .. import size
from ..progress import Progress, silent
from .beads import MadeBead, bead_of
from .between_cuts import issues as uncut_issues
from .between_cuts import uncut
from .filling import Pictures, bead_width, over_fed, spaced
from .notes import notes
from .part_volume import part_volume
from .volumes import slab_volumes, twice_volume, volumes
from .without_bead import BareLayer, empty_layer_issues

PLANE_TOLERANCE_MM = 1e-6  # mm, and of the cosine of an angle


def plan(
    solids: SolidsOnHub,
    strategy: FilledParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
    progress: Progress = silent,
) -> Toolpath:
    """The toolpath of solids, in part coordinates; layer i is i layer heights above their base.

    model: sets the speeds; with None the travel speed applies everywhere. progress(fraction, text) may raise to cancel. Raises
    InputError APEX_INSIDE, TOO_FAR_ROUND, BEAD_SPACING, NOTHING_TO_DEPOSIT, NOT_FOR_FAMILY, TOO_MANY, InfeasibleError
    THIN_REGION.
    """
    _refuse_mode(solids.has_plane_layers(), strategy, build)
    strategy = spaced(strategy, process)
    size.refuse_absurd(
        size.solids_size(solids, strategy, strategy.bead_spacing),
        strategy,
        None if strategy.bead_overlap is None else process.bead_width,
    )
    width = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, width)
    ranked: list[RankedBead] = []
    made_beads: list[MadeBead] = []
    issues: list[tuple[Stack, Issue]] = []
    bare: list[BareLayer] = []
    covers: list[Cover] = []
    numbers: list[int] = []  # of the layers of the covers
    heights: dict[
        int, list[float]
    ] = {}  # least and largest of each layer in all stacks, where it is not as high everywhere
    order = IslandOrder(as_below=strategy.min_layer_time > 0.0)
    stacks = list(field.stacks(solids, strategy))
    for stack_number, stack in enumerate(stacks):
        order.below = None  # this stack has no layer yet
        for layer in stack.layers:
            progress(
                (stack_number + layer.share_before) / len(stacks),
                f"{stack.name} layer {layer.number}",
            )
            picture = pictures.filled(layer, stack.name)
            issues += [(stack, issue) for issue in (*layer.issues, *picture.issues)]
            if picture.bare and not picture.curves:
                bare.append(BareLayer(stack, layer, picture.bare))
            if layer.heights is not None:
                heights.setdefault(layer.number, []).extend(layer.heights[::2])
            numbers.append(layer.number)
            covers.append(
                picture.cover.scaled(
                    1.0 if layer.heights is None else layer.heights[1] / strategy.layer_height
                )
            )
            beads: list[Bead] = []
            for curve in picture.curves:
                made_beads.append(bead_of(curve, layer, strategy, build, process, model))
                beads.append(made_beads[-1].bead)
            if solids.has_plane_layers():
                ranked += [
                    RankedBead(stack.group, stack.solid, layer.number, -len(ranked) - rank, bead)
                    for rank, bead in enumerate(order.order_islands(beads, picture.islands))
                ]
            else:
                ranked += [
                    RankedBead(stack.group, stack.solid, layer.number, bead.ring, bead)
                    for bead in beads
                ]
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT",
            solids.label,
            "no bead of {:g} mm or more fits in any layer; use a smaller bead spacing, or thin = "
            "single",
            strategy.least_bead,
        )
    course = order_beads(ranked, strategy.order)
    layers = add_waits(course, strategy.wait, process.rapid_speed, strategy.min_layer_time)
    missed = uncut(solids, strategy, ranked, width)
    all_issues = [
        *solids.issues,
        *[_numbered(issue, stack, course) for stack, issue in issues],
        *empty_layer_issues(bare, course),
        *uncut_issues(missed, strategy),
        *over_fed(strategy, process, model, width),
        *notes(made_beads, layers, strategy, build, process, model),
    ]
    return Toolpath(
        layers,
        solids.frame,
        strategy.layer_height,
        strategy.chord_error,
        tuple(all_issues),
        process.overlap,
        "solid" if solids.has_plane_layers() else "developable",
        solids.surroundings,
        None if model is None else model.law(process.acceleration),
        width,
        volumes=volumes(
            None if strategy.margin else part_volume(solids),
            strategy,
            covers,
            sum(piece.bare for piece in missed),
            slab_volumes(solids, strategy),
            numbers,
        ),
        twice=twice_volume(made_beads, strategy, covers, width),
        uneven=np.array(
            [(number, min(extremes), max(extremes)) for number, extremes in sorted(heights.items())]
        )
        if heights
        else None,
    )


def _numbered(issue: Issue, stack: Stack, course: Course) -> Issue:
    """An issue of a layer of a stack with the number that this layer has in the toolpath; without one where it is not in it."""
    if issue.layer is None:
        return issue
    return replace(issue, layer=course.number(stack.group, stack.solid, issue.layer))


def _refuse_mode(planes: bool, strategy: FilledParameters, build: BuildDirectionParameters) -> None:
    if getattr(strategy, "layers", "planes") != "planes" and build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "{} does not apply to curved layers, which grow along their normals; use local",
            build.mode,
        )
    if planes:
        if build.mode == "symmetry-plane":
            raise InputError(
                "NOT_FOR_FAMILY",
                "build_direction.mode",
                "symmetry-plane is for walls; planar layers grow along their normal: use local "
                "or fixed",
            )
    elif build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "{} does not apply to solids on a hub, which grow along its normals; use local",
            build.mode,
        )


def clear_by_itself(toolpath: Toolpath, solids: SolidsOnHub) -> bool:
    """Whether nothing can be above the tip of the nozzle: layers are planes, each wholly below the next, the tool is upright, and
    the surroundings end below the first.
    """
    up, origin = solids.groups[0].base.frame[:3, 2], solids.groups[0].base.frame[:3, 3]
    previous_height = -np.inf
    for _, _, bead in toolpath:
        height = float((bead.points[0] - origin) @ up)
        if (
            height < previous_height - PLANE_TOLERANCE_MM
            or (bead.tool @ up).min() < 1.0 - PLANE_TOLERANCE_MM
        ):
            return False
        previous_height = height
    return all(
        float(((body.vertices - origin) @ up).max()) < PLANE_TOLERANCE_MM
        for body in solids.surroundings
    )


def lift_axis_limits(build: BuildDirectionParameters) -> BuildDirectionParameters:
    """The same with tool axes that may point anywhere: on a hub they do, and the machine turns it."""
    return replace(build, max_tilt=np.pi)
