# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plots dock: a picture of a toolpath, joint path or program, or of some of its layers, over
time or path.
"""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.issues import AmError
from ...objects.fields.preferences import scale_of
from ...objects.staleness import STALE
from ...plots import chart, pictures
from ...plots.chart import Picture
from ...plots.pictures import OVER, PATH, TIME
from ...plots.source import Source
from .. import dock_area, preferences_watch
from ..dock_area import Follower, OnlyDock
from ..in_language import tr, translated_error
from ..widgets.shape_inputs import job_selection
from ..widgets.steady import Scrolled
from ..worker import Background, Later, Worker
from . import canvas, saving
from .canvas import Canvas
from .saving import JOINT_PATH, PROGRAM, TOOLPATH, key_of, kind_of, made_from, maker_of, plottable


def in_units(picture: Picture) -> Picture:
    """Return a picture in the user's units; machine axes keep the units of their controllers."""
    return chart.in_units(picture, scale_of)


NAME = "RoboticAM_Plots"
HEIGHT, LEAST_HEIGHT = 330, 80  # pixels; height of the dock, and minimum height of a picture
LABEL_LETTERS, MIN_LETTERS, MAX_LETTERS = (
    9,
    14,
    36,
)  # letters: width of a label, and its minimum and maximum
CHANGES = ("Key", "Status", "Label", "StartAtLayer", "StartAtBead")
KINDS = (TOOLPATH, JOINT_PATH, PROGRAM, "cell")


class PlotsDock(Follower):
    """One dock for all documents; it follows the last selection and its changes."""

    def __init__(self) -> None:
        self.target: tuple[str, str] | None = None  # names of the requested document and object
        self.source: tuple[Any, Source] | None = None  # key and data of the source
        self.picture: Picture | None = None
        self.metric: Picture | None = None  # the picture in mm, for values in a file
        self.shown: tuple[Any, ...] = ()  # object, picture and axis of the display
        self.layers_of: tuple[str, str] | None = (
            None  # object of the chosen layers, with its document, because names repeat in other documents
        )
        self.dock = dock_area.dock(NAME, dock_area.BELOW, high=HEIGHT)
        self.canvas = Canvas()
        self.canvas.setObjectName("canvas")
        self.scroll = QtGui.QScrollArea()
        self.scroll.setWidgetResizable(True)
        self.scroll.setFrameShape(QtGui.QFrame.NoFrame)
        self.scroll.setWidget(self.canvas)
        self.scroll.setMinimumHeight(LEAST_HEIGHT)
        self.reading = QtGui.QLabel()
        self.toolbar = self._make_toolbar()
        self._build()
        self.building = Background(self.dock)
        self.soon, self.changed = Later(self.dock, self.fill), Later(self.dock, self.fill)
        self.dock.seen = self.fill
        preferences_watch.listen(self.fill)
        preferences_watch.listen_to_language(self._speak)
        App.addDocumentObserver(self)
        Gui.Selection.addObserver(self)

    # ---- the fields

    def _make_toolbar(self) -> Any:
        """Create matplotlib's toolbar; None without matplotlib."""
        shown = self.canvas.provide_view()
        if shown is None:
            return None
        from .view import Toolbar  # imports matplotlib, which takes some time

        return Toolbar(shown, self._save, self._show_reading)

    def _build(self) -> None:
        """Build the fields around the canvas in the window's language."""
        form = QtGui.QWidget()
        self.choice = self._combo(
            "plotted", tr("The toolpath, joint path or program to plot"), LABEL_LETTERS
        )
        self.choice.setMaximumWidth(
            MAX_LETTERS * self.choice.fontMetrics().averageCharWidth()
        )  # leave space for the other widgets
        self.which = self._combo("picture", tr("Quantity to plot"))
        self.over = self._combo("over", tr("Along the time of the job, or along its path"))
        self.first, self.last = (
            self._layer("from", tr("The first layer")),
            self._layer("to", tr("The last layer")),
        )
        self.note, self.reading = QtGui.QLabel(), QtGui.QLabel()
        self.note.setObjectName("note")
        self.reading.setObjectName("reading")
        self._fill(form)
        for name, entry in pictures.PICTURES.items():
            self.which.addItem(canvas.translated(entry.title), name)
        for over in OVER:
            self.over.addItem({TIME: tr("time"), PATH: tr("path")}[over], over)
        for combo in (self.which, self.over):
            combo.currentIndexChanged.connect(lambda *_: self.fill())
        self.choice.activated.connect(self._chosen)
        for box in (self.first, self.last):
            box.valueChanged.connect(lambda *_: self.soon.ask())
        self.dock.hold(tr("Plots"), Scrolled(form))

    def _speak(self) -> None:
        """Rebuild in the window's new language; keep the choices."""
        indices = [(name, getattr(self, name).currentIndex()) for name in ("which", "over")]
        layers = [
            (name, getattr(self, name).maximum(), getattr(self, name).value())
            for name in ("first", "last")
        ]
        self._build()
        for name, index in indices:
            combo = getattr(self, name)
            blocked = combo.blockSignals(True)
            combo.setCurrentIndex(index)
            combo.blockSignals(blocked)
        for name, maximum, value in layers:
            box = getattr(self, name)
            blocked = box.blockSignals(True)
            box.setMaximum(maximum)
            box.setValue(value)
            box.blockSignals(blocked)
        self.fill()

    def _combo(self, name: str, help: str, letters: int = 0) -> Any:
        combo = QtGui.QComboBox()
        combo.setObjectName(name)
        combo.setToolTip(help)
        combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToContents)
        combo.setMinimumContentsLength(letters)
        combo.setMinimumWidth(
            MIN_LETTERS * combo.fontMetrics().averageCharWidth()
        )  # long names must not widen the window
        return combo

    def _layer(self, name: str, help: str) -> Any:
        box = QtGui.QSpinBox()
        box.setObjectName(name)
        box.setToolTip(help)
        box.setRange(0, 0)
        return box

    def _fill(self, form: Any) -> None:
        column, line = QtGui.QVBoxLayout(form), QtGui.QHBoxLayout()
        column.setContentsMargins(9, 4, 9, 4)
        column.setSpacing(3)
        for text, widget in (
            ("", self.choice),
            ("", self.which),
            (tr("over"), self.over),
            (tr("layers"), self.first),
            (tr("to"), self.last),
        ):
            if text:
                line.addWidget(QtGui.QLabel(text))
            line.addWidget(widget)
        line.addStretch(1)
        if self.toolbar is not None:
            self.toolbar.speak()
            # otherwise PySide treats the toolbar as deleted with its earlier parent
            self.toolbar.setParent(form)
            line.addWidget(self.toolbar)
        below = QtGui.QHBoxLayout()
        below.addWidget(self.reading, 1)
        below.addWidget(self.note)
        column.addLayout(line)
        column.addWidget(self.scroll, 1)
        column.addLayout(below)

    # ---- selection

    def open(self, obj: Any = None) -> None:
        """Open the dock and show the pictures of an object."""
        if obj is not None:
            self.target = (obj.Document.Name, obj.Name)
        self.dock.come()
        self.fill()

    def object(self) -> Any:
        """Return the selected object, or else the latest of the document; None without any."""
        if self.target is not None and self.target[0] in App.listDocuments():
            found = App.getDocument(self.target[0]).getObject(self.target[1])
            if plottable(found):
                return found
        candidates = _plottable()
        return (
            max(candidates, key=lambda obj: kind_of(obj) == JOINT_PATH) if candidates else None
        )  # not stored, because a later stage may follow

    def _chosen(self, index: int) -> None:
        candidates = _plottable()
        if 0 <= index < len(candidates):
            self.target = (candidates[index].Document.Name, candidates[index].Name)
        self.fill()

    def fill(self) -> None:
        """Create the chosen picture; do nothing while the dock is closed."""
        if not self.dock.isVisible():
            return
        self.building.cancel()
        obj = self.object()
        candidates = _plottable()
        labels = [candidate.Label for candidate in candidates]
        if [self.choice.itemText(index) for index in range(self.choice.count())] != labels:
            self.choice.clear()
            self.choice.addItems(labels)
        self.choice.setCurrentIndex(candidates.index(obj) if obj in candidates else -1)
        entry = pictures.PICTURES[self.which.currentData()]
        self.over.setEnabled(entry.along is not None)
        self.note.setText("")
        if obj is None:
            self._show(None, tr("There is no path to plot yet; make a toolpath or a joint path."))
            return
        if made_from(obj)[0].Status == STALE:
            self.note.setText(tr("The plot shows an earlier state; recompute the document."))
        self._layers(obj)
        try:
            key, make = key_of(obj), maker_of(obj)
        except AmError as error:
            self._show(None, translated_error(error))
            return
        cached = self.source[1] if self.source is not None and self.source[0] == key else None
        name, over = self.which.currentData(), self.over.currentData()
        layers = (
            min(self.first.value(), self.last.value()),
            max(self.first.value(), self.last.value()),
        )
        self.note.setText(self.note.text() or tr("Computing…"))
        if self.canvas.picture is None:
            self.canvas.show_picture(None, tr("Computing…"))

        def work() -> tuple[Source, Picture]:
            source = cached or make()
            return source, pictures.picture(name, source, over, layers)

        identity = (
            *_identity(obj),
            name,
            over,
            layers,
        )  # read now, because the object may be deleted later
        self.building.start(work, lambda worker: self._built(worker, key, identity))

    def _layers(self, obj: Any) -> None:
        """Set the range of layers; select all layers of a new object."""
        toolpath = made_from(obj)[min(1, len(made_from(obj)) - 1)]
        last_layer = max(len(toolpath.Proxy.value(toolpath).layers) - 1, 0)
        is_new, self.layers_of = self.layers_of != _identity(obj), _identity(obj)
        anew = is_new or self.last.value() == self.last.maximum()
        for box, value in (
            (self.first, 0 if is_new else self.first.value()),
            (self.last, last_layer if anew else self.last.value()),
        ):
            blocked = box.blockSignals(True)
            box.setRange(0, last_layer)
            box.setValue(value)
            box.blockSignals(blocked)

    def _built(self, worker: Worker, key: Any, identity: tuple[Any, ...]) -> None:
        if self.note.text() == tr("Computing…"):
            self.note.setText("")
        try:
            source, picture = worker.result()
            self.metric = canvas.in_words(picture, user_units=False)
            picture = canvas.in_words(in_units(picture))
        except AmError as error:
            self._show(None, translated_error(error))
            return
        self.source = (key, source)
        self._show(picture, picture.lacking, self.shown == identity)
        self.shown = identity

    def _show(self, picture: Picture | None, text: str = "", keep: bool = False) -> None:
        self.picture = picture if picture is not None and picture.charts else None
        if self.toolbar is not None:
            self.toolbar.setEnabled(self.picture is not None)
        self._show_reading("")
        self.canvas.show_picture(self.picture, text, keep)

    # ---- user actions

    def _show_reading(self, text: str) -> None:
        self.reading.setText(text)

    def _save(self, *_: Any) -> None:
        obj = self.object()
        if obj is not None and self.picture is not None:
            saving.save(self.picture, self.metric, obj, self.canvas)

    # ---- called by FreeCAD

    def addSelection(self, document: str, name: str, *_: Any) -> None:
        """Show the plots of a selected object."""
        obj = App.getDocument(document).getObject(name) if document in App.listDocuments() else None
        if obj is not None and plottable(obj) and self.target != (document, name):
            self.target = (document, name)
            QtCore.QTimer.singleShot(0, self.fill)

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """Update after a property has changed."""
        if name in CHANGES and self.dock.isVisible() and kind_of(obj) in KINDS:
            self.changed.ask()


def _identity(obj: Any) -> tuple[str, str]:
    return str(obj.Document.Uid), str(obj.Name)


def _plottable() -> list[Any]:
    document = App.ActiveDocument
    return [] if document is None else [obj for obj in document.Objects if plottable(obj)]


only = OnlyDock(PlotsDock)


def show(obj: Any = None) -> None:
    """Open the dock for an object, the selected object, or the latest."""
    only.provide().open(obj or next(filter(plottable, job_selection()), None))
