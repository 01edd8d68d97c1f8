# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search for poses of a job's part, positioner or deposition point; write a table and a page."""

from __future__ import annotations

import os
from html import escape
from typing import Any, NamedTuple

import numpy as np

from ..core.issues import ERROR, NOTE, InputError, Issue, Text, Word, has_errors
from ..core.one_thread import one_thread
from ..core.placement.place import Placed, outer, ranked
from ..report.template import fill_page
from . import output_folder as outputs
from .host import require_freecad
from .job.features import in_words_of_job
from .job.job import SECTIONS, Job

# ---- place.html: maps of poses by height, and a table of the best poses; one self-contained file
# without scripts

_BEST = 20  # number of poses in the table
_MOST_MAPS = 60
_COLOURS = ("#2b5fb3", "#2f9e8f", "#8bc34a", "#f3d13b")  # margin colours in ascending order
_OUT_OF_RANGE_COLOUR = "#b9bec8"


def render(name: str, placement: Placed) -> str:
    """Return the page of the rated poses of a job as HTML."""
    title = f"Placement of {name}"
    serve = sum(pose_result.feasible for pose_result in placement.judged)
    what = placement.moves.replace("-", " ")
    text = (
        f"{serve} of {len(placement.poses)} poses of the {what} are feasible at the {placement.points} checked points of {placement.of}. "
        "Each square shows the best rotation at its position: the colour is the smallest joint margin as a share of the range, "
        "grey if the pose is infeasible, and the number is the share of feasible points."
    )
    html_parts = [
        f'<header><h1>{escape(title)}</h1></header><p class="sub">{text}</p>',
        _table(placement),
    ]
    heights = np.unique(placement.poses[:, 2])[:_MOST_MAPS]
    low, high = _range(placement)
    html_parts.append(
        f'<p class="sub">margin from {100.0 * low:.3g} % {_key()} to {100.0 * high:.3g} %</p>'
    )
    html_parts += [_map(placement, height, low, high) for height in heights]
    return fill_page(title, html_parts)


def _table(placement: Placed) -> str:
    heads = (
        "x, mm",
        "y, mm",
        "z, mm",
        "RX, deg",
        "RY, deg",
        "RZ, deg",
        "margin, %",
        "time, s",
        "clearance, mm",
        "planned with",
    )
    rows = ["<tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"]
    proven = list(placement.proven)
    best_number = [placement.best] if placement.best is not None else []
    for number in dict.fromkeys([*best_number, *proven, *ranked(placement, "margin")[:_BEST]]):
        pose_result = placement.result_of(number)
        figures = [f"{value:.6g}" for value in outer(placement.pose(number))]
        figures += [
            _format(100.0 * pose_result.margin, ".3g"),
            _format(pose_result.time, ".0f"),
            _format(pose_result.clearance, ".3g"),
        ]
        how = "all points" if number in placement.proven else f"{placement.points} points"
        cells = [*figures, how if pose_result.feasible else f"{how}: {pose_result.code}"]
        rows.append("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>")
    return f'<div class="table"><table>{"".join(rows)}</table></div>'


def _format(value: float, form: str) -> str:
    return format(value, form) if np.isfinite(value) else "–"


def _range(placement: Placed) -> tuple[float, float]:
    margins = [pose_result.margin for pose_result in placement.judged if pose_result.feasible]
    return (min(margins), max(margins)) if margins else (0.0, 1.0)


def _map(placement: Placed, height: float, low: float, high: float) -> str:
    """Return the poses of one height as a table, seen from above."""
    rows = np.flatnonzero(placement.poses[:, 2] == height)
    best_at: dict[tuple[float, float], int] = {}
    for number in sorted(rows.tolist(), key=lambda k: _rank_key(placement, k)):
        x, y, *_ = placement.poses[number].tolist()
        best_at[x, y] = number  # the best pose is set last
    columns = sorted({x for x, _ in best_at})
    lines = []
    for y in sorted({y for _, y in best_at}, reverse=True):
        cells = [_map_cell(placement, best_at.get((x, y)), low, high) for x in columns]
        lines.append(f"<tr><th>{y:.6g}</th>{''.join(cells)}</tr>")
    heads = "".join(f"<th>{x:.6g}</th>" for x in columns)
    lines.append(f"<tr><th>y, mm / x, mm</th>{heads}</tr>")
    return (
        f'<div class="table"><table class="map"><caption>z = {height:g} mm</caption>'
        f"{''.join(lines)}</table></div>"
    )


def _map_cell(placement: Placed, number: int | None, low: float, high: float) -> str:
    """Return the table cell of a pose.

    The colour shows the margin, the text the fraction of reachable points, the tooltip all values.
    """
    if number is None:
        return "<td></td>"
    pose_result = placement.result_of(number)
    share = (pose_result.margin - low) / (high - low) if high > low else 1.0
    colour = (
        _COLOURS[min(int(4.0 * max(share, 0.0)), 3)]
        if pose_result.feasible
        else _OUT_OF_RANGE_COLOUR
    )
    best = ' class="best"' if number == placement.best else ""
    return (
        f'<td{best} style="background:{colour}" title="{escape(_pose_text(placement, number))}">'
        f"{100.0 * pose_result.share:.0f} %</td>"
    )


def _rank_key(placement: Placed, number: int) -> tuple[float, float, float]:
    pose_result = placement.result_of(number)
    return (
        float(pose_result.feasible),
        pose_result.share,
        float(np.nan_to_num(pose_result.margin, nan=-1.0)),
    )


def _pose_text(placement: Placed, number: int) -> str:
    pose_result = placement.result_of(number)
    values = [float(f"{value:.6g}") for value in outer(placement.pose(number))]
    return (
        f"{values}: {pose_result.code or 'feasible'}; margin {_format(100.0 * pose_result.margin, '.3g')} %, {_format(pose_result.time, '.0f')} s, "
        f"arm {_format(pose_result.clearance, '.3g')} mm"
    )


def _key() -> str:
    return "".join(f'<span style="color:{colour}">&#9632;</span>' for colour in _COLOURS)


TABLE, PAGE = "place.csv", "place.html"


class Result(NamedTuple):
    """Best pose as a line for the job section `cell`, or ''; issues; exit status, 0 or 3."""

    line: str
    issues: list[Issue]
    exit_status: int


def place(job: Job, folder: str | None, session: Any) -> Result:
    """Rate the poses of a job's section `place` and write the results to `folder`.

    The default folder is out/<name>-place next to the job file. Raises InputError and then writes
    nothing.
    """
    if job.cell is None:
        raise InputError(
            "NO_CELL", "cell", "the job has no cell to place the part in; add the section `cell`"
        )
    require_freecad()
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
    from freecad_am.core.placement import place as table
    from freecad_am.objects.checks.placed import placing_of

    with stages.timed("place", session):
        placement = placing_of(stages.toolpath, stages.cell, job.joints).search_poses(job.place)
    files.write(TABLE, table.rows(placement))
    files.write(PAGE, [render(job.name, placement)])
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
            "none of {} poses is feasible at {}: at most {:.3g} % of the points are within reach "
            "and limits ({}); enlarge the box in `place`, or try another cell.branch",
            count,
            Word(extent),
            100.0 * best_share,
            wrong.code,
        )
        if serve:
            text = Text(
                "none of the {} best of {} poses is feasible at all points; raise place.points "
                "or place.proven",
                len(placement.proven),
                serve,
            )
        return Result("", [*stages.issues, Issue(ERROR, "NO_PLACE", text)], 3)
    best = placement.result_of(placement.best)
    note = Issue(
        NOTE,
        "PLACED",
        Text(
            "{} of {} poses are feasible at {}; the best pose is verified at all points: margin "
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
