# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a feature of each family becomes a toolpath: layers and beads, the nozzle kept clear, what carries them.

A family is imported when one of its features is planned: all of them take longer than to plan a small part.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ...core.geometry.obstacles import Body
from ...core.issues import InputError, Issue
from ...core.kinematics.cell import mounted
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.cell import CellParameters, NozzleParameters
from ...core.parameters.process import ProcessParameters
from ...core.process import classes
from ...core.process.deposit.twice import deposited_twice
from ...core.process.model import bead_table, held_width
from ...core.process.model.bead_model import BeadModel
from ...core.process.model.material import check_speeds
from ...core.process.model.wire import set_wire_feed
from ...core.process.order import enforce_layer_time
from ...core.strategies import support
from ...core.strategies.clearance import look as clearance_look
from ...core.strategies.families import family_of
from ...core.strategies.revolution import platform
from ...core.toolpath import Toolpath as CoreToolpath
from ..shapes.platforms import platforms
from ..work import progress

STRATEGY = 0.7  # of the time goes into layers and beads, the rest into keeping the nozzle clear
CHECKED = 0.92  # and what is left into last looks
CLEARING = "keeping the nozzle clear"


@dataclass(frozen=True, eq=False)
class Given:
    """What a feature is planned of: its wall or its solids, which the feature object has found, and parameters. cell: as
    `seen_of` leaves it. stands: (4, 4) in part coordinates, the frame that sits on the platform where an earlier feature
    says which; else None."""

    wall: Any
    strategy: Any
    build: BuildDirectionParameters
    process: ProcessParameters
    cell: CellParameters | None
    stands: Array | None = None

    @property
    def nozzle(self) -> NozzleParameters:
        """Of the cell, or the usual one."""
        return NozzleParameters() if self.cell is None else self.cell.nozzle

    @property
    def model(self) -> BeadModel | None:
        """The bead model of the process."""
        return bead_table.process_model(self.process)


def seen_of(cell: CellParameters) -> CellParameters:
    """What a toolpath is planned by of a cell: nozzle, platform and which frame sits on that. All else is left as it usually
    is, so that nothing of a toolpath can depend on it, and a change of it leaves layers as they are."""
    return CellParameters(
        nozzle=cell.nozzle, platform_diameter=cell.platform_diameter, mount=cell.mount
    )


def planned(
    of: Given, fit: Callable[[CoreToolpath], CoreToolpath] = lambda made: made
) -> CoreToolpath:
    """The toolpath of a feature that is deposited alone, layers changed by `fit`; what of it lies over nothing is told."""
    made = fit(layers_of(of))
    if of.build.clearance != "none":
        progress.report(STRATEGY, CLEARING)
        made = kept_clear(made, of, (*of.wall.surroundings, *platforms(of.cell, made)))
    made = with_wire(made, of)
    progress.report(CHECKED, "looking for beads over nothing")
    plates = platforms(of.cell, made)
    if made.family == "revolution":
        stands = (
            mounted(of.cell, made.frame, made.family)
            if of.cell is not None and plates
            else made.frame
        )
        return support.with_support(made, (stands,), made.surroundings, ())
    aloft = above_platform(made, of)
    made = dataclasses.replace(made, issues=(*made.issues, *aloft))
    made = support.with_support(
        made, (), (*made.surroundings, *plates), () if aloft else bases_of(of)
    )
    return over_edge(made, of)


def over_edge(made: CoreToolpath, of: Given) -> CoreToolpath:
    """The toolpath with a warning where it begins beyond the edge of the platform."""
    if of.cell is None or of.cell.platform_diameter <= 0.0:
        return made
    feature = (
        made.frame if of.stands is None else None
    )  # of several the first one's frame counts for all
    found = support.over_edge(
        made, _stands(made, of, of.cell), of.cell.platform_diameter, made.surroundings, feature
    )
    return dataclasses.replace(made, issues=(*made.issues, *found))


def above_platform(made: CoreToolpath, of: Given) -> list[Issue]:
    """A warning where a solid that stands on a plane begins above the platform: that plane carries nothing then."""
    if of.cell is None or of.cell.platform_diameter <= 0.0 or not support.on_planes(bases_of(of)):
        return []
    return support.above(made, _stands(made, of, of.cell), made.surroundings)


def _stands(made: CoreToolpath, of: Given, cell: CellParameters) -> Array:
    return mounted(cell, made.frame, made.family) if of.stands is None else of.stands


def layers_of(of: Given) -> CoreToolpath:
    """Layers and beads of a feature; the nozzle is kept clear of the feature alone, and of that only where directions are
    settled with the layers. InputError, those of the family."""
    process = of.process
    if process.bead_model == "none" and process.wire.feed_mode != "constant" and not process.ramped:
        raise InputError(
            "NOT_FOR_FAMILY",
            "process.wire.feed_mode",
            "without a bead model or a ramp the travel speed does not vary, and "
            "the wire has nothing to follow; use constant, a process.bead_model, or process.start.ramp or process.end.ramp",
        )
    classes.refuse_speeds(process)
    family = family_of(of.strategy)
    layers, model = _PLANNERS[family.kind].layers(of), of.model
    if model is not None and not family.filled:
        layers = held_width.hold_widths(layers, process, model)
    made = classes.set_bead_ends(layers, process)
    if not family.filled:
        made = enforce_layer_time(
            made, getattr(of.strategy, "min_layer_time", 0.0), process.rapid_speed
        )
    twice = made.twice if family.filled else deposited_twice(made)
    return dataclasses.replace(
        made, max_from_vertical=of.build.max_from_vertical, twice=twice, retreat=process.retreat
    )


def kept_clear(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None = None
) -> CoreToolpath:
    """The toolpath with tools tilted clear of bodies, the platform one of them, and of deposit. feature: of several, the one
    that `of` is and that is kept clear."""
    return _PLANNERS[family_of(of.strategy).kind].cleared(toolpath, of, bodies, feature)


def with_wire(toolpath: CoreToolpath, of: Given) -> CoreToolpath:
    """The toolpath with the speed of its wire, and whether its beads are laid as their material is."""
    return check_speeds(set_wire_feed(toolpath, of.process, of.model), of.process)


def bases_of(of: Given) -> list[Any]:
    """The surfaces that solids stand on; none of walls and faces."""
    return [group.base for group in getattr(of.wall, "groups", ())]


def _share(fraction: float, text: str) -> None:
    progress.report(STRATEGY * fraction, text)


def _of_revolution(of: Given) -> CoreToolpath:
    from ...core.strategies.revolution import plan as revolution

    stands = of.stands
    if stands is None and of.cell is not None and of.cell.mount == "part":
        stands = np.eye(4)
    made = revolution.plan(
        of.wall,
        of.strategy,
        of.build,
        of.process,
        of.nozzle,
        0.0 if of.cell is None else of.cell.platform_diameter,
        stands,
        _share,
    )
    return dataclasses.replace(made, surroundings=of.wall.surroundings)


def _of_wall(of: Given) -> CoreToolpath:
    from ...core.geometry.walls.patch_wall import PatchWall

    if isinstance(of.wall, PatchWall):
        from ...core.strategies.walls import fronts as family
    else:
        from ...core.strategies.walls import plan as family
    on_another = getattr(of.wall, "ground", None) is None or of.stands is not None
    remedy = platform.MOVE if on_another else platform.MOUNT
    if (
        isinstance(of.wall, PatchWall)
        and of.cell is not None
        and (of.stands is not None or of.cell.mount != "feature")
    ):
        # the first layer is where the wall begins: before the others are looked for, which may take minutes
        begins = np.vstack([first.curve().points for first in of.wall.first])
        stands = np.eye(4) if of.stands is None else of.stands
        platform.refuse_below(of.wall.label, begins, stands, of.cell.platform_diameter, remedy)
    made = family.plan(of.wall, of.strategy, of.build, of.process, _share)
    if of.cell is not None:
        points = np.vstack([bead.points for _, _, bead in made])
        stands = mounted(of.cell, made.frame, made.family) if of.stands is None else of.stands
        platform.refuse_below(of.wall.label, points, stands, of.cell.platform_diameter, remedy)
    return dataclasses.replace(made, surroundings=of.wall.surroundings)


def _of_solids(of: Given) -> CoreToolpath:
    from ...core.strategies.solids import plan as solids_plan

    if of.stands is not None and of.cell is not None:
        platform.refuse_solids_below(of.wall, of.stands, of.cell.platform_diameter)
    elif (
        of.cell is not None and of.cell.mount != "feature"
    ):  # the feature's own frame is at its lowest end
        platform.refuse_solids_below(of.wall, np.eye(4), of.cell.platform_diameter)
    return solids_plan.plan(of.wall, of.strategy, of.build, of.process, of.model, _share)


def _of_curves(of: Given) -> CoreToolpath:
    from ...core.strategies import curves

    made = curves.plan(of.wall, of.strategy, of.build, of.process, _share)
    if of.cell is not None:
        points = np.vstack([bead.points for _, _, bead in made])
        stands = mounted(of.cell, made.frame, made.family) if of.stands is None else of.stands
        platform.refuse_below(of.wall.label, points, stands, of.cell.platform_diameter)
    return made


def _of_cladding(of: Given) -> CoreToolpath:
    from ...core.strategies import cladding

    made = cladding.plan(of.wall, of.strategy, of.build, of.process, of.model, _share)
    if of.cell is not None:
        points = np.vstack([bead.points for _, _, bead in made])
        stands = mounted(of.cell, made.frame, made.family) if of.stands is None else of.stands
        platform.refuse_below(of.wall.label, points, stands, of.cell.platform_diameter)
    return made


def _cladding_cleared(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """The machine turns the part so that its faces look up: no vertical bounds the tool axes."""
    free = dataclasses.replace(of.build, max_tilt=np.pi)
    return _tilted_clear(toolpath, of, bodies, feature, free)


def _tilted_clear(
    toolpath: CoreToolpath,
    of: Given,
    bodies: Sequence[Body],
    feature: int | None,
    build: BuildDirectionParameters | None = None,
    plane: Array | None = None,
) -> CoreToolpath:
    """As `tilt_back.kept_clear`; how far it is is told, and once that it takes long. build: in place of the feature's."""
    from ...core.strategies import size
    from ...core.strategies.clearance import tilt_back
    from ...core.strategies.progress import Watch

    issues: list[Issue] = []

    def tell(points: int, times: int) -> None:
        for issue in () if issues else size.of_tilting(points, times):
            issues.append(issue)
            progress.tell(issue)

    def share(done: float) -> None:
        progress.report(STRATEGY + done * (CHECKED - STRATEGY), CLEARING)

    return tilt_back.kept_clear(
        toolpath, bodies, of.nozzle, build or of.build, plane, feature, Watch(tell, share)
    )


def _curves_cleared(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    return _tilted_clear(toolpath, of, bodies, feature)


def _revolution_cleared(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """It is looked at what stands around; the rest was settled with the layers, but for what is deposited of others."""
    if feature is None:
        found = clearance_look.touched_at(toolpath, of.wall.surroundings, of.nozzle)
        return dataclasses.replace(toolpath, issues=(*toolpath.issues, *found))
    own = toolpath.parts[feature][0]
    count = own.point_count
    alone = clearance_look.looked_at(own, bodies, of.nozzle, count)
    among = clearance_look.looked_at(toolpath, bodies, of.nozzle, count, feature)
    if among.touched <= alone.touched:
        return toolpath
    return _tilted_clear(toolpath, of, bodies, feature)


def _wall_cleared(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    from ...core.strategies.walls.directions import symmetry_plane

    return _tilted_clear(toolpath, of, bodies, feature, plane=symmetry_plane(of.wall, of.build))


def _solids_cleared(
    toolpath: CoreToolpath, of: Given, bodies: Sequence[Body], feature: int | None
) -> CoreToolpath:
    """On a hub the machine turns them, so that no vertical bounds the tool axes."""
    from ...core.strategies.solids import plan as solids_plan

    if not of.wall.has_plane_layers():
        return _tilted_clear(
            toolpath, of, bodies, feature, solids_plan.without_axis_limits(of.build)
        )
    if feature is None and solids_plan.clear_by_itself(toolpath, of.wall):
        return toolpath
    return _tilted_clear(toolpath, of, bodies, feature)


@dataclass(frozen=True)
class _Planner:
    layers: Callable[[Given], CoreToolpath]
    cleared: Callable[[CoreToolpath, Given, Sequence[Body], int | None], CoreToolpath]


_SOLIDS = _Planner(_of_solids, _solids_cleared)
_PLANNERS = {
    "revolution": _Planner(_of_revolution, _revolution_cleared),
    "surface": _Planner(_of_wall, _wall_cleared),
    "developable": _SOLIDS,
    "solid": _SOLIDS,
    "curves": _Planner(_of_curves, _curves_cleared),
    "cladding": _Planner(_of_cladding, _cladding_cleared),
}
