# SPDX-License-Identifier: LGPL-2.1-or-later
"""The units of the page: metric for commands, the user's unit scheme for the window.

The figures of report.json are always metric.
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
    """text: converts the quantities in a text to the units of the page. scale: for values up to a
    maximum in an internal unit, the factor to the page's unit, and its name."""

    text: Callable[[str], str]
    scale: Callable[[float, str], tuple[float, str]]


METRIC = ReportUnits(str, lambda largest, unit: (1.0, unit))
_units: ContextVar[ReportUnits] = ContextVar("units of the page", default=METRIC)


@contextmanager
def shown_in(units: ReportUnits) -> Iterator[None]:
    """Draw pages in these units for as long as the context is entered."""
    token = _units.set(units)
    try:
        yield
    finally:
        _units.reset(token)


def text(words: str) -> str:
    """A text of numbers in the units of the page; no names of users may be in it."""
    return _units.get().text(words)


def scale(largest: float, unit: str) -> tuple[float, str]:
    """Return the factor from `unit` to the page's unit for values up to `largest`, and its name."""
    return _units.get().scale(largest, unit)


def message(words: str) -> str:
    """A message in the units of the page, with names as they are."""
    if not isinstance(words, Text):
        return str(words)
    values = [message(value) if isinstance(value, Text) else value for value in words.values]
    return put_values(words.template, values, text)


def label(words: str, largest: float) -> tuple[str, float]:
    """A label such as 'local distance, mm' of values of up to `largest`, in the unit of the page, and the factor of values."""
    match = _LABEL.fullmatch(words)
    if match is None:
        return words, 1.0
    factor, unit = scale(largest, match["unit"])
    return f"{match['name'] or ''}{unit}", factor


def row(words: str, cells: list[str], written: Callable[[float], str]) -> tuple[str, list[str]]:
    """A row of figures under a label with its unit, in the unit of the page."""
    values = [float(cell.replace(",", "")) for cell in cells if _FIGURE.fullmatch(cell)]
    converted, factor = label(words, max(map(abs, values), default=0.0))
    if factor == 1.0:
        return words, cells
    return converted, [
        written(factor * float(cell.replace(",", ""))) if _FIGURE.fullmatch(cell) else cell
        for cell in cells
    ]
