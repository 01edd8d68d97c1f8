# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans the rows of a table, some at the same time, and sums them up.

Each row has a process of its own: a row that brings OpenCASCADE down takes no other with it.
"""

from __future__ import annotations

import csv
import io
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
from collections.abc import Iterable
from typing import Any

from freecad_am.core.issues import AmError, Issue, has_errors

from . import run as planning
from . import supervised, table
from .console import Session, escaped

FIGURES = ("layers", "beads", "points", "length_mm", "duration_s", "spacing_min_mm", "spacing_max_mm", "condition_min")
_WORST_FIRST = (1, 130, 2, 3, 0)


def run(path: str, job_path: str, output: str | None, processes: int, session: Session) -> int:
    """Plan every row; the summary goes to stdout. The exit status of the worst row: 1 over 130 over 2 over 3."""
    columns, rows = table.read(path, job_path)
    folder = output or os.path.join(
        os.path.dirname(os.path.abspath(job_path)), "out", os.path.splitext(os.path.basename(path))[0]
    )
    results: dict[int, dict[str, Any]] = {}
    waiting = []
    for row in rows:
        if row.error is None:
            waiting.append(row)
        else:
            session.say(row.error.line())
            results[row.number] = {"exit": row.error.exit_status, "message": row.error.message}
    planning.import_all()  # once for all rows
    session.outcome = "rows that were done are whole, of the others nothing was written"
    for row, result in _planned(waiting, folder, processes, session):
        results[row.number] = result
        for line in result.pop("lines", []):
            session.say(f"row {row.number}: {line}")
        session.progress(f"{len(results)} of {len(rows)} rows done")
    session.out(_summary(columns, rows, results))
    ends = {result["exit"] for result in results.values()}
    return next((status for status in _WORST_FIRST if status in ends), 1)


def _planned(
    rows: list[table.Row], folder: str, processes: int, session: Session
) -> Iterable[tuple[table.Row, dict[str, Any]]]:
    context: Any = multiprocessing.get_context("fork" if sys.platform.startswith("linux") else "spawn")
    waiting = list(reversed(rows))
    running: dict[Any, tuple[table.Row, Any]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < processes:
                row = waiting.pop()
                receiver, sender = context.Pipe(duplex=False)
                process = context.Process(target=_plan_row, args=(row, os.path.join(folder, row.folder), sender))
                process.start()
                sender.close()
                running[receiver] = (row, process)
            for receiver in multiprocessing.connection.wait(list(running)):
                row, process = running.pop(receiver)
                yield row, _received(receiver, process)
            session.check()
    finally:
        for receiver, (_, process) in running.items():
            _stop(process)
            receiver.close()


def _received(receiver: Any, process: Any) -> dict[str, Any]:
    try:
        result: dict[str, Any] = receiver.recv()
    except EOFError:
        process.join()
        result = _ended(process.exitcode)
    receiver.close()
    process.join()
    return result


def _ended(status: int) -> dict[str, Any]:
    """The result of a row whose process ended without one."""
    error = supervised.crash("row", status)
    return {"exit": error.exit_status, "message": error.message, "lines": [error.line()]}


def _stop(process: Any) -> None:
    if process.is_alive():
        os.kill(process.pid, signal.SIGINT)  # lets it remove what is unfinished
        process.join(10.0)
    if process.is_alive():
        process.kill()
        process.join()


def _plan_row(row: table.Row, folder: str, sender: Any) -> None:
    """The work of a row's own process."""
    quiet = _Quiet()
    status, report, message = 1, None, ""
    try:
        assert row.job is not None
        result = planning.run(row.job, folder, quiet)
        status, report = result.exit_status, result.report
    except KeyboardInterrupt:
        status, message = 130, "interrupted"
    except AmError as error:
        status, message = error.exit_status, error.message
        quiet.say(error.line())
    except Exception as error:
        message = f"{type(error).__name__}: {error}"
        quiet.say(f"error[INTERNAL] {' '.join(message.split())}; this is our fault, please report it")
    sender.send({"exit": status, "message": message or quiet.first, "lines": quiet.lines, **_figures(report)})
    sender.close()
    os._exit(0)


class _Quiet(Session):
    """Collects the messages of a row, to be told in one piece when it is done."""

    def __init__(self) -> None:
        super().__init__()
        self._handle(signal.SIGINT)
        self._handle(signal.SIGTERM)
        self.lines: list[str] = []
        self.first = ""

    def say(self, line: str) -> None:
        self.lines.append(line)

    def progress(self, text: str) -> None:
        self.check()

    def issues(self, found: Iterable[Issue]) -> None:
        known = list(found)
        if has_errors(known):
            self.first = next(issue.message for issue in known if issue.level == "error")
        super().issues(known)


def _figures(report: dict[str, Any] | None) -> dict[str, Any]:
    if report is None:
        return {}
    joints = report["joints"] or {}
    return {
        "status": report["status"], **report["counts"], "length_mm": report["length_mm"], "duration_s": report["duration_s"],
        "spacing_min_mm": report["spacing_mm"]["min"], "spacing_max_mm": report["spacing_mm"]["max"],
        "condition_min": joints.get("condition_min"),
    }


def _summary(columns: list[str], rows: list[table.Row], results: dict[int, dict[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["row", *map(escaped, columns), "folder", "exit", "status", *FIGURES, "message"])
    for row in rows:
        result = results[row.number]
        status = result.get("status", "failed")
        figures = [_cell(result.get(figure)) for figure in FIGURES]
        told = map(escaped, (*row.cells.values(), row.folder))
        writer.writerow([row.number, *told, result["exit"], status, *figures, escaped(result["message"])])
    return text.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return f"{value:.6f}" if isinstance(value, float) else escaped(str(value))
