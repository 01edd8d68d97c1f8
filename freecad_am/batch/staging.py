# SPDX-License-Identifier: LGPL-2.1-or-later
"""Hidden staging folder in the output folder, in which a run collects its files.

`.unfinished-*/` contains a mark file, which the run keeps locked while it is alive, and the files.
When the files are complete, it also contains a list of files to move and remove. The next run in
the folder executes the list of a killed run and removes its remains. Nothing is written, moved or
removed through a link.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from typing import Any

try:
    import fcntl
except ImportError:  # Windows: runs cannot detect each other
    fcntl = None  # type: ignore[assignment]

PREFIX, MARK, FILES, NOTE = ".unfinished-", "run-of-freecad-am", "files", "to-publish.json"
WAIT = 10.0  # s; timeout for another run to move its files, which takes milliseconds
HELD_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")


class Linked(OSError):
    """A link exists where a folder of the run is expected."""


class Staging:
    """Staging folder of a run. others: whether other runs use the same output folder."""

    def __init__(self, folder: str) -> None:
        """Make the staging folder, after finishing and removing the remains of killed runs."""
        self.folder, self.path, self._mark = folder, "", -1
        try:
            with locked(folder), uninterrupted():
                self.others = _cleared(folder)
                self.path = tempfile.mkdtemp(prefix=PREFIX, dir=folder)
                self._mark = os.open(
                    os.path.join(self.path, MARK), os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600
                )
                _lock(self._mark)
                self.files = os.path.join(self.path, FILES)
                os.mkdir(self.files)
        except BaseException:
            self.remove()
            raise

    def publish(self, names: Sequence[str], old: Sequence[str]) -> None:
        """Remove the files `old` and move the files `names` into place."""
        with locked(self.folder):
            refuse(self.folder, [*names, *old])
            note = os.path.join(self.path, NOTE)
            with open(note + ".part", "w", encoding="utf-8") as stream:
                json.dump({"files": list(names), "old": list(old)}, stream)
            os.replace(note + ".part", note)
            _carry_out(self.folder, self.path, names, old)
            os.remove(note)

    def remove(self) -> None:
        """Remove the staging folder with its content."""
        with uninterrupted():
            if self.path:
                _discard(self.path)
            with contextlib.suppress(OSError):
                os.close(self._mark)


def refuse(folder: str, names: Sequence[str]) -> None:
    """Raise OSError if files with the given names cannot be written or removed in the folder.

    The reasons are links, files in place of folders, folders in place of files, and missing
    permissions.
    """
    for name in names:
        target = os.path.join(folder, *name.split("/"))
        if os.path.isdir(target) and not os.path.islink(target):
            raise IsADirectoryError(21, "a folder has the name of an output file", target)
        parent = os.path.dirname(target)
        while len(parent) > len(folder):
            if os.path.islink(parent):
                raise Linked(20, "a link has the name of an output folder", parent)
            if os.path.lexists(parent) and not os.path.isdir(parent):
                raise NotADirectoryError(20, "a file has the name of an output folder", parent)
            if os.path.isdir(parent) and not os.access(parent, os.W_OK | os.X_OK):
                raise PermissionError(13, "the folder is closed", parent)
            parent = os.path.dirname(parent)


def is_inside(name: Any) -> bool:
    """Whether a name with slashes is a valid path inside a folder."""
    return (
        isinstance(name, str)
        and "\0" not in name
        and "\\" not in name
        and all(word not in ("", ".", "..") for word in name.split("/"))
    )


def clear(folder: str) -> None:
    """Finish and remove the remains of killed runs in an output folder."""
    with locked(folder), uninterrupted():
        _cleared(folder)


def _cleared(folder: str) -> bool:
    """Finish and remove the remains of killed runs; return whether other runs are active."""
    has_others = False
    for entry in sorted(os.listdir(folder)):
        path = os.path.join(folder, entry)
        if not entry.startswith(PREFIX) or os.path.islink(path) or not os.path.isdir(path):
            continue
        try:
            mark = os.open(os.path.join(path, MARK), os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
        except OSError:
            with contextlib.suppress(
                OSError
            ):  # killed before making its mark, or not a staging folder
                os.rmdir(path)
            continue
        try:
            if not _lock(mark):
                has_others = True
                continue
            _finish(folder, path)
            _discard(path)
        finally:
            os.close(mark)
    return has_others


def _finish(folder: str, path: str) -> None:
    """Execute the list of a killed run."""
    try:
        with open(os.path.join(path, NOTE), encoding="utf-8") as stream:
            note = json.load(stream)
        names, old = note["files"], note["old"]
        if not all(map(is_inside, [*names, *old])):
            return
        refuse(folder, [*names, *old])
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return
    remaining = [
        name for name in names if os.path.isfile(os.path.join(path, FILES, *name.split("/")))
    ]
    _carry_out(folder, path, remaining, old)


def _carry_out(folder: str, path: str, names: Sequence[str], old: Sequence[str]) -> None:
    for name in old:
        _remove(folder, name)
    for name in names:
        target = os.path.join(folder, *name.split("/"))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.replace(os.path.join(path, FILES, *name.split("/")), target)


def _remove(folder: str, name: str) -> None:
    """Remove a file, and parent folders that become empty."""
    path = os.path.join(folder, *name.split("/"))
    if os.path.isfile(path) or os.path.islink(path):
        os.remove(path)
    parent = os.path.dirname(path)
    while len(parent) > len(folder) and os.path.isdir(parent) and not os.listdir(parent):
        os.rmdir(parent)
        parent = os.path.dirname(parent)


def _discard(path: str) -> None:
    """Remove a staging folder, the mark last, because the mark identifies the folder."""
    with contextlib.suppress(OSError):
        for entry in os.listdir(path):
            if entry != MARK:
                inside = os.path.join(path, entry)
                if os.path.isdir(inside) and not os.path.islink(inside):
                    shutil.rmtree(inside, ignore_errors=True)
                else:
                    os.remove(inside)
        os.remove(os.path.join(path, MARK))
        os.rmdir(path)


@contextlib.contextmanager
def locked(folder: str) -> Iterator[None]:
    """Within the context, no other run changes staging folders or moves files in `folder`."""
    if fcntl is None:
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        until = time.monotonic() + WAIT
        while not _lock(descriptor):
            if time.monotonic() > until:
                raise BlockingIOError(11, "another run holds the folder", folder)
            time.sleep(0.01)
        yield
    finally:
        os.close(descriptor)


def _lock(descriptor: int) -> bool:
    """Lock a file; return whether the lock succeeded. Without lock support, every lock succeeds."""
    if fcntl is None:
        return True
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Within the context, delay termination signals, for file moves that take milliseconds."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in HELD_SIGNALS if hasattr(signal, name)]
    came: list[int] = []
    old_handlers = {
        number: signal.signal(number, lambda number, _: came.append(number)) for number in numbers
    }
    try:
        yield
    finally:
        for number, handler in old_handlers.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
        for number in dict.fromkeys(came):
            os.kill(os.getpid(), number)
