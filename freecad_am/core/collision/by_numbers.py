# SPDX-License-Identifier: LGPL-2.1-or-later
"""Queries that are equal if all their numbers are: keys of results shared by several callers."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import fields, is_dataclass
from functools import cached_property

import numpy as np


class ByNumbers:
    """A dataclass (frozen, without an == of its own) that is compared by the numbers and names in its fields."""

    @cached_property
    def _numbers(self) -> Hashable:
        return _numbers(self)

    def __eq__(self, other: object) -> bool:
        return (
            type(self) is type(other)
            and isinstance(other, ByNumbers)
            and self._numbers == other._numbers
        )

    def __hash__(self) -> int:
        return hash(self._numbers)


def _numbers(value: object) -> Hashable:
    """All numbers and names in a value, to be compared."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if isinstance(value, (list, tuple)):
        return tuple(_numbers(entry) for entry in value)
    if is_dataclass(value):
        return tuple(_numbers(getattr(value, entry.name)) for entry in fields(value))
    assert isinstance(value, Hashable)
    return value
