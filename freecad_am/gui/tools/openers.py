# SPDX-License-Identifier: LGPL-2.1-or-later
"""What each tool opens. Panels and docks are imported when they are first opened: the workbench starts the sooner."""

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
from ..in_language import error_line, tr, translated_error

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
    """Open a part in the active or a new document, select and show it; None if it is rejected, which is reported,
    or cancelled."""
    is_new = App.ActiveDocument is None
    if is_new:
        Gui.doCommand("App.newDocument()")
    document = App.ActiveDocument
    old_names = {obj.Name for obj in document.Objects}
    try:
        recorded.make(document, "open_part", {"path": repr(path)})
    except (AmError, Cancelled) as error:
        if is_new:
            App.closeDocument(document.Name)
        if isinstance(error, AmError):
            App.Console.PrintError(error_line(error))
            QtGui.QMessageBox.warning(Gui.getMainWindow(), tr("Open part"), translated_error(error))
        return None
    opened_part = next(obj for obj in document.Objects if obj.Name not in old_names)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, opened_part.Name)
    view = Gui.activeDocument().activeView()
    if is_new and hasattr(view, "viewIsometric"):
        view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    return opened_part


def open_part() -> None:
    """Ask for a part file."""

    ask()


def new_job() -> None:
    """The panel of a new job."""
    from ..panels.new_job import JobPanel
    from ..panels.stage import show

    show(JobPanel())


def export_path() -> None:
    """The panel that exports a path."""
    from ..panels.stage import show
    from .export_path import ExportPanel

    show(ExportPanel())


def cell() -> None:
    """The panel of a new cell."""
    from ..panels.cell import CellPanel
    from ..panels.stage import show

    show(CellPanel())


def toolpath() -> None:
    """The panel of a new toolpath."""
    from ..panels.stage import show
    from ..panels.toolpath import ToolpathPanel

    show(ToolpathPanel())


def joint_path() -> None:
    """The panel of a new joint path."""
    from ..panels.joint_path import JointPathPanel
    from ..panels.stage import show

    show(JointPathPanel())


def redundancy_map() -> None:
    """The map of a joint path."""
    from ..redundancy_map import dock

    dock.redundancy_map()


def placement() -> None:
    """The dock of placements."""
    from ..placement import dock

    dock.placement()


def path() -> None:
    """The dock of paths."""
    from ..path import dock

    dock.show()


def infill() -> None:
    """The dock of infill."""
    from ..path import infill_dock

    infill_dock.show()


def simulate() -> None:
    """The dock of a simulation."""
    from ..simulation import dock

    dock.simulate()


def program() -> None:
    """The panel of a new program."""
    from ..panels.program import ProgramPanel
    from ..panels.stage import show

    show(ProgramPanel())


def new_machine() -> None:
    """The wizard of a new machine."""
    from ..machine_wizard import wizard

    wizard.show()


def inspect() -> None:
    """The panel of an inspection."""
    from ..inspection import panel

    panel.inspect()


def plots() -> None:
    """The dock of plots."""
    from ..plots import dock

    dock.show()
