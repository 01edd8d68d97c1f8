# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of an inspection: what was measured, how it is laid onto the part, and what came of it."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ... import api
from ...core.inspection.inspect import Inspected
from ...core.inspection.table import rows
from ...core.issues import AmError
from ...objects.inspection import Inspection
from ..panels.stage import StagePanel, show
from ..texts.translation import tr, translated, translated_error
from ..widgets.fold import Fold
from .histogram import Histogram
from .inputs import FileChoice, PlannedChoice

_LINES = 3  # pixels between the lines of the table
_INDENT = "\u2003"  # before figures under the name of their place


class InspectionPanel(StagePanel):
    """Above its inputs and parameters, once there are any, the figures and the histogram of the result."""

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
            self.say("")  # the file is still to be chosen, which needs no telling in red
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
        """Show the figures that the object has now; nothing before there are any."""
        value = self._value()
        self.results.widget.setVisible(value is not None)
        if value is None:
            return
        found = [row for row in rows(value) if row.short]
        self.table.clearSpans()
        self.table.setRowCount(0)
        place = ""
        for row in found:
            if row.group not in ("", place):
                self._add_line(translated(row.group))
                self.table.setSpan(self.table.rowCount() - 1, 0, 1, self.table.columnCount())
            place = row.group
            text = translated(row.short)
            self._add_line(
                f"{_INDENT}{text}" if place else text, row.text, row.unit, help=translated(row.name)
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

    def _placed(self, error: AmError) -> tuple[str, str]:
        place, text = super()._placed(error)
        file = self.choices[1]
        name = os.path.basename(file.line.text().strip())
        if not place and (error.where.endswith(".File") or (name and error.where.startswith(name))):
            return file.label, translated(error.message) if error.where.endswith(".File") else text
        return place, text

    def _value(self) -> Inspected | None:
        if self.obj is None or not self.obj.Key:
            return None
        try:
            found: Inspected = api.result(self.obj)
            return found
        except AmError:
            return None

    def _save(self, *_: Any) -> None:
        """Ask for a folder and write the figures."""
        try:
            first = os.path.dirname(self.obj.Document.FileName)
            folder = QtGui.QFileDialog.getExistingDirectory(
                Gui.getMainWindow(), tr("Save figures"), first
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
    """Open the panel of a new inspection; of the one that is selected, if there is one."""
    chosen = [
        obj
        for obj in Gui.Selection.getSelection()
        if isinstance(getattr(obj, "Proxy", None), Inspection)
    ]
    if chosen and chosen[-1].Document is App.ActiveDocument:
        show(InspectionPanel(chosen[-1]))
    else:
        show(InspectionPanel())
