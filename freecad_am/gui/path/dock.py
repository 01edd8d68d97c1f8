# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock beside the 3D view that shows a path layer by layer and point by point, and tells of the bead that is reached."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtGui

from ..background import redraw
from ..docks import places
from ..docks.follower import Follower
from ..preferences import watch
from ..texts.translation import tr, translated
from ..widgets.steady import SteadyText
from . import path_view
from .colouring import LAYER
from .facts import facts
from .path_view import PathView
from .slider_row import Row

NAME = "RoboticAM_PathDock"
LINES = 3  # of what is told of a point, at most
LABEL = 14  # letters of a choice that are to be seen, at least
_LAYER_PAGE, _POINT_PAGE = 10, 100


class PathDock(Follower):
    """One for all documents; it shows the path that was selected last, or else one that is to be seen."""

    def __init__(self) -> None:
        self.target: tuple[str, str] | None = None  # names of document and object
        self.filling = False
        self.dock = places.dock(NAME, places.BELOW)
        self._build()
        self.dock.seen = self.fill
        path_view.listen(lambda view: self.fill())
        path_view.listen_to_clicks(self.dock.isVisible, self._picked)
        watch.listen_to_language(self._speak)
        App.addDocumentObserver(self)
        Gui.Selection.addObserver(self)

    # ---- the fields

    def _build(self) -> None:
        """The fields, in the language of the window."""
        form = QtGui.QWidget()
        column, self.controls = QtGui.QVBoxLayout(form), QtGui.QWidget()
        column.setContentsMargins(9, 4, 9, 4)
        column.setSpacing(3)
        self.choice = self._combo("path", tr("The toolpath or joint path to look at"))
        self.colouring = self._combo("colouring", tr("What the colours of the beads tell"))
        self.look = self._combo("look", tr("Draw beads as lines, or as tubes of their width and layer height"))
        self.directions = QtGui.QCheckBox(tr("Build directions"))
        self.directions.setObjectName("directions")
        self.single = QtGui.QCheckBox(tr("One layer alone"))
        self.single.setObjectName("single")
        self.all = QtGui.QPushButton(tr("Show all"))
        self.all.setObjectName("all")
        self.from_, self.to, self.point = (
            Row("from", tr("From layer"), tr("The first layer that is shown"), _LAYER_PAGE),
            Row("to", tr("To layer"), tr("The last layer that is shown"), _LAYER_PAGE),
            Row("point", tr("Point"), tr("The last point that is shown, counted from 0 in the last layer"), _POINT_PAGE),
        )
        self.facts = SteadyText("facts", LINES)
        column.addLayout(self._choices())
        column.addWidget(self.controls)
        grid = QtGui.QGridLayout(self.controls)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(2)
        for number, row in enumerate((self.from_, self.to, self.point)):
            row.add_to(grid, number)
        column.addWidget(self.facts)
        column.addStretch(1)
        self._connect()
        self.dock.hold(tr("Path"), form)

    def _speak(self) -> None:
        """The window has another language."""
        single = self.single.isChecked()
        self._build()
        self.single.setChecked(single)
        self.fill()

    def _combo(self, name: str, help: str) -> Any:
        combo = QtGui.QComboBox()
        combo.setObjectName(name)
        combo.setToolTip(help)
        combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToContents)
        combo.setMinimumWidth(LABEL * combo.fontMetrics().averageCharWidth())  # a long label widens no window
        return combo

    def _choices(self) -> Any:
        lines = QtGui.QVBoxLayout()
        what, how = QtGui.QHBoxLayout(), QtGui.QHBoxLayout()
        for line, text, widget in (
            (what, tr("Path"), self.choice), (what, tr("Colours"), self.colouring), (how, tr("Look"), self.look),
        ):
            line.addWidget(QtGui.QLabel(text))
            line.addWidget(widget)
        what.addStretch(1)
        for box in (self.directions, self.single):
            how.addWidget(box)
        how.addStretch(1)
        how.addWidget(self.all)
        lines.addLayout(what)
        lines.addLayout(how)
        return lines

    def _connect(self) -> None:
        self.choice.activated.connect(self._chosen)
        self.colouring.activated.connect(lambda *_: self._set("Colouring", self.colouring.currentData()))
        self.look.activated.connect(lambda *_: self._set("Look", self.look.currentData()))
        self.directions.clicked.connect(lambda *_: self._set("ShowDirections", self.directions.isChecked()))
        self.single.clicked.connect(lambda *_: self._moved(self.to))
        self.all.clicked.connect(self._show_all)
        for row in (self.from_, self.to, self.point):
            row.moved = self._moved

    # ---- what is looked at

    def open(self, obj: Any = None) -> None:
        """Show the dock, and in it this path."""
        if obj is not None:
            self._take(obj)
        self.dock.come()
        self.fill()

    def follow(self, obj: Any) -> None:
        """Show this path, where the dock is open; in front of others only what was."""
        self._take(obj)
        self.fill()

    def view(self) -> PathView | None:
        """The view of the path that is looked at, None when there is none (any more)."""
        obj = self._object()
        return None if obj is None else obj.ViewObject.Proxy

    def _object(self) -> Any:
        paths = _paths()
        seen = [obj for obj in paths if obj.ViewObject.Visibility]
        if self.target is not None and self.target[0] in App.listDocuments():
            found = App.getDocument(self.target[0]).getObject(self.target[1])
            if _is_path(found) and (found.ViewObject.Visibility or not seen):
                return found
        found = (seen or paths)[-1] if paths else None
        self.target = None if found is None else (found.Document.Name, found.Name)
        return found

    def _take(self, obj: Any) -> None:
        """Look at a path: it is made visible, and what lies at the same place is hidden."""
        self.target = (obj.Document.Name, obj.Name)
        if not obj.ViewObject.Visibility:
            obj.ViewObject.Visibility = True
            planned = getattr(obj, "Toolpath", None)
            for other in _paths(obj.Document):
                if other is planned or getattr(other, "Toolpath", None) is obj:
                    other.ViewObject.Visibility = False

    def _chosen(self, index: int) -> None:
        paths = _paths()
        if 0 <= index < len(paths):
            self._take(paths[index])
        self.fill()

    # ---- what is shown of it

    def fill(self) -> None:
        """Show the state of the path; nothing while the dock is closed."""
        if self.filling or not self.dock.isVisible():
            return
        self.filling = True
        try:
            self._fill()
        finally:
            self.filling = False

    def _fill(self) -> None:
        obj = self._object()
        view = None if obj is None else obj.ViewObject.Proxy
        rows = None if view is None else view.rows
        there = rows is not None and len(rows) > 0
        for widget in (self.controls, self.colouring, self.look, self.directions, self.single, self.all):
            widget.setEnabled(there)
        paths = _paths()
        _offer(self.choice, [path.Label for path in paths], paths.index(obj) if obj in paths else -1)
        if not there:
            self.facts.tell(tr("There is no path to look at yet: make a toolpath or a joint path.") if obj is None else
                            tr("{} is hidden, or has no result.").format(obj.Label))
            return
        vobj = obj.ViewObject
        for combo, name in ((self.colouring, "Colouring"), (self.look, "Look")):
            names = vobj.getEnumerationsOfProperty(name)
            _offer(combo, names, names.index(getattr(vobj, name)), translated)
        self.directions.setChecked(vobj.ShowDirections)
        first, last, count = view.shown or (0, rows.layer_count - 1, None)
        low, high = rows.of_layers(last, last)
        self.from_.set(0, rows.layer_count - 1, first)
        self.to.set(0, rows.layer_count - 1, last)
        row = max(low, (high if count is None else low + count) - 1)
        self.point.set(0, max(high - low - 1, 0), row - low)
        told = "" if view.scale is None or view.scale.title == LAYER else view.scale.told(row)
        self.facts.tell(" · ".join(filter(None, (told, facts(rows, row)))))

    def _moved(self, row: Row) -> None:
        view = self.view()
        if self.filling or view is None or view.rows is None:
            return
        first, last = self.from_.value(), self.to.value()
        if self.single.isChecked():
            first = last = (first if row is self.from_ else last)
        elif first > last:
            first, last = (first, first) if row is self.from_ else (last, last)
        count = self.point.value() + 1 if row is self.point and self.point.value() < self.point.most() else None
        whole = (first, last, count) == (0, view.rows.layer_count - 1, None)
        self._show(view, None if whole else (first, last, count))

    def _show(self, view: PathView, shown: tuple[int, int, int | None] | None) -> None:
        """Show a stretch of a path, and in the fields what it is."""
        view.show(shown)
        self.fill()
        redraw.views_with_fields(view.obj.Document.Name)

    def _show_all(self, *_: Any) -> None:
        view = self.view()
        if view is not None:
            self.single.setChecked(False)
            self._show(view, None)

    def _picked(self, view: PathView, row: int) -> None:
        """A point of a path was clicked in the 3D view: all up to it is shown."""
        rows, obj = view.rows, view.obj
        if rows is None or row >= len(rows):
            return
        self.target = (obj.Document.Name, obj.Name)
        layer = int(rows.layers[rows.bead_of(row)])
        begin = 0 if view.shown is None else min(view.shown[0], layer)
        first = layer if self.single.isChecked() else begin
        self._show(view, (first, layer, row + 1 - rows.of_layers(layer, layer)[0]))

    def go_to(self, obj: Any, layer: int, bead: int | None, point: int | None) -> None:
        """Open, and show a path up to a point of a bead of a layer, counted from 0; the layer alone where these are None."""
        self.open(obj)
        rows = obj.ViewObject.Proxy.rows
        if rows is None or not 0 <= layer < rows.layer_count:
            return
        beads = np.flatnonzero(rows.layers == layer)
        row = rows.of_layers(layer, layer)[1] - 1
        if bead is not None and bead < len(beads):
            start, end = rows.starts[beads[bead]], rows.starts[beads[bead] + 1]
            row = int(min(start + (point or 0), end - 1))
        self._picked(obj.ViewObject.Proxy, row)

    def _set(self, name: str, value: Any) -> None:
        view = self.view()
        if view is not None:
            setattr(view.obj.ViewObject, name, value)
        self.fill()

    # ---- called by FreeCAD

    def addSelection(self, document: str, name: str, *_: Any) -> None:
        """Something was selected."""
        found = App.getDocument(document).getObject(name) if document in App.listDocuments() else None
        if _is_path(found) and found.ViewObject.Visibility:
            self.target = (document, name)
            self.fill()


def _offer(combo: Any, names: list[str], chosen: int, told: Callable[[str], str] = str) -> None:
    """Choices of a combo box, changed only where they differ."""
    if [combo.itemData(index) for index in range(combo.count())] != list(names):
        combo.clear()
        for name in names:
            combo.addItem(told(name), name)
    combo.setCurrentIndex(chosen)


def _is_path(obj: Any) -> bool:
    return isinstance(getattr(getattr(obj, "ViewObject", None), "Proxy", None), PathView)


def _paths(document: Any = None) -> list[Any]:
    document = document or App.ActiveDocument
    return [] if document is None else [obj for obj in document.Objects if _is_path(obj)]


_dock: PathDock | None = None


def show(obj: Any = None) -> None:
    """Open the dock, of a path or of what is to be seen."""
    _made().open(obj)


def go_to(obj: Any, layer: int, bead: int | None, point: int | None) -> None:
    """Open the dock, and show a path up to a place, counted from 0."""
    _made().go_to(obj, layer, bead, point)


def _made() -> PathDock:
    global _dock
    if _dock is None:
        _dock = PathDock()
    return _dock
