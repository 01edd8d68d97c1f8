# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of an inspection: the measurement, its registration and the results."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from ... import api
from ...core.inspection.bands import band_of, bands
from ...core.inspection.figures import Spread
from ...core.inspection.inspect import PREDICTED, Inspected
from ...core.inspection.point_file import MESHES, TABLES
from ...core.inspection.table import rows
from ...core.issues import AmError, InputError
from ...objects.fields.preferences import scale_of
from ...objects.inspection import KINDS, Inspection
from ...objects.stage import stage_of
from ...objects.stage_parts import Link
from .. import colours, recorded
from ..in_language import tr, translated, translated_error
from ..panels.stage import StagePanel, show
from ..path.colouring import round_numbers
from ..picking import usable
from ..widgets.fold import Fold
from ..widgets.pick_field import Input
from ..widgets.shape_inputs import job_selection


class PlannedChoice(Input):
    """Choice of a feature, a toolpath, or an object with a shape or mesh.

    The default is the present object, then the selected object or the object of the selected job,
    then the last feature.
    """

    def __init__(self, link: Link, present: Any) -> None:
        self.link, self.label = link, tr("Planned")
        self.document = App.ActiveDocument if present is None else present.Document
        self.widget = QtGui.QComboBox()
        self.widget.setObjectName("Planned")
        self.widget.setToolTip(translated(link.help))
        self.widget.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.widget.setMinimumContentsLength(8)
        objects = offered(self.document)
        for obj in objects:
            self.widget.addItem(obj.Label, obj.Name)
        selected = [obj for obj in job_selection(self.document.Name) if obj in objects]
        features = [
            obj for obj in objects if stage_of(obj) is not None and stage_of(obj).kind == "feature"
        ]
        proposed = next(
            iter([*([present] if present is not None else selected), *features[-1:], *objects]),
            None,
        )
        if proposed is not None:
            self.widget.setCurrentIndex(max(0, self.widget.findData(proposed.Name)))

    def choose_toolpath(self) -> None:
        """Select the last toolpath unless a toolpath is selected."""
        paths = [k for k in range(self.widget.count()) if self._kind(k) == "toolpath"]
        if paths and self.widget.currentIndex() not in paths:
            self.widget.setCurrentIndex(paths[-1])

    def _kind(self, index: int) -> str:
        obj = self.document.getObject(self.widget.itemData(index))
        stage = None if obj is None else stage_of(obj)
        return "" if stage is None else str(stage.kind)

    def show_stored(self, stored: Any) -> None:
        self.widget.setCurrentIndex(-1 if stored is None else self.widget.findData(stored.Name))

    @property
    def missing(self) -> str:
        return (
            ""
            if self.widget.count()
            else tr("The document has no object to compare with; open the part first.")
        )

    def arguments(self) -> dict[str, str]:
        name = self.widget.currentData() if self.widget.count() else ""
        planned = self.document.getObject(name) if name else None
        if name and planned is None:
            raise InputError(
                "NO_INPUT",
                "Inspection",
                "The object to compare with (Planned) was deleted; choose another object",
            )
        return {"planned": "None" if planned is None else recorded.reference(planned)}


class FileChoice(Input):
    """The file of measured points, typed or selected."""

    def __init__(self, path: str) -> None:
        self.label = tr("File")
        self.widget = QtGui.QWidget()
        grid = QtGui.QGridLayout(self.widget)  # the path has the whole width; buttons are below
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(2)
        self.line = QtGui.QLineEdit(path)
        self.line.setObjectName("FilePath")
        kinds = ", ".join((*TABLES, *MESHES))
        help = tr("The measured points, or a scanned mesh: {}").format(kinds)
        self.button = QtGui.QPushButton(tr("Choose…"))
        self.button.setObjectName("ChooseFile")
        self.button.setAutoDefault(False)
        self.button.clicked.connect(self._choose)
        for widget in (self.widget, self.line, self.button):
            widget.setToolTip(help)
            widget.setWhatsThis(help)
        self.predict = QtGui.QPushButton(tr("Predicted"))
        self.predict.setObjectName("PredictedDeposit")
        self.predict.setAutoDefault(False)
        self.predict.setToolTip(
            tr("No measurement: compare the deposit predicted for the toolpath")
        )
        self.predict.setWhatsThis(self.predict.toolTip())
        self.predict.clicked.connect(lambda *_: self.line.setText(PREDICTED))
        grid.addWidget(self.line, 0, 0, 1, 2)
        for column, widget in enumerate((self.button, self.predict)):
            grid.addWidget(widget, 1, column)
            widget.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
        self.widget.setObjectName("File")

    def stored(self, obj: Any) -> Any:
        return obj.File

    def show_stored(self, stored: Any) -> None:
        self.line.setText(stored)

    @property
    def missing(self) -> str:
        return "" if self.line.text().strip() else tr("Choose the file of the measured points.")

    def _choose(self, *_: Any) -> None:
        present = self.line.text().strip()
        folder = os.path.dirname(present or App.ActiveDocument.FileName)
        patterns = " ".join(f"*{ending} *{ending.upper()}" for ending in (*TABLES, *MESHES))
        path, _ = QtGui.QFileDialog.getOpenFileName(
            Gui.getMainWindow(),
            tr("Measured points"),
            folder,
            f"{tr('Points and meshes')} ({patterns});;{tr('All files')} (*)",
        )
        if path:
            self.line.setText(path)

    def arguments(self) -> dict[str, str]:
        return {"file": repr(self.line.text().strip())}


def offered(document: Any) -> list[Any]:
    """Return the objects that points can be compared with, in tree order."""
    objects = []
    for obj in [] if document is None else document.Objects:
        stage = stage_of(obj)
        if (stage is not None and stage.kind in KINDS) or (stage is None and usable(obj)):
            objects.append(obj)
    return objects


HEIGHT = 130
_SIDE, _TOP, _FOOT, _FAINT = 12, 6, 34, 90


class Histogram(QtGui.QWidget):
    """Histogram of deviations, with the tolerance limits."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("DeviationHistogram")
        self.setMinimumHeight(HEIGHT)
        self.spread: Spread | None = None
        self.tolerance = 1.0

    def set(self, spread: Spread, tolerance: float) -> None:
        """Show other deviations."""
        self.spread, self.tolerance = spread, tolerance
        self.update()

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)

    def paintEvent(self, event: Any) -> None:
        """Called by Qt."""
        if self.spread is None:
            return
        painter = QtGui.QPainter(self)
        edges, counts = self.spread.edges, self.spread.counts
        low, high = min(float(edges[0]), -self.tolerance), max(float(edges[-1]), self.tolerance)
        area = QtCore.QRectF(_SIDE, _TOP, self.width() - 2 * _SIDE, self.height() - _TOP - _FOOT)

        def across(value: float) -> float:
            return float(area.left() + (value - low) / (high - low) * area.width())

        shades = [QtGui.QColor.fromRgbF(*level.colour) for level in bands(self.tolerance)]
        band_indices = band_of(0.5 * (edges[:-1] + edges[1:]), self.tolerance)
        max_count = max(int(counts.max()), 1)
        for start, end, count, band in zip(
            edges[:-1], edges[1:], counts, band_indices, strict=True
        ):
            tall = area.height() * int(count) / max_count
            bar_left = across(float(start))
            bar = QtCore.QRectF(
                bar_left, area.bottom() - tall, max(across(float(end)) - bar_left - 0.5, 0.5), tall
            )
            painter.fillRect(bar, shades[int(band)])
        self._axis(painter, area, across, low, high)
        painter.end()

    def _axis(self, painter: Any, area: Any, across: Any, low: float, high: float) -> None:
        ink = colours.ink()
        faint = QtGui.QColor(ink)
        faint.setAlpha(_FAINT)
        painter.setPen(QtGui.QPen(faint, 1.0, QtCore.Qt.DashLine))
        for limit in (-self.tolerance, self.tolerance):
            painter.drawLine(
                QtCore.QPointF(across(limit), area.top()),
                QtCore.QPointF(across(limit), area.bottom()),
            )
        painter.setPen(ink)
        painter.drawLine(area.bottomLeft(), area.bottomRight())
        line = painter.fontMetrics().height()
        factor, unit = scale_of(high, "mm")
        for number in np.asarray(round_numbers(factor * low, factor * high, 0.0)).tolist():
            box = QtCore.QRectF(across(number / factor) - 30.0, area.bottom() + 2.0, 60.0, line)
            painter.drawText(box, QtCore.Qt.AlignHCenter, f"{number:g}")
        max_count = int(self.spread.counts.max())
        text = (
            tr("deviation, {} (most: 1 point)").format(unit)
            if max_count == 1
            else tr("deviation, {} (most: {} points)").format(unit, max_count)
        )
        box = QtCore.QRectF(0.0, self.height() - line - 1.0, self.width(), line)
        painter.drawText(box, QtCore.Qt.AlignHCenter, text)


_LINES = 3  # pixels between the lines of the table
_INDENT = "\u2003"  # before values under the name of their region


class InspectionPanel(StagePanel):
    """Shows statistics and histogram of the result above the inputs and parameters, if there is a
    result.
    """

    stage = Inspection
    icon, function, draft = "inspect", "inspect", "Inspection"

    def __init__(self, obj: Any = None) -> None:
        link = Inspection.links[0]
        choices = [
            PlannedChoice(link, None if obj is None else obj.Planned),
            FileChoice("" if obj is None else obj.File),
        ]
        choices[1].predict.clicked.connect(lambda *_: choices[0].choose_toolpath())
        super().__init__(Inspection, tr("Inspect") if obj is None else obj.Label, choices, obj)
        if obj is None and not choices[0].missing:
            self.say("")  # no file selected yet, so show no error
        self.heading.heading.setChecked(obj is None or not obj.Key)
        self.results = Fold(tr("Result"), True)
        self.table, self.histogram = QtGui.QTableWidget(0, 3), Histogram()
        self.table.setObjectName("Figures")
        self.table.setToolTip(tr("Defects are widths of the narrowest zone, as in ISO 1101"))
        self.table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.table.horizontalHeader().hide()
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setVerticalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        self.histogram.setToolTip(tr("Number of points by deviation; dashed: the tolerance"))
        self.export = QtGui.QPushButton(tr("Save figures…"))
        self.export.setObjectName("SaveFigures")
        self.export.setAutoDefault(False)
        self.export.setToolTip(
            tr("Writes the results and the deviation of every point into a folder")
        )
        self.export.clicked.connect(self._save)
        column = QtGui.QVBoxLayout()
        for widget in (self.histogram, self.table, self.export):
            widget.setWhatsThis(widget.toolTip())
            column.addWidget(widget)
        self.results.form.addRow(column)
        self.column.insertWidget(1, self.results.widget)
        self._show_results()

    def _show_findings(self) -> None:
        super()._show_findings()
        if hasattr(self, "results"):
            self._show_results()

    def _show_results(self) -> None:
        """Show the current statistics of the object; hide them without a result."""
        value = self._value()
        self.results.widget.setVisible(value is not None)
        if value is None:
            return
        figures = [row for row in rows(value) if row.short]
        self.table.clearSpans()
        self.table.setRowCount(0)
        group = ""
        for row in figures:
            if row.group not in ("", group):
                self._add_line(translated(row.group))
                self.table.setSpan(self.table.rowCount() - 1, 0, 1, self.table.columnCount())
            group = row.group
            text = translated(row.short)
            self._add_line(
                f"{_INDENT}{text}" if group else text, row.text, row.unit, help=translated(row.name)
            )
        self.table.resizeColumnsToContents()
        self.table.horizontalHeader().setSectionResizeMode(0, QtGui.QHeaderView.Stretch)
        high = sum(self.table.rowHeight(number) for number in range(self.table.rowCount()))
        self.table.setFixedHeight(high + 2 * self.table.frameWidth())
        self.histogram.set(value.spread, value.tolerance)

    def _add_line(self, *texts: str, help: str = "") -> None:
        number = self.table.rowCount()
        self.table.insertRow(number)
        for column, text in enumerate(texts):
            item = QtGui.QTableWidgetItem(text)
            item.setToolTip(help)
            if column == 1:
                item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
            self.table.setItem(number, column, item)
        self.table.setRowHeight(number, self.table.fontMetrics().height() + _LINES)

    def _locate(self, error: AmError) -> tuple[str, str]:
        key, text = super()._locate(error)
        file = self.choices[1]
        name = os.path.basename(file.line.text().strip())
        if not key and (error.where.endswith(".File") or (name and error.where.startswith(name))):
            return file.label, translated(error.message) if error.where.endswith(".File") else text
        return key, text

    def _value(self) -> Inspected | None:
        if self.obj is None or not self.obj.Key:
            return None
        try:
            result: Inspected = api.result(self.obj)
            return result
        except AmError:
            return None

    def _save(self, *_: Any) -> None:
        """Ask for a folder and write the statistics."""
        try:
            start_folder = os.path.dirname(self.obj.Document.FileName)
            folder = QtGui.QFileDialog.getExistingDirectory(
                Gui.getMainWindow(), tr("Save figures"), start_folder
            )
            if folder:
                paths = api.export(self.obj, folder)
                Gui.getMainWindow().statusBar().showMessage(
                    tr("Files written: {}").format(len(paths)), 5000
                )
        except AmError as error:
            self.say(translated_error(error))
        except ReferenceError:
            self.say(tr("The document is closed; open it again to save its figures."))


def inspect() -> None:
    """Open the panel of the selected inspection, or of a new inspection."""
    inspections = [
        obj
        for obj in Gui.Selection.getSelection()
        if isinstance(getattr(obj, "Proxy", None), Inspection)
    ]
    if inspections and inspections[-1].Document is App.ActiveDocument:
        show(InspectionPanel(inspections[-1]))
    else:
        show(InspectionPanel())
