# SPDX-License-Identifier: LGPL-2.1-or-later
"""Who is told how far a long computation is: nobody, a terminal, or a progress bar."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

Listener = Callable[[float, str], None]

_listeners: list[Listener] = []


def report(fraction: float, text: str) -> None:
    """Tell the innermost listener; it may raise to cancel."""
    if _listeners:
        _listeners[-1](fraction, text)


@contextlib.contextmanager
def told_to(listener: Listener) -> Iterator[None]:
    """Within it `listener(fraction, text)` is told."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.pop()
