# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read a batch table, one job per row, and keep the journal of finished rows.

Columns are dotted job keys; an empty cell keeps the value of the job file.
"""

from __future__ import annotations

import contextlib
import copy
import csv
import hashlib
import io
import json
import os
from dataclasses import dataclass, field, replace
from typing import Any

from ..core.geometry import job_files
from ..core.issues import InputError, Text
from ..sections import tree
from . import run
from .job import job
from .output_folder import REPORT
from .row import CHECKED

SETTING = "part.set."


@dataclass(frozen=True)
class Row:
    """One row of the table.

    number: from 1. cells: by column. folder: name of the output folder. error: set if the row has
    no valid job. files: absolute names of the files that the job names. The job is read again for
    planning.
    """

    number: int
    cells: dict[str, str]
    folder: str
    base: tree.Tree = field(repr=False)
    path: str
    label: str
    error: InputError | None = None
    files: frozenset[str] = frozenset()

    def tree(self) -> tree.Tree:
        """Return the job values of the row. Raises InputError for an invalid cell."""
        changed = tree.Tree(self.label, copy.deepcopy(self.base.values))
        for column, cell in self.cells.items():
            if cell:
                _put(changed.values, column, tree.scalar(cell, changed.where(column)), changed)
        return changed


def read(table: str, job_path: str) -> tuple[list[str], list[Row]]:
    """Read columns and rows of a table. Raises InputError for an unreadable table or job file."""
    label = os.path.basename(table)
    base = tree.read(job_path)
    columns, cells = _cells(tree.text_of(table, label), label)
    folders = _folders(columns, cells)
    files_by_cell: dict[Any, frozenset[str]] = {}
    return columns, [
        _checked(
            Row(n, dict(zip(columns, row)), folder, base, job_path, f"{label} row {n}"),
            files_by_cell,
        )
        for n, (row, folder) in enumerate(zip(cells, folders), 1)
    ]


def _cells(text: str, label: str) -> tuple[list[str], list[list[str]]]:
    try:
        lines = [
            [cell.strip() for cell in line]
            for line in csv.reader(io.StringIO(text, newline=""), strict=True)
        ]
    except csv.Error as error:
        raise InputError(
            "BAD_FILE", label, "the file is not a table: {}; separate cells by commas", error
        ) from None
    lines = [line for line in lines if any(line)]
    if len(lines) < 2:
        raise InputError(
            "EMPTY_FILE",
            label,
            "the table has no rows; write a line of job keys, then a line per job",
        )
    columns = lines[0]
    for column in columns:
        if not column or columns.count(column) > 1:
            raise InputError(
                "BAD_FILE",
                label,
                "the column {!r} is empty or duplicated; give each column a unique name",
                column,
            )
        if ";" in column or "\t" in column:
            raise InputError(
                "BAD_FILE",
                label,
                "the cells are not separated by commas; save the table as CSV with commas",
            )
        if column.split(".")[0] not in job.SECTIONS:
            message = "the column is not a job key; use keys such as strategy.layer_height"
            raise InputError("UNKNOWN_KEY", f"{label}: {column}", message)
    for number, line in enumerate(lines[1:], 1):
        if len(line) != len(columns):
            message = Text(
                "{} cells for {} columns; quote cells that contain commas", len(line), len(columns)
            )
            raise InputError("BAD_FILE", f"{label} row {number}", message)
    return columns, lines[1:]


def _folders(columns: list[str], cells: list[list[str]]) -> list[str]:
    """Return folder names: the row names if all are distinct and valid, else the row numbers."""
    width = max(3, len(str(len(cells))))
    numbers = [f"row-{number:0{width}d}" for number in range(1, len(cells) + 1)]
    names = [row[columns.index("name")] for row in cells] if "name" in columns else []
    usable = len({name.lower() for name in names}) == len(cells) and all(
        name and "/" not in name and "\\" not in name and name[0] != "." for name in names
    )
    return names if usable else numbers


def _checked(row: Row, files_by_cell: dict[Any, frozenset[str]]) -> Row:
    """Return the row with its error or files. files_by_cell: cache of the files of each cell."""
    try:
        with job_files.record_names() as named:
            job_read = job.from_tree(row.tree(), row.path)
    except InputError as error:
        return replace(row, error=error)
    if job_read.cell not in files_by_cell:
        files_by_cell[job_read.cell] = _files_of_cell(job_read)
    files = named | files_by_cell[job_read.cell]
    return replace(
        row, files=files_by_cell.setdefault(frozenset(files), frozenset(files))
    )  # rows with equal files share one set


def _files_of_cell(job_read: job.Job) -> frozenset[str]:
    """Return the machine files and link shape files of a job. Planning reports their errors."""
    with job_files.record_names() as named, contextlib.suppress(InputError):
        cell = run.resolved_cell(job_read)
        for shape in () if cell is None else cell.machine.shapes:
            if shape is not None:
                job_files.locate(shape.path)
    return frozenset(named)


def _put(values: dict[str, Any], column: str, value: Any, changed: tree.Tree) -> None:
    keys = column.split(".")
    if column.startswith(SETTING):
        name, _, key = column[len(SETTING) :].rpartition(
            "."
        )  # a Label may contain dots, a property name cannot
        if not name:
            raise InputError(
                "UNKNOWN_KEY", changed.where(column), "write part.set.<object>.<property>"
            )
        keys = ["part", "set", name, key]
    for key in keys[:-1]:
        if not isinstance(values.get(key), dict):
            values[key] = {}
        values = values[key]
    values[keys[-1]] = value


NAME = ".rows.jsonl"
FINAL_STATUSES = (0, 3)  # exit statuses of rows that are not planned again


class Journal:
    """Journal of a batch folder. resume: whether to use existing entries; else start empty."""

    def __init__(self, folder: str, made_by: str, resume: bool) -> None:
        """Open the journal.

        made_by: identifies everything except jobs and their files that results depend on.
        """
        self._folder, self._made_by, self._path = folder, made_by, os.path.join(folder, NAME)
        self._files: dict[str, str] = {}
        self._known = dict(self._lines()) if resume else {}
        if not resume:
            with contextlib.suppress(OSError):
                os.remove(self._path)

    def known(self, row: Row, dry: bool) -> dict[str, Any] | None:
        """Return the stored result of a row, None if the row has none."""
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
        """Record the result of a row whose outputs are stored."""
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
        with contextlib.suppress(OSError):  # an unrecorded row is planned again
            os.makedirs(self._folder, exist_ok=True)
            flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
            with open(os.open(self._path, flags, 0o644), "a", encoding="utf-8") as stream:
                stream.write(line + "\n")

    def _lines(self) -> list[tuple[str, dict[str, Any]]]:
        """Return the entries of the file, except an incomplete line of a killed batch."""
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
        """Return the digest of a file, computed once per batch; '' without a file."""
        if name not in self._files:
            self._files[name] = digest(name)
        return self._files[name]

    def _report(self, row: Row) -> str:
        """Return the digest of a row's report, which is the last output written."""
        return digest(os.path.join(self._folder, row.folder, REPORT)) or "none"


def digest(path: str) -> str:
    """Return the SHA-256 of a file, '' if it cannot be read."""
    if not os.path.isfile(path):
        return ""
    try:
        with open(path, "rb") as stream:
            return hashlib.sha256(stream.read()).hexdigest()
    except OSError:
        return ""
