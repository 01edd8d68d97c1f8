# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a feature becomes a toolpath: layers and beads, the nozzle kept clear, what carries them,
and remedies where no tilt clears it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ...core.families.registry import family_of
from ...core.geometry.obstacles import Body
from ...core.issues import ERROR, NOTE, AmError, InputError, Issue, Text, has_errors
from ...core.kinematics.cell import mounted
from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import PLANES
from ...core.process import classes, model_notes
from ...core.process.bead_model import check_speeds
from ...core.process.cooling_waits import enforce_layer_time
from ...core.process.deposit.pieces import deposited_twice
from ...core.process.wire import set_wire_feed
from ...core.strategies import support
from ...core.strategies.clearance.nozzle_check import CLEARANCE
from ...core.toolpath import MotionRules, Toolpath
from ...core.toolpath import Toolpath as CoreToolpath
from ..families.given import Given, platform_frame
from ..families.planner import CHECKED, CLEARING, STRATEGY
from ..families.registry import planner_for, planner_of
from ..shapes.cell_obstacles import platforms
from ..work import progress

if TYPE_CHECKING:
    from ...core.planning.other_cells import Fixed


def seen_of(cell: CellParameters) -> CellParameters:
    """The part of a cell that affects a toolpath: nozzle, platform and the frame on it. Everything
    else gets its default, so that no toolpath depends on it and a change keeps the layers.
    """
    return CellParameters(
        nozzle=cell.nozzle, platform_diameter=cell.platform_diameter, mount=cell.mount
    )


def planned(
    inputs: Given, fit: Callable[[CoreToolpath], CoreToolpath] = lambda toolpath: toolpath
) -> CoreToolpath:
    """The toolpath of a single feature, layers changed by `fit`; unsupported beads are reported."""
    toolpath = fit(layers_of(inputs))
    if inputs.build.clearance != "none":
        progress.report(STRATEGY, CLEARING)
        toolpath = kept_clear(
            toolpath, inputs, (*inputs.wall.surroundings, *platforms(inputs.cell, toolpath))
        )
    toolpath = measure_infill(add_wire_speed(toolpath, inputs), inputs)
    progress.report(CHECKED, "looking for unsupported beads")
    plates = platforms(inputs.cell, toolpath)
    if toolpath.traits.has_axis:
        stands = (
            mounted(inputs.cell, toolpath.frame, toolpath.family)
            if inputs.cell is not None and plates
            else toolpath.frame
        )
        return support.check_support(toolpath, (stands,), toolpath.surroundings, ())
    aloft = above_platform(toolpath, inputs)
    toolpath = dataclasses.replace(toolpath, issues=(*toolpath.issues, *aloft))
    toolpath = support.check_support(
        toolpath, (), (*toolpath.surroundings, *plates), () if aloft else bases_of(inputs)
    )
    return over_edge(toolpath, inputs)


def over_edge(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """The toolpath with a warning where it begins beyond the edge of the platform."""
    if inputs.cell is None or inputs.cell.platform_diameter <= 0.0:
        return toolpath
    feature = (
        toolpath.frame if inputs.stands is None else None
    )  # of several the first one's frame counts for all
    edge_issues = support.over_edge(
        toolpath,
        platform_frame(toolpath, inputs, inputs.cell),
        inputs.cell.platform_diameter,
        toolpath.surroundings,
        feature,
    )
    return dataclasses.replace(toolpath, issues=(*toolpath.issues, *edge_issues))


def above_platform(toolpath: CoreToolpath, inputs: Given) -> list[Issue]:
    """A warning if a solid with a plane base begins above the platform: nothing carries that plane."""
    if (
        inputs.cell is None
        or inputs.cell.platform_diameter <= 0.0
        or not support.is_on_planes(bases_of(inputs))
    ):
        return []
    return support.above(
        toolpath, platform_frame(toolpath, inputs, inputs.cell), toolpath.surroundings
    )


def layers_of(inputs: Given) -> CoreToolpath:
    """Return layers and beads of a feature.

    The nozzle is kept clear only of the feature itself, and only if the layers determine the tool
    directions. Raises the InputErrors of the family.
    """
    process = inputs.process
    if process.bead_model == "none" and process.wire.feed_mode != "constant" and not process.ramped:
        raise InputError(
            "NOT_FOR_FAMILY",
            "process.wire.feed_mode",
            "without a bead model or a ramp the travel speed is constant, so the wire feed has "
            "nothing to follow; use constant, a process.bead_model, or process.start.ramp or "
            "process.end.ramp",
        )
    classes.refuse_speeds(process)
    family = family_of(inputs.strategy)
    layers, model = planner_of(family).plan_layers(inputs), inputs.model
    if model is not None and not family.is_filled:
        layers = model_notes.hold_widths(layers, process, model)
    toolpath = classes.set_bead_ends(layers, process)
    if not family.is_filled:
        toolpath = enforce_layer_time(
            toolpath, getattr(inputs.strategy, "min_layer_time", 0.0), process.rapid_speed
        )
    twice = toolpath.checks.twice if family.is_filled else deposited_twice(toolpath)
    return dataclasses.replace(
        toolpath.add_checks(twice=twice),
        rules=MotionRules(process.overlap, process.retreat, inputs.build.max_from_vertical),
    )


def kept_clear(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None = None
) -> CoreToolpath:
    """The toolpath with tools tilted clear of bodies (including the platform) and deposit. feature:
    the number of the feature of `inputs` among several, which is kept clear.
    """
    return planner_for(inputs.strategy).keep_clear(toolpath, inputs, bodies, feature)


def add_wire_speed(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """The toolpath with the speed of its wire, and issues about speeds outside the material's
    range.
    """
    return check_speeds(set_wire_feed(toolpath, inputs.process, inputs.model), inputs.process)


def measure_infill(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """The toolpath with void and double deposit of plane layers, and issues where beads leave too much void."""
    max_void = getattr(inputs.strategy, "max_void", None)
    if max_void is None:
        return toolpath
    from ...core.process.deposit import void_and_double  # other families do not need it

    return void_and_double.measure(toolpath, max_void)


def bases_of(inputs: Given) -> list[Any]:
    """The bases of solids; empty for walls and faces."""
    return [group.base for group in getattr(inputs.wall, "groups", ())]


# ---- Remedies for a nozzle that no tilt clears: one build direction for a whole leaning wall,
# plane layers for a solid in curved ones


def in_planes(inputs: Given, fit: Callable[[Toolpath], Toolpath] | None) -> Fixed | None:
    """A solid in curved layers that start at its base, planned in plane ones; None for others."""
    if not inputs.strategy.has_curved_layers or any(
        group.start is not None for group in inputs.wall.groups
    ):
        return None
    from ...core.planning.other_cells import Fixed

    flat = dataclasses.replace(inputs, strategy=dataclasses.replace(inputs.strategy, layers=PLANES))
    return Fixed(
        "`strategy.layers: planes`", lambda: planned(flat) if fit is None else planned(flat, fit)
    )


def try_remedy(toolpath: Toolpath, fixed: Fixed | None) -> Toolpath:
    """A toolpath on which the nozzle touches something, and nothing else is wrong, with a note on whether it does with fixed
    build directions, or plane layers, planned so; others as they are."""
    errors = {issue.code for issue in toolpath.issues if issue.level == ERROR}
    if fixed is None or errors != {CLEARANCE}:
        return toolpath
    from ...core.planning.remedies import NO_REMEDY, REMEDY

    progress.report(1.0, Text("searching for a change that clears the nozzle: {}", fixed.remedy))
    try:
        clear = not has_errors(list(fixed.make().issues))
    except AmError:  # what cannot be asked for is not a remedy
        clear = False
    note = (
        Issue(
            NOTE,
            REMEDY,
            Text(
                "with {} the nozzle is clear; the toolpath was planned with it, the joint path "
                "was not",
                fixed.remedy,
            ),
        )
        if (clear)
        else Issue(
            NOTE,
            NO_REMEDY,
            Text("the nozzle is not clear with {} either (tested)", fixed.remedy),
        )
    )
    return dataclasses.replace(toolpath, issues=(note, *toolpath.issues))
