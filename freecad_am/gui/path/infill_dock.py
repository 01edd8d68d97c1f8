# SPDX-License-Identifier: LGPL-2.1-or-later
"""The infill dock: the section of a toolpath layer in the 3D view, with voids, double deposit and
their fractions.
"""

from __future__ import annotations

import contextlib
import math
from typing import Any

import FreeCAD as App
import numpy as np
from pivy import coin
from PySide import QtGui

from ...core.geometry.formatting import place
from ...core.geometry.section import Coverage
from ...core.process.deposit import void_and_double
from ...core.process.deposit.void_and_double import Picture
from ...core.toolpath import Layer, Toolpath
from ...core.types import Array, Index, Mask
from ...objects.fields.preferences import in_user_units
from ...objects.stage import stage_of
from ...objects.toolpath import features_of, strategy_of
from ...plots.pictures import DOUBLE_COLOUR, VOID_COLOUR
from .. import dock_area, preferences_watch
from ..colours import INVALID, PLAIN, set_role
from ..dock_area import Follower, OnlyDock
from ..in_language import tr
from ..nodes.lines import Faces
from ..nodes.wall import unpickable
from ..widgets.shape_inputs import job_selection
from ..widgets.steady import Scrolled, SteadyText
from ..worker import Background, Worker
from .dock import Row, make_combo, offer

NAME = "RoboticAM_Infill"
VOID, OVER, OUTSIDE = "void", "over", "outside"
SINGLE = "single"
COLOURS = {SINGLE: "#b8b8b8", VOID: VOID_COLOUR, OVER: DOUBLE_COLOUR}
KEYS = {VOID: VOID_COLOUR, OVER: DOUBLE_COLOUR}
LIFT = 1.02  # in layer heights; offset of the section above the layer plane, over its beads
PAGE = 10


class SectionNodes:
    """A section in the 3D view: single deposit, voids and double deposit. Transparent to clicks."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        self.node.addChild(unpickable())
        self.faces = {
            name: Faces(QtGui.QColor(colour).getRgbF()[:3], 0.0) for name, colour in COLOURS.items()
        }
        for faces in self.faces.values():
            self.node.addChild(faces.node)

    def draw(self, picture: Picture, height: float) -> None:
        """Draw a picture, `height` mm above its plane."""
        void, double = picture.void, picture.double
        masks = {SINGLE: picture.inside & ~void & ~double, VOID: void, OVER: double}
        for name, mask in masks.items():
            flat, corners = quadrangles(picture, mask)
            points = picture.section.to_part(flat) + height * picture.section.frame[:3, 2]
            self.faces[name].set(points, corners)

    def clear(self) -> None:
        """Draw nothing."""
        for faces in self.faces.values():
            faces.set(np.zeros((0, 3)), np.zeros((0, 3)))


def quadrangles(picture: Picture, mask: Mask) -> tuple[Array, Index]:
    """Convert runs of mask pixels to rectangles: corners (4 n, 2), mm, and their triangles (2 n,
    3).
    """
    steps = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    rows, starts = np.nonzero(steps > 0)
    ends = np.nonzero(steps < 0)[1]
    low, high = rows - 0.5, rows + 0.5
    left, right = starts - 0.5, ends - 0.5
    flat = picture.raster.to_plane(
        np.stack([low, low, high, high], axis=1).ravel(),
        np.stack([left, right, right, left], axis=1).ravel(),
    )
    corners = 4 * np.arange(len(rows))[:, None, None] + np.array([(0, 1, 2), (0, 2, 3)])
    return flat, corners.reshape(-1, 3)


class InfillForm(QtGui.QWidget):
    """The widgets of the dock in the window's language."""

    def __init__(self) -> None:
        super().__init__()
        column, grid, buttons = QtGui.QVBoxLayout(self), QtGui.QGridLayout(), QtGui.QHBoxLayout()
        column.setContentsMargins(9, 4, 9, 4)
        column.setSpacing(3)
        self.choice = make_combo("path", tr("The toolpath whose layers are shown"))
        self.layer = Row("layer", tr("Layer"), tr("The layer shown, from 0"), PAGE)
        self.worst = {
            VOID: _button("worst_void", tr("Worst void"), tr("Go to the layer with most void")),
            OVER: _button(
                "worst_over",
                tr("Worst overlap"),
                tr("Go to the layer with most double deposit"),
            ),
        }
        self.voids = QtGui.QCheckBox(tr("Show voids"))
        self.voids.setObjectName("voids")
        self.voids.setToolTip(
            tr("Draw the section: red without a bead, blue with double deposit, grey otherwise")
        )
        self.voids.setChecked(True)
        self.shares = {
            name: SteadyText(name, lines) for name, lines in ((VOID, 2), (OVER, 2), (OUTSIDE, 1))
        }
        self.note = SteadyText("note", 1)
        what = QtGui.QHBoxLayout()
        what.addWidget(QtGui.QLabel(tr("Path")))
        what.addWidget(self.choice)
        what.addStretch(1)
        what.addWidget(self.voids)
        self.layer.add_to(grid, 0)
        for button in self.worst.values():
            buttons.addWidget(button)
        buttons.addStretch(1)
        for layout in (what, grid, buttons):
            column.addLayout(layout)
        for text in (*self.shares.values(), self.note):
            column.addWidget(text)
        column.addStretch(1)

    def enable(self, is_enabled: bool) -> None:
        """Enable or disable the widgets."""
        self.layer.enable(is_enabled)
        for widget in (self.voids, *self.worst.values()):
            widget.setEnabled(is_enabled)

    def tell(self, coverage: Coverage | None, max_void: float) -> None:
        """Show the fractions and positions of a layer; nothing for None."""
        for name, text in self.shares.items():
            text.show_text("" if coverage is None else _share_text(coverage, name))
        over_limit = coverage is not None and coverage.void > max_void
        set_role(self.shares[VOID].label, INVALID if over_limit else PLAIN)


def _button(name: str, text: str, help: str) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    return button


def _share_text(coverage: Coverage, name: str) -> str:
    """Describe a fraction of a layer with its colour key, and the largest region if known."""
    key = f'<span style="color: {KEYS[name]}">■</span> ' if name in KEYS else ""
    return key + _share_words(coverage, name)


def _share_words(coverage: Coverage, name: str) -> str:
    """Describe a fraction in words."""
    share = getattr(coverage, name)
    if math.isnan(share):
        return tr("Void: left open on purpose")
    text = {
        VOID: tr("Void: {:.2f} % of the section"),
        OVER: tr("Double deposit: {:.2f} % of the section"),
        OUTSIDE: tr("Outside: {:.2f} % of the section"),
    }[name].format(100.0 * share)
    point = getattr(coverage, f"{name}_place", None)
    if point is None:
        return text
    size = getattr(coverage, f"{name}_size")
    largest = tr("the largest place {:.2g} mm wide at {}").format(size, place(point))
    return f"{text}, {in_user_units(largest)}"


class InfillDock(Follower):
    """One dock for all documents.

    It shows the last selected toolpath, or else the latest, and draws only while open.
    """

    def __init__(self) -> None:
        self.target: tuple[str, str] | None = None  # names of document and object
        self.filling = False
        self.nodes = SectionNodes()
        self.root: Any = None  # scene that contains the nodes
        self.drawn: tuple[Any, ...] = ()  # key of the current or pending drawing
        self.dock = dock_area.dock(NAME, dock_area.BELOW)
        self._build()
        self.drawing = Background(self.dock)
        self.dock.seen, self.dock.closed = self.fill, self._closed
        preferences_watch.listen(self.fill)
        preferences_watch.listen_to_language(self._speak)
        App.addDocumentObserver(self)

    def _build(self) -> None:
        self.form = InfillForm()
        self.form.choice.activated.connect(self._chosen)
        self.form.layer.moved = lambda row: self.fill()
        self.form.voids.clicked.connect(lambda *_: self.fill())
        for name, button in self.form.worst.items():
            button.clicked.connect(lambda *_, name=name: self._go_to_worst(name))
        self.dock.hold(tr("Infill"), Scrolled(self.form))

    def _speak(self) -> None:
        """Rebuild in the window's new language; keep the entries."""
        layer, is_drawn = self.form.layer.value(), self.form.voids.isChecked()
        self._build()
        self.form.voids.setChecked(is_drawn)
        self.form.layer.set(0, layer, layer)
        self.fill()

    # ---- the toolpath

    def open(self, obj: Any = None) -> None:
        """Open the dock and show a toolpath from its first layer."""
        if obj is not None:
            self.target = (obj.Document.Name, obj.Name)
        self.dock.come()
        self.fill()

    def object(self) -> Any:
        """Return the selected toolpath, or else the latest of the document; None without any."""
        if self.target is not None and self.target[0] in App.listDocuments():
            obj = App.getDocument(self.target[0]).getObject(self.target[1])
            if is_toolpath(obj):
                return obj
        candidates = toolpaths()
        return candidates[-1] if candidates else None

    def _chosen(self, index: int) -> None:
        candidates = toolpaths()
        if 0 <= index < len(candidates):
            self.target = (candidates[index].Document.Name, candidates[index].Name)
        self.fill()

    def _go_to_worst(self, name: str) -> None:
        obj = self.object()
        layers = () if obj is None else obj.Proxy.value(obj).layers
        shares = {
            number: float(np.nan_to_num(getattr(layer.coverage, name)))
            for number, layer in enumerate(layers)
            if layer.coverage is not None
        }
        if shares:
            self.form.layer.box.setValue(max(shares, key=lambda number: shares[number]))

    # ---- display

    def fill(self) -> None:
        """Show the state of the toolpath; do nothing while the dock is closed."""
        if self.filling or not self.dock.isVisible():
            return
        self.filling = True
        try:
            self._fill()
        finally:
            self.filling = False

    def _fill(self) -> None:
        obj, form = self.object(), self.form
        candidates = toolpaths()
        labels = [candidate.Label for candidate in candidates]
        offer(form.choice, labels, candidates.index(obj) if obj in candidates else -1)
        toolpath: Toolpath | None = None if obj is None else obj.Proxy.value(obj)
        measured = toolpath is not None and any(
            layer.coverage is not None for layer in toolpath.layers
        )
        form.enable(measured)
        form.note.show_text("" if measured else _lacking(obj))
        if toolpath is None or not measured:
            form.tell(None, 1.0)
            self._clear()
            return
        last = len(toolpath.layers) - 1
        number = min(form.layer.value(), last)
        form.layer.set(0, last, number)
        self._show_layer(obj, toolpath, number)

    def _show_layer(self, obj: Any, toolpath: Toolpath, number: int) -> None:
        """Show the fractions of a layer, and draw its section in the background."""
        layer: Layer = toolpath.layers[number]
        if layer.coverage is None:
            self.form.note.show_text(tr("This layer is not measured."))
        self.form.tell(layer.coverage, _max_void(obj, layer.feature))
        key = (obj.Document.Name, obj.Name, obj.Key, number, self.form.voids.isChecked())
        if key == self.drawn:
            return
        self.drawn = key
        self._show_stretch(obj, number)
        self.drawing.start(
            lambda: void_and_double.picture(toolpath, number),
            lambda worker: self._take(worker, obj, number),
        )

    def _take(self, worker: Worker, obj: Any, number: int) -> None:
        """Draw a section and show its positions."""
        picture: Picture | None = worker.result()
        toolpath: Toolpath = obj.Proxy.value(obj)
        layer = toolpath.layers[number]
        if picture is None:
            self.nodes.clear()
            return
        if layer.coverage is not None:
            self.form.tell(picture.find_places(), _max_void(obj, layer.feature))
        self._attach(obj)
        if self.form.voids.isChecked():
            self.nodes.draw(picture, LIFT * float(toolpath.layer_heights[number]))
        else:
            self.nodes.clear()

    def _attach(self, obj: Any) -> None:
        """Add the nodes to the scene of a toolpath."""
        root = obj.ViewObject.RootNode
        if self.root is not None and self.root[0] == (obj.Document.Name, obj.Name):
            return
        self._detach()
        root.addChild(self.nodes.node)
        self.root = ((obj.Document.Name, obj.Name), root)

    def _detach(self) -> None:
        if self.root is not None:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the document is closed
                self.root[1].removeChild(self.nodes.node)
        self.root = None

    def _clear(self) -> None:
        """Draw nothing."""
        self.drawing.cancel()
        self.nodes.clear()
        self._detach()
        self.drawn = ()

    @staticmethod
    def _show_stretch(obj: Any, number: int | None) -> None:
        """Hide the layers above `number` in the paths of a toolpath; None shows all."""
        for path in (obj, *obj.InList):
            view = getattr(getattr(path, "ViewObject", None), "Proxy", None)
            if getattr(view, "rows", None) is not None:
                view.show(None if number is None else (0, number, None))

    def _closed(self) -> None:
        """Restore the views."""
        self._clear()
        obj = self.object()
        if obj is not None:
            self._show_stretch(obj, None)

    # ---- called by FreeCAD

    def slotChangedObject(self, obj: Any, name: str) -> None:
        """Update after a property has changed."""
        if name in ("Key", "Label") and self.dock.isVisible() and is_toolpath(obj):
            self.fill()


def _lacking(obj: Any) -> str:
    if obj is None:
        return tr("There is no toolpath yet; make a toolpath of a solid.")
    return tr(
        "{} has no measured layers; recompute a toolpath of a solid in planar layers."
    ).format(obj.Label)


def _max_void(obj: Any, number: int) -> float:
    """Return the maximum void fraction of a feature without a warning."""
    feature = features_of(obj)[number]
    parameters = feature.Proxy.parameters(feature, strategy_of(feature.Proxy))
    return float(getattr(parameters, "max_void", 1.0))


def is_toolpath(obj: Any) -> bool:
    """Whether an object is a computed toolpath."""
    stage = None if obj is None else stage_of(obj)
    return stage is not None and stage.kind == "toolpath" and bool(obj.Key)


def toolpaths() -> list[Any]:
    """Return the toolpaths of the document, latest last."""
    document = App.ActiveDocument
    return [] if document is None else [obj for obj in document.Objects if is_toolpath(obj)]


def _toolpath_of(obj: Any) -> Any:
    """Return the toolpath that an object is or is derived from; None for other objects."""
    for name in ("JointPath", "Toolpath"):
        obj = getattr(obj, name, None) or obj
    return obj if is_toolpath(obj) else None


only = OnlyDock(InfillDock)


def show() -> None:
    """Open the dock for the selected toolpath, that of the selected job or stage, or the latest."""
    selected = [toolpath for toolpath in map(_toolpath_of, job_selection()) if toolpath is not None]
    only.provide().open(selected[0] if selected else None)
