# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command that plans a row for a cluster worker: the launcher's command `row`.

The command reads one line of JSON from stdin: the batch folder and the order, if any. It writes one
line of JSON to stdout: the software versions and the result. The environment specifies the location
of the job files (`core.geometry.job_files`). The command ends at SIGTERM, and when stdin closes,
because then the worker is lost and cannot remove the batch folder.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import threading
from typing import Any

from freecad_am.batch import row, versions
from freecad_am.batch import run as planning


def main() -> None:
    """Answer one request."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    null_device = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null_device, 1)  # discard output of FreeCAD and OpenCASCADE
    request = json.loads(sys.stdin.readline())
    planning.import_all()
    os.dup2(null_device, 2)  # the worker reports stderr up to this point
    answer = {"versions": versions.found_versions()}
    if request["order"] is not None:
        answer["result"] = _plan(request["folder"], row.Order(**request["order"]))
    answers.write(json.dumps(answer) + "\n")
    answers.flush()


def _plan(folder: str, order: row.Order) -> dict[str, Any]:
    """Plan an order and return its result. folder: the batch folder."""
    child = row.start_row(order)

    def end(*_: Any) -> None:
        child.stop()
        os._exit(1)

    def end_with_worker() -> None:
        sys.stdin.read()
        worker_is_lost.set()
        child.kill()

    worker_is_lost = threading.Event()
    signal.signal(signal.SIGTERM, end)
    threading.Thread(target=end_with_worker, daemon=True).start()
    while not child.poll(60.0):
        pass
    if worker_is_lost.is_set():
        shutil.rmtree(folder, ignore_errors=True)
        os._exit(1)
    return row.row_result(child)


if __name__ == "__main__":
    main()
