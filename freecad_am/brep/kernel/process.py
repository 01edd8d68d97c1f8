# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sandboxed workers: Pythons with a FreeCAD of their own that may crash, hang or be ended.

They serve two purposes. `in_kernel_process` makes long calls of the geometry kernel: while the
kernel triangulates a shape, all other threads of Python wait, the window included, and nothing can
end the call. `run_limited` reads files from outside within limits of time and memory. The numbers
are the same, bit by bit, as in this process.

Protocol: pickles in both directions. First the worker receives the module search path and returns
the version of FreeCAD. Then each question is (module, function, folder, arguments, limits); folder
and arguments are those of `transfer.dump_value`. The answer is (True, value) or (False, error).
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
from typing import Any, NamedTuple, TypeVar

import FreeCAD
import Part

from ...core.one_thread import ENVIRONMENT
from . import transfer

T = TypeVar("T")

HOST = Path(__file__).with_name("host.py")
SANDBOXED = "FREECAD_AM_SANDBOXED"  # environment variable that marks a worker
POLL_S = 0.05  # s between checks whether the waiting thread is ended
FAILED = 1  # status of a worker that ended by itself without an answer
ENDED_BY_LIMIT = -24  # status by SIGXCPU, at the limit of processor time
ENDED_BY_SYSTEM = -9  # status by SIGKILL, which Linux sends when memory runs out
START_TIMEOUT_S = 60.0
ANALYTIC_SURFACES = ("Part::GeomPlane", "Part::GeomCylinder", "Part::GeomCone")
MAX_FACES = 24  # shapes with at most this many such faces are meshed faster than sent


class Outcome(NamedTuple):
    """How a worker ended a call. status: as Popen gives it, 0 for an answer. memory: MB that the
    call took. sound, value: the answer of the worker.
    """

    status: int
    memory: float
    sound: bool = False
    value: Any = None


def in_sandbox() -> bool:
    """Return whether this process is a sandboxed worker."""
    return SANDBOXED in os.environ


def in_kernel_process(function: Callable[..., T], shape: Any, *arguments: Any) -> T:
    """Return what `function(shape, *arguments)` returns, or raise what it raises.

    A worker runs the call unless this is the main thread, which blocks no other one, or the shape
    is meshed quickly. `function` belongs to a module. Raises RuntimeError if the kernel crashes on
    the shape, MemoryError if the system ends the worker for lack of memory.
    """
    is_main = threading.current_thread() is threading.main_thread()
    if is_main or kernel_workers.unable or _is_quick(shape):
        return function(shape, *arguments)
    with tempfile.TemporaryDirectory(prefix="shape_") as folder:
        outcome = kernel_workers.run(function, (shape, *arguments), folder)
        if outcome is None:
            return function(shape, *arguments)
        if outcome.status == ENDED_BY_SYSTEM:
            raise MemoryError
        if outcome.status:
            raise RuntimeError("the kernel crashed")
        if not outcome.sound:
            raise outcome.value
        result: T = transfer.load_value(outcome.value, folder)
        return result


def run_limited(
    function: Callable[..., Any],
    arguments: tuple[Any, ...],
    folder: str,
    limits: tuple[float, float],
    timeout: float,
) -> Outcome | None:
    """Return how a worker ended `function(*arguments)`, or None if no worker can be started.

    folder: where shapes of arguments and answer are stored. limits: processor time, s, and memory,
    MB. timeout: wall-clock limit, s, which counts as the limit of processor time.
    """
    return file_workers.run(function, arguments, folder, limits, timeout)


def _is_quick(shape: Any) -> bool:
    faces = shape.Faces
    return len(faces) <= MAX_FACES and all(
        face.Surface.TypeId in ANALYTIC_SURFACES for face in faces
    )


class WorkerPool:
    """Workers that wait for their next call. unable: whether no worker could be started.

    In a fork they belong to the parent.
    """

    def __init__(self) -> None:
        self.idle: list[Worker] = []
        self.unable = False
        self._of_parent: list[Worker] = []
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._forget)

    def run(
        self,
        function: Callable[..., Any],
        arguments: tuple[Any, ...],
        folder: str,
        limits: tuple[float, float] | None = None,
        timeout: float = math.inf,
    ) -> Outcome | None:
        """See `run_limited`."""
        data = transfer.dump_value(arguments, folder)
        question = (function.__module__, function.__qualname__, folder, data, limits)
        while True:
            worker = self._idle_worker()
            is_new = worker is None
            if worker is None and not self.unable:
                worker = self._start_worker()
            if worker is None:
                return None
            try:
                worker.ask(question)
                outcome = worker.outcome(timeout)
            except WorkerLeft:
                worker.end()
                if is_new:
                    return Outcome(FAILED, worker.memory)
                continue  # an idle worker has ended
            except BaseException:  # nobody waits for the answer
                worker.end()
                raise
            if outcome.status or self.idle:
                worker.end()
            else:
                self.idle.append(worker)
            return outcome

    def end(self) -> None:
        """End all idle workers."""
        while (worker := self._idle_worker()) is not None:
            worker.end()

    def _idle_worker(self) -> Worker | None:
        try:
            return self.idle.pop()
        except IndexError:  # another thread may take the last worker at any moment
            return None

    def _start_worker(self) -> Worker | None:
        """Return a worker that is ready for questions, or None if none starts."""
        for python in _pythons():
            worker = None
            try:
                worker = Worker(python)
                worker.ask(_search_path())
                if worker.answer(START_TIMEOUT_S) == tuple(FreeCAD.Version()[:3]):
                    started, worker = worker, None
                    return started
            except (OSError, WorkerLeft, WorkerEnded, queue.Empty):
                continue
            finally:  # also if the thread is being ended
                if worker is not None:
                    worker.end()
        self.unable = True
        return None

    def _forget(self) -> None:
        """In a fork: leave the workers to the parent."""
        while (worker := self._idle_worker()) is not None:
            worker.leave_to_parent()
            self._of_parent.append(worker)


class WorkerEnded(RuntimeError):
    """The worker ended during a call, with a status as Popen gives it."""

    def __init__(self, status: int) -> None:
        super().__init__(status)
        self.status = status


class WorkerLeft(Exception):
    """The worker had ended before the call."""


class Worker:
    """A Python that runs `host`. A thread reads its answers, so that a waiting caller can be ended
    at any moment.

    The process ends at the latest with the last reference to this object: a thread that is ended
    may lose its reference between any two steps.
    """

    def __init__(self, python: str) -> None:
        self.popen: Any = subprocess.Popen(
            [python, str(HOST)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, **ENVIRONMENT, SANDBOXED: "1"},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self.kill = weakref.finalize(self, _kill, self.popen)
        self.answers: queue.Queue[Any] = queue.Queue()
        self.memory = 0.0  # MB that the last call took, as far as it was seen
        threading.Thread(
            target=_listen,
            args=(self.popen.stdout, self.answers),
            name="Kernel process",
            daemon=True,
        ).start()

    def ask(self, question: Any) -> None:
        """Send a question. Raises WorkerLeft if the worker is gone."""
        data = memoryview(pickle.dumps(question, protocol=pickle.HIGHEST_PROTOCOL))
        try:
            with _block_sigpipe():
                while data:  # without Python's buffer, which would be written at exit too
                    data = data[os.write(self.popen.stdin.fileno(), data) :]
        except OSError:
            raise WorkerLeft from None

    def answer(self, timeout: float = math.inf) -> Any:
        """Return the answer to the question.

        Raises WorkerLeft if the worker had ended before, WorkerEnded if it ends during the call,
        queue.Empty after `timeout` s.
        """
        waited, start_memory, self.memory = 0.0, _memory_of(self.popen.pid), 0.0
        while waited < timeout:
            try:
                answer = self.answers.get(timeout=POLL_S)
            except queue.Empty:
                waited += POLL_S
                self.memory = max(self.memory, _memory_of(self.popen.pid) - start_memory)
                continue
            if answer is not None:
                return answer[0]
            status = self.popen.wait()
            if status == 0:
                raise WorkerLeft
            raise WorkerEnded(status)
        raise queue.Empty

    def outcome(self, timeout: float) -> Outcome:
        """Return how the call ends. Raises WorkerLeft if the worker had ended before."""
        try:
            sound, value = self.answer(timeout)
        except queue.Empty:
            return Outcome(ENDED_BY_LIMIT, self.memory)
        except WorkerEnded as end:
            return Outcome(end.status, self.memory)
        if isinstance(value, MemoryError):
            return Outcome(ENDED_BY_SYSTEM, math.inf)
        return Outcome(0, self.memory, sound, value)

    def end(self) -> None:
        """Kill the process, even while it is working."""
        self.kill()
        for stream in (self.popen.stdin, self.popen.stdout):
            with contextlib.suppress(OSError, ValueError):
                stream.close()

    def leave_to_parent(self) -> None:
        """In a fork: detach from the process, which ends with the parent.

        Its answers stay open: a lock that the listening thread holds in the parent guards them.
        """
        self.kill.detach()
        self.popen.stdin.close()


kernel_workers = WorkerPool()
file_workers = WorkerPool()  # workers that read damaged files triangulate nothing


@contextlib.contextmanager
def _block_sigpipe() -> Iterator[None]:
    """Block SIGPIPE in this thread, so that writing to a process that is gone raises only an
    OSError.

    Plain Python ignores the signal. FreeCAD 1.0 and later start Python without its signal handlers,
    where the signal would end FreeCAD and all documents. The signal goes to the thread that writes,
    so this thread holds it back and removes it.
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows has no such signal
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
    """Return the memory of a process, MB, or 0 if unknown."""
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
    except Exception:  # the process has ended, during an answer or between answers
        answers.put(None)


def _pythons() -> list[str]:
    """Return paths of possible plain Pythons of this version; FreeCAD's own program is not one."""
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
    """Return the folders of the modules of this FreeCAD and of this package."""
    home = FreeCAD.getHomePath()
    part_folder = os.path.dirname(os.path.abspath(Part.__file__))
    return [
        *sys.path,
        str(HOST.parents[3]),
        part_folder,
        *(os.path.join(home, name) for name in ("lib", "bin")),
    ]
