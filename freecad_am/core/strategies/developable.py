# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on cylinders and cones: equidistant layers, filled, at speeds that hold the bead's width (Dai 2020)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry.developable import Array
from ..geometry.on_hub import Base, SolidsOnHub, downwards, middle_azimuth, upright
from ..geometry.surroundings import Body
from ..issues import InfeasibleError, InputError, Issue
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import DevelopableParameters
from ..process.bead_model import BeadModel
from ..process.order import Laid, ordered, waited
from ..toolpath import Toolpath
from . import size
from .hub_beads import Rolled, reversed_curve, rolled
from .hub_filling import Filled, Pictures, bead_width, spaced
from .hub_layers import Slice, slices
from .hub_notes import notes
from .hub_outlines import leaning
from .lean_notes import lean_notes
from .progress import Progress, silent

FAMILY = "developable"


def plan(
    solids: SolidsOnHub, strategy: DevelopableParameters, build: BuildDirectionParameters, process: ProcessParameters,
    model: BeadModel | None, progress: Progress = silent,
) -> Toolpath:
    """The toolpath of solids on a hub, in part coordinates; layer i lies i layer heights outside of the hub.

    model: sets the speeds, None for the travel speed everywhere. progress(fraction, text) may raise to cancel. Raises
    InputError APEX_INSIDE, TOO_FAR_ROUND, BEAD_SPACING, NOTHING_TO_DEPOSIT, NOT_FOR_FAMILY, TOO_MANY, InfeasibleError
    THIN_REGION.
    """
    if build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", f"{build.mode} is not for solids on a hub, which grow along its "
            "normals; use local",
        )
    strategy = spaced(strategy, process)
    width = None if strategy.bead_overlap is None else process.bead_width
    size.refuse_absurd(size.of_solids(solids, strategy, strategy.bead_spacing), strategy, width)
    counted = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, counted)
    laid: list[Laid] = []
    made: list[Rolled] = []
    mended: list[Issue] = []
    share = 1.0 / sum(len(one.bodies) for one in solids.groups)
    done = 0
    for group, one in enumerate(solids.groups):
        for number, body in enumerate(one.bodies):
            centre = middle_azimuth(one.base, body.vertices)
            for layer in slices(one.base, body, strategy):
                mended += layer.issues
                progress(share * done, f"{body.name} layer {layer.layer}")
                beads = _filled(layer, centre, body, one.base, pictures)
                mended += beads.issues
                for curve in beads.curves:
                    if curve.closed and process.direction == "alternate" and (layer.layer + curve.ring) % 2:
                        curve = reversed_curve(curve)
                    lean = leaning(curve, layer, strategy, build)
                    bead = rolled(curve, layer.surface, layer.middle, one.base, strategy, build, process, model, lean)
                    made.append(bead)
                    laid.append(Laid(group, number, layer.layer, curve.ring, bead.bead))
            done += 1
    if not laid:
        raise InputError(
            "NOTHING_TO_DEPOSIT", solids.label, f"no bead of {strategy.shortest:g} mm or more finds room in any layer; "
            "use a smaller bead spacing, or thin = single",
        )
    course = ordered(laid, strategy.order)
    layers = waited(course, strategy.wait, process.rapid_speed)
    issues = (*solids.issues, *notes(made, layers, mended, strategy, process, model), *lean_notes(made, layers, build))
    return Toolpath(
        layers, _frame(solids), strategy.layer_height, strategy.chord_error, issues, process.overlap, FAMILY,
        solids.surroundings, None if model is None else model.law(process.acceleration), counted,
    )


def _filled(layer: Slice, centre: float, body: Body, base: Base, pictures: Pictures) -> Filled:
    try:
        return pictures.filled(layer, centre, base)
    except InfeasibleError as error:
        where = f"{body.name} layer {layer.layer}"
        raise InfeasibleError(
            error.code, where, error.message, (Issue("error", error.code, f"{body.name}: {error.message}", layer.layer),)
        ) from None


def _frame(solids: SolidsOnHub) -> Array:
    """The frame of the feature (interface.md, mount): Z the axis of the first base, upwards in the part; origin where the
    lowest end of the solids is; X the part's X seen along Z."""
    base: Base = solids.groups[0].base
    z = base.frame[:3, 2]
    z = -z if downwards(z) else z
    vertices = np.vstack([body.vertices for group in solids.groups for body in group.bodies])
    low = float(((vertices - base.frame[:3, 3]) @ z).min())
    return upright(base.frame[:3, 3] + low * z, z)


def without_axis_limits(build: BuildDirectionParameters) -> BuildDirectionParameters:
    """The same with tool axes that may point anywhere: on a hub they do, and the machine turns it."""
    return replace(build, max_tilt=np.pi)
