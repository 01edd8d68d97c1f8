# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files from outside, read in a copy of this process that may crash, with limits of time and memory.

FreeCAD and the geometry kernel crash on some damaged files, and on others read without end. The copy is made by fork, which
takes milliseconds, and hands over what it has read in memory: shapes in the kernel's own binary form, where that gives them
back to the last digit; else they are read once more, here. Where there is no fork, and beside a window, whose threads it
would not copy, files are read here alone.
"""

from __future__ import annotations

import contextlib
import io
import os
import pickle
import resource
import select
import signal
import sys
import time
from collections.abc import Callable
from typing import Any, TypeVar

import FreeCAD
import Mesh
import Part

from ..core.issues import InputError

T = TypeVar("T")

SECONDS, SECONDS_A_MB = 4.0, 10.0  # of the processor, for any file and for each MB of it
MEMORY, MEMORY_A_MB = 600.0, 100.0  # MB, likewise, beside what this process has
LONGER = 10.0  # times as long on the clock: the processor may have others to serve, but a file that keeps us waiting ends
MB = 1e6


def apart(read: Callable[..., T], path: str | os.PathLike[str], *rest: Any, patience: float = 1.0) -> T:
    """What `read(path, *rest)` returns or raises: a shape, a mesh, what pickles. patience: times the limit of time.

    Raises InputError BAD_FILE, naming the file, where reading crashes or takes more time or memory than a file of its size
    may.
    """
    if FreeCAD.GuiUp or not sys.platform.startswith("linux"):
        return read(path, *rest)
    size = _size(path) / MB
    seconds, memory = patience * (SECONDS + SECONDS_A_MB * size), patience**0.5 * (MEMORY + MEMORY_A_MB * size)
    where = os.path.basename(os.fspath(path)) or os.fspath(path)
    told, geometry = os.memfd_create("told"), os.memfd_create("geometry")
    try:
        ended, used = _forked(lambda: _tell(told, geometry, read, path, rest), seconds, memory)
        if ended == 0:
            found = _heard(told, geometry)
            return read(path, *rest) if isinstance(found, str) and found == _AGAIN else found
        raise _refused(where, ended, used, seconds, memory)
    finally:
        os.close(told)
        os.close(geometry)


def _size(path: str | os.PathLike[str]) -> float:
    try:
        return float(os.stat(path).st_size)
    except (OSError, ValueError):
        return 0.0


def _forked(work: Callable[[], None], seconds: float, memory: float) -> tuple[int, float]:
    """How a copy of this process ended that does the work within limits, as Popen tells it, and the memory, MB, that it used
    beside what this process has."""
    ours, theirs = os.pipe()
    before = _pages(1)
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if not pid:
        _work(work, seconds, memory)
    os.close(theirs)
    ended = False
    try:
        until = time.monotonic() + LONGER * seconds
        while not ended and time.monotonic() < until:
            ended = bool(select.select([ours], [], [], 0.5)[0])  # the end of the copy closes it
    finally:
        os.close(ours)
        if not ended:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        _, status, usage = os.wait4(pid, 0)
    code = os.waitstatus_to_exitcode(status)
    return (code if ended else -signal.SIGXCPU), max(0.0, (1024.0 * usage.ru_maxrss - before) / MB)


def _work(work: Callable[[], None], seconds: float, memory: float) -> None:
    """In the copy: do the work and end."""
    status = 1
    try:
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGXCPU):
            signal.signal(number, signal.SIG_DFL)
        _end_with_parent()
        now = _pages(0)
        _limit(resource.RLIMIT_CORE, 0)
        _limit(resource.RLIMIT_CPU, round(seconds))
        _limit(resource.RLIMIT_AS, now + round(memory * MB))
        work()
        status = 0
    except MemoryError:
        status = NO_MEMORY
    except BaseException:
        status = 1
    finally:
        os._exit(status)


NO_MEMORY = 77  # exit status of a copy that has come to its limit


def _pages(column: int) -> int:
    """Bytes of this process, all of them (0) or those in memory (1)."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[column]) * resource.getpagesize()


def _limit(kind: int, value: int) -> None:
    _, hard = resource.getrlimit(kind)
    resource.setrlimit(kind, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


def _end_with_parent() -> None:
    import ctypes

    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


class _Inexact(Exception):
    """A shape is not quite the same in the binary form: IGES may give a zero the other sign."""


class _Pickler(pickle.Pickler):
    """Writes shapes and meshes to a file of their own."""

    def __init__(self, stream: Any, geometry: int) -> None:
        super().__init__(stream, protocol=pickle.HIGHEST_PROTOCOL)
        self.geometry = geometry

    def persistent_id(self, value: Any) -> str | None:
        if isinstance(value, Part.Shape):
            path = f"/proc/self/fd/{self.geometry}"
            value.exportBinary(path)
            again = Part.Shape()
            again.importBinary(path)
            if again.exportBrepToString() != value.exportBrepToString():
                raise _Inexact
            return "shape"
        if isinstance(value, Mesh.Mesh):
            value.write(f"/proc/self/fd/{self.geometry}", "BMS")
            return "mesh"
        return None


class _Unpickler(pickle.Unpickler):
    def __init__(self, stream: Any, geometry: int) -> None:
        super().__init__(stream)
        self.geometry = geometry

    def persistent_load(self, kind: str) -> Any:
        if kind == "shape":
            shape = Part.Shape()
            shape.importBinary(f"/proc/self/fd/{self.geometry}")
            return shape
        mesh = Mesh.Mesh()
        with open(f"/proc/self/fd/{self.geometry}", "rb") as stream:
            mesh.read(stream, "BMS")
        return mesh


_AGAIN = "it is sound: read it again, here"


def _tell(told: int, geometry: int, read: Callable[..., Any], path: Any, rest: tuple[Any, ...]) -> None:
    """In the copy: read and hand over."""
    try:
        answer: Any = (True, read(path, *rest))
    except InputError as error:
        answer = (False, (error.code, error.where, error.message))
    text = io.BytesIO()
    try:
        _Pickler(text, geometry).dump(answer)
    except _Inexact:
        text = io.BytesIO(pickle.dumps((True, _AGAIN)))
    data = text.getbuffer()
    while data:
        data = data[os.write(told, data):]


def _heard(told: int, geometry: int) -> Any:
    """What the copy has told; raises its InputError."""
    os.lseek(told, 0, os.SEEK_SET)
    with open(told, "rb", closefd=False) as stream:
        sound, answer = _Unpickler(stream, geometry).load()
    if sound:
        return answer
    raise InputError(*answer)


def _refused(where: str, ended: int, used: float, seconds: float, memory: float) -> InputError:
    if ended == -signal.SIGXCPU:
        why = f"it takes more than {seconds:.0f} s of the processor to read, the limit of a file of its size"
    elif ended == NO_MEMORY or used > 0.8 * memory:
        why = f"it takes more than {memory:.0f} MB of memory to read, the limit of a file of its size"
    else:
        why = "FreeCAD crashes on it"
    return InputError("BAD_FILE", where, f"it is damaged: {why}; export it again")
