# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress of long work, and the places where it may be cancelled.

A progress function receives the completed fraction, 0 to 1, and the current step. It may raise to cancel. Loops below
the steps that report call `pulse`, so that work can be cancelled between its reports.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple, TypeVar

T = TypeVar("T")

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Ignore the progress."""


class Watch(NamedTuple):
    """Receivers of a search's progress, which may raise to cancel.

    points: called before the search with the number of points and the maximum number of passes. share: called during
    the search with the completed fraction, 0 to 1.
    """

    points: Callable[[int, int], None] = lambda points, times: None
    share: Callable[[float], None] = lambda share: None

    def section(self, low: float, high: float) -> Watch:
        """Return a watch for the section of the search between two fractions."""
        return self._replace(share=lambda share: self.share(low + share * (high - low)))

    def at_end(self) -> Watch:
        """Return a watch for checks after the search, whose progress stays at 1."""
        return Watch(share=lambda share: self.share(1.0))


class _Pulses(threading.local):
    """The function that `pulse` calls, per thread."""

    def __init__(self) -> None:
        self.function: Callable[[], None] = _nothing


def _nothing() -> None:
    """Do nothing."""


_pulses = _Pulses()


def pulse() -> None:
    """Say that the work of this thread goes on; may raise to cancel it."""
    _pulses.function()


def pulse_each(items: Iterable[T], step: int = 1) -> Iterator[T]:
    """Yield items, with a pulse before every `step` of them."""
    for number, item in enumerate(items):
        if number % step == 0:
            pulse()
        yield item


@contextlib.contextmanager
def pulsing(function: Callable[[], None]) -> Iterator[None]:
    """Within the context, `pulse` calls a function in this thread, which may raise to cancel."""
    earlier, _pulses.function = _pulses.function, function
    try:
        yield
    finally:
        _pulses.function = earlier
