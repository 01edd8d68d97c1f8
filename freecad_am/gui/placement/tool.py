# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool that opens the dock of placements."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from ...core.issues import AmError
from ...objects.stage import stage_of
from ..picking.shape_inputs import job_named, job_selection
from ..texts.in_language import error_line, tr, translated_error
from . import dock

KINDS = ("joint path", "toolpath")  # kinds of placed objects, the most complete first


def placement() -> None:
    """Place the selected joint path, toolpath with a cell, or the path of the selected program;
    without such a selection, the last one of the document."""
    selected = [path for path in map(_path, job_selection()) if path is not None]
    if not selected and job_named():
        _say(
            tr(
                "{} has no toolpath with a cell to place; make one first, or select another job."
            ).format(job_named())
        )
        return
    paths = [obj for obj in App.ActiveDocument.Objects if _path(obj) is obj]
    candidates = sorted(paths, key=lambda obj: -KINDS.index(_kind(obj)))
    if not selected and not candidates:
        _say(tr("There is no toolpath with a cell to place; make one first."))
        return
    try:
        dock.show(selected[0] if selected else candidates[-1])
    except AmError as error:
        App.Console.PrintWarning(error_line(error))
        Gui.getMainWindow().statusBar().showMessage(translated_error(error), 8000)


def _kind(obj: Any) -> str:
    stage = stage_of(obj)
    return "" if stage is None else stage.kind


def _path(obj: Any) -> Any:
    """The joint path or toolpath that an object is or belongs to, with a cell; None without one."""
    kind = _kind(obj)
    if kind == "program":
        return obj.JointPath
    if kind == "joint path" or (kind == "toolpath" and obj.Cell is not None):
        return obj
    return None


def _say(text: str) -> None:
    App.Console.PrintWarning(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
