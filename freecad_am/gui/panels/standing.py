# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a stage stands, and what failed of those that follow it, in the words of a panel."""

from __future__ import annotations

from typing import Any

from ... import api
from ...core.issues import summarised
from ...objects.results.findings import issues_of, message_of, reason_of
from ...objects.staleness import FAILED, INFEASIBLE
from ..texts.translation import tr, translated

MOST_ISSUES = 6


def own_lines(obj: Any) -> list[str]:
    """The status of a stage, its message and its findings."""
    found = summarised(issues_of(obj))
    message = [translated(message_of(obj))] if obj.Message and not found else []
    lines = [
        tr("{}: {}").format(
            " ".join(filter(None, (translated(issue.level), translated(issue.where)))),
            translated(issue.message),
        )
        for issue in found
    ]
    return [tr("Status: {}").format(translated(obj.Status)), *message, *_first(lines)]


def lines_of_followers(obj: Any) -> list[str]:
    """Which of the stages that follow failed or cannot be carried out, and why; none that only waits for another one."""
    followers = set(obj.InListRecursive)
    wrong = [
        one
        for one in api.stages_of(obj.Document)
        if one.Status in (FAILED, INFEASIBLE) and (one is obj or one in followers)
    ]
    first = [one for one in wrong if one is not obj and not set(one.OutListRecursive) & set(wrong)]
    texts = {FAILED: tr("{} failed: {}"), INFEASIBLE: tr("{} is infeasible: {}")}
    return _first(
        [texts[one.Status].format(one.Label, translated(reason_of(one))) for one in first]
    )


def _first(lines: list[str]) -> list[str]:
    """As many lines as there is room for, and how many more there are."""
    left = len(lines) - MOST_ISSUES
    return lines if left <= 0 else [*lines[:MOST_ISSUES], tr("and {} more").format(left)]
