# SPDX-License-Identifier: LGPL-2.1-or-later
"""A promise about a job before its start, how it was checked, and its worst value with its position."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..issues import ERROR, Issue, Text
from ..motion import Motion

PERCENT = 100.0


def number(value: float) -> str:
    """A figure with four digits; what rounding leaves is 0."""
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "-∞"
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


class Place(NamedTuple):
    """The location of a worst value, counted from 0; None if it does not apply."""

    layer: int
    bead: int | None
    point: int | None


@dataclass(frozen=True)
class Promise:
    """One line of the preflight.

    ok: None if it was not checked; `how` gives the reason. promise: the statement. how: the method
    of the check. worst: its worst value, in `unit`, None without a figure. bound: the maximum of
    `worst` in the same unit, or with at_least its minimum. place: location of the worst value; row:
    its motion row, if it has one.
    """

    promise: str
    how: str
    ok: bool | None
    worst: float | None = None
    unit: str = ""
    bound: float | None = None
    place: Place | None = None
    at_least: bool = False
    row: int | None = None

    def as_dict(self) -> dict[str, Any]:
        """The form used in report.json."""
        return {
            "promise": self.promise,
            "how": self.how,
            "worst": self.worst,
            "unit": self.unit,
            "bound": self.bound,
            "at_least": self.at_least,
            "place": None if self.place is None else self.place._asdict(),
            "ok": self.ok,
        }

    @property
    def figure(self) -> str:
        """The worst value with its unit and its bound, '' without one."""
        if self.worst is None:
            return ""
        value, sign = amount(self.worst, self.unit), "≥" if self.at_least else "≤"
        return value if self.bound is None else Text("{} ({} {})", value, sign, number(self.bound))


def amount(value: float, unit: str, formatted: Callable[[float], str] = number) -> str:
    """Return a value with its unit.

    Counts are singular or plural as the language wants, which some languages also have for 0.

    Parameters
    ----------
    value : float
        The value.
    unit : str
        Its unit, or 'points' or 'rapids' for counts; may be empty.
    formatted : callable, optional
        Text of a number.

    Returns
    -------
    str
        The text; counts can be translated.
    """
    if unit == "points":
        return Text(
            "0 points" if value == 0.0 else "1 point" if value == 1.0 else "{} points",
            formatted(value),
        )
    if unit == "rapids":
        return Text(
            "0 rapids" if value == 0.0 else "1 rapid" if value == 1.0 else "{} rapids",
            formatted(value),
        )
    return " ".join(filter(None, (formatted(value), unit)))


def row_place(motion: Motion, row: int) -> Place:
    """The place of a row of a motion."""
    return Place(int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row]))


def issue_place(issues: Sequence[Issue]) -> Place | None:
    """The place of the first issue that has one."""
    return next(
        (
            Place(issue.layer, issue.bead, issue.point)
            for issue in issues
            if issue.layer is not None
        ),
        None,
    )


def select_issues(
    issues: Sequence[Issue], codes: Collection[str], level: str = ERROR
) -> list[Issue]:
    """Return the issues of a level that have one of the codes.

    Parameters
    ----------
    issues : sequence of Issue
        The issues.
    codes : collection of str
        Codes to select.
    level : str, optional
        The level; errors by default.

    Returns
    -------
    list of Issue
        In their order.
    """
    return [issue for issue in issues if issue.level == level and issue.code in codes]
