# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of the core in another language: their templates are translated, and their values put in."""

from __future__ import annotations

from collections.abc import Callable

from ...core.issues import Text

KINDS = ("cell", "feature", "toolpath", "program", "inspection")  # stages, as messages call them


def in_language(text: str, translate: Callable[[str], str]) -> str:
    """A text in another language, `translate` giving that of a template; itself where there is none. Values are put in as
    they are written, those that are texts of ours in that language too."""
    template = (
        text.template if isinstance(text, Text) else text.replace("{", "{{").replace("}", "}}")
    )
    key = template.strip()
    values = (_value(value, translate) for value in text.values) if isinstance(text, Text) else ()
    return template.replace(key, translate(key), 1).format(*values) if key else text


def _value(value: str, translate: Callable[[str], str]) -> str:
    """What is put into a text: one of ours, else a name or a number, which stay."""
    return (
        in_language(value, translate)
        if isinstance(value, Text) or " " in value or value in KINDS
        else value
    )


def names_first(text: str) -> bool:
    """Whether a text begins with a name, of a part or a file, which is written as it is."""
    if not isinstance(text, Text) or not text.template.startswith("{0}"):
        return False
    first = text.values[0]
    return names_first(first) if isinstance(first, Text) else first not in KINDS
