# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units of the page: metric for commands, the user's unit scheme for the window.

Values in report.json are always metric.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from ..core.issues import Text
from ..core.number_texts import put_values

_LABEL = re.compile(r"(?P<name>.*, )?(?P<unit>mm|mm/s|mm/min|cm³|g|m)")
_FIGURE = re.compile(r"-?[\d,]+(?:\.\d+)?(?:e[-+]\d+)?")


@dataclass(frozen=True)
class ReportUnits:
    """Conversions to page units.

    text: converts the quantities in a text. scale: function of the maximum value and the internal
    unit that returns the conversion factor and the name of the page unit.
    """

    text: Callable[[str], str]
    scale: Callable[[float, str], tuple[float, str]]


METRIC = ReportUnits(str, lambda largest, unit: (1.0, unit))
_units: ContextVar[ReportUnits] = ContextVar("units of the page", default=METRIC)


@contextmanager
def shown_in(units: ReportUnits) -> Iterator[None]:
    """Within the context, draw pages in the given units."""
    token = _units.set(units)
    try:
        yield
    finally:
        _units.reset(token)


def text(words: str) -> str:
    """Convert a text with quantities to page units. The text must not contain user names."""
    return _units.get().text(words)


def scale(largest: float, unit: str) -> tuple[float, str]:
    """Return the factor from `unit` to the page unit for values up to `largest`, and its name."""
    return _units.get().scale(largest, unit)


def message(words: str) -> str:
    """Convert a message to page units, without changing names."""
    if not isinstance(words, Text):
        return str(words)
    values = [message(value) if isinstance(value, Text) else value for value in words.values]
    return put_values(words.template, values, text)


def label(words: str, largest: float) -> tuple[str, float]:
    """Convert a label such as 'local distance, mm' to page units; return the value factor too.

    largest: maximum value, in the unit of the label.
    """
    match = _LABEL.fullmatch(words)
    if match is None:
        return words, 1.0
    factor, unit = scale(largest, match["unit"])
    return f"{match['name'] or ''}{unit}", factor


def row(words: str, cells: list[str], written: Callable[[float], str]) -> tuple[str, list[str]]:
    """Convert a table row, a label with unit and its values, to page units."""
    values = [float(cell.replace(",", "")) for cell in cells if _FIGURE.fullmatch(cell)]
    converted, factor = label(words, max(map(abs, values), default=0.0))
    if factor == 1.0:
        return words, cells
    return converted, [
        written(factor * float(cell.replace(",", ""))) if _FIGURE.fullmatch(cell) else cell
        for cell in cells
    ]
