# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program in a task panel, to be read and exported."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
from PySide import QtCore, QtGui

from .. import api
from ..core.issues import AmError
from . import icons


class ProgramPanel:
    """The files of a program, one at a time, read-only, with a button to export them all."""

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self.files = api.result(obj).files if obj.ResultLayout else {}
        self.form = QtGui.QWidget()
        self.form.setObjectName("RoboticAM_ProgramText")
        self.form.setWindowTitle(obj.Label)
        self.form.setWindowIcon(QtGui.QIcon(icons.path("program")))
        column = QtGui.QVBoxLayout(self.form)
        self.state = QtGui.QLabel(f"{obj.Status}. {obj.Message}" if obj.Message else f"Status: {obj.Status}")
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        self.choice = QtGui.QComboBox()
        self.choice.setObjectName("file")
        self.choice.addItems(sorted(self.files))
        self.text = QtGui.QPlainTextEdit()
        self.text.setObjectName("text")
        self.text.setReadOnly(True)
        self.text.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
        self.text.setMinimumHeight(420)
        font = QtGui.QFont("monospace")
        font.setStyleHint(QtGui.QFont.TypeWriter)
        self.text.setFont(font)
        self.button = QtGui.QPushButton("Export…")
        self.button.setObjectName("export")
        self.button.setToolTip("Writes all files of the program into a folder")
        self.button.setEnabled(bool(self.files))
        self.button.clicked.connect(self._export)
        for widget in (self.state, self.choice, self.text, self.button):
            column.addWidget(widget)
        self.choice.currentIndexChanged.connect(self._show)
        self._show()

    def _show(self, *_: Any) -> None:
        content = self.files.get(self.choice.currentText(), b"")
        self.text.setPlainText(content.decode("latin-1").replace("\r\n", "\n"))

    def _export(self, *_: Any) -> None:
        self.state.setText(export(self.obj))

    def getStandardButtons(self) -> int:
        """Close alone."""
        return int(QtGui.QDialogButtonBox.Close)

    def reject(self) -> bool:
        """Close."""
        return True


def show(obj: Any) -> None:
    """Open the text of a program."""
    from . import stage_panel

    stage_panel.show(ProgramPanel(obj))


def export(obj: Any) -> str:
    """Ask for a folder and write the files of a program; says what came of it."""
    from FreeCADGui import getMainWindow

    start = App.ParamGet("User parameter:BaseApp/Preferences/Mod/RoboticAM").GetString("ExportFolder", "")
    folder = QtGui.QFileDialog.getExistingDirectory(getMainWindow(), "Export program", start)
    if not folder:
        return f"Status: {obj.Status}"
    App.ParamGet("User parameter:BaseApp/Preferences/Mod/RoboticAM").SetString("ExportFolder", folder)
    try:
        paths = api.export(obj, folder)
    except AmError as error:
        App.Console.PrintError(error.line() + "\n")
        return str(error)
    QtCore.QTimer.singleShot(0, lambda: getMainWindow().statusBar().showMessage(f"{len(paths)} files exported", 5000))
    return f"Exported: {', '.join(paths)}"
