# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents and paths as macros give them: anything else in their place is refused before something is done with it."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App

from ..core.issues import InputError


def checked_document(doc: Any, where: str = "doc") -> Any:
    """The document. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not isinstance(doc, App.Document):
        raise InputError("BAD_INPUT", where, "{} is not a document; give one, such as FreeCAD.ActiveDocument", _named(doc))
    return doc


def checked_path(path: Any, where: str) -> str:
    """The path of a file or folder as a text. InputError BAD_INPUT for anything else, by the name of the argument."""
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    if not isinstance(text, str):
        raise InputError("BAD_INPUT", where, "{} is not a path; give one as a text, such as \"cup.step\"", _named(path))
    return text


def _named(value: Any) -> str:
    """What a value is called in a message: objects and documents by their label, which are else told by their address."""
    return getattr(value, "Label", None) or repr(value)
