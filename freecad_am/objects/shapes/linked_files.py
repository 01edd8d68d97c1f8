# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents linked by a FreeCAD document: missing documents, and documents changed after it was
saved.
"""

from __future__ import annotations

import os
import zipfile
import zlib
from collections.abc import Iterable
from typing import Any
from xml.parsers import expat

import FreeCAD as App

from ...brep.files.sandbox import read_in_sandbox
from ...core.issues import InputError, Text
from ..stage import deferred
from .file_links import linked_files, missing_files
from .places import dependencies_of

CHUNK = 1 << 16
LONGEST_HEAD = 1 << 20  # bytes of an XML before its first element


def opened(path: str, where: str) -> Any:
    """Open a document hidden; the caller closes it. Raises InputError BAD_FILE at `where`.

    A process without a window, with limits of time and memory, opens the document first.
    """
    refuse(path, where)
    read_in_sandbox(_try, path, where)
    return open_here(path, where)


def open_here(path: str, where: str) -> Any:
    """Open a document as `opened`, without the separate process."""
    refuse(path, where)
    try:
        return App.openDocument(path, True)
    except (OSError, RuntimeError, ValueError, AttributeError):
        raise InputError(
            "BAD_FILE", where, "the file cannot be read as a FreeCAD document; save it again"
        ) from None


def _try(path: str, where: str) -> None:
    open_here(path, where)


def refuse(path: str, where: str) -> None:
    """Reject files that are not FreeCAD documents, and XML with a document type.

    Entities of a document type can expand beyond the memory, and FreeCAD expands them. Raises
    InputError BAD_FILE.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            if "Document.xml" not in names:
                raise InputError(
                    "BAD_FILE",
                    where,
                    "the file cannot be read as a FreeCAD document; save it again",
                )
            for name in names:
                if name.lower().endswith(".xml"):
                    _refuse_doctype(archive, name, where)
    except (
        OSError,
        ValueError,
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        NotImplementedError,
        RuntimeError,
    ):
        raise InputError(
            "BAD_FILE", where, "the file cannot be read as a FreeCAD document; save it again"
        ) from None


class _Begun(Exception):
    """Raised at the first element of an XML, after the place of a document type."""


def _refuse_doctype(archive: zipfile.ZipFile, name: str, where: str) -> None:
    parser = expat.ParserCreate()

    def on_doctype(*_: object) -> None:
        raise _Begun

    def refused(*_: object) -> None:
        message = Text(
            "{} in the file has a document type, which FreeCAD documents never have, and is not "
            "read; save the document again",
            name,
        )
        raise InputError("BAD_FILE", where, message)

    parser.StartElementHandler, parser.StartDoctypeDeclHandler = on_doctype, refused
    with archive.open(name) as stream:
        try:
            size = 0
            while size <= LONGEST_HEAD and (chunk := stream.read(CHUNK)):
                parser.Parse(chunk, False)
                size += len(chunk)
        except (_Begun, expat.ExpatError):  # FreeCAD reports other faults
            return
    if size > LONGEST_HEAD:
        raise InputError(
            "BAD_FILE", where, "{} in the file does not begin as XML; save the document again", name
        )


def refuse_missing(source: Any, where: str) -> None:
    """Reject an object made from the content of a missing file. Raises InputError NO_LINKED_FILE."""
    needs = dependencies_of(source)
    for document in needs.documents:
        missing = missing_files(document)
        for obj in (*needs.objects, *needs.containers):
            if obj.Document == document and obj.Name in missing:
                raise no_linked_file(where, obj.Label, missing[obj.Name])


def refuse_missing_of(stage: Any, where: str) -> None:
    """Reject a stage with an input made from the content of a missing file.

    Raises InputError NO_LINKED_FILE.
    """
    inputs = stage.OutListRecursive
    for document in dict.fromkeys(entry.Document for entry in inputs):
        missing = missing_files(document)
        for entry in inputs:
            if entry.Document == document and entry.Name in missing:
                raise no_linked_file(where, entry.Label, missing[entry.Name])


def no_linked_file(where: str, label: str, file: str) -> InputError:
    """Return the error for an object that links to a missing file."""
    return InputError(
        "NO_LINKED_FILE",
        where,
        "{} links to {}, which does not exist; restore the file, or change the link in FreeCAD",
        label,
        file,
    )


def renew_changed(document: Any) -> list[Any]:
    """Recompute objects made from documents that changed after `document` was saved; return the
    objects that link to them.

    FreeCAD keeps the old shapes: it marks links as touched, but not objects with an expression.
    Linked documents come first. Stages of the workbench stay as they are.
    """
    renewed: dict[Any, None] = {}
    linking = []
    for linked_document in in_order(document):
        changed = [
            obj for obj in linked_document.Objects if _is_outdated(obj, linked_document, renewed)
        ]
        changed += [obj for obj in _links_to_changed_files(linked_document) if obj not in changed]
        for obj in changed:
            obj.touch()
        if changed:
            with deferred():
                linked_document.recompute()
            renewed[linked_document] = None
            linking += changed
    return linking


def _is_outdated(obj: Any, document: Any, renewed: Iterable[Any]) -> bool:
    """Whether FreeCAD has marked a linked object of another document as changed, or as just
    computed.
    """
    outside = [
        linked for linked in obj.OutList if linked is not None and linked.Document != document
    ]
    is_marked = "Touched" in obj.State and "Invalid" not in obj.State
    return bool(outside) and (is_marked or any(linked.Document in renewed for linked in outside))


def _links_to_changed_files(document: Any) -> list[Any]:
    """Return the objects that link to a document saved after this document."""
    if not document.FileName:
        return []
    saved = {
        os.path.realpath(open_document.FileName): open_document.LastModifiedDate
        for open_document in App.listDocuments().values()
        if open_document.FileName
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
    """Whether a linked file was written after a document that was saved in the same second.

    FreeCAD stores the time of saving in seconds.
    """
    if document.LastModifiedDate != stamp:
        return False
    try:
        return os.stat(file).st_mtime_ns > os.stat(document.FileName).st_mtime_ns
    except OSError:
        return False


def in_order(document: Any, visited: Iterable[Any] = ()) -> list[Any]:
    """Return a document and its linked documents, each after its own linked documents."""
    linked = dict.fromkeys(
        linked_object.Document
        for obj in document.Objects
        for linked_object in obj.OutList
        if linked_object is not None
    )
    order: list[Any] = []
    for linked_document in linked:
        if linked_document != document and linked_document not in visited:
            order += [
                entry
                for entry in in_order(linked_document, (*visited, document))
                if entry not in order
            ]
    return [*order, document]
