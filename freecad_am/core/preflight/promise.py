# SPDX-License-Identifier: LGPL-2.1-or-later
"""A promise about a job before it runs: the check, its worst value and where this value occurs."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..issues import ERROR, Issue, Text
from ..motion import Motion

PERCENT = 100.0


def number(value: float) -> str:
    """Format a value with four significant digits; rounding residues become 0."""
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "-∞"
    return "0" if abs(value) < 1e-12 else f"{value:.4g}"


class Place(NamedTuple):
    """Location of a worst value, with indices from 0; None for an index that does not apply."""

    layer: int
    bead: int | None
    point: int | None


@dataclass(frozen=True)
class Promise:
    """One line of the preflight.

    promise: the statement. how: the check method, or the reason for no check. ok: None if not
    checked. worst: the worst value, in `unit`; None if the check has no value. bound: maximum of
    `worst`, or its minimum if `at_least`. place: location of `worst`. row: motion row of `worst`,
    if known.
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
        """Return the promise as written to report.json."""
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
        """The worst value with its unit and bound; '' if there is no worst value."""
        if self.worst is None:
            return ""
        value, sign = amount(self.worst, self.unit), "≥" if self.at_least else "≤"
        return value if self.bound is None else Text("{} ({} {})", value, sign, number(self.bound))


def amount(value: float, unit: str, formatted: Callable[[float], str] = number) -> str:
    """Return a value with its unit.

    Counts have translatable texts for 0, 1 and more, because some languages inflect all three.

    Parameters
    ----------
    value : float
        The value.
    unit : str
        The unit, or 'points' or 'rapids' for counts; may be empty.
    formatted : callable, optional
        Formats the value.

    Returns
    -------
    str
        The value and unit; translatable for counts.
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
    """Return the location of a motion row."""
    return Place(int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row]))


def issue_place(issues: Sequence[Issue]) -> Place | None:
    """Return the location of the first issue that has a layer; None if no issue has one."""
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
    """Return the issues of one level whose code is in `codes`.

    Parameters
    ----------
    issues : sequence of Issue
        The issues.
    codes : collection of str
        Issue codes to select.
    level : str, optional
        Issue level; errors by default.

    Returns
    -------
    list of Issue
        The selected issues, in the order of `issues`.
    """
    return [issue for issue in issues if issue.level == level and issue.code in codes]
