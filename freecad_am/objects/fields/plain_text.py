# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts that properties of FreeCAD can have."""

from __future__ import annotations

from typing import Any

from ...core.issues import InputError, Text


def is_text(value: Any) -> bool:
    """Whether a value is a text that FreeCAD takes: it falls over halves of characters, and ends texts at a zero."""
    return (
        isinstance(value, str)
        and "\0" not in value
        and not any("\ud800" <= sign <= "\udfff" for sign in value)
    )


def checked_words(words: Any, where: str) -> list[str]:
    """A list of texts. InputError BAD_VALUE naming `where` for anything else."""
    if not isinstance(words, (list, tuple)) or not all(map(is_text, words)):
        raise InputError("BAD_VALUE", where, "{} is not a text; put it in quotes", safe_repr(words))
    return list(words)


def safe_repr(value: Any) -> str:
    """A value in a message, where it may be of an object that is gone and cannot even be named."""
    try:
        return repr(value)
    except ReferenceError:
        return Text("the deleted object")
