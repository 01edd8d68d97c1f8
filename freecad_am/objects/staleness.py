# SPDX-License-Identifier: LGPL-2.1-or-later
"""Marks what follows a change as stale, at once and before any recompute."""

from __future__ import annotations

from typing import Any

import FreeCAD as App

from ..core.issues import Text
from .results.findings import say

UP_TO_DATE, STALE, FAILED, INFEASIBLE = "up to date", "stale", "failed", "infeasible"
STATUSES = (UP_TO_DATE, STALE, FAILED, INFEASIBLE)

# properties that are not inputs
RESULTS = frozenset(
    {
        "Status",
        "Message",
        "Issues",
        "Texts",
        "Key",
        "Seconds",
        "ResultData",
        "ResultLayout",
        "SchemaVersion",
        "Proxy",
        "Label",
        "Label2",
        "Visibility",
    }
)

_observer: _Observer | None = None


def changed(obj: Any, name: str) -> None:
    """Mark a stage, after its property `name` changed, and all that follows as stale."""
    document = obj.Document
    if (
        document is None
        or document.Restoring
        or document.Transacting
        or "Output" in obj.getTypeOfProperty(name)
    ):
        return
    _mark(obj, name)
    _mark_followers(obj)


def watch() -> None:
    """Watch the documents for changes of shapes that features grow on; once per session."""
    global _observer
    if _observer is None:
        _observer = _Observer()
        App.addDocumentObserver(_observer)


class _Observer:
    """FreeCAD tells a stage nothing when an object it links to changes."""

    def slotChangedObject(self, obj: Any, name: str) -> None:
        if name in RESULTS or hasattr(obj, "ResultLayout") or not getattr(obj, "InList", None):
            return
        document = obj.Document
        if (
            not (document.Restoring or document.Transacting or document.Recomputing)
            and "Touched" in obj.State
        ):
            _mark_followers(obj)

    def slotRecomputedDocument(self, document: Any) -> None:
        """FreeCAD does not run what follows an object that failed, such as a link to nothing: tell what is missing."""
        for obj in document.Objects:
            if hasattr(obj, "ResultLayout") and obj.Status == STALE and obj.Proxy.missing(obj):
                _mark(obj, "")


def _mark_followers(obj: Any) -> None:
    for follower in obj.InListRecursive:
        if hasattr(follower, "ResultLayout"):
            _mark(follower, obj.Label)


def _mark(obj: Any, cause: str) -> None:
    obj.Proxy.changes += 1
    missing = obj.Proxy.missing(obj)
    status, message = (
        (FAILED, missing) if missing else (STALE, Text("{} changed; recompute", cause))
    )
    if obj.Status != status or (missing and obj.Message != missing):
        say(obj, status, message)
