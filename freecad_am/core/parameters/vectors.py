# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters that are a direction or an axis: numbers in the text of a property, a panel or a macro, a list in a job file."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

from ..issues import InputError, Text
from .records import Point


class Axis(NamedTuple):
    """A line in space: a point, mm, and a direction, not normalised."""

    point: Point
    direction: Point


@dataclass(frozen=True)
class VectorText:
    """The notation of a parameter that is a direction or an axis.

    Parameters
    ----------
    parse : callable
        Reads a text of numbers. Raises InputError.
    word : str
        The text of None; '' if a value is required.
    """

    parse: Callable[[str], Any]
    word: str = ""

    def read(self, value: Any) -> Any:
        """Return the value of a text, or of numbers, nested or not. Raises InputError BAD_VALUE."""
        if self.word and (value is None or value == self.word):
            return None
        return self.parse(value if isinstance(value, str) else _joined(value))

    def text(self, value: Any) -> str:
        """Return the text that gives a value, exactly."""
        return self.word if value is None else _joined(value)


def direction_text(where: str, word: str = "") -> VectorText:
    """Return the notation of three numbers that are a direction, not normalised."""
    return VectorText(partial(_direction, where=where, word=word), word)


def point_text(where: str, word: str) -> VectorText:
    """Return the notation of three numbers that are a point, mm; `word` is the text of None."""
    return VectorText(partial(_point, where=where, word=word), word)


def axis_text(where: str) -> VectorText:
    """Return the notation of an `Axis`: x y z i j k."""
    return VectorText(partial(_axis, where=where))


def _direction(text: str, where: str, word: str) -> Point:
    numbers = _numbers(text)
    if len(numbers) != 3 or not 0.0 < math.hypot(*numbers) < math.inf:
        also = Text(", or {}", word) if word else ""
        raise InputError(
            "BAD_VALUE",
            where,
            "{!r} is not a direction; give three numbers such as [0, 0, 1]{}",
            text,
            also,
        )
    x, y, z = numbers
    return x, y, z


def _point(text: str, where: str, word: str) -> Point:
    numbers = _numbers(text)
    if len(numbers) != 3 or not all(map(math.isfinite, numbers)):
        raise InputError(
            "BAD_VALUE",
            where,
            "{!r} is not a point; give three numbers such as [40, 0, 12.5], or {}",
            text,
            word,
        )
    x, y, z = numbers
    return x, y, z


def _axis(text: str, where: str) -> Axis:
    numbers = _numbers(text)
    is_axis = len(numbers) == 6 and all(map(math.isfinite, numbers)) and any(numbers[3:])
    if not is_axis:
        raise InputError(
            "BAD_VALUE",
            where,
            "{!r} is not an axis; give a point and a direction such as [[0, 0, 0], [0, 0, 1]]",
            text,
        )
    x, y, z, i, j, k = numbers
    return Axis((x, y, z), (i, j, k))


def _numbers(text: str) -> list[float]:
    """Return the numbers of a text, separated by blanks or commas; empty for any other text."""
    try:
        return [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        return []


def _joined(value: Any) -> str:
    return " ".join(map(_number_text, _flat(value)))


def _number_text(value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    short = f"{value:.15g}"
    return short if float(short) == value else repr(value)


def _flat(value: Any) -> Iterator[Any]:
    if isinstance(value, (list, tuple)):
        for entry in value:
            yield from _flat(entry)
    else:
        yield value
