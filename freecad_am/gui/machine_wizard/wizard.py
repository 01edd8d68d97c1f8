# SPDX-License-Identifier: LGPL-2.1-or-later
"""New Machine: from a source of geometry over limits, frames and check poses to a machine file."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.kinematics.machines.draft import Draft
from .. import icons
from ..texts.translation import tr
from .frames_page import FramesPage
from .limits_page import LimitsPage
from .name_page import NamePage
from .poses_page import PosesPage
from .source_page import SourcePage

_open: list[Any] = []


class MachineWizard(QtGui.QWizard):
    """The pages and the draft they fill. Nothing is written before Finish."""

    def __init__(self) -> None:
        super().__init__(Gui.getMainWindow())
        self.draft: Draft | None = None
        self.origin: object = None  # another one each time the source is
        self.geometry_sources: tuple[str, ...] = ()
        self.copied = False  # with the check poses of another machine
        self.saved = ""
        self.setObjectName("RoboticAM_NewMachine")
        self.setWindowTitle(tr("New machine"))
        self.setWindowIcon(QtGui.QIcon(icons.path("new_machine")))
        self.setWizardStyle(QtGui.QWizard.ModernStyle)
        self.setOption(QtGui.QWizard.NoBackButtonOnStartPage, True)
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.source_page = SourcePage(self)
        self.limits_page = LimitsPage(self)
        self.frames_page = FramesPage(self)
        self.poses_page = PosesPage(self)
        self.name_page = NamePage(self)
        for page in (
            self.source_page,
            self.limits_page,
            self.frames_page,
            self.poses_page,
            self.name_page,
        ):
            self.addPage(page)
        self.resize(980, 680)
        self.finished.connect(self._closed)

    def begin(self, draft: Draft) -> None:
        """Another source: what was entered before is not of this machine."""
        self.draft = draft
        self.origin = object()
        self.geometry_sources = draft.sources
        self.copied = draft.values is not None

    def reject(self) -> None:
        """Cancel, Esc and the window's own cross: what was entered is not lost without a question."""
        if not self._entered() or self._to_be_lost():
            super().reject()

    def _entered(self) -> bool:
        """Whether there is something to lose."""
        return self.draft is not None or self.source_page.begun()

    def _to_be_lost(self) -> bool:
        box = QtGui.QMessageBox
        asked = box.question(
            self,
            tr("New machine"),
            tr("Close without saving a machine file? All entries are lost."),
            box.Discard | box.Cancel,
            box.Cancel,
        )
        return bool(asked == box.Discard)

    def keyPressEvent(self, event: Any) -> None:
        """Enter in a field ends the field, not the page."""
        if event.key() not in (QtCore.Qt.Key_Return, QtCore.Qt.Key_Enter):
            super().keyPressEvent(event)

    def _closed(self, *_: Any) -> None:
        if self.saved:
            App.Console.PrintMessage(
                tr("Machine {} was saved: {}").format(self.draft.id, self.saved) + "\n"
            )
        if self in _open:
            _open.remove(self)


def show() -> Any:
    """Open the wizard, or bring up the one that is open."""
    if not _open:
        _open.append(MachineWizard())
    _open[0].show()
    _open[0].raise_()
    _open[0].activateWindow()
    return _open[0]
