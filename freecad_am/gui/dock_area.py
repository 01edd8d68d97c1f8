# SPDX-License-Identifier: LGPL-2.1-or-later
"""Manage the space that our docks take from the window: height below the 3D view, width next to it."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .in_language import escape_mnemonic, tr
from .widgets.upright import present


class Follower:
    """An observer of documents; `fill` shows the target, or a substitute if the target is deleted."""

    target: tuple[str, str] | None = None  # names of document and object

    def fill(self) -> None:
        """Show the current state."""
        raise NotImplementedError

    def slotDeletedObject(self, obj: Any) -> None:
        """Show another object after this one is deleted; called before."""
        QtCore.QTimer.singleShot(0, self.fill)

    def slotDeletedDocument(self, document: Any) -> None:
        """Update after a document is closed."""
        QtCore.QTimer.singleShot(0, self.fill)

    def slotActivateDocument(self, document: Any) -> None:
        """Update after another document becomes active."""
        if self.target is not None and self.target[0] != document.Name:
            self.target = None
        QtCore.QTimer.singleShot(0, self.fill)


D = TypeVar("D")


class OnlyDock(Generic[D]):
    """Holds the only dock of its kind; `dock` is None until it is first opened."""

    def __init__(self, make: Callable[[], D]) -> None:
        self._make = make
        self.dock: D | None = None

    def provide(self) -> D:
        """Return the dock; the first call creates it."""
        if self.dock is None:
            self.dock = self._make()
        return self.dock


class Shown(Protocol):
    """The content of a dock: the names of a document and of objects in it."""

    document: str
    objects: Collection[str]


class Lookout:
    """Observes the objects of a dock until stopped.

    Calls `changed` with an object and a property name. Calls `goes` before an object is deleted.
    Calls `ended` after that, with the reason and whether the document is closed.
    """

    def __init__(
        self,
        get_shown: Callable[[], Shown],
        changed: Callable[[Any, str], None],
        on_end: Callable[[str, bool], None],
        goes: Callable[[], None] = lambda: None,
    ) -> None:
        self.shown, self.changed, self.ended, self.goes = get_shown, changed, on_end, goes
        App.addDocumentObserver(self)

    def stop(self) -> None:
        """Stop observing."""
        App.removeDocumentObserver(self)

    def _shows(self, obj: Any) -> bool:
        return obj.Name in self.shown().objects and obj.Document.Name == self.shown().document

    # ---- called by FreeCAD

    def slotDeletedDocument(self, document: Any) -> None:
        """End after a document is closed."""
        if document.Name == self.shown().document:
            self.ended(tr("the document was closed"), True)

    def slotDeletedObject(self, obj: Any) -> None:
        """End after an object is deleted."""
        if self._shows(obj):
            self.goes()
            text = tr("{label} was deleted").format(label=obj.Label)
            QtCore.QTimer.singleShot(0, lambda: self.ended(text, False))

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """Report a changed property."""
        if self._shows(obj):
            self.changed(obj, name)


MOST_SHARE = 0.38  # maximum fraction of the window for a dock, so that the 3D view keeps its space
_TOLERANCE_PX = 3  # pixels; tolerance for rounding in layouts
_STABLE_MS = 300  # ms without change after which docks are considered stable
_SIDE_AREAS = (QtCore.Qt.LeftDockWidgetArea, QtCore.Qt.RightDockWidgetArea)


@dataclass
class _Part:
    """One of our docks and its size in pixels: a minimum, or the size set by the user (`by_hand`)."""

    dock: Any
    extent: int
    by_hand: bool = False


class DockArea:
    """A dock area of the window, as large as its largest open dock requests."""

    def __init__(self, area: Any) -> None:
        self.area = area
        self.across = QtCore.Qt.Horizontal if area in _SIDE_AREAS else QtCore.Qt.Vertical
        self.parts: list[_Part] = []  # in order of opening
        self.before: dict[str, int] = {}  # pixels of other docks before ours opened, by name
        self.wishes: dict[str, int] = {}  # sizes set by the user when docks were closed
        self.made: int | None = None  # resulting pixels once the docks are stable
        self.last: int | None = None
        self.timer = QtCore.QTimer()
        self.timer.setSingleShot(True)
        self.timer.setInterval(_STABLE_MS)
        self.timer.timeout.connect(self._measure)

    def enter(self, dock: Any, min_pixels: int) -> None:
        """Prepare to open a dock of at least `min_pixels`; 0: the size that its fields need."""
        self._look()
        if not self.parts:
            self.before = {
                neighbour.objectName(): self._extent(neighbour)
                for neighbour in self._visible_docks()
            }
        hint, window = dock.sizeHint(), Gui.getMainWindow()
        sideways = self.across == QtCore.Qt.Horizontal
        natural = hint.width() if sideways else hint.height()
        max_pixels = int(MOST_SHARE * (window.width() if sideways else window.height()))
        self.parts.append(
            _Part(dock, self.wishes.get(dock.objectName(), min(min_pixels or natural, max_pixels)))
        )

    def fit_size(self) -> None:
        """Resize the area to its target size."""
        docks = [member.dock for member in self.parts if self._stands(member.dock)]
        if docks:
            self._resize(docks[-1:], [self._target_extent()])
            self.made = self.last = None
            self.timer.start()

    def leave(self, dock: Any) -> None:
        """Prepare to close a dock; the other docks resize shortly after."""
        if not any(member.dock is dock for member in self.parts):
            return
        self._look()
        for member in self.parts:
            if member.dock is dock and member.by_hand:
                self.wishes[dock.objectName()] = member.extent
        self.parts = [member for member in self.parts if member.dock is not dock]
        QtCore.QTimer.singleShot(0, self._give_back)

    def has_another(self, dock: Any) -> bool:
        """Whether another of our docks is visible in the area."""
        visible_docks = self._visible_docks()
        return any(
            member.dock is not dock and member.dock in visible_docks for member in self.parts
        )

    def _give_back(self) -> None:
        if self.parts:
            self.fit_size()
            return
        docks = [dock for dock in self._visible_docks() if dock.objectName() in self.before]
        self._resize(docks, [self.before[dock.objectName()] for dock in docks])

    def _target_extent(self) -> int:
        """Return the pixels that the open docks request, in order of opening."""
        pixels = max(self.before.values(), default=0)
        for member in self.parts:
            pixels = member.extent if member.by_hand else max(pixels, member.extent)
        return pixels

    def _look(self) -> None:
        """Record manual resizing by the user."""
        self.parts = [member for member in self.parts if self._stands(member.dock)]
        if not self.parts:
            return
        extent = self._current_extent()
        if extent is not None and self.made is not None and abs(extent - self.made) > _TOLERANCE_PX:
            self.parts[-1].extent, self.parts[-1].by_hand = extent, True

    def _measure(self) -> None:
        extent = self._current_extent()
        if extent is not None and extent != self.last:  # Qt moves docks in small steps
            self.last = extent
            self.timer.start()
        else:
            self.made = extent

    def _current_extent(self) -> int | None:
        """Return the current pixels of our docks; None if none is visible."""
        visible_docks = self._visible_docks()
        own_docks = [member.dock for member in reversed(self.parts) if member.dock in visible_docks]
        return self._extent(own_docks[0]) if own_docks else None

    # ---- the window

    def _stands(self, dock: Any) -> bool:
        return (
            dock.isVisible()
            and not dock.isFloating()
            and Gui.getMainWindow().dockWidgetArea(dock) == self.area
        )

    def _visible_docks(self) -> list[Any]:
        """Return the visible docks, without docks behind others, which Qt keeps outside the window."""
        window = Gui.getMainWindow()
        docks = present(window, QtGui.QDockWidget)
        return [
            dock
            for dock in docks
            if self._stands(dock) and dock.geometry().intersects(window.rect())
        ]

    def _extent(self, dock: Any) -> int:
        """Return the pixels of a dock including its tabs above or below, as Qt counts when it
        resizes docks.
        """
        if self.across == QtCore.Qt.Horizontal:
            return int(dock.width())
        window, rect = Gui.getMainWindow(), dock.geometry()
        bars = [
            bar.geometry()
            for bar in present(window, QtGui.QTabBar)
            if bar.parent() is window and bar.isVisible()
        ]
        tabs = [
            bar.height()
            for bar in bars
            if bar.left() <= rect.center().x() <= bar.right()
            and rect.adjusted(0, -_TOLERANCE_PX, 0, _TOLERANCE_PX).intersects(bar)
        ]
        return int(rect.height() + sum(tabs[:1]))

    def _resize(self, docks: list[Any], pixels: list[int]) -> None:
        if docks:
            Gui.getMainWindow().resizeDocks(docks, pixels, self.across)


BELOW, RIGHT = QtCore.Qt.BottomDockWidgetArea, QtCore.Qt.RightDockWidgetArea
_NOWHERE = QtCore.Qt.NoDockWidgetArea


class Dock(QtGui.QDockWidget):
    """A dock that reserves space in the window.

    wide: requested fraction of the window's width, unless another of our docks is in the area.
    high: requested height, pixels; 0: the size that its fields need. `closed` is called when the
    dock is closed, `seen` when it becomes visible, such as by a click on its tab.
    """

    def __init__(self, name: str, area: Any, wide: float = 0.0, high: int = 0) -> None:
        super().__init__(Gui.getMainWindow())
        self.setObjectName(name)
        self.area, self.wide, self.high = area, wide, high
        self.closed: Callable[[], None] | None = None
        self.seen: Callable[[], None] | None = None
        self.visibilityChanged.connect(self._visible)

    def setWindowTitle(self, title: str) -> None:
        """Show a title literally: an `&` does not mark a key."""
        super().setWindowTitle(escape_mnemonic(title))

    def hold(self, title: str, content: Any) -> None:
        """Show a widget under a title; delete the previous widget."""
        self.setWindowTitle(title)
        old_content = self.widget()
        self.setWidget(content)
        if old_content is not None:
            old_content.deleteLater()

    def come(self) -> None:
        """Open the dock in front of its tabs."""
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
            QtCore.QTimer.singleShot(0, self._fit_size)  # after the layout of the other docks

    def _join(self, window: Any) -> None:
        """Become a tab of one of our docks in the area, open or closed."""
        docks = [
            dock
            for dock in _docks.values()
            if dock is not self
            and not dock.isFloating()
            and window.dockWidgetArea(dock) == self.area
        ]
        if docks:
            window.tabifyDockWidget(max(docks, key=lambda dock: dock.isVisible()), self)

    def _fit_size(self) -> None:
        """Resize the dock to its requested size."""
        area = _area(self)
        if not self.isVisible() or area is None:
            return
        self.raise_()
        if self.wide and not area.has_another(self):
            window = Gui.getMainWindow()
            window.resizeDocks([self], [int(self.wide * window.width())], QtCore.Qt.Horizontal)
        area.fit_size()

    def empty(self) -> None:
        """Close and empty the dock; afterwards only its tool opens it."""
        self.closed = None
        self.close()
        self.toggleViewAction().setVisible(False)
        content = self.widget()
        self.setWidget(None)
        if content is not None:
            content.deleteLater()

    def closeEvent(self, event: Any) -> None:
        """Return the space of the dock to its neighbours when it is closed."""
        for area in _areas:
            area.leave(self)
        super().closeEvent(event)
        if self.closed is not None:
            self.closed()

    def _visible(self, visible: bool) -> None:
        if visible and self.seen is not None:
            self.seen()


_docks: dict[str, Dock] = {}  # keeps the docks alive
_areas: list[DockArea] = []


def dock(name: str, area: Any, wide: float = 0.0, high: int = 0) -> Dock:
    """Return the dock of this name; create it at first use."""
    if name not in _docks:
        _docks[name] = Dock(name, area, wide, high)
    return _docks[name]


def _area(dock: Dock) -> DockArea | None:
    """Return the area of a dock; None if it floats."""
    area = Gui.getMainWindow().dockWidgetArea(dock)
    if dock.isFloating() or area == _NOWHERE:
        return None
    for one_area in _areas:
        if one_area.area == area:
            return one_area
    _areas.append(DockArea(area))
    return _areas[-1]


# ---- Redraw a 3D view together with fields of the window in one cycle of the event loop
#
# By default, Coin redraws a changed view one cycle after Qt has painted changed fields, and in both
# cycles Qt composes the whole window. This costs as much as a small image, so an animation requests its
# redraw together with the fields.


def schedule_redraw(view: Any) -> None:
    """Redraw a 3D view together with fields that change now. Raises RuntimeError if the view is
    closed.
    """
    # not view.redraw(): in FreeCAD 0.20 it may draw at once, without the pending updates of Coin
    view.graphicsView().viewport().update()


def views_with_fields(document: str) -> None:
    """Schedule a redraw of all 3D views of a document."""
    if document in App.listDocuments():
        for view in Gui.getDocument(document).mdiViewsOfType("Gui::View3DInventor"):
            schedule_redraw(view)
