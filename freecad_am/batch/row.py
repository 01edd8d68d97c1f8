# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan one row of a batch in a child process and return its result."""

from __future__ import annotations

import signal
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..core.issues import AmError, Issue, has_errors
from ..sections import tree
from . import run as planning
from .child import Child, crash
from .console import Session
from .job import job

CHECKED = "checked"  # status of a row that was not planned


@dataclass(frozen=True)
class Order:
    """Task of a row process: plan a job, or only check the job for errors if `dry`.

    values: job values, read from the file `path`. folder: output folder. label: job name in
    messages.
    """

    label: str
    values: dict[str, Any]
    path: str
    folder: str
    dry: bool


def start_row(order: Order) -> Child:
    """Start the process of a row."""
    return Child(plan_row, order)


def row_result(child: Child) -> dict[str, Any]:
    """Return the result of an ended row process: exit, message, lines and keys of `figures`."""
    if child.is_done:
        result: dict[str, Any] = child.result
        return result
    error = crash("row", child.exitcode)
    return {"exit": error.exit_status, "message": error.message, "lines": [error.line()]}


def plan_row(order: Order) -> dict[str, Any]:
    """In the process of a row: plan the row and return its result."""
    quiet = _Quiet()
    status, message, result = 1, "", {}
    try:
        status, result = _planned(order, quiet)
    except KeyboardInterrupt:
        status, message = 130, "interrupted"
    except AmError as error:
        status, message = error.exit_status, error.message
        quiet.say(error.line())
    except Exception as error:
        message = f"{type(error).__name__}: {error}"
        quiet.say(f"error[INTERNAL] {' '.join(message.split())}; please report this bug")
    return {"exit": status, "message": message or quiet.first, "lines": quiet.lines, **result}


def _planned(order: Order, quiet: Session) -> tuple[int, dict[str, Any]]:
    """Plan or check an order; return the exit status and the summary values."""
    job_read = job.from_tree(tree.Tree(order.label, order.values), order.path)
    if order.dry:
        with planning.named_by_keys(job_read):
            planning.check(job_read)
        return 0, {"status": CHECKED}
    result = planning.run(job_read, order.folder, quiet)
    return result.exit_status, figures(result.report)


def figures(report: dict[str, Any]) -> dict[str, Any]:
    """Return the values of a report for the batch summary."""
    joints = report["joints"] or {}
    return {
        "status": report["status"],
        **report["counts"],
        "length_mm": report["length_mm"],
        "duration_s": report["duration_s"],
        "spacing_min_mm": report["spacing_mm"]["min"],
        "spacing_max_mm": report["spacing_mm"]["max"],
        "condition_min": joints.get("condition_min"),
    }


class _Quiet(Session):
    """Session that collects the messages of a row, to write them together at the end."""

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

    def issues(self, findings: Iterable[Issue]) -> None:
        all_findings = list(findings)
        if has_errors(all_findings):
            self.first = next(issue.message for issue in all_findings if issue.level == "error")
        super().issues(all_findings)
