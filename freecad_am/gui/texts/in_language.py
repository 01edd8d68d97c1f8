# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of the core in another language: their templates are translated, and their values put in."""

from __future__ import annotations

from collections.abc import Callable

from ...core.issues import Text
from ...core.quantities import is_example, put_values

KINDS = ("cell", "feature", "toolpath", "program", "inspection")  # stages, as messages call them


def in_language(
    text: str, translate: Callable[[str], str], in_units: Callable[[str], str] | None = None
) -> str:
    """A text in another language and other units.

    Parameters
    ----------
    text : str
    translate : callable
        Returns the translation of a template; the template itself where there is none.
    in_units : callable, optional
        Returns a text of numbers with the quantities in it in other units. None: quantities stay as they are.

    Returns
    -------
    str
        Values are put in as they are written, those that are texts of ours in that language too. Values that are names stay
        whatever is in them.
    """
    template = (
        text.template if isinstance(text, Text) else text.replace("{", "{{").replace("}", "}}")
    )
    key = template.strip()
    if not key:
        return text
    values = (
        [_value(value, translate, in_units) for value in text.values]
        if isinstance(text, Text)
        else []
    )
    translation = template.replace(key, translate(key), 1)
    if in_units is None or is_example(key):
        return translation.format(*values)
    return put_values(translation, values, in_units)


def _value(
    value: str, translate: Callable[[str], str], in_units: Callable[[str], str] | None
) -> str:
    """What is put into a text: one of ours, else a name or a number, which stay."""
    if isinstance(value, Text):
        return in_language(value, translate, in_units)
    return in_language(value, translate) if " " in value or value in KINDS else value


def names_first(text: str) -> bool:
    """Whether a text begins with a name, of a part or a file, which is written as it is."""
    if not isinstance(text, Text) or not text.template.startswith("{0}"):
        return False
    first = text.values[0]
    return names_first(first) if isinstance(first, Text) else first not in KINDS
