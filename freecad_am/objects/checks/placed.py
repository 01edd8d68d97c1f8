# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is placed of a document: a toolpath, or a joint path of it with what it is planned with, in a cell."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from ...core.issues import InputError
from ...core.kinematics.cell import Cell
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.place import PlaceParameters
from ...core.parameters.process import ProcessParameters
from ...core.placement.judge import Cylinders, Job
from ...core.placement.place import Placed, placed
from ...core.toolpath import Toolpath
from .. import user_machines
from ..fields import rows
from ..shapes import cell_obstacles
from ..stage import stage_of
from ..work import progress
from .links_clear import cylinders_of


class Placing(NamedTuple):
    """What is read of a document: its cell and what makes the job, without the document. names: of the objects; document:
    its name; cell: the object."""

    settings: CellParameters
    job: Callable[[], Job]
    cell: Any
    names: tuple[str, ...]
    document: str

    def placed(self, parameters: PlaceParameters) -> Placed:
        """What the poses of a box come to; `progress` is told how far it is. Errors as `place.placed`."""
        return placed(self.job(), self.settings, parameters, progress.report)


def placing_of(path: Any, cell: Any = None, joints: JointParameters | None = None) -> Placing:
    """What is placed of a joint path or a toolpath, in its own cell or in another. joints: with what it is planned, else
    what the joint path has.

    Raises InputError BAD_INPUT for other objects, NO_INPUT where toolpath or cell are missing or have no result.
    """
    stage = stage_of(path)
    if stage is None or stage.kind not in ("joint path", "toolpath"):
        label = getattr(path, "Label", repr(path))
        raise InputError("BAD_INPUT", label, "it is neither a toolpath nor a joint path; give one")
    toolpath = path.Toolpath if stage.kind == "joint path" else path
    carried = cell if cell is not None else path.Cell
    for one, what in ((toolpath, "toolpath"), (carried, "cell")):
        if one is None or not one.Key:
            raise InputError(
                "NO_INPUT", path.Label, "its {} is missing; choose one and recompute", what
            )
    read, folders = toolpath.Proxy.reader(toolpath), tuple(user_machines.folders())
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)
    own = (
        stage.parameters(path, JointParameters) if stage.kind == "joint path" else JointParameters()
    )
    names = tuple(dict.fromkeys((path.Name, toolpath.Name, carried.Name)))
    return Placing(
        carried.Proxy.value(carried),
        lambda: _job(read(), folders, process, joints or own),
        carried,
        names,
        path.Document.Name,
    )


def given(parameters: PlaceParameters | None, values: dict[str, Any]) -> PlaceParameters:
    """Parameters with single ones changed, in outer units by row key. InputError UNKNOWN_PARAMETER, BAD_VALUE."""
    if not isinstance(parameters or PlaceParameters(), PlaceParameters):
        raise InputError(
            "BAD_INPUT",
            "parameters",
            "{} is none of the parameters that it takes; give {}",
            type(parameters).__name__,
            PlaceParameters.__name__,
        )
    known = {row.key: row for row in rows.rows(PlaceParameters)}
    unknown = sorted(set(values) - set(known))
    if unknown:
        raise InputError(
            "UNKNOWN_PARAMETER",
            "place",
            "{} is not known; use one of {}",
            ", ".join(unknown),
            ", ".join(sorted(known)),
        )
    inner = rows.flat(parameters or PlaceParameters())
    try:
        inner.update(
            {name: known[name].inner(value, f"place.{name}") for name, value in values.items()}
        )
        found: PlaceParameters = rows.build(PlaceParameters, inner)
    except ReferenceError:
        raise InputError(
            "BAD_INPUT", "place", "a value is an object that was deleted; give a number or a text"
        ) from None
    return found


def _job(
    toolpath: Toolpath,
    folders: tuple[str, ...],
    process: ProcessParameters,
    joints: JointParameters,
) -> Job:
    def cell(settings: CellParameters) -> Cell:
        return cell_obstacles.resolved(settings, toolpath, folders)

    def cylinders(of: Cell) -> Cylinders:
        return tuple(tuple(link) for link in cylinders_of(of))

    return Job(toolpath, cell, cylinders, process, joints)
