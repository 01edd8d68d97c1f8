# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report of the stages of a document, equal to the report of a job file."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..core.issues import InputError, Issue
from ..core.kinematics import cell as cells
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.joints import JointParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.program import ProgramParameters
from ..core.process.model_notes import HEIGHTS
from ..objects import user_machines
from ..objects.checks import preflight
from ..objects.current import check_current
from ..objects.fields.preferences import in_user_units, scale_of, window_is_open
from ..objects.job_group import is_group
from ..objects.joint_path import planned_of
from ..objects.results.findings import issues_of
from ..objects.stage import stage_of
from ..objects.toolpath import features_of, strategy_of
from ..objects.work import progress
from . import units
from .figures import Feature, Job, Results
from .made import Made, make_report

KINDS = ("toolpath", "joint path", "program")
PROGRAMS = "program"  # folder into which commands write programs


def reported(obj: Any) -> Callable[[], str]:
    """Return a function that draws the report page of a toolpath, joint path or program.

    The document is read now, not when the function is called. The function reports progress
    (`objects.work.progress`). Raises InputError for any other object, and for a missing or outdated
    result.
    """
    toolpath, path, program = _stages(obj)
    features = features_of(toolpath)
    stages = [stage for stage in (*features, toolpath, path, program) if stage is not None]
    check_current(obj)
    settings = None if program is None else program.Proxy.parameters(program, ProgramParameters)
    read_back = None if program is None else preflight.read_back_of(program)
    survey = functools.cache(preflight.survey_of(toolpath, path, settings))
    promised = preflight.prepared(
        toolpath, path, settings, read_back, () if program is None else issues_of(program), survey
    )
    job, folders = _job(toolpath, path), tuple(user_machines.folders())
    results = Results(
        toolpath.Proxy.value(toolpath),
        None if path is None else planned_of(path, path.Label)[0],
        0.0 if path is None else path.Seconds,
        _issues(features, toolpath, path, program),
        _files(program),
        lambda: survey().distances,
        promised,
    )
    spent = {stage.Proxy.kind.replace(" ", "_"): stage.Seconds for stage in stages}

    # read units now: a change while the page is drawn applies to the next page
    page_units = units.ReportUnits(in_user_units, scale_of) if window_is_open() else units.METRIC

    def work() -> str:
        cell = None if job.cell is None else cells.resolve(job.cell, np.eye(4), folders=folders)
        report = _steps(job, results, cell)
        report.content["timing_s"] = spent
        progress.report(0.7, "drawing the page")
        with units.shown_in(page_units):
            return report.page()

    return work


def _stages(obj: Any) -> tuple[Any, Any, Any]:
    """Return toolpath, joint path and program; None for missing stages."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in KINDS:
        label = getattr(obj, "Label", repr(obj))
        raise InputError(
            "BAD_INPUT", label, "the object has no path; choose a toolpath, joint path or program"
        )
    program = obj if stage.kind == "program" else None
    path = obj if stage.kind == "joint path" else None if program is None else program.JointPath
    if program is not None and path is None:
        raise InputError(
            "NO_INPUT", obj.Label, "the joint path of the program was deleted; choose a joint path"
        )
    toolpath = obj if path is None else path.Toolpath
    if path is not None:
        planned_of(path, obj.Label)
    return toolpath, path, program


def _job(toolpath: Any, path: Any) -> Job:
    cell = toolpath.Cell if path is None else path.Cell
    joints = JointParameters() if path is None else path.Proxy.parameters(path, JointParameters)
    features = tuple(
        Feature(
            feature.Label,
            feature.Proxy.parameters(feature, strategy_of(feature.Proxy)),
            feature.Proxy.parameters(feature, BuildDirectionParameters),
            process,
            feature.Proxy.reader(feature),
        )
        for feature, process in zip(
            features_of(toolpath), toolpath.Proxy.processes(toolpath), strict=True
        )
    )
    of_all = toolpath.Proxy.parameters(toolpath, ProcessParameters)
    looks = None if cell is None or path is None else cell.Proxy.value(cell)
    return Job(_name(toolpath), features, of_all, joints, looks)


def _name(toolpath: Any) -> str:
    """Return the job name: the label of its group, else of the document."""
    group = next((parent for parent in toolpath.InList if is_group(parent)), toolpath.Document)
    return str(group.Label)


def _files(program: Any) -> list[str]:
    if program is None or not program.Key:
        return []
    return [f"{PROGRAMS}/{name}" for name in program.Proxy.value(program).files]


def _issues(features: list[Any], toolpath: Any, path: Any, program: Any) -> list[Issue]:
    """Return the issues of all stages as a command prints them.

    Issues that a toolpath repeats from its wall appear once. Height issues at achieved speeds
    replace height issues at programmed speeds.
    """
    issues = [issue for feature in features for issue in issues_of(feature)]
    issues += [issue for issue in issues_of(toolpath) if issue not in issues]
    later = [] if path is None else list(issues_of(path))
    if any(issue.code == HEIGHTS for issue in later):
        issues = [issue for issue in issues if issue.code != HEIGHTS]
    return [*issues, *later, *(() if program is None else issues_of(program))]


def _steps(job: Job, results: Results, cell: cells.Cell | None) -> Made:
    """Make the report and report progress by step."""

    @contextlib.contextmanager
    def timed(stage: str) -> Iterator[None]:
        if stage == "preflight":
            progress.report(0.1, "checking the program")
        elif stage == "spacing_comparison":
            progress.report(0.4, "comparing the spacing of layers")
        yield

    progress.report(0.0, "measuring the path")
    return make_report(job, results, cell, timed, lambda _: None)
