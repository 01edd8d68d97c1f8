# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a toolpath: a bead model is shown by the plot of its fit."""

from __future__ import annotations

import os
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.issues import InputError
from ...core.process.model import bead_model, wire
from ...core.strategies.sequence import BY_FEATURE
from ...objects.toolpath import Toolpath
from ..background.worker import Later
from ..picking import shape_inputs
from ..signals import connect
from ..texts.in_language import tr, translated_error
from ..widgets.feature_order import FeatureOrder
from ..widgets.fit_plot import FitPlot, fits_text, speeds_text
from ..widgets.upright import scroll_areas_of
from .stage import StagePanel

MODEL, WIDTH = "process_bead_model", "process_bead_width"
NONE = "none"
SCAN = "substrate_"  # prefix of the parameters of a scan


class ToolpathPanel(StagePanel):
    """Under the bead model: the plot of its fit, the fit in words, and the speeds that the bead width asks for."""

    stage = Toolpath
    to_be_seen = False  # whether the fit is scrolled to when it is shown next

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
        scan.widget.currentIndexChanged.connect(lambda *_: self._fit_to(scan))
        self._fit_to(scan)

    def _fit_to(self, scan: Any) -> None:
        """Hide the parameters of a scan without a scan."""
        self.leave_out(
            () if scan.value() is not None else {key for key in self.places if key.startswith(SCAN)}
        )

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
        """Show the fit once typing stops, and scroll to it for another model."""
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
        """Bring the fit into sight, once it has its place."""
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
