# SPDX-License-Identifier: LGPL-2.1-or-later
"""Mark stages as stale immediately after a change, before any recompute."""

from __future__ import annotations

import functools
from typing import Any

import FreeCAD as App

from ..core.issues import AmError, Text
from .results.findings import say
from .shapes.containers import dependents_of

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

LEFT_OUT = "FreeCAD left the object out of the recompute; if the object is frozen, unfreeze it (Toggle Freeze in the tree), then recompute"


def changed(obj: Any, name: str) -> None:
    """Mark a stage whose property `name` changed, and all dependent stages, as stale."""
    document = obj.Document
    if (
        document is None
        or document.Restoring
        or document.Transacting
        or "Output" in obj.getTypeOfProperty(name)
    ):
        return
    _mark(obj, name)
    for follower in obj.InListRecursive:
        if hasattr(follower, "ResultLayout"):
            _mark(follower, obj.Label)


def watch() -> None:
    """Watch documents for changes of source shapes; once per session."""
    document_observer()


@functools.cache
def document_observer() -> _Observer:
    """Return the observer of all documents."""
    observer = _Observer()
    App.addDocumentObserver(observer)
    return observer


class _Observer:
    """Mark stages whose linked objects change or move.

    FreeCAD does not notify a stage when a linked object changes or its container moves.
    """

    def slotChangedObject(self, obj: Any, name: str) -> None:
        if name in RESULTS or hasattr(obj, "ResultLayout") or not hasattr(obj, "InList"):
            return
        document = obj.Document
        if (
            not (document.Restoring or document.Transacting or document.Recomputing)
            and "Touched" in obj.State
        ):
            _mark_followers(obj)

    def slotBeforeRecomputeDocument(self, document: Any) -> None:
        """Mark stages whose inputs changed unnoticed, such as frozen objects and files."""
        _mark_outdated(document)
        _forget_runs(document)

    def slotRecomputedDocument(self, document: Any) -> None:
        """Report missing inputs and skipped stages, and run outdated stages.

        FreeCAD does not run stages after a failed object, such as a broken link. Stages in
        documents that link to `document` are marked and wait for their own document's recompute.
        """
        for obj in document.Objects:
            if hasattr(obj, "ResultLayout") and obj.Status == STALE and obj.Proxy.missing(obj):
                _mark(obj, "")
            elif hasattr(obj, "ResultLayout") and _is_left_out(obj):
                say(obj, STALE, Text(LEFT_OUT))
        _run_outdated(document)
        for follower in document.InList:
            _mark_outdated(follower)
        _forget_runs(document)  # FreeCAD 1.1 does not call slotBeforeRecomputeDocument


def _mark_followers(obj: Any) -> None:
    """Mark stages made from an object, and outdated stages in containers that the object moves."""
    followers, placed = dependents_of(obj)
    for follower in followers:
        if hasattr(follower, "ResultLayout"):
            _mark(follower, obj.Label)
    for follower in placed:
        if hasattr(follower, "ResultLayout") and is_outdated(follower):
            _mark(follower, obj.Label)
            for later in follower.InListRecursive:
                if hasattr(later, "ResultLayout"):
                    _mark(later, obj.Label)


def _mark_outdated(document: Any) -> list[Any]:
    """Mark the stages of a document whose inputs have changed since their result was computed.

    Mark their dependent stages too. Return all marked stages.
    """
    marked: dict[Any, None] = {}
    for obj in document.Objects:
        if hasattr(obj, "ResultLayout") and is_outdated(obj):
            for stage in (obj, *obj.InListRecursive):
                if hasattr(stage, "ResultLayout"):
                    _mark(stage, obj.Label)
                    marked[stage] = None
    return list(marked)


def _run_outdated(document: Any) -> None:
    """Run the stages that a recompute left with results of outdated inputs.

    FreeCAD may run a stage before an expression moves the container of its part, and FreeCAD 1.1
    does not query stages again before a recompute. After a partial recompute, FreeCAD runs the
    stages that are still touched.
    """
    stages = [obj for obj in _mark_outdated(document) if obj.Document == document]
    for obj in sorted(stages, key=lambda stage: len(stage.OutListRecursive)):
        if "Touched" not in obj.State:
            obj.recompute()


def _forget_runs(document: Any) -> None:
    """Reset the flag that the last recompute ran a stage, for all stages of a document."""
    for obj in document.Objects:
        if hasattr(obj, "ResultLayout"):
            obj.Proxy.was_run = False


def is_outdated(obj: Any) -> bool:
    """Whether a stage has the status UP_TO_DATE although its inputs have changed."""
    if obj.Status != UP_TO_DATE or not obj.Key:
        return False
    try:
        return bool(obj.Proxy.key(obj) != obj.Key)
    except AmError:
        return False  # the next recompute reports the error


def _is_left_out(obj: Any) -> bool:
    """Whether a recompute skipped a stale stage although all its inputs are valid.

    FreeCAD 1.0 skips frozen objects and does not expose which objects are frozen.
    """
    if obj.Status != STALE or obj.Proxy.was_run:
        return False
    inputs = obj.OutListRecursive
    waits = any(
        getattr(stage_input, "Status", "") in (STALE, FAILED, INFEASIBLE) for stage_input in inputs
    )
    return not waits and not any("Invalid" in stage_input.State for stage_input in inputs)


def _mark(obj: Any, cause: str) -> None:
    obj.Proxy.changes += 1
    missing = obj.Proxy.missing(obj)
    status, message = (
        (FAILED, missing) if missing else (STALE, Text("{} changed; recompute the object", cause))
    )
    if obj.Status != status or (missing and obj.Message != missing):
        say(obj, status, message)
