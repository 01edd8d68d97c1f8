# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on cylinders and cones: equidistant layers, filled, at speeds that hold the bead's width (Dai 2020)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..filling.curve import PlaneCurve
from ..geometry.developable import Array
from ..geometry.on_hub import Base, SolidsOnHub, downwards, middle_azimuth, upright
from ..geometry.plane_curve import doubled_area
from ..geometry.region import Region
from ..geometry.strip import Strip
from ..geometry.surroundings import Body
from ..issues import InfeasibleError, InputError, Issue
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.process import ProcessParameters
from ..parameters.strategy import DevelopableParameters
from ..process.bead_model import BeadModel
from ..process.order import Laid, ordered, waited
from ..toolpath import Toolpath
from .hub_beads import Rolled, reversed_curve, rolled
from .hub_layers import Slice, filled, slices
from .hub_notes import notes

BESIDE = 0.6  # of the bead spacing; that far outside of a contour there is no material
FAMILY = "developable"

Progress = Callable[[float, str], None]


def _silent(fraction: float, text: str) -> None:
    """Tells nobody."""


def plan(
    solids: SolidsOnHub, strategy: DevelopableParameters, build: BuildDirectionParameters, process: ProcessParameters,
    model: BeadModel | None, progress: Progress = _silent,
) -> Toolpath:
    """The toolpath of solids on a hub, in part coordinates; layer i lies i layer heights outside of the hub.

    model: sets the speeds, None for the travel speed everywhere. progress(fraction, text) may raise to cancel. Raises
    InputError APEX_INSIDE, TOO_FAR_ROUND, NOTHING_TO_DEPOSIT, NOT_FOR_FAMILY, InfeasibleError THIN_REGION.
    """
    if build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY", "build_direction.mode", f"{build.mode} is not for solids on a hub, which grow along its "
            "normals; use local",
        )
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
                for curve in _filled(layer, centre, body, strategy, process):
                    deflection = _deflection(curve, layer, strategy)
                    if curve.closed and process.direction == "alternate" and (layer.layer + curve.ring) % 2:
                        curve, deflection = reversed_curve(curve), -deflection
                    bead = rolled(curve, layer.surface, layer.middle, one.base, strategy, build, process, model, deflection)
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
    issues = (*solids.issues, *notes(made, layers, mended, strategy, process, model))
    return Toolpath(
        layers, _frame(solids), strategy.layer_height, strategy.chord_error, issues, process.overlap, FAMILY,
        solids.surroundings,
    )


def _filled(
    layer: Slice, centre: float, body: Body, strategy: DevelopableParameters, process: ProcessParameters
) -> list[PlaneCurve]:
    try:
        return filled(layer, centre, strategy, process)
    except InfeasibleError as error:
        where = f"{body.name} layer {layer.layer}"
        raise InfeasibleError(
            error.code, where, error.message, (Issue("error", error.code, f"{body.name}: {error.message}", layer.layer),)
        ) from None


def _deflection(curve: PlaneCurve, layer: Slice, strategy: DevelopableParameters) -> float:
    """The deflection of the torch to the right of a bead: outwards on outer contours, none on others."""
    if strategy.deflection == 0.0 or curve.kind != "contour" or curve.ring > 0:
        return 0.0
    strip = next((one for one in layer.regions if isinstance(one, Strip)), None)
    regions = [one for one in layer.regions if isinstance(one, Region)]
    if strip is not None and curve.turns:
        height = float(strip.period.unrolled(curve.points)[:, 1].mean())
        return strategy.deflection if (height < 0.5 * sum(strip.levels)) == (curve.turns > 0) else -strategy.deflection
    if not regions:  # a hole in a strip
        return -strategy.deflection if doubled_area(curve.points) > 0.0 else strategy.deflection
    edge = np.roll(curve.points, -1, axis=0) - curve.points
    longest = np.argsort(np.hypot(*edge.T))[-9:]
    right = np.stack([edge[longest, 1], -edge[longest, 0]], axis=1) / np.hypot(*edge[longest].T)[:, None]
    probes = curve.points[longest] + 0.5 * edge[longest] + BESIDE * strategy.bead_spacing * right
    inside = np.any([region.contains(probes) for region in regions], axis=0)
    return -strategy.deflection if inside.mean() > 0.5 else strategy.deflection


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
