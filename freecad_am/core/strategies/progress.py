# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress of a strategy: a function that receives the share done, 0..1, and the current step; it may raise to cancel."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Ignore the progress."""


class Watch(NamedTuple):
    """Receivers of a search's progress: before it the number of points and the maximum number of passes, during it the share done,
    0..1; both may raise to cancel.
    """

    points: Callable[[int, int], None] = lambda points, times: None
    share: Callable[[float], None] = lambda share: None

    def section(self, low: float, high: float) -> Watch:
        """The watch of a section of the search between two shares."""
        return self._replace(share=lambda share: self.share(low + share * (high - low)))

    def at_end(self) -> Watch:
        """The watch of checks after the search, whose progress stays at its end."""
        return Watch(share=lambda share: self.share(1.0))
