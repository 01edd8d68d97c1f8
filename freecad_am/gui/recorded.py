# SPDX-License-Identifier: LGPL-2.1-or-later
"""Call the macro interface so that the Python console and macros record the calls."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from .. import api
from ..objects.results.findings import reason_of
from ..objects.shapes.places import ArrayElement
from ..objects.staleness import FAILED, INFEASIBLE
from .busy import busy
from .in_language import tr, translated

IMPORT = "import freecad_am.api as am"


def make(document: Any, function: str, arguments: dict[str, str]) -> None:
    """Call a function that creates an object in a document.

    Raises the errors of the function, and ReferenceError if the document is closed.
    """
    _run(document, function, _document(document), arguments)


def change(obj: Any, arguments: dict[str, str]) -> None:
    """Change parameters and inputs of a stage.

    Raises the errors of `api.change`, and ReferenceError if the stage is deleted.
    """
    act(obj, "change", arguments)


def act(obj: Any, function: str, arguments: dict[str, str]) -> None:
    """Call a function on a stage.

    Raises the errors of the function, and ReferenceError if the stage is deleted.
    """
    target = reference(obj)
    _run(obj.Document, function, target, arguments)


def reference(obj: Any) -> str:
    """Return the object as Python text. Raises ReferenceError if it is deleted."""
    if isinstance(obj, ArrayElement):
        return f"am.array_element({reference(obj.array)}, {obj.index})"
    # the object is removed but kept for undo: FreeCAD 0.20 raises, later versions have no name for
    # it
    name = None
    with contextlib.suppress(RuntimeError):
        name = obj.Name
    if name is None:
        raise ReferenceError("the object is no longer part of a document")
    return f"{_document(obj.Document)}.getObject({name!r})"


def _document(document: Any) -> str:
    # another document may have become active since the panel opened
    return (
        "App.ActiveDocument"
        if document is App.ActiveDocument
        else f"App.getDocument({document.Name!r})"
    )


def _run(document: Any, function: str, target: str, arguments: dict[str, str]) -> None:
    texts = [target, *(f"{key}={text}" for key, text in arguments.items())]
    old_findings = _wrong(document)
    Gui.doCommand(IMPORT)
    call = f"am.{function}({', '.join(texts)})"
    # creating an object for a link array element belongs to the same undo step
    step = (
        _one_step(document, function) if "am.array_element(" in call else contextlib.nullcontext()
    )
    with busy(), step:
        Gui.doCommand(call)
    new = [finding for finding in _wrong(document) if finding not in old_findings]
    for name, status, message in new[:1]:  # later stages repeat the finding
        text = tr("{} failed: {}") if status == FAILED else tr("{} is infeasible: {}")
        App.Console.PrintError(text.format(name, translated(message)) + "\n")


@contextlib.contextmanager
def _one_step(document: Any, name: str) -> Iterator[None]:
    """Run everything within it in one undo step."""
    if App.getActiveTransaction():
        yield
        return
    document.openTransaction(name)
    try:
        yield
    except BaseException:
        document.abortTransaction()
        raise
    document.commitTransaction()


def _wrong(document: Any) -> list[tuple[str, str, str]]:
    """Return label, status and message of the failed and infeasible stages, inputs first."""
    findings = [(obj.Label, obj.Status, reason_of(obj)) for obj in api.stages_of(document)]
    return [finding for finding in findings if finding[1] in (FAILED, INFEASIBLE)]
