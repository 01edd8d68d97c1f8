# SPDX-License-Identifier: LGPL-2.1-or-later
"""Copies of this process, made by fork in milliseconds where the system has it."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import sys
import weakref
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

FAILED = 1  # exit status of a copy whose work raised


def meanwhile(work: Callable[[], T]) -> Callable[[], T]:
    """What returns what `work` does, and raises what it raises: done by a copy of this process while this one goes on.

    Its result has to pickle. Where there is no copy, with one processor, or where the copy ends without a result, the work
    is done here when it is asked for. A copy whose result nobody can ask for any more is ended.
    """
    if not sys.platform.startswith("linux") or len(os.sched_getaffinity(0)) < 2:
        return work
    try:
        return _Meanwhile(work)
    except OSError:  # the system has no process or no pipe left
        return work


class _Meanwhile(Generic[T]):
    """The work that a copy does, and its result."""

    def __init__(self, work: Callable[[], T]) -> None:
        self._work = work
        self._ours, theirs = os.pipe()
        try:
            pid = begun(lambda: _tell(work, theirs))
        except OSError:
            os.close(self._ours)
            raise
        finally:
            os.close(theirs)
        self._end = weakref.finalize(self, _ended, pid, self._ours)

    def __call__(self) -> T:
        with contextlib.suppress(
            EOFError, pickle.UnpicklingError
        ):  # it has ended without, or was asked before
            with os.fdopen(self._ours, "rb", closefd=False) as stream:
                found: T = pickle.load(stream)
            return found
        return self._work()


def _tell(work: Callable[[], object], channel: int) -> None:
    with os.fdopen(channel, "wb") as stream:
        stream.write(pickle.dumps(work(), pickle.HIGHEST_PROTOCOL))


def _ended(pid: int, channel: int) -> None:
    """Here: end the copy, whose result is known or not asked for."""
    os.close(channel)
    with contextlib.suppress(OSError):
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)


def begun(work: Callable[[], object]) -> int:
    """The number of a copy of this process that has begun with some work. It ends with 0, or FAILED where the work raises,
    of which it says nothing unless FREECAD_AM_DEBUG is set; at any signal; and with this process."""
    parent = os.getpid()
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    asked = signal.pthread_sigmask(
        signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM)
    )  # that no handler of ours runs there
    try:
        pid = os.fork()
        if not pid:
            _carry_out(work, parent, asked)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, asked)
    return pid


def _carry_out(work: Callable[[], object], parent: int, asked: set[signal.Signals | int]) -> None:
    """In the copy: do the work, and end."""
    status = FAILED
    try:
        take_no_signals()
        signal.pthread_sigmask(signal.SIG_SETMASK, asked)
        end_with(parent)
        work()
        status = 0
    except BaseException:
        if os.environ.get("FREECAD_AM_DEBUG"):
            import traceback

            traceback.print_exc()
    finally:
        os._exit(status)


def take_no_signals() -> None:
    """Every signal ends this process, a fault of memory too: FreeCAD and its kernel would go on with what is broken."""
    for number in (
        signal.SIGINT,
        signal.SIGTERM,
        signal.SIGSEGV,
        signal.SIGABRT,
        signal.SIGFPE,
        signal.SIGXCPU,
    ):
        signal.signal(number, signal.SIG_DFL)


def end_with(parent: int) -> None:
    """Have the system end this process when its parent, the process of that number, ends, however that does."""
    import ctypes

    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:
        os._exit(FAILED)
