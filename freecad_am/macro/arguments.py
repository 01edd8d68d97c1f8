# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents and paths as macros give them: anything else in their place is refused before something is done with it."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Iterable, Mapping
from typing import Any

import FreeCAD as App

from ..core.issues import InputError
from ..objects.fields.plain_text import is_text, safe_repr


def checked_document(doc: Any, where: str = "doc") -> Any:
    """The document. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not isinstance(doc, App.Document) or is_gone(doc):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not a document; pass one, such as FreeCAD.ActiveDocument",
            named(doc),
        )
    return doc


def checked_object(value: Any, where: str, doc: Any = None) -> Any:
    """The object, of a document where that is given. InputError BAD_INPUT for anything else, by the name of the argument."""
    if isinstance(value, (tuple, list)) and value and isinstance(value[0], App.DocumentObject):
        raise InputError(
            "BAD_INPUT",
            where,
            "it takes a single object; pass it, and the names of its faces separately",
        )
    if not isinstance(value, App.DocumentObject) or is_gone(value):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not an object of a document; pass one, such as doc.Body",
            named(value),
        )
    if doc is not None and value.Document != doc:
        raise InputError(
            "BAD_INPUT",
            where,
            "{} belongs to another document, {}; pass an object of {}, such as a copy",
            value.Label,
            value.Document.Label,
            doc.Label,
        )
    return value


def checked_objects(values: Any, where: str, doc: Any = None) -> list[Any]:
    """The objects of a list; none of None. InputError BAD_INPUT as `checked_object`."""
    if values is None:
        return []
    if not isinstance(values, Iterable) or isinstance(values, (str, bytes, Mapping)):
        raise InputError(
            "BAD_INPUT",
            where,
            "{} is not a list of objects; pass one, such as [doc.Clamp]",
            named(values),
        )
    return [checked_object(value, where, doc) for value in values]


def checked_names(names: Any, where: str) -> list[str]:
    """Names of faces and edges; a text is one name, and None is none. InputError BAD_INPUT for anything else."""
    found = [names] if isinstance(names, str) else [] if names is None else names
    if not isinstance(found, (list, tuple, set, frozenset)) or not all(map(is_text, found)):
        raise InputError(
            "BAD_INPUT",
            where,
            '{} are not names of faces or edges; pass a list of texts, such as ["Face1"]',
            named(names),
        )
    return list(found)


def checked_text(value: Any, where: str) -> str:
    """The text. InputError BAD_INPUT for anything else, by the name of the argument."""
    if not is_text(value):
        raise InputError("BAD_INPUT", where, "{} is not a text; put it in quotes", named(value))
    return value


def checked_number(value: Any, where: str) -> float:
    """The number. InputError BAD_INPUT for anything else, by the name of the argument."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or math.isnan(value):
        raise InputError("BAD_INPUT", where, "{} is not a number; pass one such as 2", named(value))
    return float(value)


def checked_keywords(values: Any, where: str) -> dict[str, Any]:
    """Values by key, none of None. InputError BAD_INPUT for anything else, by the name of the argument."""
    if values is None:
        return {}
    if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
        raise InputError(
            "BAD_INPUT", where, "{} is not a mapping of keys to values; pass one", named(values)
        )
    return dict(values)


def checked_list(values: Any, where: str) -> list[Any]:
    """The values of a list, none of None. InputError BAD_INPUT for anything else, by the name of the argument."""
    if values is None:
        return []
    if not isinstance(values, (list, tuple)):
        raise InputError(
            "BAD_INPUT", where, "{} is not a list; pass one, such as []", named(values)
        )
    return list(values)


def checked_target(path: Any, where: str) -> str:
    """As `checked_path`, of what is to be written: it has a name."""
    text = checked_path(path, where)
    if not text.strip():
        raise InputError(
            "BAD_INPUT",
            where,
            '{} is not a path; pass one as a text, such as "cup.step"',
            named(path),
        )
    return text


def checked_path(path: Any, where: str) -> str:
    """The path of a file or folder as a text. InputError BAD_INPUT for anything else, by the name of the argument."""
    text = os.fspath(path) if isinstance(path, os.PathLike) else path
    if not is_text(text):
        raise InputError(
            "BAD_INPUT",
            where,
            '{} is not a path; pass one as a text, such as "cup.step"',
            named(path),
        )
    return text


def checked_job(
    doc: Any, source: Any, process: Any, then: Any, mend: Any, **texts: Any
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Process and further features of `make_all`, whose other arguments that are no links are looked at too. InputError
    BAD_INPUT for any of another kind, by its name."""
    checked_document(doc)
    for key, text in texts.items():
        checked_text(text, key)
    checked_number(mend, "mend")
    if source is not None:
        checked_object(source, "source", doc)
    return checked_keywords(process, "process"), [
        checked_keywords(one, "then") for one in checked_list(then, "then")
    ]


def is_gone(value: Any) -> bool:
    """Whether a document was closed, or an object deleted."""
    try:
        return getattr(value, "Name", None) == ""
    except ReferenceError:
        return True


def named(value: Any) -> str:
    """What a value is called in a message: objects and documents by their label, which are else told by their address."""
    return (
        safe_repr(value)
        if is_gone(value)
        else str(getattr(value, "Label", None) or safe_repr(value))
    )
