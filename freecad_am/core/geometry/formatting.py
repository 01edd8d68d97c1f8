# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places, distances and numbers in messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence


def place(point: Iterable[float]) -> str:
    """A point (x, y, z) in mm as text, to a thousandth."""
    return "(" + ", ".join(f"{round(float(number), 3) + 0.0:g}" for number in point) + ")"


def format_deviation(distance: float) -> str:
    """Format a maximum deviation in mm; at least a thousandth, below the resolution of
    measurements.
    """
    return f"{max(distance, 1e-3):.2g}"


def format_differing(value: float, reference: float, digits: int = 6) -> str:
    """Format a number so that its text differs from the text of another.

    Parameters
    ----------
    value : float
        The number.
    reference : float
        The other number.
    digits : int, optional
        Fewest significant digits.

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
    """About how many, as text: to two digits, 47,000,000, of very many 4.7e+12."""
    return f"{float(f'{number:.1e}'):,.0f}" if number < 1e12 else f"{number:.1e}"


def round_step(rough: float, steps: Sequence[float]) -> float:
    """The least of rising steps, from 1 to 10, times a power of ten that is no less than a positive number."""
    power = 10.0 ** math.floor(math.log10(rough))
    return float(power * next(step for step in steps if step * power >= rough * (1.0 - 1e-9)))


def at_least(number: float) -> float:
    """A positive number rounded up to two digits."""
    if math.isinf(number):
        return number
    step = 10.0 ** (math.floor(math.log10(number)) - 1)
    return math.ceil(number / step - 1e-9) * step
