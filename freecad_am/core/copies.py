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


def meanwhile(work: Callable[[], T]) -> Callable[[], T]:
    """What returns what `work` does, and raises what it raises: done by a copy of this process while this one goes on.

    Its result has to pickle. Where there is no copy, with one processor, or where the copy ends without a result, the work
    is done here when it is asked for. A copy whose result nobody can ask for any more is ended.
    """
    if not sys.platform.startswith("linux") or len(os.sched_getaffinity(0)) < 2:
        return work
    return _Copy(work)


class _Copy(Generic[T]):
    """The work that a copy does, and its result."""

    def __init__(self, work: Callable[[], T]) -> None:
        self._work = work
        self._ours, theirs = os.pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        pid = os.fork()
        if not pid:
            _carry_out(work, theirs)
        os.close(theirs)
        self._end = weakref.finalize(self, _ended, pid, self._ours)

    def __call__(self) -> T:
        with contextlib.suppress(EOFError, pickle.UnpicklingError):  # it has ended without, or was asked before
            with open(self._ours, "rb", closefd=False) as stream:
                found: T = pickle.load(stream)
            return found
        return self._work()


def _carry_out(work: Callable[[], object], channel: int) -> None:
    """In the copy: do the work, and end. Errors are found again, and raised, by whoever asks for the result."""
    try:
        take_no_signals()
        end_with_parent()
        with open(channel, "wb") as stream:
            stream.write(pickle.dumps(work(), pickle.HIGHEST_PROTOCOL))
    except BaseException:
        os._exit(1)
    finally:
        os._exit(0)


def _ended(pid: int, channel: int) -> None:
    """Here: end the copy, whose result is known or not asked for."""
    os.close(channel)
    with contextlib.suppress(OSError):
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)


def take_no_signals() -> None:
    """Every signal ends this process, a fault of memory too: FreeCAD and its kernel would go on with what is broken."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGXCPU):
        signal.signal(number, signal.SIG_DFL)


def end_with_parent() -> None:
    """Have the system end this process when the one that has made it ends, however that does."""
    import ctypes

    parent = os.getppid()
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:
        os._exit(1)
