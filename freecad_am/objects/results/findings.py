# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a stage says of its result: status, message and findings, as its properties hold them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from ...core.issues import ERROR, WARNING, Issue


def issues_of(obj: Any) -> tuple[Issue, ...]:
    """The findings stored with the object."""
    return tuple(Issue(**entry) for entry in json.loads(obj.Issues or "[]"))


def as_text(issues: Sequence[Issue]) -> str:
    """Findings as an object stores them."""
    return json.dumps([issue.as_dict() for issue in issues])


def first_message(issues: Sequence[Issue]) -> str:
    """The first error, else the first warning, with its place; '' when there is neither."""
    for level in (ERROR, WARNING):
        for issue in issues:
            if issue.level == level:
                return f"{issue.where}: {issue.message}" if issue.where else issue.message
    return ""


def say(obj: Any, status: str, message: str) -> None:
    """Set status and message, each only where it is another: views and panels follow every change."""
    if obj.Message != message:
        obj.Message = message
    if obj.Status != status:
        obj.Status = status
