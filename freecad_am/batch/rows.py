# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run a batch: plan the rows of a table in parallel, in processes (`row.py`) or on a cluster."""

from __future__ import annotations

import csv
import io
import multiprocessing.connection
import os
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from . import row as row_process
from . import row_table, versions
from . import run as planning
from .child import Child
from .console import Session, escaped

FIGURES = (
    "layers",
    "beads",
    "points",
    "length_mm",
    "duration_s",
    "spacing_min_mm",
    "spacing_max_mm",
    "condition_min",
)
_WORST_FIRST = (1, 130, 2, 3, 0)


@dataclass(frozen=True)
class How:
    """Options of a batch run.

    processes: number of parallel local processes. scheduler: address of a cluster scheduler, used
    instead of local processes. resume: whether to keep rows completed by an earlier run. dry:
    whether to only check rows.
    """

    processes: int = 1
    scheduler: str = ""
    resume: bool = False
    dry: bool = False


def run(path: str, job_path: str, output: str | None, how: How, session: Session) -> int:
    """Plan every row and write the summary to stdout. Return the worst exit status of all rows.

    The order from the worst status is 1, 130, 2, 3.
    """
    planning.import_all()  # import once for all rows
    columns, rows = row_table.read(path, job_path)
    folder = output or os.path.join(
        os.path.dirname(os.path.abspath(job_path)),
        "out",
        os.path.splitext(os.path.basename(path))[0],
    )
    journal = row_table.Journal(
        folder, versions.code() + str(versions.found_versions()), how.resume
    )
    results: dict[int, dict[str, Any]] = {}
    waiting = []
    for row in rows:
        if row.error is not None:
            session.say(row.error.line())
            results[row.number] = {"exit": row.error.exit_status, "message": row.error.message}
        elif (earlier_result := journal.known(row, how.dry) if how.resume else None) is not None:
            results[row.number] = earlier_result
        else:
            waiting.append(row)
    if how.resume:
        session.say(
            f"note[RESUMED] batch: {len(rows) - len(waiting)} of {len(rows)} rows are kept from an earlier run"
        )
    session.outcome = "completed rows are saved; --resume plans the remaining rows"
    began, resumed_count = time.monotonic(), len(results)
    for row, result in _planned(waiting, folder, how, session, journal):
        for line in result.pop("lines", []):
            session.say(f"row {row.number}: {line}")
        results[row.number] = result
        session.progress(
            _progress(
                len(results), len(rows), len(results) - resumed_count, time.monotonic() - began
            )
        )
    session.out(_summary(columns, rows, results))
    ends = {result["exit"] for result in results.values()}
    return next((status for status in _WORST_FIRST if status in ends), 1)


def _planned(
    rows: list[row_table.Row], folder: str, how: How, session: Session, journal: row_table.Journal
) -> Iterable[tuple[row_table.Row, dict[str, Any]]]:
    """Yield rows with their results as rows finish; record finished rows in the journal."""
    if not how.scheduler or not rows:
        return _planned_here(rows, folder, how, session, journal)
    return _planned_there(rows, folder, how, session, journal)


def _planned_there(
    rows: list[row_table.Row], folder: str, how: How, session: Session, journal: row_table.Journal
) -> Iterator[tuple[row_table.Row, dict[str, Any]]]:
    from . import cluster

    with cluster.Cluster(how.scheduler, session) as workers:
        yield from workers.planned(rows, folder, how.dry, journal)


def _planned_here(
    rows: list[row_table.Row], folder: str, how: How, session: Session, journal: row_table.Journal
) -> Iterator[tuple[row_table.Row, dict[str, Any]]]:
    waiting = list(reversed(rows))
    running: dict[Any, tuple[row_table.Row, Child]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < how.processes:
                row = waiting.pop()
                order = row_process.Order(
                    row.label,
                    row.tree().values,
                    row.path,
                    os.path.join(folder, row.folder),
                    how.dry,
                )
                child = row_process.start_row(order)
                running[child.receiver] = (row, child)
            for receiver in multiprocessing.connection.wait(list(running)):
                row, child = running[receiver]
                if child.poll(0.0):
                    result = row_process.row_result(child)
                    journal.keep(row, how.dry, result)
                    del running[receiver]
                    yield row, result
            session.check()
    finally:
        for _, child in running.values():
            child.interrupt()
        for row, child in running.values():
            child.stop()
            if child.is_done:
                journal.keep(row, how.dry, child.result)


def _progress(finished: int, rows: int, now: int, seconds: float) -> str:
    """Return the progress text with the estimated remaining time."""
    remaining_s = (rows - finished) * seconds / max(now, 1)
    text = (
        f"{remaining_s / 3600:.1f} h"
        if remaining_s > 5400
        else f"{remaining_s / 60:.0f} min"
        if remaining_s > 90
        else f"{remaining_s:.0f} s"
    )
    return f"{finished} of {rows} rows done" + (f", about {text} left" if finished < rows else "")


def _summary(
    columns: list[str], rows: list[row_table.Row], results: dict[int, dict[str, Any]]
) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        ["row", *map(escaped, columns), "folder", "exit", "status", *FIGURES, "message"]
    )
    for row in rows:
        result = results[row.number]
        status = result.get("status", "failed")
        figures = [_cell(result.get(figure)) for figure in FIGURES]
        texts = map(escaped, (*row.cells.values(), row.folder))
        writer.writerow(
            [row.number, *texts, result["exit"], status, *figures, escaped(result["message"])]
        )
    return text.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6f}" if isinstance(value, float) else escaped(str(value))
