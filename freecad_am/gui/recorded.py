# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calls of the macro interface that the Python console and macros record."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCADGui as Gui

IMPORT = "import freecad_am.api as am"


def make(function: str, arguments: Sequence[str], values: dict[str, Any]) -> None:
    """Call a function that makes something in the active document. Raises what it raises."""
    texts = ["App.ActiveDocument", *(text for text in arguments if text), *_keywords(values)]
    _run(f"am.{function}({', '.join(texts)})")


def change(obj: Any, values: dict[str, Any]) -> None:
    """Change parameters of a stage. Raises what `api.change` raises."""
    _run(f"am.change({', '.join([reference(obj), *_keywords(values)])})")


def reference(obj: Any) -> str:
    """The object as Python text."""
    return f"App.ActiveDocument.getObject({obj.Name!r})"


def _keywords(values: dict[str, Any]) -> list[str]:
    return [f"{key}={value!r}" for key, value in values.items()]


def _run(call: str) -> None:
    Gui.doCommand(IMPORT)
    Gui.doCommand(call)
