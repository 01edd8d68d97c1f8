# SPDX-License-Identifier: LGPL-2.1-or-later
"""While something is computed: a waiting cursor, and in the status bar how far it is."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .. import api


@contextlib.contextmanager
def busy() -> Iterator[None]:
    """Within it the cursor waits and the status bar tells the progress. No events are handled meanwhile."""
    bar = Gui.getMainWindow().statusBar()

    def tell(fraction: float, text: str) -> None:
        bar.showMessage(f"{text[:1].upper()}{text[1:]}: {fraction:.0%}")
        bar.repaint()

    QtGui.QApplication.setOverrideCursor(QtGui.QCursor(QtCore.Qt.WaitCursor))
    try:
        with api.told_to(tell):
            yield
    finally:
        bar.clearMessage()
        QtGui.QApplication.restoreOverrideCursor()
