# SPDX-License-Identifier: LGPL-2.1-or-later
"""Other documents that a FreeCAD document links to: those that are missing, and those that changed since it was saved."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import FreeCAD as App

from ...core.issues import InputError
from ..stage import deferred
from .file_links import linked_files, missing_files
from .places import dependencies_of


def refuse_missing(source: Any, where: str) -> None:
    """Reject an object that is made from something in a file that is not there. InputError NO_LINKED_FILE."""
    needs = dependencies_of(source)
    for document in needs.documents:
        missing = missing_files(document)
        for obj in (*needs.objects, *needs.containers):
            if obj.Document == document and obj.Name in missing:
                raise no_linked_file(where, obj.Label, missing[obj.Name])


def refuse_missing_of(stage: Any, where: str) -> None:
    """Reject a stage of which an input is made from something in a file that is not there. InputError NO_LINKED_FILE."""
    inputs = stage.OutListRecursive
    for document in dict.fromkeys(one.Document for one in inputs):
        missing = missing_files(document)
        for one in inputs:
            if one.Document == document and one.Name in missing:
                raise no_linked_file(where, one.Label, missing[one.Name])


def no_linked_file(where: str, label: str, file: str) -> InputError:
    """The error about an object that links to a file that is not there."""
    return InputError(
        "NO_LINKED_FILE",
        where,
        "{} links to {}, which is not there; put the file there, or change the link in FreeCAD",
        label,
        file,
    )


def renew_changed(document: Any) -> list[Any]:
    """Recompute what is made from documents that changed after this one was saved; the objects that link to those.

    FreeCAD keeps the old shapes: it marks links as touched, and not what has an expression. Linked documents come first.
    Stages of this workbench are left as they are.
    """
    renewed: dict[Any, None] = {}
    linking = []
    for one in in_order(document):
        changed = [obj for obj in one.Objects if _is_outdated(obj, one, renewed)]
        changed += [obj for obj in _of_changed_files(one) if obj not in changed]
        for obj in changed:
            obj.touch()
        if changed:
            with deferred():
                one.recompute()
            renewed[one] = None
            linking += changed
    return linking


def _is_outdated(obj: Any, document: Any, renewed: Iterable[Any]) -> bool:
    """Whether FreeCAD has marked what an object links to in another document as changed, or that was just computed."""
    outside = [other for other in obj.OutList if other is not None and other.Document != document]
    is_marked = "Touched" in obj.State and "Invalid" not in obj.State
    return bool(outside) and (is_marked or any(other.Document in renewed for other in outside))


def _of_changed_files(document: Any) -> list[Any]:
    """The objects that link to a document that was saved again after this one was."""
    if not document.FileName:
        return []
    saved = {
        os.path.realpath(one.FileName): one.LastModifiedDate
        for one in App.listDocuments().values()
        if one.FileName
    }
    changed = []
    for name, files in linked_files(document.FileName).items():
        obj = document.getObject(name)
        stamps = [(file, saved.get(os.path.realpath(file), stamp), stamp) for file, stamp in files]
        if obj is not None and any(
            now != stamp or _is_saved_later(file, stamp, document)
            for file, now, stamp in stamps
            if stamp
        ):
            changed.append(obj)
    return changed


def _is_saved_later(file: str, stamp: str, document: Any) -> bool:
    """Whether a linked file was written after a document that was saved in the same second: FreeCAD knows no more than the
    second of saving."""
    if document.LastModifiedDate != stamp:
        return False
    try:
        return os.stat(file).st_mtime_ns > os.stat(document.FileName).st_mtime_ns
    except OSError:
        return False


def in_order(document: Any, known: Iterable[Any] = ()) -> list[Any]:
    """A document and those that it links to, each after all that it links to."""
    linked = dict.fromkeys(
        other.Document for obj in document.Objects for other in obj.OutList if other is not None
    )
    order: list[Any] = []
    for one in linked:
        if one != document and one not in known:
            order += [found for found in in_order(one, (*known, document)) if found not in order]
    return [*order, document]
