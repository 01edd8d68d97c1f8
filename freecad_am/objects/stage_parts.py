# SPDX-License-Identifier: LGPL-2.1-or-later
"""Declarations of a stage (input links, parameter sections) and the outcome of a computation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..core.issues import Issue


@dataclass(frozen=True)
class Link:
    """A link to an input.

    name: the property. kind: required stage kind, '' for any object. type_name: FreeCAD property
    type.
    """

    name: str
    kind: str
    help: str
    required: bool = True
    type_name: str = "App::PropertyLink"

    @property
    def many(self) -> bool:
        """Whether the link takes a list of objects."""
        return self.type_name.endswith("LinkList")

    @property
    def label(self) -> str:
        """Return the panel label: the stage kind, or for example 'Start edges' for StartEdges."""
        words = (self.key if self.many else self.kind or self.key).replace("_", " ")
        return words[0].upper() + words[1:]

    @property
    def help_phrase(self) -> str:
        """Return the help text for use within a sentence: 'the cell that runs it'."""
        return self.help[0].lower() + self.help[1:].rstrip(".")

    @property
    def key(self) -> str:
        """Return the macro keyword of the link: joint_path for JointPath."""
        return "".join(
            f"_{letter.lower()}" if letter.isupper() else letter for letter in self.name
        ).lstrip("_")


@dataclass(frozen=True)
class Section:
    """A parameter dataclass of a stage, its error prefix and its property group."""

    cls: type
    prefix: str
    group: str


@dataclass(frozen=True)
class Outcome:
    """Outcome of a computation: result to store, issues, and summary values by property name."""

    value: Any
    issues: tuple[Issue, ...] = ()
    figures: tuple[tuple[str, Any], ...] = ()


Work = Callable[[], Outcome]
