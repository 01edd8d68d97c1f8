# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD documents from outside, opened where reading them has come to an end before."""

from __future__ import annotations

import zipfile
import zlib
from typing import Any
from xml.parsers import expat

import FreeCAD as App

from ...brep.files.apart import read_apart
from ...core.issues import InputError, Text

CHUNK = 1 << 16
LONGEST_HEAD = 1 << 20  # bytes of an XML before its first element


def opened(path: str, where: str) -> Any:
    """A document, hidden, which is the caller's to close. InputError BAD_FILE at `where`.

    Without a window it has been opened before in a process of its own, with limits of time and memory.
    """
    refuse(path, where)
    read_apart(_try, path, where)
    return open_here(path, where)


def open_here(path: str, where: str) -> Any:
    """As `opened`, at once."""
    refuse(path, where)
    try:
        return App.openDocument(path, True)
    except (OSError, RuntimeError, ValueError, AttributeError):
        raise InputError(
            "BAD_FILE", where, "it cannot be read as a FreeCAD document; save it again"
        ) from None


def _try(path: str, where: str) -> None:
    open_here(path, where)


def refuse(path: str, where: str) -> None:
    """Reject files that are not FreeCAD documents, and XML with a document type: its entities can
    expand beyond the memory, and FreeCAD expands them. InputError BAD_FILE.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            if "Document.xml" not in names:
                raise InputError(
                    "BAD_FILE", where, "it cannot be read as a FreeCAD document; save it again"
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
            "BAD_FILE", where, "it cannot be read as a FreeCAD document; save it again"
        ) from None


class _Begun(Exception):
    """The first element of an XML is there, before which its document type would be."""


def _refuse_doctype(archive: zipfile.ZipFile, name: str, where: str) -> None:
    parser = expat.ParserCreate()

    def on_doctype(*_: object) -> None:
        raise _Begun

    def refused(*_: object) -> None:
        message = Text(
            "{} in it has a document type, which FreeCAD documents never have, and is not read; "
            "save it again",
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
        raise InputError("BAD_FILE", where, "{} in it does not begin as XML; save it again", name)
