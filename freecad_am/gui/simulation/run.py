# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a simulation plays: a joint path of a document, or the rows of it that a program runs, with all there is to tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.issues import InputError, Issue
from ...core.kinematics import cell as cells
from ...core.kinematics.arm_contact import ArmContact
from ...core.kinematics.cell import PART_ON_ROBOT, Cell
from ...core.motion import Motion
from ...core.parameters.cell import CellParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.planning import moving_tool
from ...core.planning import program as programs
from ...core.simulation import link_rods
from ...core.simulation.arm import ArmTouches, arm_touches, laid
from ...core.simulation.link_rods import Mesh
from ...core.simulation.margins import on_deposit
from ...core.simulation.pace import Pace, pace
from ...core.simulation.timeline import Timeline, timeline
from ...core.simulation.totals import Totals, totals
from ...core.simulation.watch import Watch, watch
from ...core.toolpath import Toolpath
from ...objects import user_machines
from ...objects.findings import issues_of
from ...objects.joint_path import Planned, planned_of
from ...objects.stage import stage_of
from ...objects.staleness import STALE
from ..lines import Array
from ..link_meshes import meshes_of


@dataclass(frozen=True)
class Run:
    """All of a simulation but its pictures. title: what is played. objects: names of the objects it was made from. stale:
    whether these have changed since."""

    document: str
    title: str
    objects: tuple[str, ...]
    cell: Cell
    looks: CellParameters
    toolpath: Toolpath
    width: float
    motion: Motion
    times: Timeline
    pace: Pace
    watch: Watch
    totals: Totals
    stale: bool = False


def run_of(obj: Any) -> Run:
    """The run of a joint path or of a program. Raises InputError where there is nothing to play, saying what to do."""
    return prepared(obj)()


def prepared(obj: Any) -> Callable[[], Run]:
    """What makes the run of a joint path or of a program, without the document, from which all is read now. Raises
    InputError as `run_of`."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in ("joint path", "program"):
        raise InputError("NOT_TO_PLAY", obj.Label, "it is neither a joint path nor a program; select one of them")
    path = obj if stage.kind == "joint path" else obj.JointPath
    planned, toolpath, looks = planned_of(path, obj.Label)
    folders = user_machines.folders()
    process = path.Toolpath.Proxy.parameters(path.Toolpath, ProcessParameters)
    if not len(planned.motion):
        raise InputError("NO_RESULT", path.Label, "it has no points; there is nothing to play")
    issues, stale, label = issues_of(path), path.Status == STALE, obj.Label
    names = tuple(dict.fromkeys((obj.Name, path.Name, path.Toolpath.Name, path.Cell.Name)))
    document = obj.Document.Name
    settings = obj.Proxy.parameters(obj, ProgramParameters) if stage.kind == "program" else None
    cell = cells.resolve(looks, toolpath.frame, toolpath.family, folders)
    shapes = meshes_of(cell.machine)

    def work() -> Run:
        motion, condition, threshold, found = _rows(planned, cell, toolpath.chord_error, settings, issues)
        times = timeline(motion, process, [layer.wait for layer in toolpath.layers])
        kept = pace(motion, cell.machine.max_speed, cell.machine.max_acceleration)
        return Run(
            document=document, title=label, objects=names, cell=cell, looks=looks, toolpath=toolpath,
            width=process.bead_width, motion=motion, times=times, pace=kept,
            watch=watch(motion, cell, kept, condition, threshold, found, _arm(motion, cell, toolpath, process, shapes)),
            totals=totals(motion, times, process, toolpath.layer_height), stale=stale,
        )

    return work


def _arm(
    motion: Motion, cell: Cell, toolpath: Toolpath, process: ProcessParameters, shapes: tuple[Mesh | None, ...]
) -> ArmTouches | None:
    """What the links of a robot touch; None for machines with rotary axes, of whose links no file tells enough."""
    if cell.machine.is_table:
        return None
    rods = link_rods.of_robot(cell.machine.chain, shapes)
    deposited = laid(motion, process.bead_width, toolpath.layer_height)
    return arm_touches(motion, ArmContact(cell, rods, toolpath.surroundings, deposited))


def _rows(
    planned: Planned, cell: Cell, chord_error: float, settings: ProgramParameters | None, issues: tuple[Issue, ...]
) -> tuple[Motion, Array, Array, tuple[Issue, ...]]:
    """The motion as it is run, condition and threshold of its rows, and the findings by its points: of a program with the
    points that moves in a line get, and only from where it starts."""
    motion = planned.motion
    condition, threshold = (on_deposit(motion.deposit, column) for column in planned.joint_path.judged(motion))
    if settings is None:
        return motion, condition, threshold, issues
    if settings.motion == "cartesian" and cell.setup == PART_ON_ROBOT:
        origin = moving_tool.origins(motion, cell, chord_error)
        beads = [path.bead for path in planned.joint_path.beads]
        motion = moving_tool.kept_straight(motion, cell, chord_error, beads)
        condition, threshold = condition[origin], threshold[origin]
        issues = tuple(_renumbered(issue, planned.motion, motion, origin) for issue in issues)
    rows = programs.rows_from(motion, settings.start_at)
    motion = Motion(**{field.name: getattr(motion, field.name)[rows] for field in fields(motion)})
    return motion, condition[rows], threshold[rows], issues


def _renumbered(issue: Issue, before: Motion, after: Motion, origin: NDArray[np.int64]) -> Issue:
    """A finding by the number that its point has among added ones."""
    here = before.deposit & (before.layer == issue.layer) & (before.bead == issue.bead) & (before.point == issue.point)
    if issue.point is None or not here.any():
        return issue
    row = int(np.searchsorted(origin, int(np.argmax(here)), side="right")) - 1
    return replace(issue, point=int(after.point[row]))
