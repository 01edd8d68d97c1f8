# SPDX-License-Identifier: LGPL-2.1-or-later
"""The hidden folder inside the folder of outputs in which a run collects its files before it moves
them out.

`.unfinished-*/` holds a mark, which its run keeps locked as long as it lives, the files, and, once
these are complete, a list of files to move and remove. The next run in the folder carries out the
list of a killed run and removes its remains. Nothing is written, moved or removed through a link.
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
except ImportError:  # Windows: runs do not know of one another there
    fcntl = None  # type: ignore[assignment]

PREFIX, MARK, FILES, NOTE = ".unfinished-", "run-of-freecad-am", "files", "to-publish.json"
WAIT = 10.0  # s for another run that is moving its files, which takes milliseconds
HELD_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")


class Linked(OSError):
    """A link in place of one of our folders."""


class Staging:
    """The hidden folder of the run. `others`: whether other runs are at work in the same folder of
    outputs.
    """

    def __init__(self, folder: str) -> None:
        """Make it. What runs that were killed have left is finished and removed first."""
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
        """Remove the old files and move those named into place."""
        with locked(self.folder):
            refuse(self.folder, [*names, *old])
            note = os.path.join(self.path, NOTE)
            with open(note + ".part", "w", encoding="utf-8") as stream:
                json.dump({"files": list(names), "old": list(old)}, stream)
            os.replace(note + ".part", note)
            _carry_out(self.folder, self.path, names, old)
            os.remove(note)

    def remove(self) -> None:
        """Remove it with all that is in it."""
        with uninterrupted():
            if self.path:
                _discard(self.path)
            with contextlib.suppress(OSError):
                os.close(self._mark)


def refuse(folder: str, names: Sequence[str]) -> None:
    """Raise OSError if files with the given names cannot be written or removed inside the folder:
    links, files where folders belong, folders where files belong, closed folders.
    """
    for name in names:
        target = os.path.join(folder, *name.split("/"))
        if os.path.isdir(target) and not os.path.islink(target):
            raise IsADirectoryError(21, "a folder takes the place of a file", target)
        parent = os.path.dirname(target)
        while len(parent) > len(folder):
            if os.path.islink(parent):
                raise Linked(20, "a link takes the place of an output folder", parent)
            if os.path.lexists(parent) and not os.path.isdir(parent):
                raise NotADirectoryError(20, "a file takes the place of a folder", parent)
            if os.path.isdir(parent) and not os.access(parent, os.W_OK | os.X_OK):
                raise PermissionError(13, "the folder is closed", parent)
            parent = os.path.dirname(parent)


def is_inside(name: Any) -> bool:
    """Whether this is the name of a file inside a folder, with slashes."""
    return (
        isinstance(name, str)
        and "\0" not in name
        and "\\" not in name
        and all(word not in ("", ".", "..") for word in name.split("/"))
    )


def clear(folder: str) -> None:
    """Finish and remove what killed runs have left in a folder of outputs."""
    with locked(folder), uninterrupted():
        _cleared(folder)


def _cleared(folder: str) -> bool:
    """Finish and remove what killed runs have left; whether others are at work."""
    has_others = False
    for entry in sorted(os.listdir(folder)):
        path = os.path.join(folder, entry)
        if not entry.startswith(PREFIX) or os.path.islink(path) or not os.path.isdir(path):
            continue
        try:
            mark = os.open(os.path.join(path, MARK), os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
        except OSError:
            with contextlib.suppress(OSError):  # killed before it had its mark, or not ours
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
    """Carry out what a killed run has noted."""
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
    """Remove a file, and folders that are empty without it."""
    path = os.path.join(folder, *name.split("/"))
    if os.path.isfile(path) or os.path.islink(path):
        os.remove(path)
    parent = os.path.dirname(path)
    while len(parent) > len(folder) and os.path.isdir(parent) and not os.listdir(parent):
        os.rmdir(parent)
        parent = os.path.dirname(parent)


def _discard(path: str) -> None:
    """Remove a hidden folder, its mark last: it identifies the folder as ours."""
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
    """While this lasts no other run makes or removes hidden folders, or moves files, in this folder."""
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
    """Whether the file is locked for this process now. File systems without locks let everybody in."""
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
    """Holds Ctrl-C and requests to end back while files are moved, which takes milliseconds."""
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
