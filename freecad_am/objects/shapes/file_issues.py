# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notes on the content of a part's file, kept with the object that was made from it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from ...core.issues import Issue
from ..results.findings import parts_of, text_of

PROPERTY = "FileIssues"


def keep_file_issues(obj: Any, issues: Sequence[Issue]) -> None:
    """Store the notes on a file with the object that its shape belongs to; nothing without notes."""
    if not issues:
        return
    if PROPERTY not in obj.PropertiesList:
        obj.addProperty(
            "App::PropertyString", PROPERTY, "Part", "Notes on the content of the file.", 4
        )
    rows = [[issue.level, issue.code, parts_of(issue.message)] for issue in issues]
    setattr(obj, PROPERTY, json.dumps(rows))


def file_issues(obj: Any) -> list[Issue]:
    """The notes on the files of an object's sources, each once."""
    issues: dict[Issue, None] = {}
    for source in obj.OutListRecursive:
        for level, code, text_parts in json.loads(getattr(source, PROPERTY, "") or "[]"):
            issues[Issue(level, code, text_of(text_parts))] = None
    return list(issues)
