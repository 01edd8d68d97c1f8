# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings and errors: what is wrong, where, and what to do about it.

A finding about a sound job (unreachable point, limit exceeded) is an `Issue` with its place. An input
that cannot be understood is an `InputError`. Nothing else leaves this package for a user's mistake.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

ERROR, WARNING, NOTE = "error", "warning", "note"


@dataclass(frozen=True)
class Issue:
    """One finding. `layer`, `bead` and `point` count from 0 and are None where the finding has no such place."""

    level: str
    code: str
    message: str
    layer: int | None = None
    bead: int | None = None
    point: int | None = None

    def as_dict(self) -> dict[str, Any]:
        """The form used in report.json."""
        return asdict(self)

    @property
    def where(self) -> str:
        """The place in words, '' when there is none."""
        named = (("layer", self.layer), ("bead", self.bead), ("point", self.point))
        return " ".join(f"{word} {index}" for word, index in named if index is not None)


def has_errors(issues: tuple[Issue, ...] | list[Issue]) -> bool:
    """True when one of the issues forbids writing a program."""
    return any(issue.level == ERROR for issue in issues)


class AmError(Exception):
    """Base of all errors raised on purpose. `exit_status` is the status of the headless command."""

    exit_status = 1

    def __init__(self, code: str, where: str, message: str) -> None:
        super().__init__(f"{where}: {message}")
        self.code = code
        self.where = where
        self.message = message

    def line(self) -> str:
        """The single line printed to stderr: error[CODE] where: what, and what to do."""
        return f"error[{self.code}] {self.where}: {self.message}"


class InputError(AmError):
    """The job, the part, a machine file or the usage is wrong; the message says what to do.

    `mended_by`: parameters by key, with values that mend it, where these are known.
    """

    exit_status = 2

    def __init__(self, code: str, where: str, message: str, mended_by: Mapping[str, Any] | None = None) -> None:
        super().__init__(code, where, message)
        self.mended_by = dict(mended_by or {})


class InfeasibleError(AmError):
    """A sound job that cannot be carried out. `issues` names every place."""

    exit_status = 3

    def __init__(self, code: str, where: str, message: str, issues: tuple[Issue, ...] = ()) -> None:
        super().__init__(code, where, message)
        self.issues = issues
