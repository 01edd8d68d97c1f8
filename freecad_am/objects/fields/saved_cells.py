# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells saved as files of their own: in RoboticAM/cells in FreeCAD's folder of user data, and beside a document."""

from __future__ import annotations

import os
import re
from typing import Any

import FreeCAD as App

FOLDER = os.path.join("RoboticAM", "cells")
ENDINGS = (".yaml", ".yml")
PATTERN = "(*.yaml *.yml)"  # of these files in a file dialog
START = 20_000  # characters of a file that are looked at
MACHINE = re.compile(r"^machine\s*:", re.MULTILINE)
OF_JOBS = re.compile(
    r"^(part|cell|features|version)\s*:", re.MULTILINE
)  # a job file beside it is none


def own_folder() -> str:
    """The folder of the user's own cells, which may not be there yet."""
    return os.path.join(App.getUserAppDataDir(), FOLDER)


def is_file_of_cell(name: str) -> bool:
    """Whether a text names a cell file, by its ending."""
    return name.lower().endswith(ENDINGS)


def path_of(name: str) -> str:
    """The path of a cell file, with its ending where that is left out."""
    return name if is_file_of_cell(name) else f"{name}{ENDINGS[0]}"


def known(doc: Any) -> list[tuple[str, str]]:
    """Path and name of the cell files in the user's folder and beside a document, by name; two of one name are told apart by
    their folders. Files that cannot be read, and those of jobs, are none."""
    folders = [
        own_folder(),
        *([os.path.dirname(doc.FileName)] if doc is not None and doc.FileName else []),
    ]
    paths = [path for folder in dict.fromkeys(folders) for path in _files(folder)]
    names = [os.path.splitext(os.path.basename(path))[0] for path in paths]
    found = [
        (path, f"{name} ({os.path.dirname(path)})" if names.count(name) > 1 else name)
        for path, name in zip(paths, names, strict=True)
    ]
    return sorted(found, key=lambda one: (one[1].lower(), one[0]))


def _files(folder: str) -> list[str]:
    try:
        entries = sorted(os.scandir(folder), key=lambda one: one.name)
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
