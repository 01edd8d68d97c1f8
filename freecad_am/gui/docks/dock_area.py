# SPDX-License-Identifier: LGPL-2.1-or-later
"""The room that our docks take from the rest of the window, height below the 3D view and width beside it, and give back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ..widgets.present import present

MOST_SHARE = 0.38  # of the window that a dock asks for, so that the 3D view keeps its room
_TOLERANCE_PX = 3  # pixels that layouts round away
_STABLE_MS = 300  # ms in which docks that stand still do not change
_SIDE_AREAS = (QtCore.Qt.LeftDockWidgetArea, QtCore.Qt.RightDockWidgetArea)


@dataclass
class _Part:
    """A dock of ours, and the pixels it asks for: at least these, or just these where the user has given them by hand."""

    dock: Any
    asked: int
    by_hand: bool = False


class DockArea:
    """Of one area of the window. Docks of ours that are open there make it as large as the largest of them asks."""

    def __init__(self, area: Any) -> None:
        self.area = area
        self.across = QtCore.Qt.Horizontal if area in _SIDE_AREAS else QtCore.Qt.Vertical
        self.parts: list[_Part] = []  # in the order in which they were opened
        self.before: dict[
            str, int
        ] = {}  # names of other docks, and the pixels they had before ours came
        self.wishes: dict[str, int] = {}  # what docks had by the user's hand when they were closed
        self.made: int | None = (
            None  # what has come of the pixels that were asked for, once docks stand still
        )
        self.last: int | None = None
        self.timer = QtCore.QTimer()
        self.timer.setSingleShot(True)
        self.timer.setInterval(_STABLE_MS)
        self.timer.timeout.connect(self._measure)

    def enter(self, dock: Any, least: int) -> None:
        """A dock is about to be opened; it asks for `least` pixels, 0 for what its fields need."""
        self._look()
        if not self.parts:
            self.before = {one.objectName(): self._extent(one) for one in self._seen()}
        hint, window = dock.sizeHint(), Gui.getMainWindow()
        sideways = self.across == QtCore.Qt.Horizontal
        natural = hint.width() if sideways else hint.height()
        most = int(MOST_SHARE * (window.width() if sideways else window.height()))
        self.parts.append(
            _Part(dock, self.wishes.get(dock.objectName(), min(least or natural, most)))
        )

    def fit_size(self) -> None:
        """Make it as large as it is to be."""
        shown = [part.dock for part in self.parts if self._stands(part.dock)]
        if shown:
            self._resize(shown[-1:], [self._wanted()])
            self.made = self.last = None
            self.timer.start()

    def leave(self, dock: Any) -> None:
        """A dock is about to be closed: what stays is soon as large as without it."""
        if not any(part.dock is dock for part in self.parts):
            return
        self._look()
        for part in self.parts:
            if part.dock is dock and part.by_hand:
                self.wishes[dock.objectName()] = part.asked
        self.parts = [part for part in self.parts if part.dock is not dock]
        QtCore.QTimer.singleShot(0, self._give_back)

    def has_another(self, dock: Any) -> bool:
        """Whether another dock of ours is seen there at the same time."""
        seen = self._seen()
        return any(part.dock is not dock and part.dock in seen for part in self.parts)

    def _give_back(self) -> None:
        if self.parts:
            self.fit_size()
            return
        there = [one for one in self._seen() if one.objectName() in self.before]
        self._resize(there, [self.before[one.objectName()] for one in there])

    def _wanted(self) -> int:
        """The pixels that all who are there make together, as they came."""
        pixels = max(self.before.values(), default=0)
        for part in self.parts:
            pixels = part.asked if part.by_hand else max(pixels, part.asked)
        return pixels

    def _look(self) -> None:
        """Take notice of what the user has done by hand since."""
        self.parts = [part for part in self.parts if self._stands(part.dock)]
        if not self.parts:
            return
        found = self._found()
        if found is not None and self.made is not None and abs(found - self.made) > _TOLERANCE_PX:
            self.parts[-1].asked, self.parts[-1].by_hand = found, True

    def _measure(self) -> None:
        found = self._found()
        if found is not None and found != self.last:  # Qt moves docks little by little
            self.last = found
            self.timer.start()
        else:
            self.made = found

    def _found(self) -> int | None:
        """The pixels of ours now; None where none is seen."""
        seen = self._seen()
        own = [part.dock for part in reversed(self.parts) if part.dock in seen]
        return self._extent(own[0]) if own else None

    # ---- the window

    def _stands(self, dock: Any) -> bool:
        return (
            dock.isVisible()
            and not dock.isFloating()
            and Gui.getMainWindow().dockWidgetArea(dock) == self.area
        )

    def _seen(self) -> list[Any]:
        """The docks that stand there, without those behind others: Qt keeps these outside of the window."""
        window = Gui.getMainWindow()
        docks = present(window, QtGui.QDockWidget)
        return [
            one for one in docks if self._stands(one) and one.geometry().intersects(window.rect())
        ]

    def _extent(self, dock: Any) -> int:
        """Pixels of a dock, with the tabs above or below it: so Qt counts when docks are resized."""
        if self.across == QtCore.Qt.Horizontal:
            return int(dock.width())
        window, place = Gui.getMainWindow(), dock.geometry()
        bars = [
            bar.geometry()
            for bar in present(window, QtGui.QTabBar)
            if bar.parent() is window and bar.isVisible()
        ]
        tabs = [
            bar.height()
            for bar in bars
            if bar.left() <= place.center().x() <= bar.right()
            and place.adjusted(0, -_TOLERANCE_PX, 0, _TOLERANCE_PX).intersects(bar)
        ]
        return int(place.height() + sum(tabs[:1]))

    def _resize(self, docks: list[Any], pixels: list[int]) -> None:
        if docks:
            Gui.getMainWindow().resizeDocks(docks, pixels, self.across)
