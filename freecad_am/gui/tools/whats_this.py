# SPDX-License-Identifier: LGPL-2.1-or-later
"""Help on our tools and panels: What's This opens their page of docs/tools in a FreeCAD window.

FreeCAD passes clicks to its Help module, which knows only pages of FreeCAD's wiki. FreeCAD 0.20 has
no such module and asks for it in a dialog. In What's This mode only, clicks on our widgets are
therefore handled before FreeCAD.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.families.registry import FAMILIES
from ...objects.results.findings import message_of
from ...objects.stage import stage_of
from ...objects.staleness import INFEASIBLE
from .. import icons
from ..families.registry import window_of
from ..in_language import tr, translated
from ..picking import is_mesh, usable
from ..signals import connect
from .freecad_am import add_command

Need = Callable[[Any], str]


def nothing(doc: Any) -> str:
    """Require nothing, not even a document."""
    return ""


def document(doc: Any) -> str:
    """Require a document."""
    return tr("First open a part, or create a document.") if doc is None else ""


def part(doc: Any) -> str:
    """Require an object with a shape or a mesh."""
    return document(doc) or (
        "" if _any(doc, usable) else tr("First open a part, or import a part into this document.")
    )


def faces(doc: Any) -> str:
    """Require an object with a shape, which a mesh does not have."""
    if document(doc) or _any(doc, lambda obj: usable(obj) and not is_mesh(obj)):
        return document(doc)
    return (
        tr("First open a part with faces, such as a STEP file; a mesh has no faces.")
        if _any(doc, usable)
        else part(doc)
    )


def feature(doc: Any) -> str:
    """Require a feature to deposit."""
    if document(doc) or _some(doc, "feature"):
        return document(doc)
    return tr(
        "First make a feature with Feature…, Wall on Part…, Solid…, Solids on Hub…, Curves… or "
        "Cladding…."
    )


def toolpath_and_cell(doc: Any) -> str:
    """Require a toolpath and a cell."""
    if document(doc):
        return document(doc)
    if not _some(doc, "toolpath"):
        return tr("First make a toolpath: Toolpath….") if not feature(doc) else feature(doc)
    return "" if _some(doc, "cell") else tr("First make a cell: Cell….")


def path(doc: Any) -> str:
    """Require a computed toolpath or joint path."""
    if document(doc):
        return document(doc)
    has_path = any(obj.Key for kind in ("toolpath", "joint path") for obj in _stages(doc, kind))
    return "" if has_path else tr("First make a toolpath: Toolpath….")


def joint_path(doc: Any) -> str:
    """Require a computed joint path."""
    if document(doc):
        return document(doc)
    paths = list(_stages(doc, "joint path"))
    if any(obj.Key for obj in paths):
        return ""
    if paths:
        return tr("{} has no result: {}").format(paths[-1].Label, translated(message_of(paths[-1])))
    return tr("First make a joint path: Joint Path…, or all stages at once: New Job….")


def feasible(doc: Any) -> str:
    """Require a feasible joint path."""
    lacking = joint_path(doc)
    if lacking or any(obj.Status != INFEASIBLE for obj in _stages(doc, "joint path")):
        return lacking
    infeasible_path = list(_stages(doc, "joint path"))[-1]
    return tr("{} is infeasible: {}").format(
        infeasible_path.Label, translated(message_of(infeasible_path))
    )


def _stages(doc: Any, kind: str) -> Iterator[Any]:
    for obj in doc.Objects:
        stage = stage_of(obj)
        if stage is not None and stage.kind == kind:
            yield obj


def _some(doc: Any, kind: str) -> bool:
    return next(_stages(doc, kind), None) is not None


def _any(doc: Any, predicate: Callable[[Any], bool]) -> bool:
    return any(predicate(obj) for obj in doc.Objects)


PAGES = Path(__file__).resolve().parents[3] / "docs" / "tools"
NAME, INDEX, PREFIX = "RoboticAM_Help", "README.md", "RoboticAM_"
# pages of panels and docks that are not named after their tool
_CALLED = {
    "PathDock": "path",
    "Simulation": "simulate",
    "ProgramText": "program",
    "Inspection": "inspect",
}
_SIZE = (900, 700)


@functools.cache
def _pages() -> dict[str, str]:
    """Return the pages of panels and docks that are not named after their tool, by name."""
    of_features = {f"{type(family).__name__}Feature": window_of(family).page for family in FAMILIES}
    return {**_CALLED, **of_features}


def page_of(name: str) -> str:
    """Return the file of a tool, panel or dock by its name.

    `RoboticAM_SpinMap` gives `spin-map.md`; an unknown name gives the index.
    """
    bare = name.removeprefix(PREFIX)
    words = "".join(f"-{letter.lower()}" if letter.isupper() else letter for letter in bare).lstrip(
        "-"
    )
    page = f"{_pages().get(bare, words)}.md"
    return page if (PAGES / page).is_file() else INDEX


def url(name: str) -> str:
    """Return the address of a page, for FreeCAD versions that show it themselves."""
    return QtCore.QUrl.fromLocalFile(str(PAGES / page_of(name))).toString()


class Help:
    """The command that opens the list of tools."""

    def GetResources(self) -> dict[str, str]:
        """Return the texts in the window's language at the time when the workbench is opened."""
        return {
            "MenuText": tr("Help on Robotic AM"),
            "ToolTip": tr("Opens the help pages of the tools"),
            "WhatsThis": url(INDEX),
        }

    def Activated(self, index: int = 0) -> None:
        """Run the command: show the index of the help."""
        show(INDEX)


class HelpWindow:
    """Shows pages in a separate window and follows their links."""

    def __init__(self) -> None:
        self.window = QtGui.QDialog(Gui.getMainWindow())
        self.window.setObjectName(NAME)
        self.window.setWindowTitle(tr("Help on Robotic AM"))
        self.window.setWindowIcon(QtGui.QIcon(icons.path("workbench")))
        self.window.resize(*_SIZE)
        self.note = QtGui.QLabel()
        self.note.setObjectName("note")
        self.note.setWordWrap(True)
        self.text = QtGui.QTextBrowser()
        self.text.setObjectName("page")
        self.text.setOpenExternalLinks(True)
        connect(self.text, "sourceChanged(QUrl)", self._remove_empty_headings)
        row, column = QtGui.QHBoxLayout(), QtGui.QVBoxLayout(self.window)
        for label, act in (
            (tr("All tools"), lambda: self.show(INDEX)),
            (tr("Back"), self.text.backward),
        ):
            button = QtGui.QPushButton(label)
            button.setAutoDefault(False)
            button.clicked.connect(lambda *_, act=act: act())
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        column.addWidget(self.note)
        column.addWidget(self.text, 1)

    def _remove_empty_headings(self, *_: Any) -> None:
        """Remove empty heading rows, which Markdown requires in every table."""
        for table in self.text.document().rootFrame().childFrames():
            if isinstance(table, QtGui.QTextTable) and table.rows() > 1:
                cells = (table.cellAt(0, column) for column in range(table.columns()))
                if not any(cell.firstCursorPosition().block().text().strip() for cell in cells):
                    table.removeRows(0, 1)

    def show(self, page: str, note: str = "") -> None:
        """Show a page of docs/tools, with a note above."""
        self.note.setText(note)
        self.note.setVisible(bool(note))
        self.text.setSource(QtCore.QUrl.fromLocalFile(str(PAGES / page)))
        self.window.show()
        self.window.raise_()


class Watch(QtCore.QObject):
    """Detects What's This mode of the main window and handles clicks on our widgets in it."""

    def __init__(self, window: Any) -> None:
        super().__init__(window)
        self.window = window
        window.installEventFilter(self)

    def eventFilter(self, watched: Any, event: Any) -> bool:
        """Called by Qt; True for handled events."""
        if not isinstance(
            event, QtCore.QEvent
        ):  # PySide may confuse an event with an earlier object at its address
            return False
        kind = event.type()
        if kind == QtCore.QEvent.EnterWhatsThisMode and watched is self.window:
            QtCore.QTimer.singleShot(
                0, self._take
            )  # after FreeCAD: Qt asks the last event filter first
        elif kind == QtCore.QEvent.LeaveWhatsThisMode and watched is self.window:
            QtGui.QApplication.instance().removeEventFilter(self)
        elif kind == QtCore.QEvent.WhatsThis and isinstance(watched, QtGui.QWidget):
            name, note = _ours(watched)
            if name:
                event.accept()
                QtCore.QTimer.singleShot(0, lambda: _answer(name, note))
                return True
        return False

    def _take(self) -> None:
        if QtGui.QWhatsThis.inWhatsThisMode():
            QtGui.QApplication.instance().installEventFilter(self)


def _ours(widget: Any) -> tuple[str, str]:
    """Return the name of the tool, panel or dock of a widget ('' for foreign widgets), and the
    widget's own help.
    """
    if isinstance(widget, QtGui.QToolButton) and widget.defaultAction() is not None:
        action = widget.defaultAction()
        for name in (str(action.data() or ""), action.objectName()):
            if name.startswith(PREFIX):
                return name, ""
    note, ancestor = "", widget
    while ancestor is not None:
        help_text = ancestor.whatsThis()
        note = note or ("" if help_text.startswith("file:") else help_text)
        if ancestor.objectName().startswith(PREFIX):
            return ancestor.objectName(), note
        ancestor = ancestor.parentWidget()
    return "", ""


def _answer(name: str, note: str) -> None:
    QtGui.QWhatsThis.leaveWhatsThisMode()
    show(page_of(name), note)


_windows: list[HelpWindow] = []
_watches: list[Watch] = []


def show(page: str, note: str = "") -> None:
    """Show a page of docs/tools in the help window, created at first use."""
    for window in list(_windows):
        with contextlib.suppress(RuntimeError):  # the window was deleted with the main window
            window.show(page, note)
            return
        _windows.remove(window)
    _windows.append(HelpWindow())
    _windows[-1].show(page, note)


def install() -> None:
    """Register the command and watch the main window; may be called repeatedly."""
    if not _watches:
        add_command(NAME, Help())
        _watches.append(Watch(Gui.getMainWindow()))
