# SPDX-License-Identifier: LGPL-2.1-or-later
"""Give the workbench's toolbar its own row where it would hide tools next to others."""

from __future__ import annotations

import contextlib
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .. import picking
from ..widgets.upright import present


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


class _BarWidth(QtCore.QObject):
    """Checks the bar whenever its space changes, such as with the window width."""

    def __init__(self, bar: Any) -> None:
        super().__init__(bar)
        self.bar = bar
        bar.installEventFilter(self)

    def eventFilter(self, watched: Any, event: Any) -> bool:
        """Called by Qt; nothing is dealt with here."""
        # PySide may take an event for what lay at its address before
        if isinstance(event, QtCore.QEvent) and event.type() in (
            QtCore.QEvent.Resize,
            QtCore.QEvent.Show,
        ):
            QtCore.QTimer.singleShot(0, self.give)  # once Qt is done with its layout
        return False

    def give(self) -> None:
        """Begin a row with the bar where it is cut off; it stays where the user has put it where it is not."""
        with contextlib.suppress(RuntimeError):  # the main window is gone
            window, bar = Gui.getMainWindow(), self.bar
            cut = bar.isVisible() and not bar.isFloating() and bar.width() < bar.sizeHint().width()
            if cut and bar.orientation() == QtCore.Qt.Horizontal and not window.toolBarBreak(bar):
                window.insertToolBarBreak(bar)


def keep_whole(title: str) -> None:
    """Watch the toolbar of a title, once FreeCAD has made it; once or more often."""
    QtCore.QTimer.singleShot(0, lambda: _watch(title))


def _watch(title: str) -> None:
    with contextlib.suppress(RuntimeError):
        for bar in present(Gui.getMainWindow(), QtGui.QToolBar):
            if bar.windowTitle() == title and not bar.findChildren(_BarWidth):
                _BarWidth(bar).give()
