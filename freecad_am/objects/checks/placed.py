# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inputs and arm checks for placing a toolpath or joint path of a document in a cell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core.issues import InputError, Issue
from ...core.kinematics.cell import Cell
from ...core.kinematics.links import external_links
from ...core.kinematics.links.contact import ArmContact
from ...core.kinematics.links.external_links import Mesh
from ...core.kinematics.links.self_collision import NONE
from ...core.motion import Motion
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.place import PlaceParameters
from ...core.parameters.process import ProcessParameters
from ...core.placement.judge import Cylinders, Job
from ...core.placement.place import Placed, place_part
from ...core.planning import arm_clearance
from ...core.simulation.watch import ArmTouches, arm_touches, deposit_obstacles
from ...core.toolpath import Toolpath
from .. import user_machines
from ..fields import rows
from ..shapes import cell_obstacles
from ..shapes.cell_obstacles import meshes_of
from ..stage import stage_of
from ..work import progress


def cylinders_of(cell: Cell) -> arm_clearance.Cylinders:
    """Return the capsules of each robot link; empty for machines without link data."""
    has_links = cell.arrangement.links_known
    return (
        external_links.robot_cylinders(cell.robot.chain, meshes_of(cell.machine))
        if has_links
        else ()
    )


def arm_of(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    shapes: tuple[Mesh | None, ...],
    max_positions: int | None = None,
    clearance: float = 0.0,
) -> ArmTouches | None:
    """Return the contacts of robot links, including distances below `clearance` mm.

    At most `max_positions` positions are checked. None for machines without link data.
    """
    if not cell.arrangement.links_known:
        return None
    return _touches(
        motion,
        cell,
        toolpath,
        process,
        external_links.robot_cylinders(cell.robot.chain, shapes),
        max_positions,
        clearance,
    )


def _touches(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_clearance.Cylinders,
    max_positions: int | None,
    clearance: float,
) -> ArmTouches:
    deposited = deposit_obstacles(
        motion, toolpath.bead_width or process.bead_width, toolpath.layer_height
    )
    return arm_touches(
        motion,
        ArmContact(cell, cylinders, toolpath.surroundings, deposited, clearance),
        max_positions,
    )


def arm_issues(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_clearance.Cylinders,
    known_issues: Sequence[Issue],
) -> tuple[Issue, ...]:
    """Return an error for each bead on which, or on whose approach, a link comes too close.

    cylinders: capsules of the links. Beads in `known_issues` with the same code are skipped.
    """
    assert cell.arm_clearance is not None
    touches = _touches(motion, cell, toolpath, process, cylinders, None, cell.arm_clearance)
    reported = {
        (issue.layer, issue.bead) for issue in known_issues if issue.code == arm_clearance.CODE
    }
    issues = []
    for row in np.flatnonzero(touches.link != NONE).tolist():
        location = int(motion.layer[row]), int(motion.bead[row])
        if location not in reported:
            reported.add(location)
            what = touches.names[touches.what[row]]
            link = touches.links[touches.link[row]]
            issues.append(
                arm_clearance.clearance_issue(
                    cell, link, what, *location, on_way=not motion.deposit[row]
                )
            )
    return tuple(issues)


class Placing(NamedTuple):
    """Inputs of a placement, read from a document.

    job: function that makes the job without the document. cell: the cell object. names: names of
    the objects. document: name of the document.
    """

    settings: CellParameters
    job: Callable[[], Job]
    cell: Any
    names: tuple[str, ...]
    document: str

    def search_poses(self, parameters: PlaceParameters) -> Placed:
        """Rate the poses of a box; report to `progress`. Errors as `place.place_part`."""
        return place_part(self.job(), self.settings, parameters, progress.report)


def placing_of(path: Any, cell: Any = None, joints: JointParameters | None = None) -> Placing:
    """Read the inputs for placing a joint path or toolpath, in its own cell or another cell.

    joints: planning parameters, by default those of the joint path. Raises InputError BAD_INPUT for
    other objects, NO_INPUT if toolpath or cell are missing or have no result.
    """
    stage = stage_of(path)
    if stage is None or stage.kind not in ("joint path", "toolpath"):
        label = getattr(path, "Label", repr(path))
        raise InputError(
            "BAD_INPUT",
            label,
            "the object is neither a toolpath nor a joint path; choose a toolpath or a joint path",
        )
    toolpath = path.Toolpath if stage.kind == "joint path" else path
    carried = cell if cell is not None else path.Cell
    for stage_object, what in ((toolpath, "toolpath"), (carried, "cell")):
        if stage_object is None or not stage_object.Key:
            raise InputError(
                "NO_INPUT", path.Label, "the {} is missing; choose another and recompute", what
            )
    read_toolpath, folders = toolpath.Proxy.reader(toolpath), tuple(user_machines.folders())
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)
    own_joints = (
        stage.parameters(path, JointParameters) if stage.kind == "joint path" else JointParameters()
    )
    names = tuple(dict.fromkeys((path.Name, toolpath.Name, carried.Name)))
    return Placing(
        carried.Proxy.value(carried),
        lambda: _job(read_toolpath(), folders, process, joints or own_joints),
        carried,
        names,
        path.Document.Name,
    )


def change_parameters(
    parameters: PlaceParameters | None, values: dict[str, Any]
) -> PlaceParameters:
    """Return the parameters with individual values replaced, by row key in outer units.

    Raises InputError UNKNOWN_PARAMETER, BAD_VALUE.
    """
    if not isinstance(parameters or PlaceParameters(), PlaceParameters):
        raise InputError(
            "BAD_INPUT",
            "parameters",
            "{} is not a valid parameter; use {}",
            type(parameters).__name__,
            PlaceParameters.__name__,
        )
    rows_by_key = {row.key: row for row in rows.rows(PlaceParameters)}
    unknown = sorted(set(values) - set(rows_by_key))
    if unknown:
        raise InputError(
            "UNKNOWN_PARAMETER",
            "place",
            "{} is not known; use one of {}",
            ", ".join(unknown),
            ", ".join(sorted(rows_by_key)),
        )
    inner = rows.flat(parameters or PlaceParameters())
    try:
        inner.update(
            {
                name: rows_by_key[name].inner(value, f"place.{name}")
                for name, value in values.items()
            }
        )
        changed: PlaceParameters = rows.build(PlaceParameters, inner)
    except ReferenceError:
        raise InputError(
            "BAD_INPUT", "place", "the value is a deleted object; give a number or a text"
        ) from None
    return changed


def _job(
    toolpath: Toolpath,
    folders: tuple[str, ...],
    process: ProcessParameters,
    joints: JointParameters,
) -> Job:
    def cell(settings: CellParameters) -> Cell:
        return cell_obstacles.resolved(settings, toolpath, folders)

    def cylinders(resolved_cell: Cell) -> Cylinders:
        return tuple(tuple(link) for link in cylinders_of(resolved_cell))

    return Job(toolpath, cell, cylinders, process, joints)
