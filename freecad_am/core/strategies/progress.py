# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far a strategy is: a function told the share that is done, 0..1, and what is being done; it may raise to cancel."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Tells nobody."""
