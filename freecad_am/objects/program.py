# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program stage: the controller files, accepted only if the read-back matches the planned path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

from .. import verify as verification
from ..core.issues import InfeasibleError, InputError, has_errors
from ..core.kinematics import cell as cells
from ..core.motion import Motion
from ..core.parameters.cell import CellParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.program import ProgramParameters
from ..core.planning import linear_approach, program_beads
from ..core.planning import program as programs
from ..core.planning.beads import steps
from ..core.program import ROTARY
from ..core.program import Program as ProgramText
from ..core.toolpath import Toolpath
from ..posts import catalogue, refusals
from . import user_machines
from .checks import controllers
from .current import check_current, reason_stale
from .joint_path import Planned
from .results.findings import reason_of
from .stage import Stage
from .stage_parts import Link, Outcome, Section, Work
from .staleness import UP_TO_DATE
from .work import progress


@dataclass(frozen=True)
class Written:
    """Result of a program: file contents by name, and the read-back verification.

    verification: None without a post.
    """

    files: dict[str, bytes]
    verification: verification.Verification | None


@dataclass(frozen=True)
class Job:
    """Inputs of a program, independent of the document.

    planned, toolpath: functions that read the joint path result and the toolpath.
    """

    planned: Callable[[], Planned]
    toolpath: Callable[[], Toolpath]
    settings: CellParameters
    folders: tuple[str, ...]
    process: ProcessParameters
    parameters: ProgramParameters
    name: str


@dataclass(frozen=True)
class Posted:
    """A written program. motion: the rows that the program runs."""

    cell: cells.Cell
    toolpath: Toolpath
    motion: Motion
    program: ProgramText
    files: dict[str, bytes]


class Program(Stage):
    """Result: `Written`. Cell, toolpath and process come from the joint path."""

    kind = "program"
    sections = (Section(ProgramParameters, "program", "Program"),)
    links = (Link("JointPath", "joint path", "The joint path to write."),)
    figures = (
        (
            "Files",
            "App::PropertyStringList",
            "The controller's files; double-click to read and export them.",
        ),
    )

    def complete(self, obj: Any) -> None:
        if "ProgramName" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyString",
                "ProgramName",
                "Program",
                "Name of the program and of its files.",
            )
        super().complete(obj)

    def job(self, obj: Any) -> Job:
        """Read the inputs. Raises InputError or InfeasibleError for invalid inputs."""
        if not obj.ProgramName:
            raise InputError(
                "NO_NAME", f"{obj.Label}.ProgramName", "the program has no name; enter a name"
            )
        path = self.linked(obj)["JointPath"]
        linked = path.Proxy.linked(path)
        toolpath, cell = linked["Toolpath"], linked["Cell"]
        return Job(
            path.Proxy.reader(path),
            toolpath.Proxy.reader(toolpath),
            cell.Proxy.value(cell),
            tuple(user_machines.folders()),
            toolpath.Proxy.parameters(toolpath, ProcessParameters),
            self.parameters(obj, ProgramParameters),
            obj.ProgramName,
        )

    def prepare(self, obj: Any) -> Work:
        job, label = self.job(obj), obj.Label
        if job.parameters.post == "none":
            return lambda: Outcome(Written({}, None), figures=(("Files", []),))
        return lambda: _write_program(job, label)

    def further_inputs(self, obj: Any) -> list[str]:
        return [obj.ProgramName]

    def refuse_early(
        self, obj: Any, cell: cells.Cell, process: ProcessParameters, toolpath: Any
    ) -> None:
        """Report, before joint planning, why the cell or toolpath does not allow a program."""
        try:
            parameters = self.parameters(obj, ProgramParameters)
            refuse(cell, process, parameters)
            if catalogue.controller(parameters.post).whole_beads:
                controllers.check_beads(
                    toolpath.Proxy.value(toolpath), parameters.post, parameters.max_points
                )
        except InputError as error:
            self.say_failed(obj, error)


def refuse(cell: cells.Cell, process: ProcessParameters, parameters: ProgramParameters) -> None:
    """Reject unsuitable settings before planning.

    The cell may be resolved without the feature's frame; a numeric origin is then not checked.
    Raises InputError WRONG_CONTROLLER, NOT_FOR_WRIST, NO_PULSES, NO_SPEED_UNIT, NO_WIRE_OUTPUT,
    UNSUPPORTED_FRAME and further codes of the post.
    """
    if parameters.post == "none":
        return
    post = catalogue.load(parameters.post)
    controllers.check(cell, parameters)
    post.refuse_setup(
        parameters.motion,
        cell.setup,
        programs.external_kinds(cell),
        programs.carried_pose(cell, parameters),
    )
    if process.wire.feed_mode != "constant" and post.NO_WIRE and not parameters.dry_run:
        raise refusals.wire_refused(post.NO_WIRE)
    if process.weaves and post.NO_WEAVE:
        raise refusals.weave_refused(post.NO_WEAVE)
    if process.weaves and parameters.motion != "cartesian":
        raise refusals.weave_refused(refusals.JOINT_WEAVE, "program.motion")
    by = parameters.schedule.by
    if parameters.trigger.lead is not None and not parameters.dry_run:
        _refuse_trigger(by, post.NO_TRIGGER)
    post.refuse_process(
        refusals.Asked(
            parameters.motion,
            cell.arrangement.holds_part,
            ROTARY in programs.external_kinds(cell),
            by,
            process.wire.feed_mode != "constant" and not parameters.dry_run,
            process.weaves,
            parameters.dry_run,
        )
    )
    if by in post.NO_SCHEDULE and (process.scheduled or by == program_beads.ARC):
        raise refusals.schedule_refused(by, post.NO_SCHEDULE[by])


def _refuse_trigger(by: str, no_trigger: str) -> None:
    """Raise InputError TRIGGER if the post has no trigger or arc instructions switch the deposit.

    no_trigger: the post's reason, '' if the post supports triggers.
    """
    if no_trigger:
        raise refusals.trigger_refused(no_trigger)
    if by == program_beads.ARC:
        raise refusals.trigger_refused(
            "arc instructions time the switching of the deposit themselves"
        )


def posted(job: Job) -> Posted:
    """Write the files of a joint path without verification.

    Raises InputError for unsupported content.
    """
    post, parameters = catalogue.load(job.parameters.post), job.parameters
    post.program_name(job.name, "name")  # reject an invalid name before the long computation
    toolpath, planned = job.toolpath(), job.planned()
    cell = cells.resolve(job.settings, toolpath.frame, toolpath.family, job.folders)
    refuse(cell, job.process, parameters)
    progress.report(0.1, "building moves and events")
    motion = planned.motion
    straight = parameters.motion == "cartesian" and not post.CONTROLLER.straight_in_part
    if straight and cell.arrangement.holds_part:
        beads = [path.bead for path in planned.joint_path.beads]
        motion = steps.refined_to_chord_error(motion, cell, toolpath.chord_error, beads)
    motion, _ = steps.programmed(motion, post.CONTROLLER, toolpath.chord_error, parameters.blend)
    if linear_approach.asked(parameters, post.CONTROLLER):
        motion = linear_approach.shorten_approaches(motion, cell)
    waits = [layer.wait for layer in toolpath.layers]
    returns = programs.returning(toolpath, planned.joint_path.beads)
    program = programs.build(
        motion, cell, job.process, parameters, post.CONTROLLER, job.name, waits, returns
    )
    progress.report(0.3, "writing")
    return Posted(cell, toolpath, _run(motion, parameters), program, post.write(program))


def _write_program(job: Job, label: str) -> Outcome:
    """Write the files of a joint path, read them back and verify them.

    Raises InputError. Raises InfeasibleError NOT_VERIFIED, naming `label`, if verification fails.
    """
    posted_job = posted(job)
    progress.report(0.5, "reading back and checking")
    checked = verification.verify(
        posted_job.cell,
        posted_job.motion,
        posted_job.program,
        posted_job.files,
        catalogue.load(job.parameters.post),
        posted_job.toolpath.chord_error,
    )
    if has_errors(checked.issues):
        raise InfeasibleError(
            "NOT_VERIFIED",
            label,
            "the program, read back, differs from the planned path; do not run the program",
            issues=tuple(checked.issues),
        )
    issues = (
        *controllers.size_issues(posted_job.toolpath, job.parameters),
        *controllers.base_issues(posted_job.cell.machine, job.parameters),
        *controllers.machine_issues(posted_job.cell, job.parameters),
        *checked.issues,
    )
    return Outcome(
        Written(posted_job.files, checked), issues, (("Files", sorted(posted_job.files)),)
    )


def _run(motion: Motion, parameters: ProgramParameters) -> Motion:
    """Return the rows of the motion that the program runs: all rows, or those from the restart."""
    rows = programs.rows_from(motion, parameters.start_at)
    if rows.all():
        return motion
    return Motion(**{field.name: getattr(motion, field.name)[rows] for field in fields(motion)})


def files_of(obj: Any) -> dict[str, bytes]:
    """Return the controller files of a program object.

    Raises InputError NO_PROGRAM, with the reason, if files are missing or out of date.
    """
    template = "no program matches its inputs ({}); correct the cause and recompute the program"
    if not obj.Key or obj.Status != UP_TO_DATE:
        raise InputError("NO_PROGRAM", obj.Label, template, reason_stale(obj) or obj.Status)
    check_current(obj, "NO_PROGRAM", template)
    files: dict[str, bytes] = obj.Proxy.value(obj).files
    if not files:
        raise InputError("NO_PROGRAM", obj.Label, template, reason_of(obj) or obj.Status)
    return files
