# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress and findings of a long computation, for a terminal, a progress bar or no listener; and
its cancellation.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

from ...core.issues import InputError, Issue

Listener = Callable[[float, str], None]
Findings = Callable[[Issue], None]


class Cancelled(BaseException):
    """The computation was cancelled. No Exception, so that nothing on the way takes it for a failure of its own."""


class _Listeners(threading.local):
    """Each thread has its own: work in one thread does not reach another thread's listeners."""

    def __init__(self) -> None:
        self.stack: list[tuple[Listener, Findings | None]] = []


_listeners = _Listeners()


def report(fraction: float, text: str) -> None:
    """Report to the innermost listener of the current thread; it may raise to cancel."""
    if _listeners.stack:
        _listeners.stack[-1][0](fraction, text)


def report_issue(issue: Issue) -> None:
    """Report an issue to the innermost listener of the current thread before the work is done."""
    findings = _listeners.stack[-1][1] if _listeners.stack else None
    if findings is not None:
        findings(issue)


@contextlib.contextmanager
def told_to(listener: Listener, findings: Findings | None = None) -> Iterator[None]:
    """Report progress and findings of the current thread to functions, within a context.

    Parameters
    ----------
    listener : Listener
        Receives fraction and text; may raise to cancel.
    findings : Findings or None, optional
        Receives each issue; None for no function.

    Raises
    ------
    InputError
        BAD_INPUT for an object that cannot be called.
    """
    for called, where in ((listener, "listener"), (findings, "findings")):
        if not callable(called) and (called is not None or where == "listener"):
            raise InputError(
                "BAD_INPUT", where, "{!r} is not a function; pass one", type(called).__name__
            )
    _listeners.stack.append((listener, findings))
    try:
        yield
    finally:
        _listeners.stack.pop()


@contextlib.contextmanager
def one_of(number: int, count: int, begin: float, end: float) -> Iterator[None]:
    """Within the context `count` equal tasks, each reporting from `begin` to `end`, report as one;
    `number` counts from 0.
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
