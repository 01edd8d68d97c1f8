# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program against the plan, and what only its controller can show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..issues import Text, Word
from .promise import Promise

TEXT, BETWEEN = (
    "The text takes the tool to the planned points",
    "Between its points the text keeps to the planned path",
)


@dataclass(frozen=True)
class ReadBack:
    """How a program was read back. ok: without an error. at_points, between: mm from the plan; bound: mm that the digits of
    the text explain. allowed: mm between points. solvers: how many computed its kinematics."""

    ok: bool
    at_points: float
    between: float
    bound: float
    allowed: float
    solvers: int


def promises(read: ReadBack | None, on_controller: Sequence[str]) -> list[Promise]:
    """The promises about a text; `on_controller`: what nobody can check but there."""
    there = "not checked: only the controller can show it"
    return [*_read_back(read), *(Promise(text, there, None) for text in on_controller)]


def _read_back(read: ReadBack | None) -> list[Promise]:
    if read is None:
        return [
            Promise(what, "not checked: there is no program that was read back", None)
            for what in (TEXT, BETWEEN)
        ]
    how = "read back by a reader of its own and driven through the joint-frame chain"
    both = (
        Text("{} and PyKDL", Word(how))
        if read.solvers > 1
        else Text("{}; PyKDL is not installed", Word(how))
    )
    return [
        Promise(
            TEXT,
            both,
            _within(read, read.at_points, read.bound),
            *_figure(read.at_points, read.bound),
        ),
        Promise(
            BETWEEN,
            "the path of the text between its points, as the controller interpolates it",
            _within(read, read.between, read.allowed),
            *_figure(read.between, read.allowed),
        ),
    ]


def _within(read: ReadBack, value: float, bound: float) -> bool:
    return read.ok and value <= bound


def _figure(value: float, bound: float) -> tuple[float | None, str, float | None]:
    return (value, "mm", bound) if math.isfinite(value) else (None, "", None)
