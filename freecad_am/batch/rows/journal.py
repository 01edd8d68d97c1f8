# SPDX-License-Identifier: LGPL-2.1-or-later
"""The results of a batch's rows, one line for each as it ends, so that an interrupted batch can
resume.

A row counts as done if its job, the job's files, our code and FreeCAD are unchanged and its outputs
still exist.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from typing import Any

from ..outputs.folder import REPORT
from .process import CHECKED
from .table import Row

NAME = ".rows.jsonl"
FINAL_STATUSES = (0, 3)  # exit statuses of rows that are not tried again


class Journal:
    """The journal of a folder. resume: whether its entries count; else it starts empty."""

    def __init__(self, folder: str, made_by: str, resume: bool) -> None:
        """made_by: what the results depend on besides jobs and their files."""
        self._folder, self._made_by, self._path = folder, made_by, os.path.join(folder, NAME)
        self._files: dict[str, str] = {}
        self._known = dict(self._lines()) if resume else {}
        if not resume:
            with contextlib.suppress(OSError):
                os.remove(self._path)

    def known(self, row: Row, dry: bool) -> dict[str, Any] | None:
        """The result of a row that was done before; None without one."""
        entry = self._known.get(self._digest(row, dry))
        if (
            entry is None
            or entry["folder"] != row.folder
            or (not dry and entry["report"] != self._report(row))
        ):
            return None
        result: dict[str, Any] = entry["result"]
        return result

    def keep(self, row: Row, dry: bool, result: dict[str, Any]) -> None:
        """Write down what a row has come to, whose outputs are in place."""
        if result["exit"] not in FINAL_STATUSES:
            return
        stored = {name: value for name, value in result.items() if name != "lines"}
        line = json.dumps(
            {
                "digest": self._digest(row, dry),
                "folder": row.folder,
                "report": "" if result.get("status") == CHECKED else self._report(row),
                "result": stored,
            }
        )
        with contextlib.suppress(OSError):  # then the row is done again
            os.makedirs(self._folder, exist_ok=True)
            flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
            with open(os.open(self._path, flags, 0o644), "a", encoding="utf-8") as stream:
                stream.write(line + "\n")

    def _lines(self) -> list[tuple[str, dict[str, Any]]]:
        """The entries of the file; an unfinished line of a killed batch is left out."""
        entries = []
        try:
            with open(self._path, encoding="utf-8", errors="replace") as stream:
                for text in stream:
                    with contextlib.suppress(ValueError, TypeError, KeyError):
                        line = json.loads(text)
                        (
                            line["result"]["exit"],
                            line["result"]["message"],
                            line["folder"],
                            line["report"],
                        )
                        entries.append((str(line["digest"]), line))
        except OSError:
            return []
        return entries

    def _digest(self, row: Row, dry: bool) -> str:
        files = {name: self._file(name) for name in sorted(row.files)}
        content = json.dumps(
            [self._made_by, row.tree().values, os.path.abspath(row.path), files, dry],
            sort_keys=True,
        )
        return hashlib.sha256(content.encode()).hexdigest()

    def _file(self, name: str) -> str:
        """The digest of a file, computed once per batch; '' without a file."""
        if name not in self._files:
            self._files[name] = digest(name)
        return self._files[name]

    def _report(self, row: Row) -> str:
        """The digest of a row's report, which is written last of its outputs."""
        return digest(os.path.join(self._folder, row.folder, REPORT)) or "none"


def digest(path: str) -> str:
    """The SHA-256 of a file; '' if it cannot be read."""
    if not os.path.isfile(path):
        return ""
    try:
        with open(path, "rb") as stream:
            return hashlib.sha256(stream.read()).hexdigest()
    except OSError:
        return ""
