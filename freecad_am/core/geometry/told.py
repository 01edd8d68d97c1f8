# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places in messages."""

from __future__ import annotations

from collections.abc import Iterable


def place(point: Iterable[float]) -> str:
    """A point (x, y, z) in mm as text, to a thousandth."""
    return "(" + ", ".join(f"{round(float(number), 3) + 0.0:g}" for number in point) + ")"
