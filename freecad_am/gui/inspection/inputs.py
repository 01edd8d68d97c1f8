# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was measured, and the file of its points, as rows of a panel."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...core.inspection.inspect import PREDICTED
from ...core.inspection.point_file import MESHES, TABLES
from ...core.issues import InputError
from ...objects.inspection import KINDS
from ...objects.stage import stage_of
from ...objects.stage_parts import Link
from .. import recorded
from ..picking.an_input import Input
from ..picking.picking import usable
from ..picking.selection import meant
from ..texts.translation import tr, translated


class PlannedChoice(Input):
    """A feature, a toolpath, or an object with a shape or mesh: the present one, else the selected one or that of the job
    that is selected, else the last feature."""

    def __init__(self, link: Link, present: Any) -> None:
        self.link, self.label = link, tr("Planned")
        self.document = App.ActiveDocument if present is None else present.Document
        self.widget = QtGui.QComboBox()
        self.widget.setObjectName("Planned")
        self.widget.setToolTip(translated(link.help))
        self.widget.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.widget.setMinimumContentsLength(8)
        found = offered(self.document)
        for obj in found:
            self.widget.addItem(obj.Label, obj.Name)
        selected = [obj for obj in meant(self.document.Name) if obj in found]
        features = [
            obj for obj in found if stage_of(obj) is not None and stage_of(obj).kind == "feature"
        ]
        wanted = next(
            iter([*([present] if present is not None else selected), *features[-1:], *found]), None
        )
        if wanted is not None:
            self.widget.setCurrentIndex(max(0, self.widget.findData(wanted.Name)))

    def choose_toolpath(self) -> None:
        """The last toolpath, where none is chosen."""
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
            else tr("This document has nothing to compare with; open the part first.")
        )

    def arguments(self) -> dict[str, str]:
        name = self.widget.currentData() if self.widget.count() else ""
        chosen = self.document.getObject(name) if name else None
        if name and chosen is None:
            raise InputError(
                "NO_INPUT", "Inspection", "Planned is missing, as it was deleted; choose another"
            )
        return {"planned": "None" if chosen is None else recorded.reference(chosen)}


class FileChoice(Input):
    """The file of measured points, typed or chosen."""

    def __init__(self, path: str) -> None:
        self.label = tr("File")
        self.widget = QtGui.QWidget()
        grid = QtGui.QGridLayout(self.widget)  # the path has the whole width, buttons are below
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
        first = os.path.dirname(present or App.ActiveDocument.FileName)
        some = " ".join(f"*{ending} *{ending.upper()}" for ending in (*TABLES, *MESHES))
        path, _ = QtGui.QFileDialog.getOpenFileName(
            Gui.getMainWindow(),
            tr("Measured points"),
            first,
            f"{tr('Points and meshes')} ({some});;{tr('All files')} (*)",
        )
        if path:
            self.line.setText(path)

    def arguments(self) -> dict[str, str]:
        return {"file": repr(self.line.text().strip())}


def offered(document: Any) -> list[Any]:
    """What points can be compared with, in the order of the tree."""
    found = []
    for obj in [] if document is None else document.Objects:
        stage = stage_of(obj)
        if (stage is not None and stage.kind in KINDS) or (stage is None and usable(obj)):
            found.append(obj)
    return found
