# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files from outside, read in a process that may crash, with limits of time and memory.

FreeCAD and the geometry kernel crash on some damaged files, and on others read without end. Without
a window it is a fork of the current process, made in milliseconds. A fork does not copy threads,
though: in a process with a window, and after the geometry kernel of FreeCAD 1.0 or later has
started its threads, a process of `kernel_process` reads instead. It starts once and ends as soon as
its caller is cancelled. `answers` transfers the result. Without either, files are read in this
process.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
import select
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import FreeCAD
import Mesh
import Part

from ...core import copies
from ...core.issues import InputError, Text, Word
from ..kernel import process as kernel_process

AGAIN = "it is sound: read it again, here"  # IGES may give a zero the other sign in the binary form


class _Inexact(Exception):
    """A shape is not quite the same in the binary form."""


class _Pickler(pickle.Pickler):
    """Writes shapes and meshes to a file of their own."""

    def __init__(self, stream: Any, geometry: str) -> None:
        super().__init__(stream, protocol=pickle.HIGHEST_PROTOCOL)
        self.geometry = geometry

    def persistent_id(self, value: Any) -> str | None:
        if isinstance(value, Part.Shape):
            value.exportBinary(self.geometry)
            again = Part.Shape()
            again.importBinary(self.geometry)
            if again.exportBrepToString() != value.exportBrepToString():
                raise _Inexact
            return "shape"
        if isinstance(value, Mesh.Mesh):
            value.write(self.geometry, "BMS")
            return "mesh"
        return None


class _Unpickler(pickle.Unpickler):
    def __init__(self, stream: Any, geometry: str) -> None:
        super().__init__(stream)
        self.geometry = geometry

    def persistent_load(self, kind: str) -> Any:
        if kind == "shape":
            shape = Part.Shape()
            shape.importBinary(self.geometry)
            return shape
        mesh = Mesh.Mesh()
        with open(self.geometry, "rb") as stream:
            mesh.read(stream, "BMS")
        return mesh


def write_answer(
    answer_file: str,
    geometry: str,
    reader: Callable[..., Any],
    path: str | os.PathLike[str],
    arguments: tuple[Any, ...],
) -> None:
    """In the other process: run `reader` and write its result or InputError into the files."""
    try:
        answer: Any = (True, reader(path, *arguments))
    except InputError as error:
        answer = (False, (error.code, error.where, error.message))
    text = io.BytesIO()
    try:
        _Pickler(text, geometry).dump(answer)
    except _Inexact:
        text = io.BytesIO(pickle.dumps((True, AGAIN)))
    with open(answer_file, "wb") as stream:
        stream.write(text.getbuffer())


def read_answer(answer_file: str, geometry: str) -> Any:
    """Return the result of the other process; raises its InputError."""
    with open(answer_file, "rb") as stream:
        sound, answer = _Unpickler(stream, geometry).load()
    if sound:
        return answer
    raise InputError(*answer)


if sys.platform != "win32":
    import resource

T = TypeVar("T")

SECONDS, SECONDS_A_MB = 4.0, 10.0  # processor time, s, per file and per MB
SECONDS_TO_CUT = 20.0  # s more for a 3MF file, whose negative volumes are subtracted on reading
MEMORY, MEMORY_A_MB = 600.0, 100.0  # MB, likewise, in addition to the memory of the current process
MAX_FILE_MB = 2000  # MB of a file
WALL_CLOCK_FACTOR = 10.0  # wall-clock limit as a multiple of the processor time, as other processes share the processor
MB = 1e6
NO_MEMORY = 77  # exit status of a copy that has come to its limit

_is_apart = False  # whether this is such a process


def read_apart(
    reader: Callable[..., T], path: str | os.PathLike[str], *arguments: Any, patience: float = 1.0
) -> T:
    """What `reader(path, *arguments)` returns or raises: a shape, a mesh, or a picklable value.
    `reader` is a function of a module. patience: factor on the time limit.

    Raises InputError BAD_FILE, naming the file, where reading crashes or takes more time or memory than a file of its size
    may, and for one larger than LARGEST.
    """
    size = _size(path) / MB
    where = os.path.basename(os.fspath(path)) or os.fspath(path)
    if size > MAX_FILE_MB:
        message = Text(
            "the file is larger than {} MB, the maximum; check that it is the right one",
            MAX_FILE_MB,
        )
        raise InputError("BAD_FILE", where, message)
    if _is_apart or not (FreeCAD.GuiUp or sys.platform.startswith("linux")):
        return reader(path, *arguments)
    limits = _limits(where, size, patience)
    if not (FreeCAD.GuiUp or _has_kernel_threads()):
        with _Reading(reader, path, arguments, *limits) as copy:
            exit_code, used = copy.wait()
            if exit_code:
                raise _refused(where, exit_code, used, *limits)
            result = read_answer(*copy.files)
    else:
        with _answer_files() as files:
            question = (*files, reader.__module__, reader.__qualname__, path, arguments, *limits)
            how = kernel_process.limited(answer, question, WALL_CLOCK_FACTOR * limits[0])
            if how is None:  # there is no other process
                return reader(path, *arguments)
            if how[0]:
                raise _refused(where, *how, *limits)
            result = read_answer(*files)
    return reader(path, *arguments) if isinstance(result, str) and result == AGAIN else result


def _limits(name: str, size: float, patience: float) -> tuple[float, float]:
    """Limits of processor time, s, and memory, MB, for reading a file of `size` MB."""
    seconds = patience * (SECONDS + SECONDS_A_MB * size)
    if name.lower().endswith(".3mf"):
        seconds += SECONDS_TO_CUT
    return seconds, patience**0.5 * (MEMORY + MEMORY_A_MB * size)


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
    arguments: tuple[Any, ...],
    seconds: float,
    memory: float,
) -> None:
    """In a process of `kernel_process`: read within limits and write the answer."""
    global _is_apart
    import importlib

    _is_apart = True
    reader = getattr(importlib.import_module(module), function)
    if sys.platform == "win32":
        write_answer(answer_file, geometry, reader, path, arguments)
        return
    copies.take_no_signals()
    spent = resource.getrusage(resource.RUSAGE_SELF)
    with contextlib.ExitStack() as cleanup:
        limits = [
            (resource.RLIMIT_CPU, round(spent.ru_utime + spent.ru_stime + seconds)),
            (resource.RLIMIT_CORE, 0),
        ]
        if sys.platform.startswith("linux"):
            limits.append((resource.RLIMIT_AS, _pages(0) + round(memory * MB)))
        for kind, value in limits:
            soft, hard = resource.getrlimit(kind)
            cleanup.callback(resource.setrlimit, kind, (soft, hard))
            resource.setrlimit(
                kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard)
            )
        write_answer(answer_file, geometry, reader, path, arguments)


def _size(path: str | os.PathLike[str]) -> float:
    try:
        return float(os.stat(path).st_size)
    except (OSError, ValueError):
        return 0.0


class _Reading:
    """A fork of the current process that reads a file within limits; `close` removes it completely."""

    def __init__(
        self,
        reader: Callable[..., object],
        path: Any,
        arguments: tuple[Any, ...],
        seconds: float,
        memory: float,
    ) -> None:
        self._before, self._longest, self._pid = _pages(1), WALL_CLOCK_FACTOR * seconds, 0
        self._over, theirs = os.pipe()
        self._descriptors = [self._over, os.memfd_create("told"), os.memfd_create("geometry")]
        text, geometry = self._descriptors[1:]
        self.files = (
            f"/proc/self/fd/{text}",
            f"/proc/self/fd/{geometry}",
        )  # that this process and its copies have
        try:
            self._pid = copies.fork(
                lambda: _limited(seconds, memory, *self.files, reader, path, arguments)
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
        """The exit code as Popen gives it, and the memory, MB, used in addition to the current
        process's.
        """
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
    """In the fork: read, and write the answer."""
    global _is_apart
    _is_apart = True
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_CPU, round(seconds))
    _limit(resource.RLIMIT_AS, _pages(0) + round(memory * MB))
    try:
        write_answer(*what)
    except MemoryError:
        os._exit(NO_MEMORY)


def _pages(column: int) -> int:
    """Memory of the current process, bytes: total (0) or resident (1)."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[column]) * resource.getpagesize()


def _limit(kind: int, value: int) -> None:
    _, hard = resource.getrlimit(kind)
    resource.setrlimit(kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


def _refused(where: str, exit_code: int, used: float, seconds: float, memory: float) -> InputError:
    if exit_code == -signal.SIGXCPU:
        why = Text(
            "reading it takes more than {:.0f} s of processor time, the limit for a file of its "
            "size",
            seconds,
        )
    elif exit_code == NO_MEMORY or used > 0.8 * memory:
        why = Text(
            "reading it takes more than {:.0f} MB of memory, the limit for a file of its size",
            memory,
        )
    else:
        why = "FreeCAD crashes on it"
    return InputError("BAD_FILE", where, "it is damaged: {}; export it again", Word(why))
