# SPDX-License-Identifier: LGPL-2.1-or-later
"""Long calls of the geometry kernel, made in a process of their own where a window would have to wait for them.

Python's other threads, the window's included, are blocked while the kernel makes the triangles of a
shape, and nothing can end such a call. So worker threads of a window use a separate process; the
main thread, which blocks no other thread, calls the kernel directly. Both come to the same numbers,
bit by bit: shapes travel in the kernel's own binary form.

Protocol: pickles both ways. First the module search path is sent, and the version of FreeCAD comes back. Then
(module, function, file of the shape or '', further arguments) gives (True, value) or (False, error).
"""

from __future__ import annotations

import contextlib
import math
import os
import pickle
import queue
import signal
import subprocess
import sys
import tempfile
import threading
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import FreeCAD
import Part

from ...core.one_thread import ENVIRONMENT

T = TypeVar("T")

HOST = Path(__file__).with_name("host.py")
LOOK_EVERY = 0.05  # s; how soon a thread that waits is ended
FAILED = 1  # of one that ends of itself, but not as it should
ENDED_BY_LIMIT = -24  # of SIGXCPU
ENDED_BY_SYSTEM = -9  # Popen's code for SIGKILL, which Linux sends when memory runs out
START = 60.0  # s that a process may take to be there
ANALYTIC_SURFACES = ("Part::GeomPlane", "Part::GeomCylinder", "Part::GeomCone")
MAX_FACES = 24  # shapes of up to this many such faces are meshed faster than sent

_idle: list[_Process] = []
_readers: list[_Process] = []  # processes that have read files from outside
_unable = False


def in_kernel_process(function: Callable[..., T], shape: Any, *arguments: Any) -> T:
    """What `function(shape, *arguments)` returns or raises; it must be a function of a module, and
    return no shapes.

    Raises RuntimeError where the kernel crashes on the shape, MemoryError where the system ends it for lack of memory.
    """
    if _unable or threading.current_thread() is threading.main_thread() or _is_quick(shape):
        return function(shape, *arguments)
    with _shape_file(shape) as path:
        for _ in range(2):
            process = _free(_idle) or _start_process()
            if process is None:
                return function(shape, *arguments)
            try:
                process.ask((function.__module__, function.__qualname__, path, arguments))
                sound, answer = process.answer()
            except _Left:  # it had nothing to do for long
                process.end()
                continue
            except BaseException:  # its answer would have no receiver
                process.end()
                raise
            if _idle:
                process.end()
            else:
                _idle.append(process)
            if sound:
                result: T = answer
                return result
            raise answer
    return function(shape, *arguments)


def limited(
    function: Callable[..., None], arguments: tuple[Any, ...], longest: float
) -> tuple[int, float] | None:
    """The exit code, as Popen gives it, of the process in which `function(*arguments)` ran within
    its own limits (0 for success), and the memory, MB, that it took. None if no process can be
    started.

    longest: wall-clock limit, s, after which the process is ended, as at the limit of processor
    time.
    """
    while True:
        used = _free(_readers)
        process = used or _start_process()
        if process is None:
            return None
        try:
            process.ask((function.__module__, function.__qualname__, "", arguments))
            sound, answer = process.answer(longest)
        except _Left:
            process.end()
            if used is None:
                return FAILED, process.most
            continue  # it had nothing to do for long
        except queue.Empty:
            process.end()
            return ENDED_BY_LIMIT, process.most
        except (_Crashed, MemoryError):
            return process.popen.wait(), process.most
        except BaseException:  # who asked is cancelled
            process.end()
            raise
        if isinstance(answer, MemoryError):
            process.end()
            return ENDED_BY_SYSTEM, math.inf
        _readers.append(process)
        return 0 if sound else FAILED, process.most


def _free(idle: list[_Process]) -> _Process | None:
    """An idle process, or None."""
    try:
        return idle.pop()
    except IndexError:  # asked beforehand, another thread might take the last one in between
        return None


def _is_quick(shape: Any) -> bool:
    faces = shape.Faces
    return len(faces) <= MAX_FACES and all(
        face.Surface.TypeId in ANALYTIC_SURFACES for face in faces
    )


@contextlib.contextmanager
def _shape_file(shape: Any) -> Iterator[str]:
    """The path of a temporary file of the shape."""
    handle, path = tempfile.mkstemp(suffix=".bin", prefix="shape_")
    os.close(handle)
    try:
        shape.exportBinary(path)
        yield path
    finally:
        with contextlib.suppress(OSError):
            os.remove(path)


class _Crashed(RuntimeError):
    """The process has gone while it was at work."""


class _Left(Exception):
    """The process has gone while it was idle."""


class _Process:
    """A Python that runs `kernel.host`; another thread listens to it, so that a waiting caller can
    be ended at any moment.

    It ends at the latest when the last reference is gone: a thread that is ended may lose it
    between any two steps.
    """

    def __init__(self, python: str) -> None:
        self.popen: Any = subprocess.Popen(
            [python, str(HOST)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, **ENVIRONMENT},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self.kill = weakref.finalize(self, _kill, self.popen)
        self.answers: queue.Queue[Any] = queue.Queue()
        self.most = 0.0  # MB that the last question took, as far as it was seen
        threading.Thread(
            target=_listen,
            args=(self.popen.stdout, self.answers),
            name="Kernel process",
            daemon=True,
        ).start()

    def ask(self, question: Any) -> None:
        """Send a question. Raises _Left if the process is gone."""
        data = memoryview(pickle.dumps(question, protocol=pickle.HIGHEST_PROTOCOL))
        try:
            with _block_sigpipe():
                while data:  # past Python's buffer, which would be written at exit too, after the receiver is gone
                    data = data[os.write(self.popen.stdin.fileno(), data) :]
        except OSError:
            raise _Left from None

    def answer(self, longest: float = float("inf")) -> Any:
        """Wait for its answer. Raises _Left where it went before it was asked, RuntimeError where it crashed, MemoryError
        where the system ended it; queue.Empty after `longest` s."""
        waited, start_memory, self.most = 0.0, _memory_of(self.popen.pid), 0.0
        while waited < longest:
            try:
                answer = self.answers.get(timeout=LOOK_EVERY)
            except queue.Empty:
                waited += LOOK_EVERY
                self.most = max(self.most, _memory_of(self.popen.pid) - start_memory)
                continue
            if answer is not None:
                return answer[0]
            code = self.popen.wait()
            if code == 0:
                raise _Left
            if code == ENDED_BY_SYSTEM:
                raise MemoryError
            raise _Crashed("it crashed")
        raise queue.Empty

    def end(self) -> None:
        """End the process even while it works."""
        self.kill()
        for stream in (self.popen.stdin, self.popen.stdout):
            with contextlib.suppress(OSError, ValueError):
                stream.close()


@contextlib.contextmanager
def _block_sigpipe() -> Iterator[None]:
    """Block SIGPIPE in this thread, so that writing to a process that has gone raises an OSError
    and nothing else.

    Python ignores the signal that comes with it. FreeCAD 1.0 and later start Python without its handlers: there it ends
    FreeCAD, with all documents. It comes to the thread that writes, so it is held back in that one and taken away.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows knows no such signal
        yield
        return
    old_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    try:
        yield
    finally:
        if signal.SIGPIPE not in old_mask:
            if signal.SIGPIPE in signal.sigpending():
                signal.sigwait({signal.SIGPIPE})
            signal.pthread_sigmask(signal.SIG_SETMASK, old_mask)


def _memory_of(pid: int) -> float:
    """Memory of a process, MB, or 0 if unknown."""
    try:
        with open(f"/proc/{pid}/statm", encoding="ascii") as stream:
            return int(stream.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6
    except (OSError, ValueError, IndexError):
        return 0.0


def _kill(popen: Any) -> None:
    with contextlib.suppress(OSError):
        popen.kill()
    popen.wait()


def _listen(stream: Any, answers: queue.Queue[Any]) -> None:
    try:
        while True:
            answers.put((pickle.load(stream),))
    except Exception:  # it has ended, in the midst of an answer or between two
        answers.put(None)


def _start_process() -> _Process | None:
    """A process that is ready for questions, or None if none can be started; a failure is not tried
    again.
    """
    global _unable
    for python in _pythons():
        process = None
        try:
            process = _Process(python)
            process.ask(_search_path())
            if process.answer(START) == tuple(FreeCAD.Version()[:3]):
                started, process = process, None
                return started
        except (OSError, _Left, RuntimeError, queue.Empty):
            continue
        finally:  # also where the thread is being ended
            if process is not None:
                process.end()
    _unable = True
    return None


def _pythons() -> list[str]:
    """Paths that may be a plain Python of the current version, as FreeCAD's own program is not one."""
    version = "{}.{}".format(*sys.version_info)
    home = FreeCAD.getHomePath()
    candidates = [sys.executable or ""]
    for folder in dict.fromkeys((sys.prefix, sys.base_prefix, home)):
        candidates += [
            os.path.join(folder, "bin", name)
            for name in (f"python{version}", "python3", "python.exe", "python")
        ]
        candidates.append(os.path.join(folder, "python.exe"))
    named = (path for path in candidates if os.path.basename(path).lower().startswith("python"))
    return list(
        dict.fromkeys(path for path in named if os.access(path, os.X_OK) and os.path.isfile(path))
    )


def _search_path() -> list[str]:
    """Where the modules that this FreeCAD has loaded, and ours, are found."""
    home = FreeCAD.getHomePath()
    part_folder = os.path.dirname(os.path.abspath(Part.__file__))
    return [
        *sys.path,
        str(HOST.parents[3]),
        part_folder,
        *(os.path.join(home, name) for name in ("lib", "bin")),
    ]
