# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the table of a batch, one job a row, and keeps the journal of finished rows.

Columns are dotted job keys; an empty cell keeps the job's own value.
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
    """One row: its number (from 1), the cells by column, its folder's name, the error if it has no
    job, and `files`, the absolute names of the files that the job names. The job itself is read
    again when it is planned.
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
        """The values of the job. Raises InputError for a cell that is not understood."""
        changed = tree.Tree(self.label, copy.deepcopy(self.base.values))
        for column, cell in self.cells.items():
            if cell:
                _put(changed.values, column, tree.scalar(cell, changed.where(column)), changed)
        return changed


def read(table: str, job_path: str) -> tuple[list[str], list[Row]]:
    """Columns and rows. Raises InputError for a table or job file that cannot be read at all."""
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
            "BAD_FILE", label, "this is not a table: {}; separate cells by commas", error
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
                "the column {!r} is empty or duplicated; use each name once",
                column,
            )
        if ";" in column or "\t" in column:
            raise InputError(
                "BAD_FILE",
                label,
                "the cells are not separated by commas; save the table as CSV with commas",
            )
        if column.split(".")[0] not in job.SECTIONS:
            message = "there is no such key; use job keys such as strategy.layer_height"
            raise InputError("UNKNOWN_KEY", f"{label}: {column}", message)
    for number, line in enumerate(lines[1:], 1):
        if len(line) != len(columns):
            message = Text(
                "{} cells for {} columns; quote cells that contain commas", len(line), len(columns)
            )
            raise InputError("BAD_FILE", f"{label} row {number}", message)
    return columns, lines[1:]


def _folders(columns: list[str], cells: list[list[str]]) -> list[str]:
    """The rows' names where they have different ones that can name a folder, else their numbers."""
    width = max(3, len(str(len(cells))))
    numbers = [f"row-{number:0{width}d}" for number in range(1, len(cells) + 1)]
    names = [row[columns.index("name")] for row in cells] if "name" in columns else []
    usable = len({name.lower() for name in names}) == len(cells) and all(
        name and "/" not in name and "\\" not in name and name[0] != "." for name in names
    )
    return names if usable else numbers


def _checked(row: Row, files_by_cell: dict[Any, frozenset[str]]) -> Row:
    """The row with its error or files; `files_by_cell`: files of cells met before."""
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
    )  # one set for all rows alike


def _files_of_cell(job_read: job.Job) -> frozenset[str]:
    """Files of the machines, with the shapes of their links. Planning the row reports their errors."""
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
        )  # a Label may have dots, a property has none
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
