# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a simulation plays: a joint path of a document, or the rows of it that a program runs, with all there is to tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...core.issues import InputError
from ...core.kinematics.cell import Cell
from ...core.motion import Motion
from ...core.parameters.cell import CellParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.simulation.achievable_feed import AchievableFeed, achievable_feed
from ...core.simulation.timeline import Timeline, timeline
from ...core.simulation.totals import Totals, totals
from ...core.simulation.watch import Watch, watch
from ...core.toolpath import Toolpath
from ...core.types import Array
from ...objects import user_machines
from ...objects.checks.links_clear import arm_of
from ...objects.joint_path import planned_of
from ...objects.results.as_run import as_run
from ...objects.results.findings import issues_of
from ...objects.shapes.cell_obstacles import resolved
from ...objects.shapes.link_meshes import meshes_of
from ...objects.stage import stage_of
from ...objects.staleness import STALE, UP_TO_DATE


@dataclass(frozen=True, eq=False)
class Run:
    """All of a simulation but its pictures. title: what is played. objects: names of the objects it was made from. stale:
    whether these have changed since. deposit: the predicted deposit, as an inspection of the toolpath has it; None if
    there is none that fits."""

    document: str
    title: str
    objects: tuple[str, ...]
    cell: Cell
    looks: CellParameters
    toolpath: Toolpath
    width: float
    motion: Motion
    times: Timeline
    feed: AchievableFeed
    watch: Watch
    totals: Totals
    stale: bool = False
    deposit: Array | None = None


def run_of(obj: Any) -> Run:
    """The run of a joint path or of a program. Raises InputError where there is nothing to play, saying what to do."""
    return prepared(obj)()


def prepared(obj: Any) -> Callable[[], Run]:
    """What makes the run of a joint path or of a program, without the document, from which all is read now. Raises
    InputError as `run_of`."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in ("joint path", "program"):
        raise InputError(
            "NOT_TO_PLAY", obj.Label, "it is neither a joint path nor a program; select one"
        )
    path = obj if stage.kind == "joint path" else obj.JointPath
    planned, toolpath, looks = planned_of(path, obj.Label)
    folders = user_machines.folders()
    process = path.Toolpath.Proxy.parameters(path.Toolpath, ProcessParameters)
    if not len(planned.motion):
        raise InputError("NO_RESULT", path.Label, "it has no points to play; choose another path")
    issues, stale, label = issues_of(path), path.Status == STALE, obj.Label
    deposited = _predicted(path.Toolpath)
    names = tuple(dict.fromkeys((obj.Name, path.Name, path.Toolpath.Name, path.Cell.Name)))
    document = obj.Document.Name
    settings = obj.Proxy.parameters(obj, ProgramParameters) if stage.kind == "program" else None
    cell = resolved(looks, toolpath, folders)
    shapes = meshes_of(cell.machine)

    def work() -> Run:
        run = as_run(planned, cell, toolpath.chord_error, settings, issues)
        motion = run.motion
        times = timeline(motion, process, [layer.wait for layer in toolpath.layers])
        kept = achievable_feed(motion, cell.machine.max_speed, cell.machine.max_acceleration)
        return Run(
            document=document,
            title=label,
            objects=names,
            cell=cell,
            looks=looks,
            toolpath=toolpath,
            width=process.bead_width,
            motion=motion,
            times=times,
            feed=kept,
            watch=watch(
                motion,
                cell,
                kept,
                run.condition,
                run.threshold,
                run.issues,
                arm_of(motion, cell, toolpath, process, shapes),
            ),
            totals=totals(motion, times, process, toolpath),
            stale=stale,
            deposit=deposited,
        )

    return work


def _predicted(toolpath: Any) -> Array | None:
    """The deposit that the last inspection of a toolpath has predicted, where it fits that."""
    for obj in reversed(toolpath.InList):
        stage = stage_of(obj)
        if (
            stage is not None
            and stage.kind == "inspection"
            and obj.Key
            and obj.Status == UP_TO_DATE
        ):
            found: Array | None = stage.value(obj).laid
            if found is not None:
                return found
    return None
