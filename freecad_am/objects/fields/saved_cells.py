# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells saved as files, in the folder RoboticAM/cells of the user's data and next to a document."""

from __future__ import annotations

import os
import re
from typing import Any

import FreeCAD as App

FOLDER = os.path.join("RoboticAM", "cells")
ENDINGS = (".yaml", ".yml")
PATTERN = "(*.yaml *.yml)"  # filter in a file dialog
START = 20_000  # characters of a file that are read
MACHINE = re.compile(r"^machine\s*:", re.MULTILINE)
OF_JOBS = re.compile(
    r"^(part|cell|features|version)\s*:", re.MULTILINE
)  # a job file next to it is not a cell


def own_folder() -> str:
    """Return the folder of the user's cells, which may not exist yet."""
    return os.path.join(App.getUserAppDataDir(), FOLDER)


def is_file_of_cell(name: str) -> bool:
    """Whether a text names a cell file, by its extension."""
    return name.lower().endswith(ENDINGS)


def path_of(name: str) -> str:
    """Return the path of a cell file, with the extension added if missing."""
    return name if is_file_of_cell(name) else f"{name}{ENDINGS[0]}"


def known(doc: Any) -> list[tuple[str, str]]:
    """Return path and name of the cell files in the user's folder and next to a document, by name.

    Equal names include their folders. Unreadable files and job files are skipped.
    """
    folders = [
        own_folder(),
        *([os.path.dirname(doc.FileName)] if doc is not None and doc.FileName else []),
    ]
    paths = [path for folder in dict.fromkeys(folders) for path in _files(folder)]
    names = [os.path.splitext(os.path.basename(path))[0] for path in paths]
    cells = [
        (path, f"{name} ({os.path.dirname(path)})" if names.count(name) > 1 else name)
        for path, name in zip(paths, names, strict=True)
    ]
    return sorted(cells, key=lambda entry: (entry[1].lower(), entry[0]))


def _files(folder: str) -> list[str]:
    try:
        entries = sorted(os.scandir(folder), key=lambda file_entry: file_entry.name)
    except OSError:
        return []
    return [entry.path for entry in entries if is_file_of_cell(entry.name) and _is_cell(entry.path)]


def _is_cell(path: str) -> bool:
    try:
        with open(path, encoding="utf-8") as file:
            start = file.read(START)
    except (OSError, UnicodeDecodeError):
        return False
    return bool(MACHINE.search(start)) and not OF_JOBS.search(start)
