# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format positions, distances and numbers for messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence


def place(point: Iterable[float]) -> str:
    """Format a point (x, y, z), mm, to a thousandth."""
    return "(" + ", ".join(f"{round(float(number), 3) + 0.0:g}" for number in point) + ")"


def format_deviation(distance: float) -> str:
    """Format a maximum deviation, mm; at least 0.001, which is below measurement resolution."""
    return f"{max(distance, 1e-3):.2g}"


def format_differing(value: float, reference: float, digits: int = 6) -> str:
    """Format a number so that its text differs from the text of a reference.

    Parameters
    ----------
    value : float
        The number.
    reference : float
        The reference.
    digits : int, optional
        Minimum number of significant digits.

    Returns
    -------
    str
        The text.
    """
    return next(
        (
            text
            for count in range(digits, 18)
            if (text := f"{value:.{count}g}") != f"{reference:.{count}g}"
        ),
        repr(value),
    )


def count(number: float) -> str:
    """Format an approximate count to two digits, such as 47,000,000 or 4.7e+12."""
    return f"{float(f'{number:.1e}'):,.0f}" if number < 1e12 else f"{number:.1e}"


def round_step(rough: float, steps: Sequence[float]) -> float:
    """Round a positive number up to a power of ten times one of rising `steps` from 1 to 10."""
    power = 10.0 ** math.floor(math.log10(rough))
    return float(power * next(step for step in steps if step * power >= rough * (1.0 - 1e-9)))


def at_least(number: float) -> float:
    """Round a positive number up to two digits."""
    if math.isinf(number):
        return number
    step = 10.0 ** (math.floor(math.log10(number)) - 1)
    return math.ceil(number / step - 1e-9) * step
