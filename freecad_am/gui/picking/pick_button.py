# SPDX-License-Identifier: LGPL-2.1-or-later
"""Buttons that pick and clear an input, and the click in the tree or the 3D view that a button waits for."""

from __future__ import annotations

import contextlib
import weakref
from collections.abc import Callable
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui


def pick_button(text: str, name: str, help: str) -> Any:
    """A narrow button beside the field of an input."""
    button = QtGui.QToolButton()
    button.setText(text)
    button.setObjectName(name)
    button.setToolTip(help)
    button.setFocusPolicy(QtCore.Qt.TabFocus)
    return button


class NextClick:
    """Calls `act`, a method, once something is selected, after `wait`; `widget`: whose end ends it.

    The method is held weakly: its object holds this one, and a cycle would keep the fields of a closed panel.
    """

    def __init__(self, widget: Any, act: Callable[[], None]) -> None:
        self.act, self.waits = weakref.WeakMethod(act), False
        widget.destroyed.connect(self.stop)

    def wait(self) -> None:
        """Wait for the next click."""
        if not self.waits:
            self.waits = True
            Gui.Selection.addObserver(self)

    def stop(self, *_: Any) -> None:
        """Wait no longer; once or more often."""
        if self.waits:
            self.waits = False
            Gui.Selection.removeObserver(self)

    def addSelection(self, *_: Any) -> None:
        """Something was clicked; called by FreeCAD, which must first be done with it."""
        QtCore.QTimer.singleShot(0, self._clicked)

    setSelection = addSelection

    def _clicked(self) -> None:
        if self.waits:
            self.stop()
            act = self.act()
            with contextlib.suppress(RuntimeError):  # the panel is closed
                if act is not None:
                    act()
