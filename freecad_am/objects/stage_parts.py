# SPDX-License-Identifier: LGPL-2.1-or-later
"""What stages are declared with: links to inputs, sections of parameters; and what computing them gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..core.issues import Issue


@dataclass(frozen=True)
class Link:
    """A link to an input: the property, its FreeCAD type, the stage it must be ('' for any object) and a help."""

    name: str
    kind: str
    help: str
    required: bool = True
    type_name: str = "App::PropertyLink"

    @property
    def many(self) -> bool:
        """Whether it links to any number of objects."""
        return self.type_name.endswith("LinkList")

    @property
    def label(self) -> str:
        """Its name in a panel: the kind of stage, or 'Start edges' for StartEdges."""
        words = (self.key if self.many else self.kind or self.key).replace("_", " ")
        return words[0].upper() + words[1:]

    @property
    def help_phrase(self) -> str:
        """Its help within a sentence: 'the cell that runs it'."""
        return self.help[0].lower() + self.help[1:].rstrip(".")

    @property
    def key(self) -> str:
        """Its name as a macro keyword: joint_path for JointPath."""
        return "".join(
            f"_{letter.lower()}" if letter.isupper() else letter for letter in self.name
        ).lstrip("_")


@dataclass(frozen=True)
class Section:
    """A parameters dataclass of a stage, the prefix of its errors and the property group it is shown in."""

    cls: type
    prefix: str
    group: str


@dataclass(frozen=True)
class Outcome:
    """What a stage computed: the value to store, findings, and figures to show by property name."""

    value: Any
    issues: tuple[Issue, ...] = ()
    figures: tuple[tuple[str, Any], ...] = ()


Work = Callable[[], Outcome]
