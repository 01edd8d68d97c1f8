# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder of outputs: files appear whole or not at all, and only our own are ever removed."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import tempfile
import threading
from collections.abc import Iterable, Iterator
from typing import Any

from freecad_am.core.issues import InputError

WAYPOINTS, REPORT, PAGE, PROGRAMS = "waypoints.csv", "report.json", "report.html", "program"
DOCUMENT_ENDING = ".FCStd"
PROGRAM_ENDINGS = (".ls",)  # of the controllers' texts that are ours wherever they stand in program/
# endings of main programs, and those of their parts
PART_ENDINGS = {".mpf": ".spf", ".ngc": ".ngc"}
# what tells a program or application of ours: remarks that every one begins with
OUR_REMARKS = ("Limits: ", "Travel speed ")


class Outputs:
    """Collects the files of a run in a hidden folder of the target and moves them into place at the end.

    Use as a context: leaving it without `publish` removes everything that was collected, and the target folder is as it
    was. Raises InputError UNWRITABLE at once where the target cannot be written.
    """

    def __init__(self, folder: str) -> None:
        self.folder = os.path.abspath(folder)
        self._made: list[str] = []
        try:
            self._make_folder()
            self.staging = tempfile.mkdtemp(prefix=".unfinished-", dir=self.folder)
        except (OSError, ValueError) as error:
            self._remove_made()
            raise self._unwritable(self.folder, error) from None

    def __enter__(self) -> Outputs:
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self.staging, ignore_errors=True)
        self._remove_made()

    def path(self, name: str) -> str:
        """Where to write the file `name` (slashes for folders) of this run."""
        path = os.path.join(self.staging, *name.split("/"))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def write(self, name: str, data: bytes | Iterable[str]) -> None:
        """Write a file of this run; text in pieces, as UTF-8 with the line ends it has."""
        try:
            with open(self.path(name), "wb") as stream:
                stream.writelines([data] if isinstance(data, bytes) else (piece.encode() for piece in data))
        except OSError as error:
            raise self._unwritable(self._target(name), error) from None

    def publish(self, earlier: set[str]) -> list[str]:
        """Move every file into place; the names, sorted. Ctrl-C waits meanwhile.

        What of `earlier` this run has not is removed first: no program must stay beside a report that does not know it.
        """
        names = sorted(_files(self.staging))
        old = earlier - set(names)
        with _Uninterrupted():
            try:
                self._refuse_folders(names)
                for name in sorted(old):
                    self._remove(name)
                for name in names:
                    os.makedirs(os.path.dirname(self._target(name)), exist_ok=True)
                    os.replace(os.path.join(self.staging, *name.split("/")), self._target(name))
            except OSError as error:
                raise self._unwritable(error.filename or self.folder, error) from None
        return names

    def _target(self, name: str) -> str:
        return os.path.join(self.folder, *name.split("/"))

    def _refuse_folders(self, names: list[str]) -> None:
        for name in names:
            if os.path.isdir(self._target(name)):
                raise IsADirectoryError(21, "a folder stands where a file belongs", self._target(name))
            parent = os.path.dirname(self._target(name))
            while parent != self.folder:
                if os.path.lexists(parent) and not os.path.isdir(parent):
                    raise NotADirectoryError(20, "a file stands where a folder belongs", parent)
                parent = os.path.dirname(parent)

    def _unwritable(self, path: str, error: Exception) -> InputError:
        reason = getattr(error, "strerror", None) or str(error)
        message = f"outputs cannot be written here ({reason}); free it or choose another folder with -o"
        return InputError("UNWRITABLE", path, message)

    def _make_folder(self) -> None:
        missing = []
        path = self.folder
        while not os.path.lexists(path):
            missing.append(path)
            path = os.path.dirname(path)
        for path in reversed(missing):
            try:
                os.mkdir(path)
                self._made.append(path)
            except FileExistsError:
                if not os.path.isdir(path):  # else another row of the batch was quicker
                    raise

    def _remove_made(self) -> None:
        for path in reversed(self._made):
            try:
                os.rmdir(path)  # fails where something was published, which is what keeps it
            except OSError:
                return

    def _remove(self, name: str) -> None:
        path = self._target(name)
        if os.path.isfile(path) or os.path.islink(path):
            os.remove(path)
        parent = os.path.dirname(path)
        while parent != self.folder and os.path.isdir(parent) and not os.listdir(parent):
            os.rmdir(parent)
            parent = os.path.dirname(parent)


def earlier_programs(folder: str) -> set[str]:
    """Names of the controllers' texts in program/: listings, and programs and applications of ours with their parts."""
    here = os.path.join(folder, PROGRAMS)
    names = {file for file in _listed(here) if file.lower().endswith(PROGRAM_ENDINGS)}
    for main in _listed(here):
        stem, ending = os.path.splitext(main)
        if ending.lower() in PART_ENDINGS and _is_ours(os.path.join(here, main)):
            part = re.compile(re.escape(stem) + r"\d+" + re.escape(PART_ENDINGS[ending.lower()]), re.IGNORECASE)
            names |= {main, *(file for file in _listed(here) if part.fullmatch(file))}
    for application in _listed(here):
        if _is_ours(os.path.join(here, application, "start.pgx")):
            inside = _listed(os.path.join(here, application))
            parts = [part for part in inside if re.fullmatch(re.escape(application) + r"\d+", part)]
            for path in (application, *(f"{application}/{part}" for part in parts)):
                last = path.rpartition("/")[2]
                files = (f"{last}.pjx", f"{last}.dtx", "start.pgx", "stop.pgx")
                names |= {f"{path}/{file}" for file in files if os.path.isfile(os.path.join(here, path, file))}
    return {f"{PROGRAMS}/{name}" for name in names}


def _is_ours(path: str) -> bool:
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as stream:
            text = stream.read(_HEAD)
    except OSError:
        return False
    return all(remark in text for remark in OUR_REMARKS)


_HEAD = 4096  # characters of a program that hold the remarks it begins with


def earlier_outputs(folder: str) -> set[str]:
    """Names of the outputs of an earlier run: those its report tells of, and the controllers' texts in program/."""
    names = earlier_programs(folder)
    report = _earlier_report(folder)
    if report is None:
        return names
    told = [name for name in report["programs"] if isinstance(name, str) and name.startswith(PROGRAMS + "/")]
    return names | {name for name in told if ".." not in name.split("/")} | {
        WAYPOINTS, REPORT, PAGE, report["name"] + DOCUMENT_ENDING
    }


def _earlier_report(folder: str) -> dict[str, Any] | None:
    try:
        with open(os.path.join(folder, REPORT), encoding="utf-8") as stream:
            report = json.load(stream)
    except (OSError, ValueError):
        return None
    if not isinstance(report, dict) or not isinstance(report.get("programs"), list) or "issues" not in report:
        return None  # somebody else's
    return report if isinstance(report.get("name"), str) and os.sep not in report["name"] else None


def _listed(folder: str) -> list[str]:
    try:
        return os.listdir(folder)
    except OSError:
        return []


def _files(folder: str) -> Iterator[str]:
    for root, _, files in os.walk(folder):
        for file in files:
            yield os.path.relpath(os.path.join(root, file), folder).replace(os.sep, "/")


class _Uninterrupted:
    """Holds Ctrl-C back while files are moved, which takes milliseconds."""

    def __enter__(self) -> None:
        self._main = threading.current_thread() is threading.main_thread()
        if self._main:
            self._before = signal.signal(signal.SIGINT, signal.SIG_IGN)

    def __exit__(self, *_: object) -> None:
        if self._main:
            signal.signal(signal.SIGINT, self._before)
