# SPDX-License-Identifier: LGPL-2.1-or-later
"""Check that stored results match the current document and files. All exports run this check."""

from __future__ import annotations

from typing import Any

import FreeCAD as App

from ..core.issues import AmError, InputError, Text
from .results.findings import message_of, reason_of
from .results.fingerprints import is_of_earlier_version
from .shapes.containers import containers_of, members_of
from .stage import stage_of
from .staleness import FAILED, INFEASIBLE, STALE, is_outdated


def check_current(obj: Any, code: str = "NO_RESULT", template: str = "") -> None:
    """Check that the results of a stage and of its input stages match the current inputs.

    Parameters
    ----------
    obj : App.DocumentObject
        A stage with a result.
    code : str
        Error code.
    template : str
        Error message about `obj`, with one placeholder for the reason. If empty, the message is
        about the first outdated stage.

    Raises
    ------
    InputError
        If an input was changed, was not recomputed, or was deleted.
    """
    for stage_object in _chain(obj):
        if reason := reason_outdated(stage_object):
            if template:
                raise InputError(code, obj.Label, template, reason)
            raise InputError(
                code,
                stage_object.Label,
                "the result does not match its inputs ({}); recompute the object first",
                reason,
            )
    check_recomputed(obj, code)


def reason_outdated(obj: Any) -> str:
    """Return why the stored result of a stage does not match its inputs, '' if it matches."""
    if obj.Status in (STALE, FAILED):
        return message_of(obj) or str(obj.Status)
    try:
        fits = obj.Proxy.key(obj) == obj.Key
    except AmError as error:
        return error.sentence
    if fits:
        return ""
    if obj.Status == INFEASIBLE:
        return message_of(obj)
    if is_of_earlier_version(obj):
        return Text("an earlier version computed the result; read Migrating in the changelog")
    return Text("{}: an input changed after the computation", obj.Label)


def is_stale(obj: Any) -> bool:
    """Whether a stage result is older than its inputs. Infeasible stages are not stale."""
    return obj.Status == STALE or is_outdated(obj)


def reason_stale(obj: Any) -> str:
    """Return why a stage is not up to date.

    If the stage waits for a stale input stage, return the reason of the first stale stage.
    """
    if obj.Status == STALE:
        stale_stage = next((stage for stage in _chain(obj) if stage.Status == STALE), obj)
        if stale_stage != obj:
            return Text("{}: {}", stale_stage.Label, message_of(stale_stage))
    return reason_of(obj)


def check_recomputed(obj: Any, code: str = "NO_RESULT") -> None:
    """Check that FreeCAD has recomputed all source objects of a stage.

    Raises InputError `code`, naming the object that was not recomputed.
    """
    for source in _sources(obj):
        if "Touched" in source.State and not _is_from_another_version(source.Document):
            raise InputError(
                code,
                obj.Label,
                "{} was changed but not yet recomputed; recompute the document first",
                source.Label,
            )


def _chain(obj: Any) -> list[Any]:
    """Return a stage and its input stages, inputs first."""
    stages = [member for member in (obj, *obj.OutListRecursive) if stage_of(member) is not None]
    return sorted(stages, key=lambda stage: len(stage.OutListRecursive))


def _sources(obj: Any) -> list[Any]:
    """Return the objects, other than stages, that a stage depends on.

    These are source objects, their containers, and objects in the containers' expressions.
    """
    inputs = [member for member in obj.OutListRecursive if stage_of(member) is None]
    around = [outer for member in inputs for outer in containers_of(member)]
    placing = [
        member for outer in around for member in outer.OutList if member not in members_of(outer)
    ]
    return list(dict.fromkeys((*inputs, *around, *placing)))


def _is_from_another_version(document: Any) -> bool:
    """Whether another FreeCAD version saved a document.

    In such a document, objects with newly added properties count as touched.
    """
    saved = str(document.getProgramVersion()) if document.FileName else ""
    return bool(saved) and not saved.startswith(".".join(App.Version()[:2]))
