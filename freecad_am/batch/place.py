# SPDX-License-Identifier: LGPL-2.1-or-later
"""Possible positions of the part of a job, its positioner or its deposition point: a table, a page,
and the best pose.
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple

from ..core.issues import ERROR, NOTE, InputError, Issue, Text, Word, has_errors
from ..core.one_thread import one_thread
from . import paths
from .job.features import in_words_of_job
from .job.job import SECTIONS, Job
from .outputs import folder as outputs

TABLE, PAGE = "place.csv", "place.html"


class Result(NamedTuple):
    """The best pose as a line of a section `cell`, or ''; the issues, and the exit status, 0 or 3."""

    line: str
    issues: list[Issue]
    exit_status: int


def place(job: Job, folder: str | None, session: Any) -> Result:
    """Try the poses of the section `place` of a job and write the results into `folder`, by default
    out/<name>-place next to the job file.

    Raises InputError; then nothing is written.
    """
    if job.cell is None:
        raise InputError(
            "NO_CELL", "cell", "the job has no cell to place the part in; add the section `cell`"
        )
    paths.require_freecad()
    import FreeCAD

    from . import run
    from .job import document as job_document

    target = folder or os.path.join(job.folder, "out", f"{job.name}-place")
    try:
        run.check(job)
        with one_thread(), outputs.Outputs(target, session) as files:
            document = job_document.new_document(job)
            try:
                stages = run.as_far_as_toolpath(job, document, session)
                if has_errors(stages.issues):
                    return Result("", stages.issues, 3)
                return _write_results(job, stages, files, session)
            finally:
                FreeCAD.closeDocument(document.Name)
    except InputError as found:
        error = in_words_of_job(found)
        if error.where.split(".")[0].split("[")[0] in SECTIONS:
            raise job.tree.locate(error) from None
        raise error from None


def _write_results(job: Job, stages: Any, files: outputs.Outputs, session: Any) -> Result:
    from freecad_am.core.placement import table
    from freecad_am.objects.checks.placed import placing_of

    from .outputs import place_page

    with stages.timed("place", session):
        placement = placing_of(stages.toolpath, stages.cell, job.joints).search_poses(job.place)
    files.write(TABLE, table.rows(placement))
    files.write(PAGE, [place_page.render(job.name, placement)])
    files.publish(
        {name for name in (TABLE, PAGE) if os.path.isfile(os.path.join(files.folder, name))}
    )
    count, serve = (
        len(placement.poses),
        sum(pose_result.feasible for pose_result in placement.judged),
    )
    extent = Text("{} of {} points", placement.points, placement.of)
    if placement.best is None:
        best_share = max(pose_result.share for pose_result in placement.judged)
        wrong = placement.judged[max(range(count), key=lambda k: placement.judged[k].share)]
        text = Text(
            "none of {} poses works at {}: at most {:.3g} % of the points are within reach and "
            "limits ({}); enlarge the box in `place`, or try another cell.branch",
            count,
            Word(extent),
            100.0 * best_share,
            wrong.code,
        )
        if serve:
            text = Text(
                "none of the {} best of {} poses is feasible at all points, only at some; raise "
                "place.points or place.proven",
                len(placement.proven),
                serve,
            )
        return Result("", [*stages.issues, Issue(ERROR, "NO_PLACE", text)], 3)
    best = placement.result_of(placement.best)
    note = Issue(
        NOTE,
        "PLACED",
        Text(
            "{} of {} poses are feasible at {}; the best one is verified at all points: margin "
            "{:.3g} %, {:.0f} s; {} and {} are in {}",
            serve,
            count,
            Word(extent),
            100.0 * best.margin,
            best.time,
            TABLE,
            PAGE,
            files.folder,
        ),
    )
    return Result(table.key(placement, placement.best), [*stages.issues, note], 0)
