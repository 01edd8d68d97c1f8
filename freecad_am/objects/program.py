# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program in a document: the controller's files, written only when reading them back gives the planned path."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from .. import verify as verification
from ..core.issues import InfeasibleError, InputError, has_errors
from ..core.kinematics import cell as cells
from ..core.kinematics.cell import PART_ON_ROBOT
from ..core.motion import Motion
from ..core.parameters.process import ProcessParameters
from ..core.parameters.program import ProgramParameters
from ..core.planning import moving_tool
from ..core.planning import program as programs
from ..core.toolpath import Toolpath
from ..posts import catalogue, refusals
from . import progress, user_machines
from .joint_path import Planned
from .stage import Link, Outcome, Section, Stage, Work


@dataclass(frozen=True)
class Written:
    """The result of a program: file name -> content, and how the read-back went (None where there is no post)."""

    files: dict[str, bytes]
    verification: verification.Verification | None


class Program(Stage):
    """Result: `Written`. Its cell, toolpath and process are those of the joint path."""

    kind = "program"
    sections = (Section(ProgramParameters, "program", "Program"),)
    links = (Link("JointPath", "joint path", "The joint path to write."),)
    figures = (("Files", "App::PropertyStringList", "The controller's files; double-click to read and export them."),)

    def complete(self, obj: Any) -> None:
        if "ProgramName" not in obj.PropertiesList:
            obj.addProperty("App::PropertyString", "ProgramName", "Program", "Name of the program and of its files.")
        super().complete(obj)

    def prepare(self, obj: Any) -> Work:
        if not obj.ProgramName:
            raise InputError("NO_NAME", f"{obj.Label}.ProgramName", "the program has no name; give one")
        joint_object = self.linked(obj)["JointPath"]
        linked = joint_object.Proxy.linked(joint_object)
        toolpath_object, cell_object = linked["Toolpath"], linked["Cell"]
        parameters = self.parameters(obj, ProgramParameters)
        if parameters.post == "none":
            return lambda: Outcome(Written({}, None), figures=(("Files", []),))
        toolpath = toolpath_object.Proxy.value(toolpath_object)
        settings, folders = cell_object.Proxy.value(cell_object), user_machines.folders()
        process = toolpath_object.Proxy.parameters(toolpath_object, ProcessParameters)
        cell = cells.resolve(settings, toolpath.frame, toolpath.family, folders)
        refuse(cell, process, parameters)
        planned, name, label = joint_object.Proxy.value(joint_object), obj.ProgramName, obj.Label

        def work() -> Outcome:
            return _written(planned, toolpath, cell, process, parameters, name, label)

        return work

    def further_inputs(self, obj: Any) -> list[str]:
        return [obj.ProgramName]

    def refuse_early(self, obj: Any, cell: cells.Cell, process: ProcessParameters) -> None:
        """Say at once, before its joint path is planned, what makes the program impossible in the cell."""
        try:
            refuse(cell, process, self.parameters(obj, ProgramParameters))
        except InputError as error:
            self.say_failed(obj, error)


def refuse(cell: cells.Cell, process: ProcessParameters, parameters: ProgramParameters) -> None:
    """What can be refused before anything is planned: InputError WRONG_CONTROLLER, NO_WIRE_OUTPUT, UNSUPPORTED_FRAME and
    others of the post. A cell resolved without the feature's frame will do; an origin that is given by numbers is then not
    looked at."""
    if parameters.post == "none":
        return
    post: Any = catalogue.load(parameters.post)
    programs.check_controller(cell.machine, parameters.post)
    post.refuse_setup(parameters.motion, cell.setup)
    carried = programs.on_table(cell, parameters)
    if parameters.post == "linuxcnc" and parameters.motion == "cartesian" and carried is not None:
        post.refuse_tilt(carried)
    if process.wire.feed_mode != "constant" and post.NO_WIRE and not parameters.dry_run:
        raise refusals.wire_refused(post.NO_WIRE)


def _written(
    planned: Planned, toolpath: Toolpath, cell: cells.Cell, process: ProcessParameters, parameters: ProgramParameters,
    name: str, label: str,
) -> Outcome:
    """The files of a joint path, written and read back. InputError; InfeasibleError NOT_VERIFIED naming `label`."""
    motion = planned.motion
    post = catalogue.load(parameters.post)
    progress.report(0.1, "building moves and events")
    if parameters.motion == "cartesian" and cell.setup == PART_ON_ROBOT:
        beads = [path.bead for path in planned.joint_path.beads]
        motion = moving_tool.kept_straight(motion, cell, toolpath.chord_error, beads)
    waits = [layer.wait for layer in toolpath.layers]
    returns = programs.returning(toolpath, planned.joint_path.beads)
    program = programs.build(motion, cell, process, parameters, name, waits, returns)
    progress.report(0.3, "writing")
    files = post.write(program)
    progress.report(0.5, "reading back and checking")
    checked = verification.verify(cell, _run(motion, parameters), program, files, post, toolpath.chord_error)
    if has_errors(checked.issues):
        raise InfeasibleError(
            "NOT_VERIFIED", label, "reading the program back does not give the planned path", tuple(checked.issues),
        )
    return Outcome(Written(files, checked), tuple(checked.issues), (("Files", sorted(files)),))


def _run(motion: Motion, parameters: ProgramParameters) -> Motion:
    """The rows of the motion that the program runs; all but where it resumes."""
    rows = programs.rows_from(motion, parameters.start_at)
    if rows.all():
        return motion
    return Motion(**{field.name: getattr(motion, field.name)[rows] for field in fields(motion)})


def files_of(obj: Any) -> dict[str, bytes]:
    """The controller's files of a program object. InputError 'NO_PROGRAM' when there are none, saying why."""
    files: dict[str, bytes] = obj.Proxy.value(obj).files if obj.Key else {}
    if obj.Status != "up to date" or not files:
        raise InputError("NO_PROGRAM", obj.Label, f"no program fits its inputs ({obj.Message or obj.Status})")
    return files
