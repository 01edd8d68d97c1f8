# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program against the plan, and the checks that only its controller can do."""

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
    """The result of the read-back.

    ok: no error. at_points, between: mm from the plan. bound: mm that the digits of the text
    explain. allowed: mm between points. solvers: number of solvers of its kinematics.
    """

    ok: bool
    at_points: float
    between: float
    bound: float
    allowed: float
    solvers: int


def promises(read_back: ReadBack | None, on_controller: Sequence[str]) -> list[Promise]:
    """The promises about a text; `on_controller`: checks that only the controller can do."""
    not_checked = "not checked: only the controller can show it"
    return [*_read_back(read_back), *(Promise(text, not_checked, None) for text in on_controller)]


def _read_back(read_back: ReadBack | None) -> list[Promise]:
    if read_back is None:
        return [
            Promise(what, "not checked: there is no program that was read back", None)
            for what in (TEXT, BETWEEN)
        ]
    how = "read back by a reader of its own and driven through the joint-frame chain"
    method = (
        Text("{} and PyKDL", Word(how))
        if read_back.solvers > 1
        else Text("{}; PyKDL is not installed", Word(how))
    )
    return [
        Promise(
            TEXT,
            method,
            _is_within(read_back, read_back.at_points, read_back.bound),
            *_figure(read_back.at_points, read_back.bound),
        ),
        Promise(
            BETWEEN,
            "the path of the text between its points, as the controller interpolates it",
            _is_within(read_back, read_back.between, read_back.allowed),
            *_figure(read_back.between, read_back.allowed),
        ),
    ]


def _is_within(read_back: ReadBack, value: float, bound: float) -> bool:
    return read_back.ok and value <= bound


def _figure(value: float, bound: float) -> tuple[float | None, str, float | None]:
    return (value, "mm", bound) if math.isfinite(value) else (None, "", None)
