# SPDX-License-Identifier: LGPL-2.1-or-later
"""A task panel goes with the document that it was opened in, and follows undo and redo there."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any
from weakref import WeakMethod

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore

_GONE = (RuntimeError, ReferenceError, NameError)


class Watch:
    """An observer of documents. It knows the panel by its widget alone: FreeCAD takes that away with the panel."""

    def __init__(self) -> None:
        self.form: Any = None
        self.document = ""
        self.follow_undo: Callable[[], Callable[[], None] | None] = lambda: (
            None
        )  # gives it as long as the panel is there

    def slotDeletedDocument(self, document: Any) -> None:
        """A document is about to go; once it is gone, so does the panel."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._close)

    def slotUndoDocument(self, document: Any) -> None:
        """Something was undone or done again; once FreeCAD is through with it, the panel shows that."""
        if self.form is not None and document.Name == self.document:
            QtCore.QTimer.singleShot(0, self._follow)

    slotRedoDocument = slotUndoDocument

    def _follow(self) -> None:
        follow = self.follow_undo()
        with contextlib.suppress(*_GONE):  # it is closed already
            if self.form is not None and follow is not None:
                follow()

    def _close(self) -> None:
        form, self.form = self.form, None
        with contextlib.suppress(*_GONE):  # it is closed already
            if form is not None and form.window() is not form and Gui.Control.activeDialog():
                Gui.Control.closeDialog()

    def forget(self, *_: Any) -> None:
        """The panel is closed."""
        self.form = None


_watches: list[Watch] = []


def with_document(panel: Any) -> None:
    """Close a panel that was just opened when its document is closed."""
    if not _watches:
        _watches.append(Watch())
        App.addDocumentObserver(_watches[0])
    watch = _watches[0]
    watch.form, watch.document = (
        panel.form,
        panel.document.Name if panel.document is not None else "",
    )
    follow = getattr(panel, "follow_undo", None)
    watch.follow_undo = (lambda: None) if follow is None else WeakMethod(follow)
    panel.form.destroyed.connect(watch.forget)
