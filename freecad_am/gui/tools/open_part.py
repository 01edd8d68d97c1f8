# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part from a file, read in a process of its own: a file on which FreeCAD would crash, or which it would read without end,
is refused, and the window goes on."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...core.issues import AmError
from ...objects.shapes.part_file import PART_FILES
from ...objects.work.progress import Cancelled
from .. import recorded
from ..texts.translation import error_line, tr, translated_error

ENDINGS = PART_FILES


def ask() -> None:
    """Let a file be chosen, and open it."""
    document = App.ActiveDocument
    folder = (
        os.path.dirname(document.FileName) if document is not None and document.FileName else ""
    )
    endings = " ".join(f"*{ending} *{ending.upper()}" for ending in ENDINGS)
    kinds = tr("Parts, meshes and tables of points ({})").format(endings)
    path, _ = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), tr("Open part"), folder, kinds)
    if path:
        opened(path)


def opened(path: str) -> Any:
    """The part of a file in the active document, or in a new one, selected and in sight; None where it is refused, which is
    told, or cancelled."""
    is_new = App.ActiveDocument is None
    if is_new:
        Gui.doCommand("App.newDocument()")
    document = App.ActiveDocument
    before = {obj.Name for obj in document.Objects}
    try:
        recorded.make(document, "open_part", {"path": repr(path)})
    except (AmError, Cancelled) as error:
        if is_new:
            App.closeDocument(document.Name)
        if isinstance(error, AmError):
            App.Console.PrintError(error_line(error))
            QtGui.QMessageBox.warning(Gui.getMainWindow(), tr("Open part"), translated_error(error))
        return None
    part = next(obj for obj in document.Objects if obj.Name not in before)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, part.Name)
    view = Gui.activeDocument().activeView()
    if is_new and hasattr(view, "viewIsometric"):
        view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    return part
