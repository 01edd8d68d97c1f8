# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs a job: part to programs in a document, and all that is written about it."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from freecad_am.core.geometry.on_hub import SolidsOnHub
from freecad_am.core.issues import InfeasibleError, InputError, Issue, has_errors
from freecad_am.core.one_thread import one_thread
from freecad_am.core.strategies.families import family_of

from . import outputs, paths
from .job import SECTIONS, Job
from .job_features import in_words_of_job


@dataclass(frozen=True)
class Result:
    """What a run wrote (absolute paths) and how it ended: exit status 0 or 3."""

    paths: list[str]
    report: dict[str, Any]
    exit_status: int


@dataclass
class Stages:
    """The stages as far as they got: document objects and the findings about them."""

    document: Any
    job: Any = None  # with the families chosen that it left open
    features: list[Any] = field(default_factory=list)
    toolpath: Any = None
    joint_path: Any = None
    program: Any = None
    issues: list[Issue] = field(default_factory=list)
    timing: dict[str, float] = field(default_factory=dict)

    @contextlib.contextmanager
    def timed(self, stage: str, session: Any) -> Iterator[None]:
        """Tell of a stage and take its time."""
        from freecad_am.objects.progress import told_to

        name = stage.replace("_", " ")
        session.progress(f"{name} ...")
        started = time.perf_counter()
        with told_to(
            lambda fraction, text: session.progress(f"{name}: {text} {fraction:.0%}"), lambda issue: session.issues([issue])
        ):
            yield
        session.check()
        self.timing[stage] = time.perf_counter() - started


def default_folder(job: Job) -> str:
    """Where the outputs go when nothing else is asked for."""
    return os.path.join(job.folder, "out", job.name)


def import_all() -> None:
    """Import what a run needs, for a process that starts others."""
    paths.require_freecad()
    from freecad_am import api  # noqa: F401

    from . import report  # noqa: F401


def run(job: Job, folder: str, session: Any, page: bool = True) -> Result:
    """Plan a job and write its outputs into `folder`, report.html only with `page`. `session` is told of progress and
    findings.

    Raises InputError; then nothing is written. An infeasible job has a result, but no programs.
    """
    started = time.perf_counter()
    paths.require_freecad()
    import FreeCAD

    try:
        cell = check(job)
        with one_thread(), outputs.Outputs(folder, session) as files:
            document = FreeCAD.newDocument("Job")
            try:
                document.Label, document.UndoMode = job.name, 0
                stages = plan(job, document, session)
                result = _write(stages.job, stages, cell, files, session, started, page)
            finally:
                FreeCAD.closeDocument(document.Name)
            from freecad_am.core.strategies.size import LARGE

            session.issues(issue for issue in stages.issues if issue.code != LARGE)
            return result
    except InputError as found:
        error = in_words_of_job(found)
        if error.where.split(".")[0].split("[")[0] in SECTIONS:
            raise job.tree.placed(error) from None
        raise error from None


def check(job: Job) -> Any:
    """What can be refused before the long work starts: machine, limits, set-up, post, name of the program.

    The cell without its feature, or None.
    """
    if job.program is not None:
        from freecad_am.posts import catalogue

        post: Any = catalogue.load(job.program.post)
        post.program_name(job.name, "name")
    if job.cell is None:
        return None
    import numpy as np

    from freecad_am.core.kinematics import cell
    from freecad_am.objects import user_machines

    resolved = cell.resolve(job.cell, np.eye(4), folders=user_machines.folders())
    if job.program is not None:
        from freecad_am.objects import program

        program.refuse(resolved, job.process, job.program)
    return resolved


def plan(job: Job, document: Any, session: Any) -> Stages:
    """All stages of a job in a document; stops where the job cannot be carried out and says so in `issues`."""
    from freecad_am import api
    from freecad_am.core.process.predicted import HEIGHTS
    from freecad_am.core.strategies.size import LARGE

    from .job_shapes import Shapes

    stages = Stages(document)
    with stages.timed("part", session):
        shapes = [Shapes(document, job, number) for number in range(len(job.features))]
    cell = None
    if job.cell is not None:
        with stages.timed("cell", session):
            cell = api.make_cell(document, parameters=job.cell)
    with stages.timed("feature", session):
        for one in shapes:
            earlier = [other.part for other in shapes[: one.number] if other.solid]
            proposal = one.choose(earlier)
            stages.issues += [] if proposal is None else [proposal]
            stages.features.append(one.make_feature(earlier))
    job = stages.job = _as_chosen(job, shapes)
    for feature in stages.features:
        stages.issues += api.issues(feature)
    session.issues(issue for issue in stages.issues if issue.code == LARGE)  # before the work that takes long
    with stages.timed("toolpath", session):
        if len(job.features) == 1:
            stages.toolpath = api.make_toolpath(document, stages.features[0], cell, process=job.process)
        else:
            stages.toolpath = api.make_toolpath(
                document, stages.features, cell, sequence=job.sequence, process=job.process,
                processes=[one.process for one in job.features],
            )
    # a toolpath repeats the findings about its wall
    stages.issues += [issue for issue in api.issues(stages.toolpath) if issue not in stages.issues]
    if cell is None or has_errors(stages.issues):
        return stages
    with stages.timed("joint_path", session):
        stages.joint_path = api.make_joint_path(document, stages.toolpath, cell, joints=job.joints)
    found = api.issues(stages.joint_path)
    if any(issue.code == HEIGHTS for issue in found):  # at the speeds as run, not only as asked for
        stages.issues = [issue for issue in stages.issues if issue.code != HEIGHTS]
    stages.issues += found
    if job.program is None or has_errors(stages.issues):
        return stages
    with stages.timed("program", session):
        try:
            stages.program = api.make_program(document, stages.joint_path, name=job.name, program=job.program)
            stages.issues += api.issues(stages.program)
        except InfeasibleError as error:
            stages.issues += error.issues or [Issue("error", error.code, error.message)]
    return stages


def _as_chosen(job: Job, shapes: Sequence[Any]) -> Job:
    """The job with the features as they were chosen."""
    features = tuple(one.of for one in shapes)
    return dataclasses.replace(job, features=features, process=features[0].process if len(features) == 1 else job.process)


def _write(
    job: Job, stages: Stages, cell: Any, files: outputs.Outputs, session: Any, started: float, page: bool
) -> Result:
    """Everything but the page, which is drawn last."""
    from freecad_am import api
    from freecad_am.core.process import deposit_balance, spacing
    from freecad_am.core.simulation import deposit, waypoints

    from . import report

    toolpath = api.result(stages.toolpath)
    planned = None if stages.joint_path is None else api.result(stages.joint_path)
    if planned is not None:
        toolpath = planned.joint_path.toolpath(toolpath)
    axes = () if cell is None else cell.machine.columns
    motion = deposit.alone(toolpath, len(axes)) if planned is None else planned.motion
    with stages.timed("waypoints", session):
        files.write(outputs.WAYPOINTS, waypoints.text(motion, axes, () if cell is None else cell.machine.units))
    programs = {} if stages.program is None or has_errors(stages.issues) else api.result(stages.program).files
    for name, content in programs.items():
        files.write(f"{outputs.PROGRAMS}/{name}", content)
    with stages.timed("document", session):
        _save(stages.document, files.path(job.name + outputs.DOCUMENT_ENDING))
    with stages.timed("report", session):
        distances = spacing.between_layers(toolpath)
        content = report.build(job.name, toolpath, motion, distances, job.process, stages.issues)
        if planned is not None:
            report.add_joints(content, planned.joint_path, cell, job.joints, stages.joint_path.Seconds)
    with stages.timed("spacing_comparison", session):
        walls = _compared_walls(job, stages, toolpath, distances)
        if not toolpath.features:
            content["spacing_comparison"] = _with_motion(job, stages, walls[0], planned, cell, session)
    with stages.timed("preflight", session):
        content["preflight"] = [one.as_dict() for one in _preflight(stages, distances)]
    balances = [
        deposit_balance.of_toolpath(api.result(feature), part, one.process.bead_width)
        for feature, one, (part, _) in zip(stages.features, job.features, toolpath.parts, strict=True)
    ]
    content["deposit"] = deposit_balance.as_dict(deposit_balance.together(balances))
    if toolpath.features:
        content["features"] = report.features(job.features, toolpath, motion, balances, [list(one.rows) for one in walls])
    content["programs"] = [f"{outputs.PROGRAMS}/{name}" for name in sorted(programs)]
    content["timing_s"] = {**stages.timing, "total": time.perf_counter() - started}
    files.write(outputs.REPORT, [report.text(content)])
    if page:
        with stages.timed("page", session):
            alone = len(job.features) == 1 and family_of(job.strategy).filled
            found = api.result(stages.features[0]) if alone else None
            solids = found if isinstance(found, SolidsOnHub) else None
            page_text = _page(job, content, toolpath, motion, walls, planned, cell, solids)
            files.write(outputs.PAGE, [page_text])
    written = files.publish(outputs.earlier_outputs(files.folder))
    return Result([os.path.join(files.folder, name) for name in written], content, 0 if content["status"] == "ok" else 3)


def _preflight(stages: Stages, distances: Any) -> Any:
    """The promises of the stages as far as they got."""
    from freecad_am.objects import preflight

    return preflight.of_stages(stages.toolpath, stages.joint_path, stages.program, distances)


def _compared_walls(job: Job, stages: Stages, toolpath: Any, distances: Any) -> list[Any]:
    """Of each feature what the page shows, with what other spacings of a wall would be: nothing for other families.
    distances: between all layers."""
    from freecad_am import api
    from freecad_am.core.process import spacing

    from .of_feature import OfFeature

    found = []
    for feature, one, (part, _) in zip(stages.features, job.features, toolpath.parts, strict=True):
        apart = spacing.between_layers(part) if toolpath.features else distances
        shown = OfFeature(one.name if toolpath.features else "", part, apart, getattr(one.strategy, "band", None))
        if family_of(one.strategy).kind == "surface":
            from . import spacing_comparison  # slow to import, and only walls need it

            compared = spacing_comparison.compare(api.result(feature), one)
            shown = shown._replace(compared=compared, rows=spacing_comparison.rows(compared, one, part, apart))
        found.append(shown)
    return found


def _with_motion(job: Job, stages: Stages, wall: Any, planned: Any, cell: Any, session: Any) -> list[dict[str, Any]]:
    """The rows about the wall of a single feature, with how the robot moves where that was asked for."""
    from freecad_am import api

    rows: list[dict[str, Any]] = list(wall.rows)
    if rows and planned is not None:
        from . import spacing_comparison

        rows[0]["motion"] = spacing_comparison.motion_of(planned.joint_path, planned.motion, cell, job.joints)
        others = spacing_comparison.motions(api.result(stages.features[0]), job, session)
        for row in rows[1:]:
            found = others.get(row["method"])
            row["reason" if isinstance(found, str) else "motion"] = found or row["motion"]
    return rows


def _page(
    job: Job, content: dict[str, Any], toolpath: Any, motion: Any, walls: Sequence[Any], planned: Any, cell: Any, solids: Any
) -> str:
    from freecad_am.core.simulation.margins import on_deposit
    from freecad_am.plots.source import Source

    from . import page

    source = Source(toolpath, motion, job.process)
    if planned is not None:
        condition, threshold = (on_deposit(motion.deposit, column) for column in planned.joint_path.judged(motion))
        source = Source(toolpath, motion, job.process, cell, condition, threshold)
    platform = job.cell.platform_diameter if job.cell else None
    return page.render(page.Content(content, source, walls, platform, solids))


def _save(document: Any, path: str) -> None:
    try:
        document.saveAs(path)
    except (OSError, RuntimeError) as error:
        raise InputError("UNWRITABLE", path, f"the document cannot be saved ({error}); free the disk") from None
    if not os.path.isfile(path):
        raise InputError("UNWRITABLE", path, "the document cannot be saved; free the disk")
