# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock that shows a path layer by layer and point by point in the 3D view, with the data of the
last bead.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ...core.toolpath import Bead
from ...objects.fields.preferences import in_user_units, quantity_text
from .. import dock_area, preferences_watch
from ..dock_area import Follower, OnlyDock, views_with_fields
from ..in_language import tr, translated
from ..widgets.shape_inputs import job_selection
from ..widgets.steady import Scrolled, SteadyText, hold
from . import path_view
from .colouring import LAYER
from .path_view import PathView
from .pieces import Rows


class Row:
    """A slider with arrows at its ends and a number field; `moved` is called after the user moves
    it.
    """

    def __init__(self, name: str, text: str, help: str, page: int) -> None:
        self.label, self.slider, self.box = (
            QtGui.QLabel(text),
            QtGui.QSlider(QtCore.Qt.Horizontal),
            QtGui.QSpinBox(),
        )
        self.back, self.on = QtGui.QToolButton(), QtGui.QToolButton()
        for button, arrow, step in (
            (self.back, QtCore.Qt.LeftArrow, -1),
            (self.on, QtCore.Qt.RightArrow, 1),
        ):
            button.setArrowType(arrow)
            button.setAutoRepeat(True)
            button.clicked.connect(lambda *_, step=step: self.box.setValue(self.box.value() + step))
        self.slider.setObjectName(f"{name}_slider")
        self.box.setObjectName(f"{name}_spin")
        self.back.setObjectName(f"{name}_back")
        self.on.setObjectName(f"{name}_on")
        self.slider.setPageStep(page)
        for widget in (self.slider, self.box):
            widget.setToolTip(help)
        self.back.setToolTip(tr("Previous"))
        self.on.setToolTip(tr("Next"))
        self.moved: Any = lambda row: None
        self.slider.valueChanged.connect(self._slid)
        self.box.valueChanged.connect(lambda *_: self.moved(self))

    def add_to(self, grid: Any, row: int) -> None:
        """Add the widgets to a row of a grid with five columns."""
        for column, widget in enumerate((self.label, self.back, self.slider, self.on, self.box)):
            grid.addWidget(widget, row, column)
        grid.setColumnStretch(2, 1)

    def enable(self, is_enabled: bool) -> None:
        """Enable or disable the widgets."""
        for widget in (self.label, self.back, self.slider, self.on, self.box):
            widget.setEnabled(is_enabled)

    def _slid(self, value: int) -> None:
        if value != self.box.value():
            self.box.setValue(value)  # emits the change

    def set(self, lowest: int, highest: int, value: int) -> None:
        """Set bounds and value without a signal."""
        for widget in (self.slider, self.box):
            blocked = widget.blockSignals(True)
            widget.setRange(lowest, highest)
            widget.setValue(value)
            widget.blockSignals(blocked)
        hold(self.box)  # keeps the width of the widest number

    def value(self) -> int:
        """Return the entered value."""
        return int(self.box.value())

    def most(self) -> int:
        """Return the upper bound."""
        return int(self.box.maximum())


LINES = 3  # maximum number of lines for a point's data
LABEL = 14  # minimum number of visible letters of a choice
_LAYER_PAGE, _POINT_PAGE = 10, 100


class PathForm(QtGui.QWidget):
    """The widgets in the window's language."""

    def __init__(self) -> None:
        super().__init__()
        column, self.controls = QtGui.QVBoxLayout(self), QtGui.QWidget()
        column.setContentsMargins(9, 4, 9, 4)
        column.setSpacing(3)
        self.choice = make_combo("path", tr("The toolpath or joint path to show"))
        self.colouring = make_combo("colouring", tr("Quantity shown by the colours of the beads"))
        self.look = make_combo(
            "look", tr("Draw beads as lines, or as tubes of their width and layer height")
        )
        self.directions = QtGui.QCheckBox(tr("Build directions"))
        self.directions.setObjectName("directions")
        self.single = QtGui.QCheckBox(tr("One layer only"))
        self.single.setObjectName("single")
        self.all = QtGui.QPushButton(tr("Show all"))
        self.all.setObjectName("all")
        self.from_, self.to, self.point = (
            Row("from", tr("From layer"), tr("The first layer shown"), _LAYER_PAGE),
            Row("to", tr("To layer"), tr("The last layer shown"), _LAYER_PAGE),
            Row(
                "point",
                tr("Point"),
                tr("The last point shown, counted from 0 in the last layer"),
                _POINT_PAGE,
            ),
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

    def enable(self, is_enabled: bool) -> None:
        """Enable or disable the choices."""
        for widget in (
            self.controls,
            self.colouring,
            self.look,
            self.directions,
            self.single,
            self.all,
        ):
            widget.setEnabled(is_enabled)

    def _choices(self) -> Any:
        lines = QtGui.QVBoxLayout()
        what, how = QtGui.QHBoxLayout(), QtGui.QHBoxLayout()
        for line, text, widget in (
            (what, tr("Path"), self.choice),
            (what, tr("Colours"), self.colouring),
            (how, tr("Look"), self.look),
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


def offer(combo: Any, names: list[str], current: int, label: Callable[[str], str] = str) -> None:
    """Set the choices of a combo box if they changed."""
    if [combo.itemData(index) for index in range(combo.count())] != list(names):
        combo.clear()
        for name in names:
            combo.addItem(label(name), name)
    combo.setCurrentIndex(current)


def make_combo(name: str, help: str) -> Any:
    combo = QtGui.QComboBox()
    combo.setObjectName(name)
    combo.setToolTip(help)
    combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToContents)
    combo.setMinimumWidth(
        LABEL * combo.fontMetrics().averageCharWidth()
    )  # a long label must not widen the window
    return combo


def facts(rows: Rows, row: int) -> str:
    """Describe the bead of a row (layer, number, kind, speed, width, length and time) and the row's
    position.

    Numbers count from 0, as in messages, programs and `waypoints.csv`. Layers of several beads also
    show the number in the layer, as the dock does.
    """
    index = rows.bead_of(row)
    bead, layer = rows.bead(index), int(rows.layers[index])
    start, end = np.searchsorted(rows.layers, [layer, layer + 1])
    point = row - int(rows.starts[index])
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    time = float((length / bead.speed[1:]).sum())
    x, y, z = bead.points[point]
    low, high = rows.layer_rows(layer, layer)
    text = in_user_units(
        tr("point {} (0 to {}) at {:.2f}, {:.2f}, {:.2f} mm").format(point, len(bead) - 1, x, y, z)
    )
    if end - start > 1:
        text = tr("point {} (0 to {}) of the layer, of the bead {}").format(
            row - low, high - low - 1, text
        )
    return " · ".join(
        (
            tr("Layer {} (0 to {})").format(layer, rows.layer_count - 1),
            tr("bead {} (0 to {}), {}").format(
                index - int(start), int(end - start) - 1, _kind(bead)
            ),
            quantity_text(float(bead.speed[max(point, 1)]), "mm/s"),
            in_user_units(tr("{:.4g} mm wide").format(float(rows.width[row]))),
            in_user_units(tr("{:.1f} mm long in {:.1f} s").format(float(length.sum()), time)),
            text,
        )
    )


def _kind(bead: Bead) -> str:
    if bead.role.closing:
        return tr("closing bead")
    names = {
        "contour": tr("contour"),
        "line": tr("line"),
        "zigzag": tr("zigzag"),
        "spiral": tr("spiral"),
        "centre": tr("centre bead"),
        "closing": tr("closing bead"),
    }
    return names.get(bead.role.kind, tr("closed") if bead.closed else tr("open"))


NAME = "RoboticAM_PathDock"
VISIBILITY, GROUP_TOUCHED = (
    "Visibility",
    "_GroupTouched",
)  # a group's GroupTouched changes with its members


class PathDock(Follower):
    """One dock for all documents. It shows the last selected path, or else a visible path."""

    def __init__(self) -> None:
        self.target: tuple[str, str] | None = None  # names of document and object
        self.filling = False
        self.dock = dock_area.dock(NAME, dock_area.BELOW)
        self._build()
        self.dock.seen, self.dock.closed = self.fill, self._closed
        path_view.listen(lambda view: self.fill())
        path_view.listen_to_clicks(self.dock.isVisible, self._follow_click)
        preferences_watch.listen_to_language(self._speak)
        App.addDocumentObserver(self)
        Gui.Selection.addObserver(self)

    # ---- the fields

    def _build(self) -> None:
        """Build the fields in the window's language."""
        self.form = PathForm()
        self._connect()
        self.dock.hold(tr("Path"), Scrolled(self.form))

    def _speak(self) -> None:
        """Rebuild in the window's new language."""
        single = self.form.single.isChecked()
        self._build()
        self.form.single.setChecked(single)
        self.fill()

    def _connect(self) -> None:
        self.form.choice.activated.connect(self._chosen)
        self.form.colouring.activated.connect(
            lambda *_: self._set("Colouring", self.form.colouring.currentData())
        )
        self.form.look.activated.connect(lambda *_: self._set("Look", self.form.look.currentData()))
        self.form.directions.clicked.connect(
            lambda *_: self._set("ShowDirections", self.form.directions.isChecked())
        )
        self.form.single.clicked.connect(lambda *_: self._update_range(self.form.to))
        self.form.all.clicked.connect(self._show_all)
        for row in (self.form.from_, self.form.to, self.form.point):
            row.moved = self._update_range

    # ---- selected path

    def open(self, obj: Any = None) -> None:
        """Open the dock and show a path in it."""
        if obj is not None:
            self._take(obj)
        self.dock.come()
        self.fill()

    def follow(self, obj: Any) -> None:
        """Show a path if the dock is open; keep the order of the docks."""
        self._take(obj)
        self.fill()

    def view(self) -> PathView | None:
        """Return the view of the selected path, None without one."""
        obj = self._object()
        return None if obj is None else obj.ViewObject.Proxy

    def _object(self) -> Any:
        paths = _paths()
        visible = [obj for obj in paths if obj.ViewObject.Visibility]
        if self.target is not None and self.target[0] in App.listDocuments():
            path = App.getDocument(self.target[0]).getObject(self.target[1])
            if _is_path(path) and (path.ViewObject.Visibility or not visible):
                return path
        path = (visible or paths)[-1] if paths else None
        self.target = None if path is None else (path.Document.Name, path.Name)
        return path

    def _take(self, obj: Any) -> None:
        """Select and show a path, and hide the path at the same position."""
        self.target = (obj.Document.Name, obj.Name)
        if not obj.ViewObject.Visibility:
            _show(obj, True)
            planned = getattr(obj, "Toolpath", None)
            for path in _paths(obj.Document):
                if path is planned or getattr(path, "Toolpath", None) is obj:
                    _show(path, False)

    def _chosen(self, index: int) -> None:
        paths = _paths()
        if 0 <= index < len(paths):
            self._take(paths[index])
        self.fill()

    # ---- visible range

    def fill(self) -> None:
        """Show the state of the path; do nothing while the dock is closed."""
        if self.filling or not self.dock.isVisible():
            return
        self.filling = True
        try:
            self._fill()
        finally:
            self.filling = False

    def _fill(self) -> None:
        obj, form = self._object(), self.form
        view = None if obj is None else obj.ViewObject.Proxy
        rows = None if view is None else view.rows
        has_rows = rows is not None and len(rows) > 0
        form.enable(has_rows)
        paths = _paths()
        offer(form.choice, [path.Label for path in paths], paths.index(obj) if obj in paths else -1)
        if not has_rows:
            form.facts.show_text(
                tr("There is no path to show yet; make a toolpath or a joint path.")
                if obj is None
                else tr("{} is hidden, or has no result.").format(obj.Label)
            )
            return
        vobj = obj.ViewObject
        for combo, name in ((form.colouring, "Colouring"), (form.look, "Look")):
            names = vobj.getEnumerationsOfProperty(name)
            offer(combo, names, names.index(getattr(vobj, name)), translated)
        form.directions.setChecked(vobj.ShowDirections)
        from_layer, to_layer, count = view.shown or (0, rows.layer_count - 1, None)
        low, high = rows.layer_rows(to_layer, to_layer)
        form.from_.set(0, rows.layer_count - 1, from_layer)
        form.to.set(0, rows.layer_count - 1, to_layer)
        row = max(low, (high if count is None else low + count) - 1)
        form.point.set(0, max(high - low - 1, 0), row - low)
        text = "" if view.scale is None or view.scale.title == LAYER else view.scale.text_at(row)
        form.facts.show_text(" · ".join(filter(None, (text, facts(rows, row)))))

    def _update_range(self, row: Row) -> None:
        view, form = self.view(), self.form
        if self.filling or view is None or view.rows is None:
            return
        from_layer, to_layer = form.from_.value(), form.to.value()
        if form.single.isChecked():
            from_layer = to_layer = from_layer if row is form.from_ else to_layer
        elif from_layer > to_layer:
            from_layer, to_layer = (
                (from_layer, from_layer) if row is form.from_ else (to_layer, to_layer)
            )
        count = (
            form.point.value() + 1
            if row is form.point and form.point.value() < form.point.most()
            else None
        )
        is_complete = (from_layer, to_layer, count) == (0, view.rows.layer_count - 1, None)
        self._show(view, None if is_complete else (from_layer, to_layer, count))

    def _show(self, view: PathView, stretch: tuple[int, int, int | None] | None) -> None:
        """Show a stretch of a path and its range in the fields."""
        view.show(stretch)
        self.fill()
        views_with_fields(view.obj.Document.Name)

    def _show_all(self, *_: Any) -> None:
        view = self.view()
        if view is not None:
            self.form.single.setChecked(False)
            self._show(view, None)

    def _closed(self) -> None:
        """Show all paths completely, because without the dock nothing indicates a hidden stretch."""
        self.form.single.setChecked(False)
        for document in App.listDocuments().values():
            for view in (obj.ViewObject.Proxy for obj in _paths(document)):
                if view.shown is not None:
                    view.show(None)

    def _follow_click(self, view: PathView, row: int) -> None:
        """Show the path up to a point clicked in the 3D view."""
        rows, obj = view.rows, view.obj
        if rows is None or row >= len(rows):
            return
        self.target = (obj.Document.Name, obj.Name)
        layer = int(rows.layers[rows.bead_of(row)])
        begin = 0 if view.shown is None else min(view.shown[0], layer)
        start = layer if self.form.single.isChecked() else begin
        self._show(view, (start, layer, row + 1 - rows.layer_rows(layer, layer)[0]))

    def go_to(self, obj: Any, layer: int, bead: int | None, point: int | None) -> None:
        """Open the dock and show a path up to a point of a bead in a layer, counted from 0.

        None for bead and point shows the whole layer.
        """
        self.open(obj)
        rows = obj.ViewObject.Proxy.rows
        if rows is None or not 0 <= layer < rows.layer_count:
            return
        beads = np.flatnonzero(rows.layers == layer)
        row = rows.layer_rows(layer, layer)[1] - 1
        if bead is not None and bead < len(beads):
            start, end = rows.starts[beads[bead]], rows.starts[beads[bead] + 1]
            row = int(min(start + (point or 0), end - 1))
        self._follow_click(obj.ViewObject.Proxy, row)

    def _set(self, name: str, value: Any) -> None:
        view = self.view()
        if view is not None:
            setattr(view.obj.ViewObject, name, value)
        self.fill()

    # ---- called by FreeCAD

    def addSelection(self, document: str, name: str, *_: Any) -> None:
        """Show a selected path."""
        obj = App.getDocument(document).getObject(name) if document in App.listDocuments() else None
        if _is_path(obj) and obj.ViewObject.Visibility:
            self.target = (document, name)
            self.fill()


def _show(obj: Any, visible: bool) -> None:
    """Show or hide a path without marking the document as changed."""
    groups = [parent for parent in obj.InListRecursive if GROUP_TOUCHED in parent.PropertiesList]
    changing = [(obj, VISIBILITY), (obj.ViewObject, VISIBILITY)]
    changing += [(group, GROUP_TOUCHED) for group in groups]
    for holder, name in changing:
        holder.setPropertyStatus(name, "NoModify")
    try:
        obj.ViewObject.Visibility = visible
    finally:
        for holder, name in changing:
            holder.setPropertyStatus(name, "-NoModify")


def _is_path(obj: Any) -> bool:
    return isinstance(getattr(getattr(obj, "ViewObject", None), "Proxy", None), PathView)


def _paths(document: Any = None) -> list[Any]:
    document = document or App.ActiveDocument
    return [] if document is None else [obj for obj in document.Objects if _is_path(obj)]


only = OnlyDock(PathDock)


def show(obj: Any = None) -> None:
    """Open the dock for a path. The default is the selected path, the path of the selected job or
    stage, or a visible path.
    """
    only.provide().open(obj or next(filter(_is_path, job_selection()), None))


def go_to(obj: Any, layer: int, bead: int | None, point: int | None) -> None:
    """Open the dock and show a path up to a point, counted from 0."""
    only.provide().go_to(obj, layer, bead, point)
