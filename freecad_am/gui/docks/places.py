# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our docks as the window has them: one frame each for the session, tabs of one place until the user moves them.

A frame stays when it is closed, hidden, for Qt keeps with it what the user has made of it: another area, floating, beside
others. What it shows may be another thing each time it is opened.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..texts.labels import without_key
from .dock_area import DockArea

BELOW, RIGHT = QtCore.Qt.BottomDockWidgetArea, QtCore.Qt.RightDockWidgetArea
_NOWHERE = QtCore.Qt.NoDockWidgetArea


class Dock(QtGui.QDockWidget):
    """A frame. `wide` is the share of the window's width that it asks for unless another of ours is beside it, `high` the
    pixels; 0 for what its fields need.

    `closed` is called when it is closed, by whomever; `seen` when it comes to be seen, as when its tab is clicked.
    """

    def __init__(self, name: str, area: Any, wide: float = 0.0, high: int = 0) -> None:
        super().__init__(Gui.getMainWindow())
        self.setObjectName(name)
        self.area, self.wide, self.high = area, wide, high
        self.closed: Callable[[], None] | None = None
        self.seen: Callable[[], None] | None = None
        self.visibilityChanged.connect(self._visible)

    def setWindowTitle(self, title: str) -> None:
        """Show a title as it is: an `&` in it marks no key."""
        super().setWindowTitle(without_key(title))

    def hold(self, title: str, content: Any) -> None:
        """Show this, under this title; what it held goes."""
        self.setWindowTitle(title)
        before = self.widget()
        self.setWidget(content)
        if before is not None:
            before.deleteLater()

    def come(self) -> None:
        """Open it, in front of those it shares a place with."""
        window = Gui.getMainWindow()
        if not self.isFloating() and window.dockWidgetArea(self) == _NOWHERE:
            window.addDockWidget(self.area, self)
            self._join(window)
        opened = not self.isVisible()
        area = _area(self)
        if opened and area is not None:
            area.enter(self, self.high)
        self.toggleViewAction().setVisible(True)
        self.show()
        self.raise_()
        if opened:
            QtCore.QTimer.singleShot(0, self._fit_size)  # once it has its place among other docks

    def _join(self, window: Any) -> None:
        """Become a tab of one of ours that stands there, or would if it were open."""
        there = [
            one
            for one in _docks.values()
            if one is not self and not one.isFloating() and window.dockWidgetArea(one) == self.area
        ]
        if there:
            window.tabifyDockWidget(max(there, key=lambda one: one.isVisible()), self)

    def _fit_size(self) -> None:
        """The room it asks for."""
        area = _area(self)
        if not self.isVisible() or area is None:
            return
        self.raise_()
        if self.wide and not area.has_another(self):
            window = Gui.getMainWindow()
            window.resizeDocks([self], [int(self.wide * window.width())], QtCore.Qt.Horizontal)
        area.fit_size()

    def empty(self) -> None:
        """Close it, and hold nothing: it is not to be opened but by its tool."""
        self.closed = None
        self.close()
        self.toggleViewAction().setVisible(False)
        content = self.widget()
        self.setWidget(None)
        if content is not None:
            content.deleteLater()

    def closeEvent(self, event: Any) -> None:
        """It is closed: the room it took is given back."""
        for area in _areas:
            area.leave(self)
        super().closeEvent(event)
        if self.closed is not None:
            self.closed()

    def _visible(self, visible: bool) -> None:
        if visible and self.seen is not None:
            self.seen()


_docks: dict[str, Dock] = {}  # Python must keep them
_areas: list[DockArea] = []


def dock(name: str, area: Any, wide: float = 0.0, high: int = 0) -> Dock:
    """The frame of this name, made when it is first asked for."""
    if name not in _docks:
        _docks[name] = Dock(name, area, wide, high)
    return _docks[name]


def _area(one: Dock) -> DockArea | None:
    """The room of the area where a dock stands, or would; None of one that floats."""
    area = Gui.getMainWindow().dockWidgetArea(one)
    if one.isFloating() or area == _NOWHERE:
        return None
    for one_area in _areas:
        if one_area.area == area:
            return one_area
    _areas.append(DockArea(area))
    return _areas[-1]
