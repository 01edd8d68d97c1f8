# SPDX-License-Identifier: LGPL-2.1-or-later
"""The process that plans rows for a worker of a cluster, each in a copy of itself that has all modules already.

Lines of JSON come in by stdin and go out by stdout: first the settings, answered by versions, then an order each, answered
by its result. It ends with its stdin, which the worker holds, and removes the folder of the batch then; on request it ends
together with the row that it is planning.
Started by boot.py, as the word `rows` of the launcher.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import tempfile
from typing import Any

from freecad_am.batch import run as planning
from freecad_am.batch import versions


def main() -> None:
    """Serve until stdin ends."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)  # FreeCAD and OpenCASCADE write there as well
    lines = sys.stdin
    planning.import_all()
    os.dup2(nowhere, 2)  # without a reader from now on
    settings = json.loads(lines.readline())
    _set_up(settings)
    _answer(answers, versions.found_versions())
    for line in lines:
        request = json.loads(line)
        _answer(answers, versions.found_versions() if "versions" in request else _planned(request))
    shutil.rmtree(settings["folder"], ignore_errors=True)  # the worker is lost and cannot remove it


def _answer(stream: Any, answer: dict[str, Any]) -> None:
    stream.write(json.dumps(answer) + "\n")
    stream.flush()


def _set_up(settings: dict[str, Any]) -> None:
    """Files are copies from now on, and temporary ones go into the folder of the batch."""
    from freecad_am.core.geometry import located
    from freecad_am.objects import user_machines

    temporary = os.path.join(settings["folder"], "temporary")
    os.makedirs(temporary, exist_ok=True)
    os.environ["TMPDIR"] = tempfile.tempdir = temporary
    located.use_copies(settings["copies"], (versions.ROOT, settings["folder"]), settings["home"])
    user_machines.use_folders(tuple(settings["machines"]))


def _planned(request: dict[str, Any]) -> dict[str, Any]:
    """The result of an order."""
    from freecad_am.batch.rows import table

    receiver, process = table.start_row(table.Order(**request))

    def end(*_: Any) -> None:
        table.stop(process)
        os._exit(1)

    old_handler = signal.signal(signal.SIGTERM, end)
    try:
        return table.received(receiver, process)
    finally:
        signal.signal(signal.SIGTERM, old_handler)


if __name__ == "__main__":
    main()
