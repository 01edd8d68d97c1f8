# SPDX-License-Identifier: LGPL-2.1-or-later
"""A row of a batch in a process of its own: one that brings OpenCASCADE down takes no other with it."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from freecad_am.core import copies
from freecad_am.core.issues import AmError, Issue, has_errors
from freecad_am.sections import tree

from .. import run as planning
from .. import supervised
from ..console import Session
from ..job import job
from ..outputs import staging

GRACE = 1.0  # s that a process has to end on request
CHECKED = "checked"  # status of a row that was not planned


@dataclass(frozen=True)
class Order:
    """The task of a process: plan the job with the `values` read from the file `path` into a
    folder, or only check it for errors (`dry`). label: the job's name in messages.
    """

    label: str
    values: dict[str, Any]
    path: str
    folder: str
    dry: bool


def start_row(order: Order) -> tuple[Any, Any]:
    """Start the process of a row; return the receiving end of the pipe for its result, and the
    process.
    """
    context: Any = multiprocessing.get_context(
        "fork" if sys.platform.startswith("linux") else "spawn"
    )
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_carry_out, args=(order, sender))
    process.outputs = order.folder
    process.start()
    sender.close()
    return receiver, process


def received(receiver: Any, process: Any) -> dict[str, Any]:
    """The result of a row whose process has ended: exit, message, output lines, and `figures`."""
    try:
        result: dict[str, Any] = receiver.recv()
    except EOFError:
        process.join()
        error = supervised.crash("row", process.exitcode)
        result = {"exit": error.exit_status, "message": error.message, "lines": [error.line()]}
    receiver.close()
    process.join()
    return result


def last_result(receiver: Any) -> dict[str, Any] | None:
    """The result of a process that has been stopped; None if it had none yet."""
    try:
        return receiver.recv() if not receiver.closed and receiver.poll() else None
    except EOFError:
        return None
    finally:
        receiver.close()


def ask_to_stop(process: Any) -> None:
    """Ask a process to end, without waiting."""
    if process.is_alive():
        os.kill(process.pid, signal.SIGINT)


def stop(process: Any) -> None:
    """End a process and remove its unfinished files, if the geometry kernel keeps it from doing so."""
    ask_to_stop(process)
    process.join(GRACE)
    if process.is_alive():
        process.kill()
        process.join()
        if os.path.isdir(process.outputs):
            with contextlib.suppress(OSError):
                staging.clear(process.outputs)


def _carry_out(order: Order, sender: Any) -> None:
    """The work of the process."""
    made_by = multiprocessing.parent_process()
    assert made_by is not None and made_by.pid is not None
    copies.end_with(made_by.pid)
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
        quiet.say(
            f"error[INTERNAL] {' '.join(message.split())}; this is our fault, please report it"
        )
    sender.send({"exit": status, "message": message or quiet.first, "lines": quiet.lines, **result})
    sender.close()
    os._exit(0)


def _planned(order: Order, quiet: Session) -> tuple[int, dict[str, Any]]:
    """The exit status and the figures."""
    job_read = job.from_tree(tree.Tree(order.label, order.values), order.path)
    if order.dry:
        with planning.named_by_keys(job_read):
            planning.check(job_read)
        return 0, {"status": CHECKED}
    result = planning.run(job_read, order.folder, quiet)
    return result.exit_status, figures(result.report)


def figures(report: dict[str, Any]) -> dict[str, Any]:
    """The figures of a report for the summary of a batch."""
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
    """Collects the messages of a row, to be written together when it is done."""

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
