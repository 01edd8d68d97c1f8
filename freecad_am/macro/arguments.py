# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents and paths as macros give them: anything else in their place is refused before something is done with it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

import FreeCAD as App

from ..core.issues import InputError, Text


def checked_document(doc: Any, where: str = "doc") -> Any:
    """The document. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not isinstance(doc, App.Document) or _is_gone(doc):
        raise InputError("BAD_INPUT", where, "{} is not a document; give one, such as FreeCAD.ActiveDocument", _named(doc))
    return doc


def checked_object(value: Any, where: str, doc: Any = None) -> Any:
    """The object, of a document where that is given. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not isinstance(value, App.DocumentObject) or _is_gone(value):
        raise InputError("BAD_INPUT", where, "{} is not an object of a document; give one, such as doc.Body", _named(value))
    if doc is not None and value.Document != doc:
        raise InputError("BAD_INPUT", where, "{} is an object of another document, {}; give one of {}, such as a copy of it",
                         value.Label, value.Document.Label, doc.Label)
    return value


def checked_objects(values: Any, where: str, doc: Any = None) -> list[Any]:
    """The objects of a list; none of None. InputError BAD_INPUT as `checked_object`."""
    if values is None:
        return []
    if not isinstance(values, Iterable) or isinstance(values, (str, bytes, Mapping)):
        raise InputError("BAD_INPUT", where, "{} is not a list of objects; give one, such as [doc.Clamp]", _named(values))
    return [checked_object(value, where, doc) for value in values]


def checked_names(names: Any, where: str) -> list[str]:
    """Names of faces and edges; a text is one name, and None is none. InputError BAD_INPUT for anything else."""
    found = [names] if isinstance(names, str) else [] if names is None else names
    if not isinstance(found, (list, tuple, set, frozenset)) or not all(isinstance(name, str) for name in found):
        raise InputError("BAD_INPUT", where, "{} are not names of faces or edges; give a list of texts, such as "
                         "[\"Face1\"]", _named(names))
    return list(found)


def checked_text(value: Any, where: str) -> str:
    """The text. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not isinstance(value, str):
        raise InputError("BAD_INPUT", where, "{} is not a text; give one in quotes", _named(value))
    return value


def checked_path(path: Any, where: str) -> str:
    """The path of a file or folder as a text. InputError BAD_INPUT for anything else, by the name of the argument."""
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    if not isinstance(text, str):
        raise InputError("BAD_INPUT", where, "{} is not a path; give one as a text, such as \"cup.step\"", _named(path))
    return text


def _is_gone(value: Any) -> bool:
    """Whether a document was closed, or an object deleted."""
    try:
        return not value.Name
    except ReferenceError:
        return True


def _named(value: Any) -> str:
    """What a value is called in a message: objects and documents by their label, which are else told by their address."""
    try:
        return str(getattr(value, "Label", None) or repr(value))
    except ReferenceError:  # which has no name any more
        return Text("what was deleted")
