# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a feature of each family becomes a toolpath: layers and beads, the nozzle kept clear, what carries them.

A family is imported when one of its features is planned: importing every family takes longer than
planning a small part.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.families.registry import family_of
from ...core.geometry.obstacles import Body
from ...core.issues import InputError, Issue
from ...core.kinematics.cell import mounted
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.process import classes
from ...core.process.deposit.pieces import deposited_twice
from ...core.process.model import notes, wire
from ...core.process.model.bead_model import BeadModel
from ...core.process.model.material import check_speeds
from ...core.process.model.wire import set_wire_feed
from ...core.process.order import enforce_layer_time
from ...core.strategies import support
from ...core.strategies.clearance import look as clearance_look
from ...core.strategies.revolution import clearance
from ...core.toolpath import Toolpath as CoreToolpath
from ...core.types import Array
from ..shapes.platforms import platforms
from ..work import progress

STRATEGY = 0.7  # share of the time for layers and beads, the rest keeps the nozzle clear
CHECKED = 0.92  # the remaining share is for the final checks
CLEARING = "keeping the nozzle clear"


@dataclass(frozen=True, eq=False)
class Given:
    """The planning inputs of a feature: its wall or solids, which the feature object has found, and
    parameters. cell: as `seen_of` leaves it. stands: (4, 4) in part coordinates, the frame on the
    platform if an earlier feature sets it; else None.
    """

    wall: Any
    strategy: Any
    build: BuildDirectionParameters
    process: ProcessParameters
    cell: CellParameters | None
    stands: Array | None = None

    @property
    def nozzle(self) -> NozzleParameters:
        """The nozzle of the cell, or the usual one."""
        return NozzleParameters() if self.cell is None else self.cell.nozzle

    @property
    def model(self) -> BeadModel | None:
        """The bead model of the process."""
        return wire.process_model(self.process)


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
    toolpath = add_wire_speed(toolpath, inputs)
    progress.report(CHECKED, "looking for beads over nothing")
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
        _stands(toolpath, inputs, inputs.cell),
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
    return support.above(toolpath, _stands(toolpath, inputs, inputs.cell), toolpath.surroundings)


def _stands(toolpath: CoreToolpath, inputs: Given, cell: CellParameters) -> Array:
    return (
        mounted(cell, toolpath.frame, toolpath.family) if inputs.stands is None else inputs.stands
    )


def layers_of(inputs: Given) -> CoreToolpath:
    """Layers and beads of a feature; the nozzle is kept clear only of the feature itself, and only
    if directions are settled with the layers. InputErrors of the family.
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
    layers, model = _PLANNERS[family.kind].layers(inputs), inputs.model
    if model is not None and not family.is_filled:
        layers = notes.hold_widths(layers, process, model)
    toolpath = classes.set_bead_ends(layers, process)
    if not family.is_filled:
        toolpath = enforce_layer_time(
            toolpath, getattr(inputs.strategy, "min_layer_time", 0.0), process.rapid_speed
        )
    twice = toolpath.twice if family.is_filled else deposited_twice(toolpath)
    return dataclasses.replace(
        toolpath,
        max_from_vertical=inputs.build.max_from_vertical,
        twice=twice,
        retreat=process.retreat,
    )


def kept_clear(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None = None
) -> CoreToolpath:
    """The toolpath with tools tilted clear of bodies (including the platform) and deposit. feature:
    the number of the feature of `inputs` among several, which is kept clear.
    """
    return _PLANNERS[family_of(inputs.strategy).kind].cleared(toolpath, inputs, bodies, feature)


def add_wire_speed(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """The toolpath with the speed of its wire, and issues about speeds outside the material's
    range.
    """
    return check_speeds(set_wire_feed(toolpath, inputs.process, inputs.model), inputs.process)


def bases_of(inputs: Given) -> list[Any]:
    """The bases of solids; empty for walls and faces."""
    return [group.base for group in getattr(inputs.wall, "groups", ())]


def _share(fraction: float, text: str) -> None:
    progress.report(STRATEGY * fraction, text)


def _plan_revolution(inputs: Given) -> CoreToolpath:
    from ...core.strategies.revolution import plan as revolution

    stands = inputs.stands
    if stands is None and inputs.cell is not None and inputs.cell.mount == "part":
        stands = np.eye(4)
    toolpath = revolution.plan(
        inputs.wall,
        inputs.strategy,
        inputs.build,
        inputs.process,
        inputs.nozzle,
        0.0 if inputs.cell is None else inputs.cell.platform_diameter,
        stands,
        _share,
    )
    return dataclasses.replace(toolpath, surroundings=inputs.wall.surroundings)


def _plan_wall(inputs: Given) -> CoreToolpath:
    from ...core.geometry.walls.patch_wall import PatchWall

    if isinstance(inputs.wall, PatchWall):
        from ...core.strategies.walls import fronts as family
    else:
        from ...core.strategies.walls import plan as family
    on_another = getattr(inputs.wall, "ground", None) is None or inputs.stands is not None
    remedy = clearance.MOVE if on_another else clearance.MOUNT
    if (
        isinstance(inputs.wall, PatchWall)
        and inputs.cell is not None
        and (inputs.stands is not None or inputs.cell.mount != "feature")
    ):
        # the first layer is where the wall begins: before the others are looked for, which may take minutes
        begins = np.vstack([start_curve.curve().points for start_curve in inputs.wall.first])
        stands = np.eye(4) if inputs.stands is None else inputs.stands
        clearance.refuse_below(
            inputs.wall.label, begins, stands, inputs.cell.platform_diameter, remedy
        )
    toolpath = family.plan(inputs.wall, inputs.strategy, inputs.build, inputs.process, _share)
    if inputs.cell is not None:
        points = np.vstack([bead.points for _, _, bead in toolpath])
        stands = (
            mounted(inputs.cell, toolpath.frame, toolpath.family)
            if inputs.stands is None
            else inputs.stands
        )
        clearance.refuse_below(
            inputs.wall.label, points, stands, inputs.cell.platform_diameter, remedy
        )
    return dataclasses.replace(toolpath, surroundings=inputs.wall.surroundings)


def _plan_solids(inputs: Given) -> CoreToolpath:
    from ...core.strategies.solids import plan as solids_plan

    if inputs.stands is not None and inputs.cell is not None:
        clearance.refuse_solids_below(inputs.wall, inputs.stands, inputs.cell.platform_diameter)
    elif (
        inputs.cell is not None and inputs.cell.mount != "feature"
    ):  # the feature's own frame is at its lowest end
        clearance.refuse_solids_below(inputs.wall, np.eye(4), inputs.cell.platform_diameter)
    return solids_plan.plan(
        inputs.wall, inputs.strategy, inputs.build, inputs.process, inputs.model, _share
    )


def _plan_curves(inputs: Given) -> CoreToolpath:
    from ...core.strategies import curves

    toolpath = curves.plan(inputs.wall, inputs.strategy, inputs.build, inputs.process, _share)
    if inputs.cell is not None:
        points = np.vstack([bead.points for _, _, bead in toolpath])
        stands = (
            mounted(inputs.cell, toolpath.frame, toolpath.family)
            if inputs.stands is None
            else inputs.stands
        )
        clearance.refuse_below(inputs.wall.label, points, stands, inputs.cell.platform_diameter)
    return toolpath


def _plan_cladding(inputs: Given) -> CoreToolpath:
    from ...core.strategies import cladding

    toolpath = cladding.plan(
        inputs.wall, inputs.strategy, inputs.build, inputs.process, inputs.model, _share
    )
    if inputs.cell is not None:
        points = np.vstack([bead.points for _, _, bead in toolpath])
        stands = (
            mounted(inputs.cell, toolpath.frame, toolpath.family)
            if inputs.stands is None
            else inputs.stands
        )
        clearance.refuse_below(inputs.wall.label, points, stands, inputs.cell.platform_diameter)
    return toolpath


def _cladding_cleared(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """The machine turns the part so that its faces look up: no vertical bounds the tool axes."""
    free = dataclasses.replace(inputs.build, max_tilt=np.pi)
    return _tilted_clear(toolpath, inputs, bodies, feature, free)


def _tilted_clear(
    toolpath: CoreToolpath,
    inputs: Given,
    bodies: Sequence[Body],
    feature: int | None,
    build: BuildDirectionParameters | None = None,
    plane: Array | None = None,
) -> CoreToolpath:
    """As `tilt_back.keep_clear`; reports its progress, and once that it takes long. build: in place
    of the feature's.
    """
    from ...core.strategies import size
    from ...core.strategies.clearance import tilt_back
    from ...core.strategies.progress import Watch

    issues: list[Issue] = []

    def report_points(points: int, times: int) -> None:
        for issue in () if issues else size.tilting_issues(points, times):
            issues.append(issue)
            progress.report_issue(issue)

    def share(fraction: float) -> None:
        progress.report(STRATEGY + fraction * (CHECKED - STRATEGY), CLEARING)

    return tilt_back.keep_clear(
        toolpath,
        bodies,
        inputs.nozzle,
        build or inputs.build,
        plane,
        feature,
        Watch(report_points, share),
    )


def _curves_cleared(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    return _tilted_clear(toolpath, inputs, bodies, feature)


def _revolution_cleared(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """Check clearance to the surroundings; the rest was settled with the layers, except deposit of
    other features.
    """
    if feature is None:
        touch_issues = clearance_look.nozzle_issues(
            toolpath, inputs.wall.surroundings, inputs.nozzle
        )
        return dataclasses.replace(toolpath, issues=(*toolpath.issues, *touch_issues))
    feature_part = toolpath.parts[feature][0]
    count = feature_part.point_count
    alone = clearance_look.check_nozzle(feature_part, bodies, inputs.nozzle, count)
    among = clearance_look.check_nozzle(toolpath, bodies, inputs.nozzle, count, feature)
    if among.touched <= alone.touched:
        return toolpath
    return _tilted_clear(toolpath, inputs, bodies, feature)


def _wall_cleared(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    from ...core.strategies.walls.beads import symmetry_plane

    return _tilted_clear(
        toolpath, inputs, bodies, feature, plane=symmetry_plane(inputs.wall, inputs.build)
    )


def _solids_cleared(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """On a hub the machine turns them, so that no vertical bounds the tool axes."""
    from ...core.strategies.solids import plan as solids_plan

    if not inputs.wall.has_plane_layers():
        return _tilted_clear(
            toolpath, inputs, bodies, feature, solids_plan.lift_axis_limits(inputs.build)
        )
    if feature is None and solids_plan.clear_by_itself(toolpath, inputs.wall):
        return toolpath
    return _tilted_clear(toolpath, inputs, bodies, feature)


@dataclass(frozen=True)
class _Planner:
    layers: Callable[[Given], CoreToolpath]
    cleared: Callable[[CoreToolpath, Given, Sequence[Body], int | None], CoreToolpath]


_SOLIDS = _Planner(_plan_solids, _solids_cleared)
_PLANNERS = {
    "revolution": _Planner(_plan_revolution, _revolution_cleared),
    "surface": _Planner(_plan_wall, _wall_cleared),
    "developable": _SOLIDS,
    "solid": _SOLIDS,
    "curves": _Planner(_plan_curves, _curves_cleared),
    "cladding": _Planner(_plan_cladding, _cladding_cleared),
}
