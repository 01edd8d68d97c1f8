# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan the toolpath of a feature: layers and beads, nozzle clearance, support, and remedies."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...brep.kernel.process import in_kernel_process
from ...brep.shapes.tessellate import tessellated
from ...core.families.registry import family_of
from ...core.geometry.frames import unit
from ...core.geometry.obstacles import Body
from ...core.issues import ERROR, NOTE, AmError, InputError, Issue, Text, has_errors
from ...core.kinematics.cell import mounted
from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import PLANES
from ...core.parameters.settings import WHERE, Setting
from ...core.process import classes, model_notes, seams
from ...core.process.bead_model import check_speeds
from ...core.process.cooling_waits import enforce_layer_time, remove_waits
from ...core.process.deposit.pieces import deposited_twice
from ...core.process.wire import set_wire_feed
from ...core.strategies import support
from ...core.strategies.by_place import Zone, apply_settings
from ...core.strategies.clearance.nozzle_check import CLEARANCE
from ...core.toolpath import MotionRules, Toolpath
from ...core.toolpath import Toolpath as CoreToolpath
from ...core.types import Array
from ..families.given import Given, platform_frame
from ..families.planner import CHECKED, CLEARING, STRATEGY
from ..families.registry import planner_for, planner_of
from ..shapes.bodies import global_shape, is_mesh, snapshot_of
from ..shapes.cell_obstacles import platforms
from ..work import progress

if TYPE_CHECKING:
    from ...core.planning.other_cells import Fixed


def seen_of(cell: CellParameters) -> CellParameters:
    """Return the part of a cell that affects a toolpath: nozzle, platform and mount.

    All other parameters get their defaults, so that changing them does not invalidate the layers.
    """
    return CellParameters(
        nozzle=cell.nozzle, platform_diameter=cell.platform_diameter, mount=cell.mount
    )


def planned(
    inputs: Given, fit: Callable[[CoreToolpath], CoreToolpath] = lambda toolpath: toolpath
) -> CoreToolpath:
    """Plan the toolpath of a single feature, and report unsupported beads.

    fit: function applied to the layers before clearance.
    """
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
    """Return the toolpath with a warning if it begins beyond the edge of the platform."""
    if inputs.cell is None or inputs.cell.platform_diameter <= 0.0:
        return toolpath
    feature = (
        toolpath.frame if inputs.stands is None else None
    )  # with several features, the frame of the first feature applies to all
    edge_issues = support.over_edge(
        toolpath,
        platform_frame(toolpath, inputs, inputs.cell),
        inputs.cell.platform_diameter,
        toolpath.surroundings,
        feature,
    )
    return dataclasses.replace(toolpath, issues=(*toolpath.issues, *edge_issues))


def above_platform(toolpath: CoreToolpath, inputs: Given) -> list[Issue]:
    """Return a warning if a solid with a plane base begins above the platform, unsupported."""
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
            "without a bead model or a ramp the travel speed is constant, and a proportional "
            "wire feed has no effect; use constant, a process.bead_model, or process.start.ramp "
            "or process.end.ramp",
        )
    classes.refuse_speeds(process)
    seams.check_parameters(process.seam)
    family = family_of(inputs.strategy)
    layers, model = planner_of(family).plan_layers(inputs), inputs.model
    if not family.is_filled:
        layers = seams.place_seams(layers, process)
    seams.check_distance(layers, process.seam)
    layers = dataclasses.replace(
        layers, issues=(*layers.issues, *seams.unused_issues(layers, process.seam))
    )
    if model is not None and not family.is_filled:
        layers = model_notes.hold_widths(layers, process, model)
    layers = apply_settings(layers, process, inputs.zones, stacking_direction(layers, inputs))
    toolpath = seams.set_scarfs(classes.set_bead_ends(layers, process), process)
    if not family.is_filled or _waits_by_speed(inputs):
        toolpath = remove_waits(toolpath)
        toolpath = enforce_layer_time(
            toolpath, getattr(inputs.strategy, "min_layer_time", 0.0), process.rapid_speed
        )
    twice = toolpath.checks.twice if family.is_filled else deposited_twice(toolpath)
    return dataclasses.replace(
        toolpath.add_checks(twice=twice),
        rules=MotionRules(process.overlap, process.retreat, inputs.build.max_from_vertical),
    )


def _waits_by_speed(inputs: Given) -> bool:
    """Return whether the waits of a filled feature must be found again, at the speeds of places.

    Raises InputError NOT_YET for a wait between visits to a solid.
    """
    if all(setting.travel_speed is None for setting in inputs.process.settings):
        return False
    if getattr(inputs.strategy, "wait", 0.0) > 0.0:
        raise InputError(
            "NOT_YET",
            "strategy.wait",
            "settings by place that change the travel speed cannot be combined with it yet; use "
            "strategy.min_layer_time or process.between_layers.wait",
        )
    return getattr(inputs.strategy, "min_layer_time", 0.0) > 0.0


def stacking_direction(toolpath: CoreToolpath, inputs: Given) -> Array:
    """Return the direction (3,) in which the layers of a feature are stacked, part coordinates."""
    groups = getattr(inputs.wall, "groups", ())
    if groups:
        base = groups[0].base if inputs.wall.has_plane_layers() else None
        return np.asarray(toolpath.frame[:3, 2] if base is None else base.frame[:3, 2])
    direction = getattr(inputs.strategy, "direction", None)  # of curves
    return np.asarray(toolpath.frame[:3, 2] if direction is None else unit(np.array(direction)))


def kept_clear(
    toolpath: CoreToolpath, inputs: Given, bodies: Sequence[Body], feature: int | None = None
) -> CoreToolpath:
    """Tilt the tool axes of a toolpath clear of bodies (including the platform) and deposit.

    feature: index of the feature of `inputs` among several; only this feature is tilted.
    """
    return planner_for(inputs.strategy).keep_clear(toolpath, inputs, bodies, feature)


def add_wire_speed(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """Set the wire feed of a toolpath, and report speeds outside the material's range."""
    return check_speeds(set_wire_feed(toolpath, inputs.process, inputs.model), inputs.process)


def measure_infill(toolpath: CoreToolpath, inputs: Given) -> CoreToolpath:
    """Measure void and double deposit of plane layers, and report layers with too much void."""
    max_void = getattr(inputs.strategy, "max_void", None)
    if max_void is None:
        return toolpath
    from ...core.process.deposit import void_and_double  # only needed for plane layers

    return void_and_double.measure(toolpath, max_void)


def bases_of(inputs: Given) -> list[Any]:
    """Return the bases of solids; empty for walls and faces."""
    return [group.base for group in getattr(inputs.wall, "groups", ())]


# ---- Remedies if no tilt clears the nozzle: one build direction for a leaning wall, plane layers
# for a solid with curved layers


def in_planes(inputs: Given, fit: Callable[[Toolpath], Toolpath] | None) -> Fixed | None:
    """Return the alternative with plane layers for a solid with curved layers, else None.

    The curved layers must start at the base of the solid.
    """
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
    """Test whether an alternative clears the nozzle, and add a note on the outcome.

    The toolpath is unchanged without an alternative, or unless nozzle contact is its only error.
    """
    errors = {issue.code for issue in toolpath.issues if issue.level == ERROR}
    if fixed is None or errors != {CLEARANCE}:
        return toolpath
    from ...core.planning.remedies import NO_REMEDY, REMEDY

    progress.report(1.0, Text("searching for a change that clears the nozzle: {}", fixed.remedy))
    try:
        clear = not has_errors(list(fixed.make().issues))
    except AmError:  # an invalid alternative is not a remedy
        clear = False
    note = (
        Issue(
            NOTE,
            REMEDY,
            Text(
                "with {} the nozzle is clear; the toolpath, but not the joint path, was planned "
                "with this change",
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


# ---- Geometry of settings by place: solids of the document, and faces of the part

CHORD_MM = 0.01  # mm; largest distance of the triangles from curved faces


def zones_of(settings: Sequence[Setting], objects: Sequence[Any], source: Any) -> tuple[Zone, ...]:
    """Return the geometry of each setting, in document coordinates.

    Parameters
    ----------
    settings : sequence of Setting
        The settings.
    objects : sequence of App.DocumentObject
        The objects that `inside` may name, by name or label.
    source : App.DocumentObject
        The part with the faces.

    Returns
    -------
    tuple of Zone
        A zone for each setting; without geometry if it has none.

    Raises
    ------
    InputError
        NO_OBJECT, NO_FACES or NO_SHAPE, naming the setting.
    """
    solids: dict[str, Body] = {}
    zones = []
    for number, setting in enumerate(settings):
        where = f"{WHERE}[{number}].where"
        if setting.inside and setting.inside not in solids:
            solids[setting.inside] = _solid(setting.inside, objects, where)
        faces = _faces(setting.faces, source, where) if setting.faces else None
        zones.append(Zone(solids.get(setting.inside), faces))
    return tuple(zones)


def _solid(name: str, objects: Sequence[Any], where: str) -> Body:
    named = [obj for obj in objects if name == obj.Name] or [
        obj for obj in objects if name == obj.Label
    ]
    if not named:
        labels = ", ".join(obj.Label for obj in objects) or "none"
        raise InputError(
            "NO_OBJECT",
            f"{where}.inside",
            "{} is not among the zones of the toolpath ({}); add the object to its property Zones, "
            "or name another",
            name,
            labels,
        )
    snapshot = snapshot_of(named[0])
    if snapshot.mesh is not None:
        return snapshot.body()
    if not snapshot.shape.Solids:
        raise InputError(
            "OPEN_MESH",
            f"{where}.inside",
            "{} is not a solid, so it has no inside; use a closed solid, a closed mesh or a box",
            snapshot.label,
        )
    triangles = in_kernel_process(tessellated, snapshot.shape.copy(False), CHORD_MM)
    return Body(snapshot.label, triangles.vertices, triangles.triangles)


def _faces(names: Sequence[str], source: Any, where: str) -> Array:
    """Return the triangles (m, 3, 3) of faces of a part."""
    if is_mesh(source):
        raise InputError(
            "NO_FACES",
            f"{where}.faces",
            "{} is a mesh, which has no faces; use a solid, a box or heights",
            source.Label,
        )
    shape = global_shape(source)
    missing = [
        name
        for name in names
        if not name.removeprefix("Face").isdecimal()
        or not 1 <= int(name.removeprefix("Face")) <= len(shape.Faces)
    ]
    if missing:
        raise InputError(
            "NO_FACES",
            f"{where}.faces",
            "{} has no {}; it has Face1 to Face{}",
            source.Label,
            ", ".join(missing),
            len(shape.Faces),
        )
    triangles = in_kernel_process(tessellated, shape.copy(False), CHORD_MM)
    face_numbers = [int(name.removeprefix("Face")) - 1 for name in names]
    rows = [triangles.vertices[triangles.triangles[triangles.owner == k]] for k in face_numbers]
    return np.concatenate(rows)
