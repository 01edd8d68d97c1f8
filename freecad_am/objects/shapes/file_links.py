# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of a saved FreeCAD document to other documents, read from its file."""

from __future__ import annotations

import os
import zipfile
import zlib
from typing import Any
from xml.parsers import expat

SUFFIX = ".fcstd"


def linked_files(path: str) -> dict[str, list[tuple[str, str]]]:
    """Return the linked documents of each object of a document file, by object name.

    A document is given by its absolute path and the time when it was saved last before this
    document. Links in expressions count too. Empty for an unreadable file: opening it reports the
    reason.
    """
    files: dict[str, list[tuple[str, str]]] = {}
    folder = os.path.dirname(os.path.abspath(path))
    owner = ""
    in_data = False

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal owner, in_data
        in_data = in_data or tag == "ObjectData"
        if in_data and tag == "Object":
            owner = attributes.get("name", "")
        file = attributes.get("file", "")
        if owner and file.lower().endswith(SUFFIX):
            target = os.path.normpath(os.path.join(folder, file))
            files.setdefault(owner, []).append((target, attributes.get("stamp", "")))

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    try:
        with zipfile.ZipFile(path) as archive, archive.open("Document.xml") as stream:
            parser.ParseFile(stream)
    except (OSError, KeyError, ValueError, zipfile.BadZipFile, zlib.error, expat.ExpatError):
        return {}
    return files


def missing_files(document: Any) -> dict[str, str]:
    """Return the first missing linked file of each object of an open document, by object name."""
    if not document.FileName:
        return {}
    missing = {}
    for name, files in linked_files(document.FileName).items():
        absent = [file for file, _ in files if not os.path.isfile(file)]
        if absent:
            missing[name] = absent[0]
    return missing
