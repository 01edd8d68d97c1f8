# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who is told how far a long computation is, and what is found on the way: nobody, a terminal, or a progress bar; and how it
ends when cancelled."""

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
    """Each thread has its own: works in two threads do not tell each other's listeners."""

    def __init__(self) -> None:
        self.stack: list[tuple[Listener, Findings | None]] = []


_listeners = _Listeners()


def report(fraction: float, text: str) -> None:
    """Tell the innermost listener of this thread; it may raise to cancel."""
    if _listeners.stack:
        _listeners.stack[-1][0](fraction, text)


def tell(issue: Issue) -> None:
    """Tell the innermost listener of this thread of something that is better known before the work is done."""
    findings = _listeners.stack[-1][1] if _listeners.stack else None
    if findings is not None:
        findings(issue)


@contextlib.contextmanager
def told_to(listener: Listener, findings: Findings | None = None) -> Iterator[None]:
    """Within it `listener(fraction, text)` is told of what this thread computes, and `findings(issue)` of what is found on
    the way. InputError BAD_INPUT for what cannot be called."""
    for called, where in ((listener, "listener"), (findings, "findings")):
        if not callable(called) and (called is not None or where == "listener"):
            raise InputError(
                "BAD_INPUT", where, "{!r} is not a function; give one", type(called).__name__
            )
    _listeners.stack.append((listener, findings))
    try:
        yield
    finally:
        _listeners.stack.pop()


@contextlib.contextmanager
def one_of(number: int, count: int, begin: float, end: float) -> Iterator[None]:
    """Within it works alike, each of which tells of itself from `begin` to `end`, are told as one: this is that of a number,
    from 0 on, of so many."""
    if not _listeners.stack:
        yield
        return
    listener, findings = _listeners.stack[-1]
    low = begin + (end - begin) * number / count

    def as_one(fraction: float, text: str) -> None:
        listener(low + (fraction - begin) / count, text)

    with told_to(as_one, findings):
        yield
