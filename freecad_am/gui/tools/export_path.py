# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel that exports a path or its report, or creates an object of another workbench from it."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ... import api
from ...core.issues import AmError
from ...objects.stage import stage_of
from ...objects.work.progress import Cancelled
from .. import icons, recorded
from ..colours import INVALID, set_role
from ..in_language import tr, translated, translated_error
from ..panels.stage import CLOSED
from ..signals import connect
from ..widgets.quantity import QuantityField
from ..widgets.shape_inputs import job_selection
from ..widgets.upright import scrolls, upright

STEP, DXF, CSV, JOINTS, REPORT, CAM, TRAJECTORY = (
    "step",
    "dxf",
    "csv",
    "joints",
    "report",
    "cam",
    "trajectory",
)
_FILES = {STEP: ".step", DXF: ".dxf", CSV: ".csv", JOINTS: ".json", REPORT: ".html"}
_KINDS = ("toolpath", "joint path", "program")
_PREFERENCES, _FOLDER = "User parameter:BaseApp/Preferences/Mod/RoboticAM", "WiresFolder"


class ExportPanel:
    """Panel to choose a path and the export format, initially `kind`; nothing happens before OK."""

    def __init__(self, kind: str = STEP) -> None:
        self.document = App.ActiveDocument
        self.proposed = ""  # file name without extension that the panel proposed
        self.paths = [
            obj for kind in _KINDS for obj in api.stages_of(self.document, kind) if obj.Key
        ]
        self.form = QtGui.QWidget()
        self.form.setObjectName("RoboticAM_ExportPath")
        self.form.setWindowTitle(tr("Export path"))
        self.form.setWindowIcon(QtGui.QIcon(icons.path("export_path")))
        self.error = QtGui.QLabel()
        self.error.setObjectName("error")
        self.error.setWordWrap(True)
        set_role(self.error, INVALID)
        self.error.hide()
        self.path = self._combo("Path", tr("The toolpath, joint path or program to export"))
        self.path.addItems([obj.Label for obj in self.paths])
        self.path.setCurrentIndex(self._first())
        self.kind = self._combo("Kind", tr("Format of the export"))
        for key, text in (
            (STEP, tr("STEP file of wires")),
            (DXF, tr("DXF file of polylines")),
            (CSV, tr("CSV table of waypoints")),
            (JOINTS, tr("JSON file of a ROS joint trajectory")),
            (REPORT, tr("HTML page of the report")),
            (CAM, tr("CAM path in this document")),
            (TRAJECTORY, tr("Robot trajectory in this document")),
        ):
            self.kind.addItem(text, key)
        self.kind.setCurrentIndex(self.kind.findData(kind))
        self.file = QtGui.QLineEdit()
        self.file.setObjectName("File")
        self.file.setMinimumWidth(70)
        self._help(self.file, tr("The file to write; its extension follows the format"))
        self.browse = QtGui.QPushButton("…")
        self.browse.setObjectName("browse")
        self.browse.setMaximumWidth(32)
        self._help(self.browse, tr("Choose the file"))
        self.rapids = QtGui.QCheckBox(tr("Rapid moves too"))
        self.rapids.setObjectName("Rapids")
        self._help(
            self.rapids,
            tr(
                "Also write the moves between beads, on a separate layer; toolpaths have no such "
                "moves"
            ),
        )
        self.tolerance = QuantityField(0.1, "mm", tr("Tolerance"), can_follow=False)
        self.tolerance.box.setObjectName("Tolerance")
        self._help(
            self.tolerance.box,
            tr("Points are omitted while the path stays within this distance"),
        )
        self.turn = QuantityField(2.0, "deg", tr("Turn"), can_follow=False)
        self.turn.box.setObjectName("Turn")
        self._help(
            self.turn.box,
            tr("Points are omitted while the tool axis stays within this angle"),
        )
        self._lay_out()
        self._follow()
        self.kind.currentIndexChanged.connect(self._follow)
        self.path.currentIndexChanged.connect(self._follow)
        self.browse.clicked.connect(self._ask)

    # ---- display

    def _combo(self, name: str, help: str) -> Any:
        combo = QtGui.QComboBox()
        combo.setObjectName(name)
        combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        combo.setMinimumContentsLength(12)
        self._help(combo, help)
        return combo

    def _help(self, widget: Any, help: str) -> None:
        widget.setToolTip(help)
        widget.setWhatsThis(help)

    def _lay_out(self) -> None:
        column, self.grid, line = (
            QtGui.QVBoxLayout(self.form),
            QtGui.QFormLayout(),
            QtGui.QHBoxLayout(),
        )
        line.addWidget(self.file, 1)
        line.addWidget(self.browse)
        self.file_row = QtGui.QWidget()
        self.file_row.setLayout(line)
        line.setContentsMargins(0, 0, 0, 0)
        for text, widget in (
            (tr("Path"), self.path),
            (tr("Make"), self.kind),
            (tr("File"), self.file_row),
            ("", self.rapids),
            (tr("Tolerance"), self.tolerance.box),
            (tr("Turn"), self.turn.box),
        ):
            self.grid.addRow(text, widget)
        self.file_note = QtGui.QLabel()
        self.file_note.setObjectName("FileNote")
        self.file_note.setWordWrap(True)
        set_role(self.file_note, INVALID)
        self.grid.insertRow(self.grid.getWidgetPosition(self.file_row)[0] + 1, "", self.file_note)
        self._note_file("")
        connect(self.file, "textChanged(QString)", self._file_anew)
        column.addWidget(self.error)
        column.addLayout(self.grid)
        column.addStretch(1)
        scrolls(self.form)
        upright(self.form)

    def _follow(self, *_: Any) -> None:
        """Show the fields of the chosen format, and a suitable file name."""
        kind = self.kind.currentData()
        self._note_file("")
        for widget, is_shown in (
            (self.file_row, kind in _FILES),
            (self.rapids, kind in (STEP, DXF)),
            (self.tolerance.box, kind == TRAJECTORY),
            (self.turn.box, kind == TRAJECTORY),
        ):
            for row_widget in filter(None, (widget, self.grid.labelForField(widget))):
                row_widget.setVisible(is_shown)
        if kind in _FILES and 0 <= self.path.currentIndex() < len(self.paths):
            typed = os.path.splitext(self.file.text().strip())[0]
            if typed in ("", self.proposed):
                typed = self.proposed = self._proposed()
            self.file.setText(typed + _FILES[kind])

    def _proposed(self) -> str:
        last_folder = App.ParamGet(_PREFERENCES).GetString(_FOLDER, "")
        folder = last_folder or os.path.dirname(self.document.FileName) or os.path.expanduser("~")
        return os.path.join(folder, self.path.currentText().replace(os.sep, "-"))

    def _first(self) -> int:
        """Return the index of the selected path or the path of the selected job; otherwise the last
        joint path.
        """
        for obj in job_selection(self.document.Name):
            if obj in self.paths:
                return self.paths.index(obj)
        joint_paths = [k for k, obj in enumerate(self.paths) if stage_of(obj).kind == "joint path"]
        return joint_paths[-1] if joint_paths else len(self.paths) - 1

    def _ask(self, *_: Any) -> None:
        ending = _FILES[self.kind.currentData()]
        file_path = QtGui.QFileDialog.getSaveFileName(
            self.form, tr("Export path"), self.file.text(), f"*{ending}"
        )[0]
        if file_path:
            self.file.setText(
                file_path
                if os.path.splitext(file_path)[1].lower() == ending
                else file_path + ending
            )

    def say(self, text: str) -> None:
        """Show an error."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def _note_file(self, text: str) -> None:
        """Show a problem of the file under its field."""
        self.file_note.setText(text)
        self.file_note.setVisible(bool(text))

    def _file_anew(self, *_: Any) -> None:
        """Clear the note once the file changes."""
        self._note_file("")

    # ---- called by FreeCAD

    def accept(self) -> bool:
        """Export the path or create the object; return True to close the panel, or show an error in
        it.
        """
        self.say("")
        self._note_file("")
        kind = self.kind.currentData()
        try:
            recorded.act(self.paths[self.path.currentIndex()], *self._call(kind))
        except AmError as error:
            if kind in _FILES and error.where == self.file.text().strip():
                self._note_file(translated(error.message))
            else:
                self.say(translated_error(error))
        except Cancelled:
            self.say(tr("Cancelled: nothing was exported."))
        except ReferenceError:
            self.say(tr(CLOSED))
        else:
            if kind in _FILES:
                path = self.file.text().strip()
                App.ParamGet(_PREFERENCES).SetString(_FOLDER, os.path.dirname(path))
                Gui.getMainWindow().statusBar().showMessage(tr("{} was written").format(path), 5000)
            return True
        return False

    def _call(self, kind: str) -> tuple[str, dict[str, str]]:
        functions = {
            CSV: "export_waypoints",
            JOINTS: "export_joint_trajectory",
            REPORT: "export_report",
        }
        if kind in functions:
            return functions[kind], {"path": repr(self.file.text().strip())}
        if kind in _FILES:
            return "export_wires", {
                "path": repr(self.file.text().strip()),
                "rapids": repr(self.rapids.isChecked()),
            }
        if kind == CAM:
            return "make_cam_path", {}
        return "make_trajectory", {
            "tolerance": repr(self.tolerance.read()),
            "turn": repr(self.turn.read()),
        }

    def reject(self) -> bool:
        """Close the panel; nothing was exported."""
        return True
