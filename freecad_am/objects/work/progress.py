# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress, issues, cancellation and failures of a long computation."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator
from typing import Any

from ...brep.kernel.limits import reported
from ...core.issues import InputError, Issue

Listener = Callable[[float, str], None]
Findings = Callable[[Issue], None]


class Cancelled(BaseException):
    """The computation was cancelled. Not an Exception, so that error handlers do not catch it."""


class _Listeners(threading.local):
    """Listeners per thread: work in one thread does not report to another thread's listeners."""

    def __init__(self) -> None:
        self.stack: list[tuple[Listener, Findings | None]] = []


_listeners = _Listeners()


def report(fraction: float, text: str) -> None:
    """Report to the innermost listener of the current thread, which may raise to cancel."""
    if _listeners.stack:
        _listeners.stack[-1][0](fraction, text)


def report_issue(issue: Issue) -> None:
    """Report an issue to the innermost listener of the current thread, before the work ends."""
    findings = _listeners.stack[-1][1] if _listeners.stack else None
    if findings is not None:
        findings(issue)


@contextlib.contextmanager
def told_to(listener: Listener, findings: Findings | None = None) -> Iterator[None]:
    """Within the context, report progress and issues of the current thread to functions.

    Parameters
    ----------
    listener : Listener
        Function of fraction and text; may raise an exception to cancel.
    findings : Findings or None, optional
        Function of an issue; None to ignore issues.

    Raises
    ------
    InputError
        BAD_INPUT for an object that is not callable.
    """
    for called, where in ((listener, "listener"), (findings, "findings")):
        if not callable(called) and (called is not None or where == "listener"):
            raise InputError(
                "BAD_INPUT", where, "{!r} is not a function; pass a function", type(called).__name__
            )
    _listeners.stack.append((listener, findings))
    try:
        yield
    finally:
        _listeners.stack.pop()


@contextlib.contextmanager
def one_of(number: int, count: int, begin: float, end: float) -> Iterator[None]:
    """Within the context, scale the progress of one of `count` equal tasks.

    Each task reports fractions from `begin` to `end`. number: task index, from 0.
    """
    if not _listeners.stack:
        yield
        return
    listener, findings = _listeners.stack[-1]
    low = begin + (end - begin) * number / count

    def as_one(fraction: float, text: str) -> None:
        listener(low + (fraction - begin) / count, text)

    with told_to(as_one, findings):
        yield


# ---- Failures of memory and kernel during a computation, as errors with a remedy


@contextlib.contextmanager
def memory_faults(label: str) -> Iterator[None]:
    """Within the context, convert MemoryError to InputError NO_MEMORY, naming `label`."""
    try:
        yield
    except MemoryError:
        raise InputError(
            "NO_MEMORY",
            label,
            "the computation needs more memory than available; use larger steps, such as layer "
            "height and chord error, or a smaller part",
        ) from None


@contextlib.contextmanager
def kernel_faults(obj: Any) -> Iterator[None]:
    """Within the context, convert kernel faults to InputError BAD_SHAPE, naming the source."""
    source = getattr(obj, "Source", None)
    origin = source[0] if source else obj
    with reported(str(origin.Label), getattr(origin, "Shape", None)):
        yield
