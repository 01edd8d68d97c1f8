# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a job: plan all stages in a document and write all outputs."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..core.issues import ERROR, NOTE, InfeasibleError, InputError, Issue, Text, has_errors
from ..core.one_thread import one_thread
from . import output_folder as outputs
from .host import require_freecad
from .job import document as job_document
from .job.features import UPRIGHT, JobFeature, in_words_of_job, leans
from .job.job import SECTIONS, Job

Plan = Callable[
    [Job, str], Any
]  # returns the stages of a job, given the error code that the automatic choice caused


def planned(job: Job, plan: Plan, close: Callable[[Any], None]) -> Any:
    """Plan the stages of a job, with fallbacks for automatic choices that fail.

    If automatically chosen curved layers fail, plan with planes. If an automatically chosen wall
    fails, plan with a fixed build direction and keep this plan if it succeeds. close: disposes of
    unused stages.
    """
    stages = plan(job, "")
    if not has_errors(stages.issues):
        return stages
    if fails := _in_vain(stages, _curved(job, stages)):
        close(stages)
        return plan(job, fails)
    if fails := _in_vain(stages, _leaning(job, stages)):
        alternative = plan(job, fails)
        better = not has_errors(alternative.issues)
        close(stages if better else alternative)
        return alternative if better else stages
    return _check_remedy(job, stages, plan, close)


def _in_vain(stages: Any, is_chosen: bool) -> str:
    """Return the code of the first error if `is_chosen`, else ''."""
    return next((issue.code for issue in stages.issues if is_chosen and issue.level == ERROR), "")


def _curved(job: Job, stages: Any) -> bool:
    """Whether curved layers were chosen automatically for a feature."""
    feature_pairs = zip(job.features, stages.job.features, strict=True)
    return any(
        job_feature.sections is not None
        and "layers" not in job_feature.sections["strategy"]
        and chosen_feature.strategy.has_curved_layers
        for job_feature, chosen_feature in feature_pairs
    )


def _leaning(job: Job, stages: Any) -> bool:
    """Whether a wall with free build directions was chosen automatically and a remedy may exist."""
    from freecad_am.core.planning.remedies import NO_REMEDY

    if stages.joint_path is None and any(issue.code == NO_REMEDY for issue in stages.issues):
        return False
    feature_pairs = zip(job.features, stages.job.features, strict=True)
    return any(
        job_feature.sections is not None and leans(job_feature, chosen_feature.strategy)
        for job_feature, chosen_feature in feature_pairs
    )


def _with(feature: JobFeature, alone: bool) -> JobFeature:
    """Return a feature changed so that the nozzle clears the part.

    A wall gets one build direction. Curved layers become planes if `alone`, the only feature.
    """
    from freecad_am.core.parameters.filled import PLANES

    if leans(feature, feature.strategy):
        return dataclasses.replace(
            feature, build_direction=dataclasses.replace(feature.build_direction, mode=UPRIGHT)
        )
    if alone and feature.strategy.has_curved_layers:
        return dataclasses.replace(
            feature, strategy=dataclasses.replace(feature.strategy, layers=PLANES)
        )
    return feature


def _check_remedy(job: Job, stages: Any, plan: Plan, close: Callable[[Any], None]) -> Any:
    """Test whether the job is feasible with the nozzle remedy that its toolpath reported.

    Return the stages with a note on the outcome, unchanged without such a remedy.
    """
    from freecad_am.core.planning.remedies import NO_REMEDY, REMEDY

    text = next((issue for issue in stages.issues if issue.code == REMEDY), None)
    if text is None or stages.joint_path is not None or job.cell is None:
        return stages
    features = tuple(
        _with(feature, len(stages.job.features) == 1) for feature in stages.job.features
    )
    what = text.message.values[0]
    alternative = plan(dataclasses.replace(job, features=features), "")
    feasible = not has_errors(alternative.issues)
    close(alternative)
    note = (
        Issue(NOTE, REMEDY, Text("the job is feasible with {}; tested, not applied", what))
        if feasible
        else Issue(
            NOTE,
            NO_REMEDY,
            Text("with {} the nozzle is clear, but the job is still infeasible (tested)", what),
        )
    )
    stages.issues = [note if issue is text else issue for issue in stages.issues]
    return stages


@dataclass(frozen=True)
class Result:
    """Files of a run (absolute paths), its report and its exit status, 0 or 3."""

    paths: list[str]
    report: dict[str, Any]
    exit_status: int


@dataclass
class Stages:
    """Stages planned so far: document objects and their issues."""

    document: Any
    job: Any = None  # the job with automatically chosen families filled in
    cell: Any = None
    features: list[Any] = field(default_factory=list)
    toolpath: Any = None
    joint_path: Any = None
    program: Any = None
    issues: list[Issue] = field(default_factory=list)
    timing: dict[str, float] = field(default_factory=dict)

    @contextlib.contextmanager
    def timed(self, stage: str, session: Any) -> Iterator[None]:
        """Report the progress of a stage and record its duration."""
        from freecad_am.objects.work.progress import told_to

        name = stage.replace("_", " ")
        session.progress(f"{name} ...")
        started = time.perf_counter()
        with told_to(
            lambda fraction, text: session.progress(f"{name}: {text} {fraction:.0%}"),
            lambda issue: session.issues([issue]),
        ):
            yield
        session.check()
        self.timing[stage] = time.perf_counter() - started


def default_folder(job: Job) -> str:
    """Return the default output folder of a job."""
    return os.path.join(job.folder, "out", job.name)


def import_all() -> None:
    """Import the modules of a run, in a process that forks workers."""
    require_freecad()
    from freecad_am import api  # noqa: F401
    from freecad_am.report import made  # noqa: F401


def run(job: Job, folder: str, session: Any, page: bool = True) -> Result:
    """Plan a job and write its outputs to `folder`, including report.html if `page`.

    `session` receives progress and issues. Raises InputError and then writes nothing. An
    infeasible job has a result but no programs.
    """
    started = time.perf_counter()
    require_freecad()
    import FreeCAD

    with named_by_keys(job):
        cell = check(job)
        with one_thread(), outputs.Outputs(folder, session) as files:
            stages = planned(
                job,
                lambda variant, fails: _in_a_document(variant, session, fails),
                lambda stages: FreeCAD.closeDocument(stages.document.Name),
            )
            try:
                result = _write(stages.job, stages, cell, files, session, started, page)
            finally:
                FreeCAD.closeDocument(stages.document.Name)
            from freecad_am.core.strategies.estimated_size import LARGE_CODE

            session.issues(issue for issue in stages.issues if issue.code != LARGE_CODE)
            return result


@contextlib.contextmanager
def named_by_keys(job: Job) -> Iterator[None]:
    """Convert errors about document stages to errors about job keys."""
    try:
        yield
    except InputError as found:
        error = in_words_of_job(found)
        if error.where.split(".")[0].split("[")[0] in SECTIONS:
            raise job.tree.locate(error) from None
        raise error from None


def check(job: Job) -> Any:
    """Check machine, limits, set-up, post and program name before the long computation.

    Return the cell resolved without a feature, None for a job without a cell.
    """
    if job.program is not None:
        from freecad_am.posts import catalogue

        post: Any = catalogue.load(job.program.post)
        post.program_name(job.name, "name")
    resolved = resolved_cell(job)
    if resolved is not None and job.program is not None:
        from freecad_am.objects import program

        program.refuse(resolved, job.process, job.program)
    return resolved


def resolved_cell(job: Job) -> Any:
    """Return the job's cell resolved without a feature, None without a cell.

    Raises InputError as `core.kinematics.cell.resolve`.
    """
    if job.cell is None:
        return None
    import numpy as np

    from freecad_am.core.kinematics import cell
    from freecad_am.objects import user_machines

    return cell.resolve(job.cell, np.eye(4), folders=user_machines.folders())


def _in_a_document(job: Job, session: Any, fails: str) -> Stages:
    """Plan the stages of a job in a new document."""
    import FreeCAD

    document = job_document.new_document(job)
    try:
        return plan(job, document, session, fails)
    except BaseException:
        FreeCAD.closeDocument(document.Name)
        raise


def plan(job: Job, document: Any, session: Any, fails: str = "") -> Stages:
    """Plan all stages of a job in a document. Stop at an infeasible stage.

    The reason is in `issues` of the result. fails: error code that the first automatic choice
    caused, '' for the first attempt.
    """

    from freecad_am import api

    from ..core.process.model_notes import HEIGHTS

    stages = as_far_as_toolpath(job, document, session, fails)
    job = stages.job
    if stages.cell is None or has_errors(stages.issues):
        return stages
    if job.program is not None:
        from freecad_am.objects.checks import controllers

        controllers.check_beads(
            api.result(stages.toolpath), job.program.post, job.program.max_points
        )
        # report before joint planning; the program stage reports the same issues later
        session.issues(controllers.size_issues(api.result(stages.toolpath), job.program))
    with stages.timed("joint_path", session):
        stages.joint_path = api.make_joint_path(
            document, stages.toolpath, stages.cell, joints=job.joints
        )
    path_issues = api.issues(stages.joint_path)
    if any(
        issue.code == HEIGHTS for issue in path_issues
    ):  # the joint path predicts heights at executed speeds, which replaces the earlier issue
        stages.issues = [issue for issue in stages.issues if issue.code != HEIGHTS]
    stages.issues += path_issues
    if has_errors(stages.issues):
        return stages
    if job.program is not None:
        with stages.timed("program", session):
            _make_program(stages)
    return stages


def as_far_as_toolpath(job: Job, document: Any, session: Any, fails: str = "") -> Stages:
    """Plan the stages of a job up to the toolpath, as in `plan`."""
    from freecad_am import api
    from freecad_am.core.strategies.estimated_size import LARGE_CODE

    from .job.job import unused_key_issues
    from .job.shapes import Shapes, toolpath_of

    stages = Stages(document)
    stages.issues += unused_key_issues(job)
    with stages.timed("part", session):
        shapes = [Shapes(document, job, number, fails) for number in range(len(job.features))]
    if job.cell is not None:
        with stages.timed("cell", session):
            stages.cell = api.make_cell(document, parameters=job.cell)
    with stages.timed("feature", session):
        for shape in shapes:
            earlier = [
                earlier_shape.part
                for earlier_shape in shapes[: shape.number]
                if earlier_shape.solid
            ]
            proposal = shape.choose(earlier)
            stages.issues += [] if proposal is None else [proposal]
            stages.features.append(shape.make_feature(earlier))
    job = stages.job = _as_chosen(job, shapes)
    for feature in stages.features:
        stages.issues += api.issues(feature)
    session.issues(
        issue for issue in stages.issues if issue.code == LARGE_CODE
    )  # report before the long computation
    with stages.timed("toolpath", session):
        stages.toolpath = toolpath_of(job, document, stages.features, stages.cell, shapes[0].scan)
    # a toolpath repeats the issues of its wall
    stages.issues += [issue for issue in api.issues(stages.toolpath) if issue not in stages.issues]
    return stages


def _make_program(stages: Stages) -> None:
    from freecad_am import api

    job = stages.job
    try:
        stages.program = api.make_program(
            stages.document, stages.joint_path, name=job.name, program=job.program
        )
        stages.issues += api.issues(stages.program)
    except InfeasibleError as error:
        stages.issues += error.issues or [Issue("error", error.code, error.message)]


def _as_chosen(job: Job, shapes: Sequence[Any]) -> Job:
    """Return the job with its automatically chosen features."""
    features = tuple(shape.of for shape in shapes)
    return dataclasses.replace(
        job, features=features, process=features[0].process if len(features) == 1 else job.process
    )


def _write(
    job: Job,
    stages: Stages,
    cell: Any,
    files: outputs.Outputs,
    session: Any,
    started: float,
    page: bool,
) -> Result:
    """Write all outputs. The page is drawn last."""
    from freecad_am import api
    from freecad_am.core.simulation import waypoints
    from freecad_am.report import figures, made

    programs = (
        {}
        if stages.program is None or has_errors(stages.issues)
        else api.result(stages.program).files
    )
    results = outputs.results(stages, [f"{outputs.PROGRAMS}/{name}" for name in programs])
    _, motion = made.as_run(results, cell)
    axes, units = ((), ()) if cell is None else (cell.machine.columns, cell.machine.units)
    with stages.timed("waypoints", session):
        by_place = bool(job.process.settings)
        files.write(outputs.WAYPOINTS, waypoints.text(motion, axes, units, by_place))
    for name, content in programs.items():
        files.write(f"{outputs.PROGRAMS}/{name}", content)
    with stages.timed("document", session):
        job_document.save(stages.document, files.path(job.name + outputs.DOCUMENT_ENDING))
    report_job = outputs.job(job, stages)
    report = made.make_report(
        report_job, results, cell, lambda stage: stages.timed(stage, session), session.progress
    )
    report.content["timing_s"] = {**stages.timing, "total": time.perf_counter() - started}
    files.write(outputs.REPORT, [figures.text(report.content)])
    if page:
        with stages.timed("page", session):
            files.write(outputs.PAGE, [report.page()])
    written = files.publish(outputs.earlier_outputs(files.folder))
    status = 0 if report.content["status"] == "ok" else 3
    return Result([os.path.join(files.folder, name) for name in written], report.content, status)
