# SPDX-License-Identifier: LGPL-2.1-or-later
"""The workbench's menu, and what it adds to the context menus of shapes."""

from __future__ import annotations

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..picking import picking
from ..widgets.present import present


def show_tooltips(title: str) -> None:
    """Let the entries of the menu show their tooltips, once FreeCAD has made it."""

    def show() -> None:
        for menu in present(Gui.getMainWindow().menuBar(), QtGui.QMenu):
            if menu.title().replace("&", "") == title:
                menu.setToolTipsVisible(True)

    QtCore.QTimer.singleShot(0, show)


def for_selection() -> list[str]:
    """Tools for the shapes that are selected."""
    document = App.ActiveDocument
    if document is None or Gui.Control.activeDialog():
        return []
    picks = picking.selected(document)
    if not picks:
        return []
    return [
        "RoboticAM_NewJob",
        *[f"RoboticAM_{name}" for name in ("WallOnPart", "Solid", "SolidsOnHub")]
        * (len(picks) > 1),
    ]
