# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files from outside, read in a process that may crash, with limits of time and memory.

FreeCAD and the geometry kernel crash on some damaged files, and on others read without end. Without a window the process is
a copy of this one, made by fork in milliseconds. A fork does not copy threads, though: beside a window, and after the
geometry kernel of FreeCAD 1.0 or later has started its threads, it is a process of `kernel_process`, which is started once,
and ended as soon as whoever waits for it is cancelled. What was read comes back as `answers` has it. Where there is neither,
files are read here.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import FreeCAD

from ...core import copies
from ...core.issues import InputError, Text, Word
from ..kernel import process as kernel_process
from . import answers

if sys.platform != "win32":
    import resource

T = TypeVar("T")

SECONDS, SECONDS_A_MB = 4.0, 10.0  # of the processor, for any file and for each MB of it
MEMORY, MEMORY_A_MB = 600.0, 100.0  # MB, likewise, beside what this process has
LARGEST = 2000  # MB of a file
LONGER = 10.0  # times as long on the clock: the processor may have others to serve, but a file that keeps us waiting ends
MB = 1e6
NO_MEMORY = 77  # exit status of a copy that has come to its limit

_is_apart = False  # whether this is such a process


def apart(
    read: Callable[..., T], path: str | os.PathLike[str], *rest: Any, patience: float = 1.0
) -> T:
    """What `read(path, *rest)` returns or raises: a shape, a mesh, what pickles. `read` is a function of a module. patience:
    times the limit of time.

    Raises InputError BAD_FILE, naming the file, where reading crashes or takes more time or memory than a file of its size
    may, and for one larger than LARGEST.
    """
    size = _size(path) / MB
    where = os.path.basename(os.fspath(path)) or os.fspath(path)
    if size > LARGEST:
        message = Text(
            "the file is larger than {} MB, the most that is read; is it the right one?", LARGEST
        )
        raise InputError("BAD_FILE", where, message)
    if _is_apart or not (FreeCAD.GuiUp or sys.platform.startswith("linux")):
        return read(path, *rest)
    limits = _limits(size, patience)
    if not (FreeCAD.GuiUp or _has_kernel_threads()):
        with _Reading(read, path, rest, *limits) as copy:
            ended, used = copy.wait()
            if ended:
                raise _refused(where, ended, used, *limits)
            found = answers.hear(*copy.files)
    else:
        with _answer_files() as files:
            question = (*files, read.__module__, read.__qualname__, path, rest, *limits)
            how = kernel_process.limited(answer, question, LONGER * limits[0])
            if how is None:  # there is no other process
                return read(path, *rest)
            if how[0]:
                raise _refused(where, *how, *limits)
            found = answers.hear(*files)
    return read(path, *rest) if isinstance(found, str) and found == answers.AGAIN else found


def _limits(size: float, patience: float) -> tuple[float, float]:
    """s of the processor and MB of memory that reading a file of so many MB may take."""
    return patience * (SECONDS + SECONDS_A_MB * size), patience**0.5 * (MEMORY + MEMORY_A_MB * size)


def _has_kernel_threads() -> bool:
    """Whether the geometry kernel may have started threads in this process.

    From FreeCAD 1.0 on it does so for booleans, for example. A forked copy that computes a shape then waits for threads
    which it does not have, without end.
    """
    return int(FreeCAD.Version()[0]) >= 1 and len(os.listdir("/proc/self/task")) > 1


@contextlib.contextmanager
def _answer_files() -> Iterator[tuple[str, str]]:
    """The paths of two files in a folder of their own."""
    with tempfile.TemporaryDirectory(prefix="reading_") as folder:
        yield os.path.join(folder, "told"), os.path.join(folder, "geometry")


def answer(
    answer_file: str,
    geometry: str,
    module: str,
    function: str,
    path: Any,
    rest: tuple[Any, ...],
    seconds: float,
    memory: float,
) -> None:
    """In a process of `kernel_process`: read within limits, and tell."""
    global _is_apart
    import importlib

    _is_apart = True
    read = getattr(importlib.import_module(module), function)
    if sys.platform == "win32":
        answers.tell(answer_file, geometry, read, path, rest)
        return
    copies.take_no_signals()
    spent = resource.getrusage(resource.RUSAGE_SELF)
    with contextlib.ExitStack() as before:
        limits = [
            (resource.RLIMIT_CPU, round(spent.ru_utime + spent.ru_stime + seconds)),
            (resource.RLIMIT_CORE, 0),
        ]
        if sys.platform.startswith("linux"):
            limits.append((resource.RLIMIT_AS, _pages(0) + round(memory * MB)))
        for kind, value in limits:
            soft, hard = resource.getrlimit(kind)
            before.callback(resource.setrlimit, kind, (soft, hard))
            resource.setrlimit(
                kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard)
            )
        answers.tell(answer_file, geometry, read, path, rest)


def _size(path: str | os.PathLike[str]) -> float:
    try:
        return float(os.stat(path).st_size)
    except (OSError, ValueError):
        return 0.0


class _Reading:
    """A copy of this process that reads a file within limits; nothing is left of it once this is closed."""

    def __init__(
        self,
        read: Callable[..., object],
        path: Any,
        rest: tuple[Any, ...],
        seconds: float,
        memory: float,
    ) -> None:
        self._before, self._longest, self._pid = _pages(1), LONGER * seconds, 0
        self._over, theirs = os.pipe()
        self._descriptors = [self._over, os.memfd_create("told"), os.memfd_create("geometry")]
        text, geometry = self._descriptors[1:]
        self.files = (
            f"/proc/self/fd/{text}",
            f"/proc/self/fd/{geometry}",
        )  # that this process and its copies have
        try:
            self._pid = copies.begun(
                lambda: _limited(seconds, memory, *self.files, read, path, rest)
            )
        except BaseException:
            self.close()
            raise
        finally:
            os.close(theirs)

    def __enter__(self) -> _Reading:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def wait(self) -> tuple[int, float]:
        """How it ended, as Popen tells it, and the memory, MB, that it used beside what this process has."""
        until = time.monotonic() + self._longest
        while (
            not (over := bool(select.select([self._over], [], [], 0.5)[0]))
            and time.monotonic() < until
        ):
            pass  # its end closes the pipe
        if not over:
            os.kill(self._pid, signal.SIGKILL)
        _, status, usage = os.wait4(self._pid, 0)
        self._pid = 0
        code = os.waitstatus_to_exitcode(status)
        return (code if over else -signal.SIGXCPU), max(
            0.0, (1024.0 * usage.ru_maxrss - self._before) / MB
        )

    def close(self) -> None:
        if self._pid:
            with contextlib.suppress(OSError):
                os.kill(self._pid, signal.SIGKILL)
                os.waitpid(self._pid, 0)
            self._pid = 0
        while self._descriptors:
            os.close(self._descriptors.pop())


def _limited(seconds: float, memory: float, *what: Any) -> None:
    """In the copy: read, and tell."""
    global _is_apart
    _is_apart = True
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_CPU, round(seconds))
    _limit(resource.RLIMIT_AS, _pages(0) + round(memory * MB))
    try:
        answers.tell(*what)
    except MemoryError:
        os._exit(NO_MEMORY)


def _pages(column: int) -> int:
    """Bytes of this process, all of them (0) or those in memory (1)."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[column]) * resource.getpagesize()


def _limit(kind: int, value: int) -> None:
    _, hard = resource.getrlimit(kind)
    resource.setrlimit(kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


def _refused(where: str, ended: int, used: float, seconds: float, memory: float) -> InputError:
    if ended == -signal.SIGXCPU:
        why = Text(
            "it takes more than {:.0f} s of the processor to read, the limit of a file of its size",
            seconds,
        )
    elif ended == NO_MEMORY or used > 0.8 * memory:
        why = Text(
            "it takes more than {:.0f} MB of memory to read, the limit of a file of its size",
            memory,
        )
    else:
        why = "FreeCAD crashes on it"
    return InputError("BAD_FILE", where, "it is damaged: {}; export it again", Word(why))
