# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a toolpath, with a plot of the bead model's fit."""

from __future__ import annotations

import os
from typing import Any

import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ...core.issues import InputError
from ...core.parameters.process import BY_ANGLE, BY_POINT, HIDDEN, SHARPEST, SPREAD
from ...core.process import bead_model, wire
from ...core.process.bead_model import MINUTE, BeadModel
from ...core.process.wire import Measured
from ...core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ...objects.fields.preferences import in_user_units
from ...objects.stage import stage_of
from ...objects.stage_parts import Link
from ...objects.toolpath import Toolpath
from ...plots.chart import Picture, fit
from .. import recorded
from ..in_language import marked, tr, translated, translated_error
from ..plots.canvas import Canvas, in_words
from ..plots.dock import in_units
from ..signals import connect
from ..widgets import shape_inputs
from ..widgets.pick_field import Input
from ..widgets.shape_inputs import StageChoice, selected
from ..widgets.upright import scroll_areas_of
from ..worker import Later
from .stage import StagePanel

# ---- Plot and description of a bead model's fit

HEIGHT = 210


class FitPlot(Canvas):
    """Width over travel speed: a curve per radius and the measured points."""

    def __init__(self) -> None:
        super().__init__(interactive=False)
        self.setObjectName("BeadModelPlot")
        self.setMinimumHeight(HEIGHT)

    def set(self, measured: Measured, model: BeadModel, target_width: float | None) -> None:
        """Show another fit; `target_width`, mm, is drawn as a horizontal line."""
        self.show_picture(
            in_words(in_units(Picture("fit", "", (fit(measured, model, target_width),))))
        )

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)


def fits_text(measured: Measured, model: BeadModel) -> str:
    """Describe the fits in words."""
    lines = []
    for name, curve in ((tr("Width"), model.width), (tr("Height"), model.height)):
        lines.append(
            f"{name} = {curve.m:.4g} v^(-1/3) {_signed(curve.p)}/r {_signed(curve.t)} mm, "
            + tr("v in mm/min; R² {:.4f}, RMSE {:.3f} mm").format(curve.r_squared, curve.rmse)
        )
    slow, fast = (MINUTE * speed for speed in model.speeds)
    lines.append(
        in_user_units(
            tr("{} beads, {:g} to {:g} mm/min, r {:g} to {:g} mm, wire {:g} m/min").format(
                len(measured.width),
                slow,
                fast,
                model.radii[0],
                model.radii[1],
                MINUTE * model.wire_feed / 1000.0,
            )
        )
    )
    return "\n".join(lines)


def speeds_text(model: BeadModel, width: float) -> str:
    """Return the speeds for a width, and whether they are within the table."""
    solution = model.speed_for(width, np.array([model.radii[0], np.inf]))
    ends = np.select(
        [solution.too_slow, solution.too_fast],
        [tr("{} mm/min (the slowest of the table)"), tr("{} mm/min (the fastest of the table)")],
        "{} mm/min",
    )
    tight, straight = (
        str(end).format(f"{MINUTE * speed:.0f}")
        for speed, end in zip(solution.speed, ends, strict=True)
    )
    return in_user_units(
        tr("{:g} mm wide: {} where straight, {} where r is {:g} mm").format(
            width, straight, tight, model.radii[0]
        )
    )


def _signed(number: float) -> str:
    return f"{'+' if number >= 0.0 else '−'} {abs(number):.4g}"


# ---- The order of several features in a toolpath: the features after the first, and their sequence of
# layers

SHOWN = 3  # visible rows
PADDING = 14  # px around the text of a button
NAMES = {BY_FEATURE: marked("one after the other"), BY_HEIGHT: marked("lowest layer first")}


class FeatureOrder(Input):
    """The features after the first feature, which `first` selects.

    For a new toolpath, the selected features are added at once, later by a button. Up on the
    topmost feature makes it the first.
    """

    def __init__(self, link: Link, first_choice: StageChoice, present: Any, sequence: str) -> None:
        self.link, self.label, self.first = link, translated(link.label), first_choice
        self.explicit = bool(present)
        self.document = first_choice.document
        self.widget = QtGui.QWidget()
        self.widget.setToolTip(translated(link.help))
        column = QtGui.QVBoxLayout(self.widget)
        column.setContentsMargins(0, 0, 0, 0)
        self.list = QtGui.QListWidget()
        self.list.setObjectName("FeatureOrder")
        self.list.setMaximumHeight(int((SHOWN + 0.5) * self.list.fontMetrics().lineSpacing()) + 8)
        column.addWidget(self.list)
        row = QtGui.QHBoxLayout()
        buttons = (
            (
                "AddFeature",
                tr("Add"),
                tr("Adds the selected features, or the next feature in the document"),
                self.add,
            ),
            (
                "FeatureUp",
                tr("Up"),
                tr("Deposits the chosen feature earlier"),
                lambda: self.move(-1),
            ),
            (
                "FeatureDown",
                tr("Down"),
                tr("Deposits the chosen feature later"),
                lambda: self.move(1),
            ),
            (
                "RemoveFeature",
                tr("Remove"),
                tr("Removes the selected feature from this toolpath"),
                self.remove,
            ),
        )
        for name, text, tip, act in buttons:
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.setToolTip(tip)
            button.setAutoDefault(False)
            # as narrow as the text: four buttons at the style's width would widen the panel
            button.setMinimumWidth(button.fontMetrics().horizontalAdvance(text) + PADDING)
            button.clicked.connect(lambda *_, act=act: act())
            row.addWidget(button)
        column.addLayout(row)
        self.sequence = QtGui.QComboBox()
        self.sequence.setObjectName("Sequence")
        self.sequence.setToolTip(
            tr(
                "Order of several features: one after the other, or the lowest layer of any "
                "feature first"
            )
        )
        for value, name in NAMES.items():
            self.sequence.addItem(translated(name), value)
        self.sequence.setCurrentIndex(self.sequence.findData(sequence))
        column.addWidget(self.sequence)
        for obj in self._selected() if present is None else present:
            self._put(obj)
        self._show()

    def names(self) -> list[str]:
        """Return the names of the features after the first, in order."""
        return [self.list.item(row).data(QtCore.Qt.UserRole) for row in range(self.list.count())]

    def add(self) -> None:
        """Add the selected features, or the next feature of the document that is not in the list."""
        all_names = [self.first.widget.itemData(k) for k in range(self.first.widget.count())]
        remaining = [
            name
            for name in all_names
            if name not in (*self.names(), self.first.widget.currentData())
        ]
        features = self._selected() or [self.document.getObject(name) for name in remaining[:1]]
        for obj in features:
            self._put(obj)
        self.show_note(
            ""
            if features
            else tr("The document has no other feature; create another feature first.")
        )
        self._show()

    def move(self, by: int) -> None:
        """Move the selected feature up or down by one."""
        row, names = self.list.currentRow(), self.names()
        if row < 0:
            return
        if row + by < 0:  # becomes the first feature, which moves to the top of the list
            former = self.first.widget.currentData()
            self.first.widget.setCurrentIndex(self.first.widget.findData(names[0]))
            names[0] = former
        elif row + by < len(names):
            names[row], names[row + by] = names[row + by], names[row]
        self.list.clear()
        for name in names:
            self._put(self.document.getObject(name))
        self.list.setCurrentRow(min(max(row + by, 0), len(names) - 1))

    def remove(self) -> None:
        """Remove the selected feature."""
        self.list.takeItem(self.list.currentRow())
        self._show()

    def stored(self, obj: Any) -> Any:
        return list(getattr(obj, self.link.name)), obj.Sequence

    def show_stored(self, stored: Any) -> None:
        objects, sequence = stored
        self.list.clear()
        for obj in objects:
            self._put(obj)
        self.sequence.setCurrentIndex(self.sequence.findData(sequence))
        self._show()

    def applied(self) -> None:
        self.explicit = self.explicit or bool(self.names())

    def arguments(self) -> dict[str, str]:
        names = [name for name in self.names() if name != self.first.widget.currentData()]
        if not names and not self.explicit:
            return {}
        references = ", ".join(recorded.reference(self.document.getObject(name)) for name in names)
        return {self.link.key: f"[{references}]", "sequence": repr(self.sequence.currentData())}

    def _selected(self) -> list[Any]:
        """Return the selected features except the first."""
        features = [
            obj
            for obj in selected(self.document.Name)
            if getattr(stage_of(obj), "kind", "") == "feature"
        ]
        return [obj for obj in features if obj.Name != self.first.widget.currentData()]

    def _put(self, obj: Any) -> None:
        if obj is None or obj.Name in self.names():
            return
        item = QtGui.QListWidgetItem(obj.Label)
        item.setData(QtCore.Qt.UserRole, obj.Name)
        self.list.addItem(item)

    def _show(self) -> None:
        self.sequence.setEnabled(self.list.count() > 0)


MODEL, WIDTH = "process_bead_model", "process_bead_width"
SEAM = "process_seam_"
POINT, AWAY_FROM = f"{SEAM}point", f"{SEAM}away_from"
SEAM_KEYS = {  # keys of the seam that a position uses
    BY_ANGLE: {"angle", "step"},
    BY_POINT: {"point"},
    SHARPEST: {"angle", "step"},
    SPREAD: {"angle", "distance"},
    HIDDEN: {"away_from"},
}
NO_POINT = marked("Click a place of the part in the 3D view first.")
NO_VIEW = marked("Open a 3D view first.")
NONE = "none"
SCAN = "substrate_"  # prefix of scan parameters
DIGITS = 4  # decimals of a vector from the 3D view


class ToolpathPanel(StagePanel):
    """Shows the plot of the fit, its description and the speeds for the bead width under the bead
    model.
    """

    stage = Toolpath
    to_be_seen = False  # whether to scroll to the fit when it is shown next

    def __init__(self, obj: Any = None) -> None:
        title = tr("Toolpath") if obj is None else obj.Label
        feature, *other_choices = shape_inputs.of(Toolpath, obj)
        assert isinstance(feature, shape_inputs.StageChoice)
        link = next(link for link in Toolpath.links if link.many)
        present, sequence = (
            (None, BY_FEATURE) if obj is None else (getattr(obj, link.name), obj.Sequence)
        )
        order = FeatureOrder(link, feature, present, sequence)
        super().__init__(Toolpath, title, [feature, order, *other_choices], obj)
        self.plot = FitPlot()
        self.fit = QtGui.QLabel()
        self.fit.setObjectName("BeadModelFit")
        self.fit.setWordWrap(True)
        self.fit.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        field, _, fold = self.places[MODEL]
        self.choose = QtGui.QPushButton(tr("Choose a table…"))
        self.choose.setObjectName("ChooseBeadTable")
        self.choose.setToolTip(tr("Reads measured beads from a file of comma separated values"))
        self.choose.setAutoDefault(False)
        self.choose.clicked.connect(self._choose)
        for widget in (self.fit, self.plot, self.choose):
            fold.add_below(field.widget, widget)
        self.later = Later(self.form, self._show_fit)
        field.widget.editTextChanged.connect(lambda *_: self._soon(True))
        width = self.places[WIDTH][0].widget.findChild(QtGui.QLineEdit)
        connect(width, "textChanged(QString)", lambda *_: self._soon(False))
        self._show_fit()
        scan = next(choice for choice in other_choices if choice.widget.objectName() == "InputScan")
        self.scan = scan
        position = self.places[f"{SEAM}position"][0].widget
        self._add_seam_buttons()
        for widget in (scan.widget, position):
            widget.currentIndexChanged.connect(lambda *_: self._show_used())
        self._show_used()

    def _add_seam_buttons(self) -> None:
        """Add the buttons that take the seam point and direction from the 3D view."""
        self.seam_buttons = {}
        for key, text, name, tip, act in (
            (
                POINT,
                tr("Take the clicked place"),
                "TakeSeamPoint",
                tr("Takes the place of the part that you clicked last in the 3D view"),
                self._take_point,
            ),
            (
                AWAY_FROM,
                tr("Take the view direction"),
                "TakeSeamDirection",
                tr("Hides seams from the present view of the part"),
                self._take_direction,
            ),
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.setToolTip(tip)
            button.setAutoDefault(False)
            button.clicked.connect(lambda *_, act=act: act())
            field, _, fold = self.places[key]
            fold.add_below(field.widget, button)
            self.seam_buttons[key] = button

    def _show_used(self) -> None:
        """Hide the parameters of the scan without a scan, and those that the seam position ignores."""
        unused = set()
        if self.scan.value() is None:
            unused = {key for key in self.places if key.startswith(SCAN)}
        used = SEAM_KEYS[self.places[f"{SEAM}position"][0].value]
        for keys in SEAM_KEYS.values():
            unused |= {f"{SEAM}{key}" for key in keys - used}
        self.leave_out(unused)
        for key, button in self.seam_buttons.items():
            button.setVisible(key not in unused)

    def _take_point(self) -> None:
        """Enter the place that the user clicked last."""
        points = [
            point
            for entry in Gui.Selection.getSelectionEx(self.document.Name, 0)
            for point in entry.PickedPoints
        ]
        self._enter_vector(POINT, points[-1] if points else None, tr(NO_POINT))

    def _take_direction(self) -> None:
        """Enter the direction from the part to the eye."""
        view = Gui.ActiveDocument.ActiveView if Gui.ActiveDocument else None
        has_camera = hasattr(view, "getViewDirection")
        direction = view.getViewDirection().negative() if has_camera else None
        self._enter_vector(AWAY_FROM, direction, tr(NO_VIEW))

    def _enter_vector(self, key: str, vector: Any, missing: str) -> None:
        """Enter a vector, or say under the field what is missing."""
        self.show_note(key, "" if vector is not None else missing)
        if vector is not None:
            numbers = (round(float(number), DIGITS) + 0.0 for number in vector)
            self.places[key][0].show(" ".join(f"{number:g}" for number in numbers))

    def _choose(self, *_: Any) -> None:
        """Ask for the file of a calibration table."""
        folder, kinds = (
            os.path.dirname(self.document.FileName),
            f"{tr('Tables')} (*.csv);;{tr('All files')} (*)",
        )
        path, _ = QtGui.QFileDialog.getOpenFileName(
            Gui.getMainWindow(), tr("Calibration table"), folder, kinds
        )
        if path:
            self.places[MODEL][0].widget.setEditText(path)

    def _soon(self, of_model: bool) -> None:
        """Show the fit once typing stops; scroll to it for another model."""
        self.to_be_seen = self.to_be_seen or of_model
        self.later.ask()

    def _show_fit(self) -> None:
        """Plot the entered model; show a problem of its table under the field."""
        note, name = self.notes[MODEL], self.places[MODEL][0].value
        note.hide()
        self.plot.hide()
        self.fit.hide()
        if name in ("", NONE):
            return
        try:
            measured = wire.read_table(name)
            model = bead_model.fit(*measured)
        except InputError as error:
            note.setText(translated_error(error))
            note.show()
            return
        width = self._width()
        self.plot.set(measured, model, width)
        self.fit.setText(
            fits_text(measured, model) + ("" if width is None else f"\n{speeds_text(model, width)}")
        )
        self.plot.show()
        self.fit.show()
        if self.to_be_seen:
            self.to_be_seen = False
            QtCore.QTimer.singleShot(0, self._scroll)

    def _scroll(self) -> None:
        """Scroll to the fit after the layout is done."""
        for area in scroll_areas_of(self.form):
            if area.isVisible():
                area.ensureWidgetVisible(self.fit)

    def _width(self) -> float | None:
        """Return the entered width; None without one."""
        try:
            width = float(self.places[WIDTH][0].value)
        except InputError:
            return None
        return width if width > 0.0 else None
