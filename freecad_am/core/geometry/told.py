# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places and distances in messages."""

from __future__ import annotations

from collections.abc import Iterable


def place(point: Iterable[float]) -> str:
    """A point (x, y, z) in mm as text, to a thousandth."""
    return "(" + ", ".join(f"{round(float(number), 3) + 0.0:g}" for number in point) + ")"


def deviation(distance: float) -> str:
    """How far something is off at most, a distance in mm as text; a thousandth where it is less, than which nobody measures
    finer."""
    return f"{max(distance, 1e-3):.2g}"
