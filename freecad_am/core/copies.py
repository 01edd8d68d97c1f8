# SPDX-License-Identifier: LGPL-2.1-or-later
"""Copies of this process, made by fork in milliseconds on systems that support it."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Callable

FAILED = 1  # exit status of a copy whose work raised


def fork(work: Callable[[], object]) -> int:
    """Fork a copy of this process to run `work`, and return its process id.

    The copy exits with 0, or with FAILED if the work raises; it prints the error only with
    FREECAD_AM_DEBUG. It ends at any signal, and together with this process.
    """
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
    """Let every signal end this process, even a memory fault: FreeCAD and its kernel would go on
    with corrupt data.
    """
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
    """Have the system end this process when its parent (the process id `parent`) ends for any
    reason.
    """
    import ctypes

    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != parent:
        os._exit(FAILED)
