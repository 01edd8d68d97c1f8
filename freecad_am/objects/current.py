# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether stored results fit the document and the files as they are now. All that writes a result asks here first."""

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
    """Check that the results of a stage and of its input stages fit the current inputs.

    Parameters
    ----------
    obj : App.DocumentObject
        A stage with a result.
    code : str
        The code of the error.
    template : str
        The message of the error with one place for the reason, about `obj` itself; else it is about the first stage that
        does not fit.

    Raises
    ------
    InputError
        Where an input was changed, was not recomputed, or is gone.
    """
    for stage_object in _chain(obj):
        if reason := reason_outdated(stage_object):
            if template:
                raise InputError(code, obj.Label, template, reason)
            raise InputError(
                code,
                stage_object.Label,
                "no result fits its inputs ({}); recompute it first",
                reason,
            )
    check_recomputed(obj, code)


def reason_outdated(obj: Any) -> str:
    """Why the stored result of a stage does not fit its inputs, '' where it does."""
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
        return Text("an earlier version computed it; read Migrating in the changelog")
    return Text("{}: an input changed after the computation", obj.Label)


def is_stale(obj: Any) -> bool:
    """Whether a stage shows an earlier state than its inputs; an infeasible stage shows the reason."""
    return obj.Status == STALE or is_outdated(obj)


def reason_stale(obj: Any) -> str:
    """Why a stage is not up to date: the reason of the first stale stage if it only waits for that
    one.
    """
    if obj.Status == STALE:
        stale_stage = next((stage for stage in _chain(obj) if stage.Status == STALE), obj)
        if stale_stage != obj:
            return Text("{}: {}", stale_stage.Label, message_of(stale_stage))
    return reason_of(obj)


def check_recomputed(obj: Any, code: str = "NO_RESULT") -> None:
    """Check that FreeCAD has recomputed all that a stage is made of.
    Raises InputError `code` naming the object that it has not."""
    for source in _sources(obj):
        if "Touched" in source.State and not _is_from_another_version(source.Document):
            raise InputError(
                code,
                obj.Label,
                "{} was changed but not yet recomputed; recompute the document first",
                source.Label,
            )


def _chain(obj: Any) -> list[Any]:
    """A stage and the stages that it is made of, inputs first."""
    stages = [member for member in (obj, *obj.OutListRecursive) if stage_of(member) is not None]
    return sorted(stages, key=lambda stage: len(stage.OutListRecursive))


def _sources(obj: Any) -> list[Any]:
    """The source objects (no stages) of a stage and its inputs, their containers, and the objects
    that the containers' expressions refer to.
    """
    inputs = [member for member in obj.OutListRecursive if stage_of(member) is None]
    around = [outer for member in inputs for outer in containers_of(member)]
    placing = [
        member for outer in around for member in outer.OutList if member not in members_of(outer)
    ]
    return list(dict.fromkeys((*inputs, *around, *placing)))


def _is_from_another_version(document: Any) -> bool:
    """Whether another version of FreeCAD saved a document: objects whose properties are new count as touched in it."""
    saved = str(document.getProgramVersion()) if document.FileName else ""
    return bool(saved) and not saved.startswith(".".join(App.Version()[:2]))
