# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program in a window of its own, to be read and exported."""

from __future__ import annotations

from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from .. import api
from ..core.issues import AmError
from . import icons

_PREFERENCES = "User parameter:BaseApp/Preferences/Mod/RoboticAM"


class ProgramWindow:
    """The files of a program, one at a time, read-only, with a button to export them all."""

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self.files = api.result(obj).files if obj.Key else {}
        self.window = QtGui.QDialog(Gui.getMainWindow())
        self.window.setObjectName("RoboticAM_ProgramText")
        self.window.setWindowTitle(obj.Label)
        self.window.setWindowIcon(QtGui.QIcon(icons.path("program")))
        self.window.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.window.resize(760, 620)
        self.state = QtGui.QLabel(f"Status: {obj.Status}. {obj.Message}".rstrip(" "))
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        self.choice = QtGui.QComboBox()
        self.choice.setObjectName("file")
        self.choice.addItems(sorted(self.files))
        self.text = QtGui.QPlainTextEdit()
        self.text.setObjectName("text")
        self.text.setReadOnly(True)
        self.text.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
        font = QtGui.QFont("monospace")
        font.setStyleHint(QtGui.QFont.TypeWriter)
        self.text.setFont(font)
        self._lay_out()
        self.choice.currentIndexChanged.connect(self._show)
        self._show()

    def _lay_out(self) -> None:
        column, row = QtGui.QVBoxLayout(self.window), QtGui.QHBoxLayout()
        export_button = _button("Export…", "export", "Writes all files of the program into a folder", self._export)
        export_button.setEnabled(bool(self.files))
        row.addWidget(self.choice, 1)
        row.addWidget(export_button)
        row.addWidget(_button("Close", "close", "Closes this window", lambda *_: self.window.close()))
        column.addLayout(row)
        column.addWidget(self.text, 1)
        column.addWidget(self.state)

    def _show(self, *_: Any) -> None:
        content = self.files.get(self.choice.currentText(), b"")
        self.text.setPlainText(content.decode("latin-1").replace("\r\n", "\n"))

    def _export(self, *_: Any) -> None:
        try:
            self.state.setText(export(self.obj))
        except ReferenceError:
            self.state.setText("The document is closed; open it again to export.")


def _button(text: str, name: str, help: str, act: Any) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    button.setAutoDefault(False)
    button.clicked.connect(act)
    return button


def show(obj: Any) -> None:
    """Open the text of a program in a window that does not block the others."""
    shown = ProgramWindow(obj)
    shown.window.show()
    shown.window.raise_()
    # Python must keep the object as long as its window
    shown.window.kept = shown


def export(obj: Any) -> str:
    """Ask for a folder and write the files of a program; says what came of it."""
    preferences = App.ParamGet(_PREFERENCES)
    folder = QtGui.QFileDialog.getExistingDirectory(
        Gui.getMainWindow(), "Export program", preferences.GetString("ExportFolder", "")
    )
    if not folder:
        return f"Status: {obj.Status}"
    try:
        paths = api.export(obj, folder)
    except AmError as error:
        App.Console.PrintError(error.line() + "\n")
        return str(error)
    preferences.SetString("ExportFolder", folder)
    text = f"{len(paths)} files written to {folder}"
    Gui.getMainWindow().statusBar().showMessage(text, 5000)
    return text
