# SPDX-License-Identifier: LGPL-2.1-or-later
"""Progress of a strategy.

A progress function receives the completed fraction, 0 to 1, and the current step. It may raise to cancel.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

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
