# SPDX-License-Identifier: LGPL-2.1-or-later
"""A FreeCAD command of this workbench: its texts, its requirements, and a tooltip with missing
requirements. Also keeps the toolbar complete.
"""

from __future__ import annotations

import contextlib
import html
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .. import icons, picking
from ..in_language import tr
from ..widgets.upright import present
from . import whats_this

PREFIX = "RoboticAM_"


class Tool:
    """A command.

    icon: also the object that the command creates. action: opens its panel or window. need: returns
    what a document lacks for it. with_dialog: whether it is available while a task panel is open.
    """

    name = ""  # without prefix
    hint = ""  # current tooltip text below the name

    def __init__(
        self,
        icon: str,
        text: str,
        help: str,
        action: Callable[[], None],
        need: whats_this.Need = whats_this.document,
        with_dialog: bool = False,
    ) -> None:
        # untranslated: FreeCAD translates by command name, and again when the language changes
        self.icon, self.text, self.help, self.action, self.need = icon, text, help, action, need
        self.with_dialog = with_dialog

    def GetResources(self) -> dict[str, str]:
        """Return texts and icon. The macro interface, not the command, opens the undo step.

        With ForEdit, FreeCAD asks `IsActive` even while a task panel is open.
        """
        return {
            "Pixmap": icons.path(self.icon),
            "MenuText": self.text,
            "ToolTip": self.help,
            "StatusTip": self.help,
            "CmdType": "AlterDoc NoTransaction ForEdit",
            "WhatsThis": whats_this.url(self.name),
        }

    def IsActive(self) -> bool:
        """Whether the tool is available; otherwise the tooltip names the missing requirement."""
        lacking = self.missing()
        help = tr(self.help)
        hint = tr("{}. {}").format(help, lacking) if lacking else help
        if hint != self.hint and self._explain(hint):
            self.hint = hint
        return not lacking

    def missing(self) -> str:
        """Return what the user must do first, '' if the tool is available."""
        try:
            if (
                App.ActiveDocument is not None
                and not self.with_dialog
                and Gui.Control.activeDialog()
            ):
                return tr("First close the task panel that is open.")
            return self.need(App.ActiveDocument)
        except (ReferenceError, RuntimeError):  # the document is being closed
            return tr("First open a part, or create a document.")

    def _explain(self, text: str) -> bool:
        """Update the tooltip, which FreeCAD sets only once. Return False while no button exists."""
        command = Gui.Command.get(PREFIX + self.name)
        actions = [] if command is None else command.getAction()
        name, help = html.escape(tr(self.text).rstrip("…")), html.escape(text, quote=False)
        bar = Gui.getMainWindow().statusBar()
        for action in actions:
            if action.statusTip() != text and bar.currentMessage() == action.statusTip():
                bar.clearMessage()  # the message is outdated
            action.setToolTip(f"<p><b>{name}</b></p><p>{help}</p>")
            action.setStatusTip(text)
        return bool(actions)

    def Activated(self, index: int = 0) -> None:
        """Run the tool. A macro or a shortcut may call it while it is unavailable."""
        lacking = self.missing()
        if lacking:
            App.Console.PrintWarning(tr("{}: {}").format(tr(self.text), lacking) + "\n")
        else:
            # the tooltip under the pointer is outdated
            Gui.getMainWindow().statusBar().clearMessage()
            self.action()


# ---- Move the workbench's toolbar to its own row if it would be cut off


def show_tooltips(title: str) -> None:
    """Show tooltips of menu entries, after FreeCAD has created the menu."""

    def show() -> None:
        for menu in present(Gui.getMainWindow().menuBar(), QtGui.QMenu):
            if menu.title().replace("&", "") == title:
                menu.setToolTipsVisible(True)

    QtCore.QTimer.singleShot(0, show)


def for_selection() -> list[str]:
    """Return the tools for the selected shapes."""
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
    """Checks the toolbar whenever its space changes, such as with the window width."""

    def __init__(self, bar: Any) -> None:
        super().__init__(bar)
        self.bar = bar
        bar.installEventFilter(self)

    def eventFilter(self, watched: Any, event: Any) -> bool:
        """Called by Qt; the filter handles no event itself."""
        # PySide may confuse an event with an earlier object at its address
        if isinstance(event, QtCore.QEvent) and event.type() in (
            QtCore.QEvent.Resize,
            QtCore.QEvent.Show,
        ):
            QtCore.QTimer.singleShot(0, self.give)  # after Qt has finished the layout
        return False

    def give(self) -> None:
        """Move a toolbar that is cut off to a new row; otherwise keep the user's position."""
        with contextlib.suppress(RuntimeError):  # the main window is deleted
            window, bar = Gui.getMainWindow(), self.bar
            cut = bar.isVisible() and not bar.isFloating() and bar.width() < bar.sizeHint().width()
            if cut and bar.orientation() == QtCore.Qt.Horizontal and not window.toolBarBreak(bar):
                window.insertToolBarBreak(bar)


def keep_whole(title: str) -> None:
    """Watch the toolbar with a title after FreeCAD has created it; may be called repeatedly."""
    QtCore.QTimer.singleShot(0, lambda: _watch(title))


def _watch(title: str) -> None:
    with contextlib.suppress(RuntimeError):
        for bar in present(Gui.getMainWindow(), QtGui.QToolBar):
            if bar.windowTitle() == title and not bar.findChildren(_BarWidth):
                _BarWidth(bar).give()
