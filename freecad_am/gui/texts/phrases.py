# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts with figures put in are recognised by the templates they were made from.

The core writes its messages in English, with the figures in them, and knows no language. Here a message is taken apart:
'Box is a mesh; a wall is of faces.' is the template '{0} is a mesh; a wall is of faces.' and the value 'Box'.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

_FIELD = re.compile(r"\{(\d+)\}")
_BREAK = re.compile(r"[:;.] ")


@dataclass(frozen=True)
class Template:
    """A text with the places {0}, {1} and so on for what is put in; braces of the text itself are doubled."""

    text: str

    @cached_property
    def literals(self) -> tuple[str, ...]:
        """What stands before, between and after the places."""
        return tuple(part.replace("{{", "{").replace("}}", "}") for part in _FIELD.split(self.text)[::2])

    @cached_property
    def fields(self) -> tuple[int, ...]:
        """The numbers of the places, in their order."""
        return tuple(map(int, _FIELD.findall(self.text)))

    @cached_property
    def weight(self) -> int:
        """How much it says by itself: of two templates that fit a text the heavier one is meant."""
        return len("".join(self.literals))

    @cached_property
    def key(self) -> str:
        """Its longest literal part, which every text made from it holds."""
        return max(self.literals, key=len)

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        return re.compile("(.*?)".join(map(re.escape, self.literals)), re.DOTALL)

    def values(self, text: str) -> dict[int, str] | None:
        """What was put into the places of a text; None where it was not made from this template."""
        found = self._pattern.fullmatch(text) if self.key in text else None
        return None if found is None else dict(zip(self.fields, found.groups(), strict=True))


class Phrases:
    """All templates, those that say most first."""

    def __init__(self, templates: Iterable[str], words: Iterable[str] = ()) -> None:
        """words: those of the templates without a place that are ours wherever they stand alone; others may be names."""
        self.words = frozenset(words)
        known = [Template(text) for text in dict.fromkeys(templates)]
        self.plain = {one.literals[0] for one in known if not one.fields}
        self.templates = sorted((one for one in known if one.fields), key=lambda one: -one.weight)

    def find(self, text: str) -> tuple[Template, dict[int, str]] | None:
        """The template of a text and what was put in; None for a text of none."""
        if text in self.plain:
            return Template(text.replace("{", "{{").replace("}", "}}")), {}
        for one in self.templates:
            values = one.values(text)
            if values is not None:
                return one, values
        return None

    def translated(self, text: str, translate: Callable[[str], str]) -> str:
        """A text in another language, `translate` giving that of a template; itself where it is of none.

        What was put in may be a text of its own, such as the remedy at the end of an error.
        """
        found = self.find(text)
        if found is None:
            return self._apart(text, translate)
        template, values = found
        inner = {at: self._inner(value, translate) for at, value in values.items()}
        count = 1 + max(inner, default=-1)
        return translate(template.text).format(*(inner.get(at, "") for at in range(count)))

    def names_first(self, text: str) -> bool:
        """Whether a text begins with a name, of a part or a file, which is written as it is."""
        found = self.find(text)
        if found is None:
            return any(self.find(text[match.end():]) is not None for match in _BREAK.finditer(text) if match[0] == ": ")
        template, values = found
        if not template.fields or template.literals[0]:
            return False
        first = values[template.fields[0]]
        return first not in self.words and (self.find(first) is None or self.names_first(first))

    def _inner(self, value: str, translate: Callable[[str], str]) -> str:
        """What was put into a text: words of ours, else a name or a number, which stay."""
        return self.translated(value, translate) if " " in value or value in self.words else value

    def _apart(self, text: str, translate: Callable[[str], str]) -> str:
        """A text after the place it is about, 'Box: it is empty', or added to one, 'Box; it is empty'; itself where what
        follows is of no template either."""
        for at in (match.start() for match in _BREAK.finditer(text)):
            if text[at] == ":" and self.find(text[at + 2:]) is not None:
                before, after = self._inner(text[:at], translate), self.translated(text[at + 2:], translate)
                return translate("{}: {}").format(before, after)
            if self.find(text[at:]) is not None:  # only now what stands before: at each break it would double the work
                return self._inner(text[:at], translate) + self.translated(text[at:], translate)
        parts = text.split("; ")
        known = len(parts) > 1 and any(self.find(part) is not None for part in parts)
        return "; ".join(self._inner(part, translate) for part in parts) if known else text
