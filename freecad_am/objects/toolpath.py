# SPDX-License-Identifier: LGPL-2.1-or-later
"""The toolpath in a document: layers and beads with build directions, made from a feature.

A family of features is imported when one of it is planned: all of them take longer than to plan a small part.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..brep.off_part import off_faces, off_mesh, off_solids
from ..core.geometry.on_hub import SolidsOnHub
from ..core.issues import InputError
from ..core.kinematics.cell import mounted
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters, NozzleParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.strategy import FilledParameters, RevolutionParameters, SolidParameters, SurfaceParameters
from ..core.process import bead_table, deposit_balance, on_part
from ..core.process.bead_model import BeadModel
from ..core.process.wire import fed
from ..core.strategies import clearance_look, platform, support
from ..core.toolpath import Toolpath as CoreToolpath
from . import progress
from .platforms import platforms
from .shapes import Taken, taken
from .stage import Link, Outcome, Section, Stage, Work, stage_of

FIXED = "fixed"
STRATEGY = 0.7  # of the time goes into layers and beads, the rest into keeping the nozzle clear
CHECKED, LOOKED = 0.92, 0.95  # and what is left into last looks


class Toolpath(Stage):
    """Result: core.toolpath.Toolpath. Without a cell the nozzle has its default shape and there is no platform."""

    kind = "toolpath"
    sections = (Section(ProcessParameters, "process", "Process"),)
    links = (
        Link("Feature", "feature", "The feature to deposit."),
        Link("Cell", "cell", "The cell, for the clearance of nozzle and platform.", required=False),
    )
    figures = (
        ("Layers", "App::PropertyInteger", "Number of layers."),
        ("Beads", "App::PropertyInteger", "Number of beads."),
        ("Points", "App::PropertyInteger", "Number of points of all beads."),
        ("Length", "App::PropertyLength", "Length of all beads."),
    )

    def prepare(self, obj: Any) -> Work:
        for following in obj.InList:
            stage = stage_of(following)
            if stage is not None and stage.kind == "joint path":
                following.Proxy.look_ahead(following)
        linked = self.linked(obj)
        feature, cell = linked["Feature"], linked["Cell"]
        shape = stage_of(feature)
        assert shape is not None
        carried = None if cell is None else cell.Proxy.value(cell)
        wall, strategy = shape.value(feature), shape.parameters(feature, strategy_of(shape))
        build, process = shape.parameters(feature, BuildDirectionParameters), self.parameters(obj, ProcessParameters)
        sources = tuple(taken(one) for one in (feature.Source[0], *getattr(feature, "Further", ())))

        def work() -> Outcome:
            toolpath = _looked_at(planned(wall, strategy, build, process, carried), wall, sources, strategy)
            told = deposit_balance.issues(deposit_balance.of_toolpath(wall, toolpath, process.bead_width))
            toolpath = dataclasses.replace(toolpath, issues=(*told, *toolpath.issues))
            figures = (
                ("Layers", len(toolpath.layers)), ("Beads", toolpath.bead_count), ("Points", toolpath.point_count),
                ("Length", toolpath.length),
            )
            return Outcome(toolpath, toolpath.issues, figures)

        return work

    def fixed(self, obj: Any) -> Callable[[], CoreToolpath] | None:
        """What makes the toolpath anew with one build direction, the axis of the part, without the document; None where it
        has that, and of features other than parts of revolution."""
        feature = obj.Feature
        shape = stage_of(feature)
        if shape is None or strategy_of(shape) is not RevolutionParameters:
            return None
        build = shape.parameters(feature, BuildDirectionParameters)
        if build.mode == FIXED:
            return None
        wall, strategy = shape.reader(feature), shape.parameters(feature, RevolutionParameters)
        process = self.parameters(obj, ProcessParameters)
        carried = None if obj.Cell is None else obj.Cell.Proxy.value(obj.Cell)
        return lambda: planned(wall(), strategy, dataclasses.replace(build, mode=FIXED), process, carried)

    def further_inputs(self, obj: Any) -> list[str]:
        model = self.parameters(obj, ProcessParameters).bead_model
        return [] if model == "none" else [repr(bead_table.load(model))]


def _looked_at(toolpath: CoreToolpath, wall: Any, sources: Sequence[Taken], strategy: Any) -> CoreToolpath:
    """The toolpath with whether it lies on the shapes that it was made for; nobody looks where these have no faces."""
    progress.report(LOOKED, "looking whether the deposit lies on the part")
    places = on_part.places(toolpath)
    if isinstance(strategy, SolidParameters):  # where the part was cut, above the surface that beads of the layer lie on
        up = strategy.share_of_cut * strategy.layer_height * places.build
        places = places._replace(points=places.points + up)
    limit = on_part.allowed(toolpath, getattr(strategy, "margin", 0.0))
    if isinstance(wall, SolidsOnHub):
        off = np.min([_off_solid(source, places.points, limit) for source in sources], axis=0)
    else:
        off = off_faces(sources[0].shape, wall.faces, places.points, limit)
    return on_part.judged(toolpath, places, off, limit)


def _off_solid(source: Taken, points: Any, limit: float) -> Any:
    if source.shape is not None:
        return off_solids(source.shape, points, limit)
    body = source.body()
    return off_mesh(body.vertices, body.triangles, points)


def strategy_of(feature: Stage) -> type:
    """The parameters dataclass of a feature's strategy."""
    return next(section.cls for section in feature.sections if section.prefix == "strategy")


def planned(
    wall: Any, strategy: RevolutionParameters | SurfaceParameters | FilledParameters,
    build: BuildDirectionParameters, process: ProcessParameters, cell: CellParameters | None,
) -> CoreToolpath:
    """The toolpath of a wall or of solids, the result of a feature, cut by the strategy of its family; what of it lies over
    nothing is told."""
    made = fed(_made(wall, strategy, build, process, cell), process, _model(process))
    progress.report(CHECKED, "looking for beads over nothing")
    plates = platforms(cell, made)
    if made.family == "revolution":
        stands = mounted(cell, made.frame, made.family) if cell is not None and plates else made.frame
        return support.told(made, (stands,), made.surroundings, ())
    bases = [group.base for group in wall.groups] if isinstance(wall, SolidsOnHub) else ()
    return support.told(made, (), (*made.surroundings, *plates), bases)


def _made(
    wall: Any, strategy: RevolutionParameters | SurfaceParameters | FilledParameters,
    build: BuildDirectionParameters, process: ProcessParameters, cell: CellParameters | None,
) -> CoreToolpath:
    if process.bead_model == "none" and process.wire.feed_mode != "constant":
        raise InputError(
            "NOT_FOR_FAMILY", "process.wire.feed_mode", "without a bead model the travel speed does not vary, and the wire "
            "has nothing to follow; use constant, or a process.bead_model"
        )
    if isinstance(strategy, FilledParameters):
        return _of_solids(wall, strategy, build, process, cell)
    if process.bead_model != "none":
        raise InputError(
            "NOT_FOR_FAMILY", "process.bead_model", "a bead model sets the travel speed of solids alone; use none"
        )
    if isinstance(strategy, SurfaceParameters):
        from ..core.geometry.patch_wall import PatchWall

        if isinstance(wall, PatchWall):
            from ..core.strategies import wall_fronts as family
        else:
            from ..core.strategies import surface as family
        made = family.plan(wall, strategy, build, process, _share)
        if cell is not None:
            points = np.vstack([bead.points for _, _, bead in made])
            platform.refuse_below(wall.label, points, mounted(cell, made.frame, made.family), cell.platform_diameter)
        progress.report(STRATEGY, "keeping the nozzle clear")
        return _kept_clear(made, wall, build, cell)
    from ..core.strategies import revolution

    toolpath = revolution.plan(
        wall, strategy, build, process, NozzleParameters() if cell is None else cell.nozzle,
        0.0 if cell is None else cell.platform_diameter,
        np.eye(4) if cell is not None and cell.mount == "part" else None, _share,
    )
    return _kept_clear(toolpath, wall, build, cell)


def _model(process: ProcessParameters) -> BeadModel | None:
    return None if process.bead_model == "none" else bead_table.load(process.bead_model)


def _share(fraction: float, text: str) -> None:
    progress.report(STRATEGY * fraction, text)


def _of_solids(
    solids: SolidsOnHub, strategy: FilledParameters, build: BuildDirectionParameters, process: ProcessParameters,
    cell: CellParameters | None,
) -> CoreToolpath:
    """Solids. On a hub the machine turns them, so that no vertical bounds the tool axes."""
    from ..core.strategies import wall_clearance
    from ..core.strategies.solids import plan as solids_plan

    model = _model(process)
    if cell is not None and cell.mount != "feature":  # the feature's own frame is at its lowest end
        platform.refuse_solids_below(solids, np.eye(4), cell.platform_diameter)
    toolpath = solids_plan.plan(solids, strategy, build, process, model, _share)
    if build.clearance == "none":
        return toolpath
    progress.report(STRATEGY, "keeping the nozzle clear")
    nozzle = NozzleParameters() if cell is None else cell.nozzle
    bodies = (*solids.surroundings, *platforms(cell, toolpath))
    if not solids_plan.on_planes(solids):
        return wall_clearance.kept_clear(toolpath, bodies, nozzle, solids_plan.without_axis_limits(build))
    if solids_plan.clear_by_itself(toolpath, solids):
        return toolpath
    return wall_clearance.kept_clear(toolpath, bodies, nozzle, build)


def _kept_clear(
    toolpath: CoreToolpath, wall: Any, build: BuildDirectionParameters, cell: CellParameters | None
) -> CoreToolpath:
    """The toolpath with what stands around its wall, and tools tilted clear of that; on parts of revolution it is looked
    at, the rest being settled with the layers."""
    toolpath = dataclasses.replace(toolpath, surroundings=wall.surroundings)
    nozzle = NozzleParameters() if cell is None else cell.nozzle
    if build.clearance == "none":
        return toolpath
    if toolpath.family == "revolution":
        found = clearance_look.touched_at(toolpath, wall.surroundings, nozzle)
        return dataclasses.replace(toolpath, issues=(*toolpath.issues, *found))
    from ..core.strategies import surface_directions, wall_clearance

    bodies = (*wall.surroundings, *platforms(cell, toolpath))
    return wall_clearance.kept_clear(toolpath, bodies, nozzle, build, surface_directions.plane(wall, build))
