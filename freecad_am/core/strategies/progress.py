# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a strategy is: a function told the share that is done, 0..1, and what is being done; it may raise to cancel."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Tells nobody."""


class Watch(NamedTuple):
    """Who is told of a search: before it at how many points, how many times at most, and on the way the share that is done,
    0..1; both may raise to cancel."""

    points: Callable[[int, int], None] = lambda points, times: None
    share: Callable[[float], None] = lambda share: None

    def within(self, low: float, high: float) -> Watch:
        """Of a part of the search, which begins and ends at these shares of it."""
        return self._replace(share=lambda share: self.share(low + share * (high - low)))

    def at_end(self) -> Watch:
        """Of what is looked at when the search is through: told that it goes on alone."""
        return Watch(share=lambda share: self.share(1.0))
