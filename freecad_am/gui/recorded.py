# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calls of the macro interface that the Python console and macros record."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

IMPORT = "import freecad_am.api as am"


def make(function: str, arguments: dict[str, str]) -> None:
    """Call a function that makes something in the active document. Raises what it raises."""
    _run(function, "App.ActiveDocument", arguments)


def change(obj: Any, arguments: dict[str, str]) -> None:
    """Change parameters and inputs of a stage. Raises what `api.change` raises."""
    _run("change", reference(obj), arguments)


def reference(obj: Any) -> str:
    """The object as Python text."""
    return f"App.ActiveDocument.getObject({obj.Name!r})"


def _run(function: str, first: str, arguments: dict[str, str]) -> None:
    texts = [first, *(f"{key}={text}" for key, text in arguments.items())]
    Gui.doCommand(IMPORT)
    Gui.doCommand(f"am.{function}({', '.join(texts)})")
