# SPDX-License-Identifier: LGPL-2.1-or-later
"""Typed access to the JSON of a machine file: every error names file, key and value.

docs/machines.md explains the keys.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...geometry import frames
from ...geometry.file_content import read_content
from ...issues import InputError, Text, Word
from ...types import Array

MAX_FILE_MB = 16  # MB
LARGEST_NUMBER = 1e300


class Node:
    """A part of a machine file with its place in it. Getters raise InputError 'BAD_MACHINE'."""

    def __init__(self, value: Any, path: Path, key: str = "") -> None:
        self.value, self.path, self.key = value, path, key

    def bad(self, message: str) -> InputError:
        """The error about this part."""
        return InputError(
            "BAD_MACHINE", f"{self.path}{': ' if self.key else ''}{self.key}", message
        )

    def only(self, *allowed: str) -> Node:
        """Return the node, if it is an object without unknown keys."""
        if not isinstance(self.value, dict):
            raise self.bad(
                Text(
                    "{} is not an object with the keys {}; write one in braces",
                    _short(self.value),
                    ", ".join(allowed),
                )
            )
        for key in self.value:
            if key not in allowed:
                raise self.bad(Text("the key {!r} is not known; use {}", key, ", ".join(allowed)))
        return self

    def has(self, key: str) -> bool:
        """Whether a key of an object is there and not null."""
        return isinstance(self.value, dict) and self.value.get(key) is not None

    def __getitem__(self, key: str) -> Node:
        if not isinstance(self.value, dict) or key not in self.value:
            raise self.bad(Text("the key {!r} is missing; add it", key))
        return Node(self.value[key], self.path, f"{self.key}.{key}".lstrip("."))

    def items(self, length: int | None = None) -> list[Node]:
        """The parts of a list, of `length` where given."""
        if not isinstance(self.value, list) or (length is not None and len(self.value) != length):
            raise self.bad(
                Text(
                    "{} is not a list{}; write one in square brackets",
                    _short(self.value),
                    Word(Text(" of {}", length) if length is not None else ""),
                )
            )
        return [
            Node(value, self.path, f"{self.key}[{index}]") for index, value in enumerate(self.value)
        ]

    def pairs(self) -> Iterator[tuple[str, Node]]:
        """The keys and values of an object."""
        if not isinstance(self.value, dict):
            raise self.bad(Text("{} is not an object; write one in braces", _short(self.value)))
        return ((key, self[key]) for key in self.value)

    def text(self) -> str:
        """A text that is not empty."""
        if not isinstance(self.value, str) or not self.value:
            raise self.bad(Text("{} is not a text; write one in quotes", _short(self.value)))
        return self.value

    def texts(self) -> tuple[str, ...]:
        """A list of texts."""
        return tuple(item.text() for item in self.items())

    def number(self) -> float:
        """A finite number."""
        if (
            isinstance(self.value, bool)
            or not isinstance(self.value, (int, float))
            or not abs(self.value) <= LARGEST_NUMBER
        ):
            raise self.bad(Text("{} is not a number; write one such as 12.5", _short(self.value)))
        return float(self.value)

    def numbers(self, length: int) -> Array:
        """A list of finite numbers (length,)."""
        are_numbers = isinstance(self.value, list) and {type(value) for value in self.value} <= {
            int,
            float,
        }
        if (
            are_numbers
            and len(self.value) == length
            and all(abs(value) <= LARGEST_NUMBER for value in self.value)
        ):
            return np.array(self.value, float)
        # something is wrong: find which
        return np.array([item.number() for item in self.items(length)])

    def span(self, unit: float = math.radians(1.0)) -> tuple[float, float]:
        """Return a range of two numbers times `unit`: angles in degrees become rad; null is
        unlimited.
        """
        if self.value is None:
            return -math.inf, math.inf
        lower, upper = (item.number() for item in self.items(2))
        if not lower < upper:
            raise self.bad(
                Text(
                    "{} is not a range; give the smaller value first, or null for a continuous "
                    "axis",
                    _short(self.value),
                )
            )
        return lower * unit, upper * unit

    def matrix(self, rows: int, columns: int) -> Array:
        """A list of lists of numbers (rows, columns)."""
        return np.array([row.numbers(columns) for row in self.items(rows)]).reshape(rows, columns)

    def pose(self) -> Array:
        """A pose (4, 4) of `origin` in mm and `rpy` in degrees."""
        return frames.from_rpy(self["origin"].numbers(3), np.radians(self["rpy"].numbers(3)))


def _once(pairs: list[tuple[str, Any]], path: Path) -> dict[str, Any]:
    """Return an object, each key of which occurs once."""
    entries: dict[str, Any] = {}
    for key, value in pairs:
        if key in entries:
            raise InputError(
                "BAD_MACHINE", str(path), "the key {!r} appears twice; remove one", key
            )
        entries[key] = value
    return entries


def read(path: Path) -> Node:
    """The content of a machine file; InputError 'BAD_MACHINE' when it cannot be read as JSON."""
    try:
        return Node(
            json.loads(
                read_content(path, MAX_FILE_MB, "BAD_MACHINE", str(path)).decode("utf-8-sig"),
                object_pairs_hook=lambda pairs: _once(pairs, path),
            ),
            path,
        )
    except RecursionError:
        raise InputError(
            "BAD_MACHINE",
            str(path),
            "it is nested too deeply for a machine file; choose another file",
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(
            "BAD_MACHINE",
            str(path),
            "cannot be read as a machine file: {}; correct it, or choose another file",
            error,
        ) from None


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."
