# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who is told how far a long computation is: nobody, a terminal, or a progress bar; and how it ends when cancelled."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator

Listener = Callable[[float, str], None]


class Cancelled(BaseException):
    """The computation was cancelled. No Exception, so that nothing on the way takes it for a failure of its own."""


class _Listeners(threading.local):
    """Each thread has its own: works in two threads do not tell each other's listeners."""

    def __init__(self) -> None:
        self.stack: list[Listener] = []


_listeners = _Listeners()


def report(fraction: float, text: str) -> None:
    """Tell the innermost listener of this thread; it may raise to cancel."""
    if _listeners.stack:
        _listeners.stack[-1](fraction, text)


@contextlib.contextmanager
def told_to(listener: Listener) -> Iterator[None]:
    """Within it `listener(fraction, text)` is told of what this thread computes."""
    _listeners.stack.append(listener)
    try:
        yield
    finally:
        _listeners.stack.pop()
