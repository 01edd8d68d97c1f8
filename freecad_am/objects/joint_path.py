# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joint path stage: the joint values of a toolpath in a cell, and the motion with rapids."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.issues import NOTE, AmError, InputError, Issue, Text, has_errors
from ..core.kinematics import cell as cells
from ..core.kinematics.links.external_links import titles_without_shape
from ..core.kinematics.machines.machine import UNKNOWN_REMARK
from ..core.motion import Motion
from ..core.parameters.cell import CellParameters
from ..core.parameters.joints import JointParameters
from ..core.parameters.process import ProcessParameters
from ..core.planning.beads.speeds import SLOWED
from ..core.planning.joint_path import JointPath as JointsOfBeads
from ..core.planning.motion import assemble
from ..core.planning.other_cells import Fixed, Tried
from ..core.planning.plan import plan_joints
from ..core.planning.remedies import LONGEST_SEARCH, most_points, remedies
from ..core.process import wire
from ..core.process.model_notes import height_issue
from ..core.simulation import payload
from ..core.simulation.timeline import MM3_PER_CM3, timeline, totals
from ..core.toolpath import Toolpath
from . import user_machines
from .checks.collisions import collision_issues, look, margin_issues
from .checks.placed import arm_issues, cylinders_of
from .shapes import cell_obstacles
from .stage import Stage, stage_of
from .stage_parts import Link, Outcome, Section, Work
from .staleness import UP_TO_DATE
from .work import progress

JOINTS = 0.9  # progress fraction after joint planning
TRYING = 0.95  # progress fraction after rapid moves


@dataclass(frozen=True)
class Planned:
    """Result of a joint path: joint values of the deposit, and the motion with all rapid moves."""

    joint_path: JointsOfBeads
    motion: Motion


@dataclass(frozen=True)
class Job:
    """Inputs of a joint path, independent of the document.

    toolpath: function that reads the toolpath. fixed: alternative toolpath with one build
    direction, None if not applicable. own_speed: for each of several features, whether its travel
    speed differs from the job's.
    """

    toolpath: Callable[[], Toolpath]
    settings: CellParameters
    folders: tuple[str, ...]
    process: ProcessParameters
    parameters: JointParameters
    fixed: Fixed | None = None
    own_speed: tuple[bool, ...] = ()


def planned_of(path: Any, label: str) -> tuple[Planned, Toolpath, CellParameters]:
    """Return the results of a joint path object, its toolpath and its cell.

    path: None if the object is deleted. Raises InputError NO_RESULT, naming `label`, without a
    joint path; NO_INPUT without a toolpath or cell.
    """
    if path is None or not path.Key:
        raise InputError("NO_RESULT", label, "there is no joint path yet; recompute the document")
    for link in ("Toolpath", "Cell"):
        linked = getattr(path, link)
        if linked is None or not linked.Key:
            raise InputError(
                "NO_INPUT",
                path.Label,
                "the {} is missing; choose another and recompute",
                link.lower(),
            )
    planned, toolpath, cell = (
        stage.Proxy.value(stage) for stage in (path, path.Toolpath, path.Cell)
    )
    return planned, toolpath, cell


class JointPath(Stage):
    """Result: `Planned`. An infeasible result is kept for inspection."""

    kind = "joint path"
    sections = (Section(JointParameters, "joints", "Joints"),)
    links = (
        Link("Toolpath", "toolpath", "The toolpath to run."),
        Link("Cell", "cell", "The cell that runs the toolpath."),
    )
    figures = (
        ("Duration", "App::PropertyFloat", "Time of all moves (s)."),
        (
            "SmallestCondition",
            "App::PropertyFloat",
            "Smallest condition of the Jacobian while depositing.",
        ),
        (
            "TotalTime",
            "App::PropertyFloat",
            "Time of the whole job with lead times and waits between layers (s).",
        ),
        ("DepositTime", "App::PropertyFloat", "Time of depositing moves (s)."),
        ("WaitTime", "App::PropertyFloat", "Lead times and waits between layers (s)."),
        ("DepositLength", "App::PropertyLength", "Length of the deposit as executed."),
        (
            "DepositVolume",
            "App::PropertyFloat",
            "Volume of the deposit, bead width times layer height (cm\u00b3).",
        ),
        ("DepositMass", "App::PropertyFloat", "Mass of the deposit (g)."),
    )

    def look_ahead(self, obj: Any) -> None:
        """Report on each program of the joint path if it is impossible, before planning begins."""
        programs = [
            candidate
            for candidate in obj.InList
            if (stage := stage_of(candidate)) is not None and stage.kind == "program"
        ]
        toolpath, cell = obj.Toolpath, obj.Cell
        if (
            not programs
            or stage_of(toolpath) is None
            or stage_of(cell) is None
            or cell.Status != UP_TO_DATE
        ):
            return
        with contextlib.suppress(AmError):  # toolpath and cell report these errors in their status
            resolved = cells.resolve(
                cell.Proxy.value(cell), np.eye(4), folders=user_machines.folders()
            )
            process = toolpath.Proxy.parameters(toolpath, ProcessParameters)
            for program in programs:
                program.Proxy.refuse_early(program, resolved, process, toolpath)

    def job(self, obj: Any) -> Job:
        """Read the inputs. Raises InputError or InfeasibleError for invalid inputs."""
        linked = self.linked(obj)
        toolpath, cell = linked["Toolpath"], linked["Cell"]
        return Job(
            toolpath.Proxy.reader(toolpath),
            cell.Proxy.value(cell),
            tuple(user_machines.folders()),
            toolpath.Proxy.parameters(toolpath, ProcessParameters),
            self.parameters(obj, JointParameters),
            toolpath.Proxy.fixed(toolpath),
            toolpath.Proxy.own_speeds(toolpath),
        )

    def prepare(self, obj: Any) -> Work:
        self.look_ahead(obj)
        job = self.job(obj)

        def work() -> Outcome:
            toolpath, process = job.toolpath(), job.process
            cell = cell_obstacles.resolved(job.settings, toolpath, job.folders)
            cylinders = () if cell.arm_clearance is None else cylinders_of(cell)
            started = time.monotonic()
            joint_path = plan_joints(
                toolpath,
                cell,
                job.parameters,
                lambda fraction, text: progress.report(JOINTS * fraction, text),
                cylinders,
            )
            seconds_per_point = (time.monotonic() - started) / max(toolpath.point_count, 1)
            progress.report(JOINTS, "joining the beads by rapid moves")
            motion, rapid_issues = assemble(
                joint_path,
                cell,
                process,
                toolpath.surroundings,
                job.parameters,
                toolpath.layer_height,
                cylinders,
            )
            margin_notes = (
                ()
                if not cylinders
                else arm_issues(
                    motion, cell, toolpath, process, cylinders, (*joint_path.issues, *rapid_issues)
                )
            )
            notes = (*_not_kept(cell), *_not_known(cell), *_drawn_plain(cell), *_fit_notes(cell))
            issues_found = (*joint_path.issues, *rapid_issues, *margin_notes)
            if not has_errors(issues_found):
                progress.report(TRYING, "checking the arm for collisions")
                issues_found = (
                    *issues_found,
                    *collision_issues(motion, cell, toolpath, process),
                    *margin_issues(motion, cell),
                )
            issues = (
                *issues_found,
                *notes,
                *_heights_as_run(joint_path, toolpath, process),
            )
            tried = Tried(
                lambda: toolpath,
                job.settings,
                job.folders,
                process,
                job.parameters,
                job.fixed,
                own_speed=job.own_speed,
                cylinders=cylinders or cylinders_of(cell),
                shapes=cell.shapes,
                look=look,
            )
            _report_search_time(toolpath, issues, seconds_per_point)
            issues = (
                *remedies(tried, joint_path, issues, lambda _, text: progress.report(TRYING, text)),
                *issues,
            )
            issues = (*issues, *payload.issues(motion, cell, toolpath, process))
            condition = np.concatenate([bead.condition for bead in joint_path.beads])
            smallest = float(np.nanmin(condition)) if np.isfinite(condition).any() else 0.0
            return Outcome(
                Planned(joint_path, motion),
                issues,
                (("SmallestCondition", smallest), *_sums(motion, process, toolpath)),
            )

        return work


def _report_search_time(
    toolpath: Toolpath, issues: Sequence[Issue], seconds_per_point: float
) -> None:
    """Report the duration of a long search for remedies.

    seconds_per_point: planning time of one point, s.
    """
    from ..core.strategies import estimated_size

    for issue in estimated_size.remedy_issues(
        most_points(toolpath, issues), seconds_per_point, LONGEST_SEARCH
    ):
        progress.report_issue(issue)


def _fit_notes(cell: cells.Cell) -> list[Issue]:
    """Return a note on the part pose fitted to touched points, with its residuals."""
    if cell.poses.offset is None:
        return []
    residual, six = cell.poses.offset.residual, cell.poses.offset.six()
    residuals, pose = (
        ", ".join(f"{value:.{digits}g}" for value in values)
        for values, digits in ((residual, 3), (six, 7))
    )
    return [
        Issue(
            NOTE,
            "WORK_OFFSET",
            Text(
                "{} touched points put the part at [{}] mm and deg in the robot base; residuals "
                "at the points: {} mm, {:.3g} mm root mean square",
                len(residual),
                pose,
                residuals,
                float(np.sqrt((residual**2).mean())),
            ),
        )
    ]


def _not_kept(cell: cells.Cell) -> list[Issue]:
    """Return a note if planning does not keep the links clear of the cell's obstacles."""
    if (
        not cell.shapes.obstacles
        or cell.arm_clearance is not None
        or not cell.arrangement.links_known
    ):
        return []
    names = ", ".join(obstacle.name for obstacle in cell.shapes.obstacles)
    return [
        Issue(
            NOTE,
            "OBSTACLES_NOT_KEPT",
            Text(
                "{}: checked against the nozzle during planning, but against links and part only "
                "after planning; set cell.arm_clearance to check links and part during planning "
                "too",
                names,
            ),
        )
    ]


def _not_known(cell: cells.Cell) -> list[Issue]:
    """Return a note on positioners and tracks without a shape, which collision checks ignore."""
    if cell.external is None or not (
        lacking := ", ".join(titles_without_shape(cell.external, cell.shapes.external_links))
    ):
        return []
    return [
        Issue(
            NOTE,
            "BODIES_NOT_KNOWN",
            Text(
                "the shape of {} is unknown, so nozzle, torch and robot are not checked against "
                "this mechanism; add bodies to its machine file, or list its fixed parts in "
                "cell.obstacles",
                lacking,
            ),
        )
    ]


def _drawn_plain(cell: cells.Cell) -> list[Issue]:
    """Return a note on ignored content of a robot's URDF, such as meshes that cannot be drawn."""
    notes = cell.robot.remarks if cell.robot.controller_remark == UNKNOWN_REMARK else ()
    return (
        [Issue(NOTE, "URDF_LOOKS", Text("{}: {}", cell.robot.title, Text.joined("; ", notes)))]
        if notes
        else []
    )


def _heights_as_run(
    path: JointsOfBeads, toolpath: Toolpath, process: ProcessParameters
) -> list[Issue]:
    """Return the issue on bead heights at the executed speeds, if the plan slows beads.

    The issue replaces the toolpath's height prediction.
    """
    model = None if toolpath.law is None else wire.process_model(process)
    if model is None or not any(issue.code == SLOWED for issue in path.issues):
        return []
    beads = [entry.bead for entry in path.beads]
    return [height_issue(beads, toolpath.layer_height, process, model, as_run=True)]


def _sums(
    motion: Motion, process: ProcessParameters, toolpath: Toolpath
) -> tuple[tuple[str, float], ...]:
    """Return the job's duration and deposit totals, by property name."""
    times = timeline(motion, process, [layer.wait for layer in toolpath.layers])
    sums = totals(motion, times, process, toolpath)
    return (
        ("Duration", float(np.nansum(motion.duration))),
        ("TotalTime", sums.time),
        ("DepositTime", sums.deposit_time),
        ("WaitTime", sums.wait_time),
        ("DepositLength", sums.length),
        ("DepositVolume", sums.volume / MM3_PER_CM3),
        ("DepositMass", sums.mass),
    )
