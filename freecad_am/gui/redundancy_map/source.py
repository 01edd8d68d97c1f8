# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a map is made of: a joint path of a document with its toolpath and cell."""

from __future__ import annotations

import contextlib
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ...core.collision.bead_ends import LINK_GRAIN, Beads
from ...core.issues import InputError
from ...core.kinematics.cell import Cell
from ...core.kinematics.inverse import opw
from ...core.kinematics.links import cylinders as link_cylinders
from ...core.kinematics.links.contact import ArmContact
from ...core.kinematics.links.cylinders import Mesh
from ...core.parameters.joints import JointParameters
from ...core.parameters.process import ProcessParameters
from ...core.planning.joint_path import JointPath
from ...core.planning.plan import REVOLUTION
from ...core.planning.task import Task
from ...core.toolpath import Bead, Toolpath
from ...objects import user_machines
from ...objects.joint_path import planned_of
from ...objects.results.findings import first_message, issues_of
from ...objects.shapes.cell_obstacles import resolved
from ...objects.shapes.link_meshes import meshes_of
from ...objects.stage import stage_of
from ...objects.staleness import UP_TO_DATE
from ..texts.translation import tr, translated


@dataclass(frozen=True)
class Source:
    """All that is read of the document. objects: names of those it was read from. beads: of the toolpath, with their places
    (layer, index), from the seams that the plan moved them to. width: mm of beads that tell none. shapes: meshes that a user
    gave the links of the robot."""

    document: str
    name: str
    title: str
    objects: tuple[str, ...]
    cell: Cell
    parameters: JointParameters
    toolpath: Toolpath
    planned: JointPath
    beads: tuple[Bead, ...]
    places: tuple[tuple[int, int], ...]
    width: float
    shapes: tuple[Mesh | None, ...]

    @cached_property
    def starts(self) -> Array:
        """(beads + 1,) how many points there are before each bead, and in all."""
        return np.concatenate([[0], np.cumsum([len(bead) for bead in self.beads])])

    @cached_property
    def arm(self) -> ArmContact:
        """The robot with what is around it and, in the order of the beads, the deposit; made in the background."""
        deposited = Beads.of(self.beads, self.width, self.toolpath.layer_height).solid(LINK_GRAIN)
        cylinders = link_cylinders.robot_cylinders(self.cell.robot.chain, self.shapes)
        return ArmContact(self.cell, cylinders, self.toolpath.surroundings, deposited)

    @property
    def branch(self) -> int:
        """The branch that was planned."""
        return opw.branch_index(self.planned.branch)

    def task(self, branch: int) -> Task:
        """What the planner has to do on a branch."""
        return Task(self.cell, branch, self.parameters, self.toolpath.family != REVOLUTION)


def source_of(obj: Any) -> Source:
    """What there is about a joint path. Raises InputError where there is no map of it, saying what to do."""
    stage = stage_of(obj)
    if stage is None or stage.kind != "joint path":
        raise InputError("NO_MAP", getattr(obj, "Label", "?"), "it is not a joint path; select one")
    value, toolpath, looks = planned_of(obj, obj.Label)
    cell = resolved(looks, toolpath, user_machines.folders())
    if not cell.machine.free or not value.joint_path.branch:
        raise InputError(
            "NO_MAP",
            obj.Label,
            "its machine has two rotary axes and no tool redundancy; open the map of a robot",
        )
    return Source(
        document=obj.Document.Name,
        name=obj.Name,
        title=obj.Label,
        objects=tuple(dict.fromkeys((obj.Name, obj.Toolpath.Name, obj.Cell.Name))),
        cell=cell,
        parameters=obj.Proxy.parameters(obj, JointParameters),
        toolpath=toolpath,
        planned=value.joint_path,
        beads=_as_run(toolpath, value.joint_path, cell),
        places=_places(toolpath, value.joint_path, cell),
        width=obj.Toolpath.Proxy.parameters(obj.Toolpath, ProcessParameters).bead_width,
        shapes=meshes_of(cell.robot),
    )


def status_of(obj: Any) -> tuple[str, bool]:
    """How a joint path itself stands, in words of the window, and whether that is wrong; '' of one that is gone."""
    with contextlib.suppress(ReferenceError, RuntimeError):
        message = first_message(issues_of(obj))
        wrong, status = obj.Status != UP_TO_DATE, translated(obj.Status)
        return tr("{}: {}").format(
            status, translated(message)
        ) if message and wrong else status, wrong
    return "", False


def _places(toolpath: Toolpath, planned: JointPath, cell: Cell) -> tuple[tuple[int, int], ...]:
    if cell.external is not None:
        return tuple((path.layer, path.index) for path in planned.beads)
    return tuple((layer, index) for layer, index, _ in toolpath)


def _as_run(toolpath: Toolpath, planned: JointPath, cell: Cell) -> tuple[Bead, ...]:
    """The beads of a toolpath from the seams of the plan: it may start a closed one elsewhere, where an axis then has the
    room for it that it has not from its own seam. Layers with beads that it runs in pieces are as they are. With external
    axes they are those of the plan itself, which tell where these axes are."""
    if cell.external is not None:
        return tuple(path.bead for path in planned.beads)
    run = {(path.layer, path.index): path.bead for path in planned.beads}
    pieces, beads = (
        Counter(path.layer for path in planned.beads),
        Counter(layer for layer, _, _ in toolpath),
    )
    found = []
    for layer, index, bead in toolpath:
        other = run.get((layer, index))
        if other is not None and bead.closed and pieces[layer] == beads[layer]:
            away = np.linalg.norm(bead.points[:-1] - other.points[0], axis=1)
            bead = bead.started_at(int(away.argmin()))
        found.append(bead)
    return tuple(found)
