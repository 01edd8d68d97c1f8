# SPDX-License-Identifier: LGPL-2.1-or-later
"""The dock beside the 3D view that shows a path layer by layer and point by point, and tells of the bead that is reached."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np

from ..background import redraw
from ..docks import places
from ..docks.follower import Follower
from ..picking.selection import meant
from ..preferences import watch
from ..texts.translation import tr, translated
from ..widgets.scrolled import Scrolled
from . import path_view
from .colouring import LAYER
from .facts import facts
from .form import PathForm, offer
from .path_view import PathView
from .slider_row import Row

NAME = "RoboticAM_PathDock"
VISIBILITY, GROUP_TOUCHED = (
    "Visibility",
    "_GroupTouched",
)  # a group has the latter changed with its members


class PathDock(Follower):
    """One for all documents; it shows the path that was selected last, or else one that is to be seen."""

    def __init__(self) -> None:
        self.target: tuple[str, str] | None = None  # names of document and object
        self.filling = False
        self.dock = places.dock(NAME, places.BELOW)
        self._build()
        self.dock.seen, self.dock.closed = self.fill, self._closed
        path_view.listen(lambda view: self.fill())
        path_view.listen_to_clicks(self.dock.isVisible, self._picked)
        watch.listen_to_language(self._speak)
        App.addDocumentObserver(self)
        Gui.Selection.addObserver(self)

    # ---- the fields

    def _build(self) -> None:
        """The fields, in the language of the window."""
        self.form = PathForm()
        self._connect()
        self.dock.hold(tr("Path"), Scrolled(self.form))

    def _speak(self) -> None:
        """The window has another language."""
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
        self.form.single.clicked.connect(lambda *_: self._moved(self.form.to))
        self.form.all.clicked.connect(self._show_all)
        for row in (self.form.from_, self.form.to, self.form.point):
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
            _show(obj, True)
            planned = getattr(obj, "Toolpath", None)
            for other in _paths(obj.Document):
                if other is planned or getattr(other, "Toolpath", None) is obj:
                    _show(other, False)

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
        obj, form = self._object(), self.form
        view = None if obj is None else obj.ViewObject.Proxy
        rows = None if view is None else view.rows
        there = rows is not None and len(rows) > 0
        form.enable(there)
        paths = _paths()
        offer(form.choice, [path.Label for path in paths], paths.index(obj) if obj in paths else -1)
        if not there:
            form.facts.tell(
                tr("There is no path to show yet: make a toolpath or a joint path.")
                if obj is None
                else tr("{} is hidden, or has no result.").format(obj.Label)
            )
            return
        vobj = obj.ViewObject
        for combo, name in ((form.colouring, "Colouring"), (form.look, "Look")):
            names = vobj.getEnumerationsOfProperty(name)
            offer(combo, names, names.index(getattr(vobj, name)), translated)
        form.directions.setChecked(vobj.ShowDirections)
        first, last, count = view.shown or (0, rows.layer_count - 1, None)
        low, high = rows.of_layers(last, last)
        form.from_.set(0, rows.layer_count - 1, first)
        form.to.set(0, rows.layer_count - 1, last)
        row = max(low, (high if count is None else low + count) - 1)
        form.point.set(0, max(high - low - 1, 0), row - low)
        text = "" if view.scale is None or view.scale.title == LAYER else view.scale.text_at(row)
        form.facts.tell(" · ".join(filter(None, (text, facts(rows, row)))))

    def _moved(self, row: Row) -> None:
        view, form = self.view(), self.form
        if self.filling or view is None or view.rows is None:
            return
        first, last = form.from_.value(), form.to.value()
        if form.single.isChecked():
            first = last = first if row is form.from_ else last
        elif first > last:
            first, last = (first, first) if row is form.from_ else (last, last)
        count = (
            form.point.value() + 1
            if row is form.point and form.point.value() < form.point.most()
            else None
        )
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
            self.form.single.setChecked(False)
            self._show(view, None)

    def _closed(self) -> None:
        """All paths are whole again: nothing would tell what is left out of them."""
        self.form.single.setChecked(False)
        for document in App.listDocuments().values():
            for view in (obj.ViewObject.Proxy for obj in _paths(document)):
                if view.shown is not None:
                    view.show(None)

    def _picked(self, view: PathView, row: int) -> None:
        """A point of a path was clicked in the 3D view: all up to it is shown."""
        rows, obj = view.rows, view.obj
        if rows is None or row >= len(rows):
            return
        self.target = (obj.Document.Name, obj.Name)
        layer = int(rows.layers[rows.bead_of(row)])
        begin = 0 if view.shown is None else min(view.shown[0], layer)
        first = layer if self.form.single.isChecked() else begin
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
        found = (
            App.getDocument(document).getObject(name) if document in App.listDocuments() else None
        )
        if _is_path(found) and found.ViewObject.Visibility:
            self.target = (document, name)
            self.fill()


def _show(obj: Any, visible: bool) -> None:
    """Show or hide a path; to look at one does not count as a change of the document."""
    groups = [one for one in obj.InListRecursive if GROUP_TOUCHED in one.PropertiesList]
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


_dock: PathDock | None = None


def show(obj: Any = None) -> None:
    """Open the dock, of a path, of the selected one or that of the selected job or stage, or else of what is to be seen."""
    _made().open(obj or next(filter(_is_path, meant()), None))


def go_to(obj: Any, layer: int, bead: int | None, point: int | None) -> None:
    """Open the dock, and show a path up to a place, counted from 0."""
    _made().go_to(obj, layer, bead, point)


def _made() -> PathDock:
    global _dock
    if _dock is None:
        _dock = PathDock()
    return _dock
