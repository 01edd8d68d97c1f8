# SPDX-License-Identifier: LGPL-2.1-or-later
"""A window with the text of a program, for reading and export."""

from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtCore, QtGui

from .. import api
from ..core.issues import AmError
from ..core.motion import Motion
from ..core.types import Array
from ..objects.fields import preferences
from ..objects.program import files_of
from ..objects.results.findings import message_of
from ..objects.staleness import UP_TO_DATE
from ..posts.catalogue import Lines, lines_of
from . import icons
from .colours import FAINT, INVALID, PLAIN, set_role
from .in_language import error_line, tr, translated, translated_error
from .path import dock as path_dock
from .path import path_view
from .simulation import wording
from .simulation.player import run_of

# ---- The text of a program

MARK_ALPHA = 70  # of 255; opacity of a marked line's background


def listing(name: str) -> Any:
    """Return a named read-only field for unwrapped lines in a monospaced font."""
    text = QtGui.QPlainTextEdit()
    text.setObjectName(name)
    text.setReadOnly(True)
    text.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
    font = QtGui.QFont("monospace")
    font.setStyleHint(QtGui.QFont.TypeWriter)
    text.setFont(font)
    return text


def mark(text: Any, line: int, focus: bool = False) -> None:
    """Mark a line, from 0. focus: also move the cursor into the line and scroll to it."""
    cursor = QtGui.QTextCursor(text.document().findBlockByNumber(line))
    if focus:
        text.setTextCursor(cursor)
        text.centerCursor()
    marked = QtGui.QTextEdit.ExtraSelection()
    marked.cursor = cursor
    ground = text.palette().color(QtGui.QPalette.Highlight)
    ground.setAlpha(MARK_ALPHA)
    marked.format.setBackground(ground)
    marked.format.setProperty(QtGui.QTextFormat.FullWidthSelection, True)
    text.setExtraSelections([marked])


@dataclass(frozen=True)
class Located:
    """The moves of a program's text. rows: (n,) motion row that each move leads to."""

    motion: Motion
    rows: Any
    lines: Lines

    @classmethod
    def of(cls, post: str, files: dict[str, bytes], motion: Motion) -> Located | None:
        """Locate the lines of a program; None if it does not have one line per move."""
        lines, rows = lines_of(post, files), np.flatnonzero(motion.moves)
        return cls(motion, rows, lines) if len(lines) == len(rows) else None

    def row_at(self, name: str, line: int) -> int | None:
        """Return the motion row of a line of a file, from 0; None in a file without moves."""
        move = self.lines.move_at(name, line)
        return None if move is None else int(self.rows[move])

    def line_at(self, layer: int, bead: int, position: Array) -> tuple[str, int] | None:
        """Return file and line, from 0, of the point of a bead nearest to a position (3,), mm.

        Return None if the program does not have the bead.
        """
        motion, rows = self.motion, self.rows
        indices = np.flatnonzero(
            motion.deposit[rows] & (motion.layer[rows] == layer) & (motion.bead[rows] == bead)
        )
        if not len(indices):
            return None
        distance = np.linalg.norm(motion.position[rows[indices]] - position, axis=1)
        return self.lines.of(int(indices[int(distance.argmin())]))

    def text_at(self, row: int) -> str:
        """Describe a motion row in words."""
        motion = self.motion
        text = tr("layer {} bead {}").format(int(motion.layer[row]), int(motion.bead[row]))
        if not motion.deposit[row]:
            return tr("{}: on the approach").format(text)
        return tr("{} point {}").format(text, int(motion.point[row]))

    def show(self, path: Any, row: int) -> None:
        """Show the joint path in the 3D view up to a row; for a rapid, up to its next bead."""
        motion, drawn = self.motion, path.ViewObject.Proxy.rows
        layer, bead = int(motion.layer[row]), int(motion.bead[row])
        beads = [] if drawn is None else np.flatnonzero(drawn.layers == layer)
        if bead >= len(beads):
            return
        start, end = drawn.starts[beads[bead]], drawn.starts[beads[bead] + 1]
        distance = np.linalg.norm(drawn.points[start:end] - motion.position[row], axis=1)
        path_dock.go_to(path, layer, bead, int(distance.argmin()) if motion.deposit[row] else 0)


class ProgramWindow:
    """The files of a program, one at a time, read-only, with a button to export all of them."""

    def __init__(self, obj: Any) -> None:
        self.obj = obj
        self.files: dict[str, bytes] = {}
        self.window = QtGui.QDialog(Gui.getMainWindow())
        self.window.setObjectName("RoboticAM_ProgramText")
        self.window.setWindowTitle(obj.Label)
        self.window.setWindowIcon(QtGui.QIcon(icons.path("program")))
        self.window.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.window.resize(760, 620)
        self.state = QtGui.QLabel()
        self.state.setObjectName("state")
        self.state.setWordWrap(True)
        self.sums = QtGui.QLabel()
        self.sums.setObjectName("sums")
        self.sums.setWordWrap(True)
        self.choice = QtGui.QComboBox()
        self.choice.setObjectName("file")
        self.text = listing("text")
        self.text.setToolTip(
            tr("Click a line to show its point on the path; click the path to mark its line")
        )
        self.text.cursorPositionChanged.connect(self._at_line)
        self.place = QtGui.QLabel()
        self.place.setObjectName("place")
        self.located: Located | None = None
        self.filling = False  # while the program, not the user, moves the cursor
        self.export_button = _button(
            tr("Export…"),
            "export",
            tr("Writes all files of the program into a folder"),
            self._export,
        )
        self._lay_out()
        self.load()
        self.choice.currentIndexChanged.connect(self._show)
        self.window.finished.connect(lambda *_: _shown.remove(self))
        _shown.append(self)

    def load(self) -> None:
        """Show the current content of the object."""
        try:
            self.files = api.result(self.obj).files if self.obj.Key else {}
        except AmError:  # during undo, the parts of a result are restored one by one
            return
        names, current = sorted(self.files), self.choice.currentText()
        self.choice.blockSignals(True)
        self.choice.clear()
        self.choice.addItems(names)
        self.choice.setCurrentIndex(names.index(current) if current in names else 0)
        self.choice.blockSignals(False)
        self.export_button.setEnabled(not self._refused())
        self.export_button.setToolTip(
            self._refused() or tr("Writes all files of the program into a folder")
        )
        fits = self.obj.Status == UP_TO_DATE
        warning = (
            ""
            if fits or not names
            else tr("This program belongs to an earlier plan; do not run it.")
        )
        status = tr("Status: {}.").format(translated(self.obj.Status))
        self.state.setText(
            " ".join(filter(None, (warning, status, translated(message_of(self.obj)))))
        )
        self.located = None
        self.place.clear()
        try:
            run = run_of(self.obj)
            self.sums.setText(
                "  ·  ".join(
                    tr("{}: {}").format(name, value) for name, value in wording.totals(run)
                )
            )
            if fits and names:
                self.located = Located.of(self.obj.Post, self.files, run.motion)
        except (
            AmError,
            AttributeError,
        ):  # the joint path is deleted, or undo has not yet restored it completely
            self.sums.setText("")
        set_role(self.state, PLAIN if fits else INVALID)
        set_role(self.text, PLAIN if fits else FAINT)
        self._show()

    def _lay_out(self) -> None:
        column, row = QtGui.QVBoxLayout(self.window), QtGui.QHBoxLayout()
        row.addWidget(self.choice, 1)
        row.addWidget(self.export_button)
        row.addWidget(
            _button(tr("Close"), "close", tr("Closes this window"), lambda *_: self.window.close())
        )
        column.addLayout(row)
        column.addWidget(self.text, 1)
        column.addWidget(self.place)
        column.addWidget(self.sums)
        column.addWidget(self.state)

    def _show(self, *_: Any) -> None:
        text = (
            self.files.get(self.choice.currentText(), b"").decode("latin-1").replace("\r\n", "\n")
        )
        if text != self.text.toPlainText():
            self.filling = True
            self.text.setPlainText(text)
            self.filling = False

    def _at_line(self) -> None:
        """Show the path up to the point of the line with the cursor."""
        cursor = self.text.textCursor()
        if self.located is None or self.filling or cursor.hasSelection():
            return
        row = self.located.row_at(self.choice.currentText(), cursor.blockNumber())
        if row is not None:
            mark(self.text, cursor.blockNumber())
            self._show_place(cursor.blockNumber(), row)
            with contextlib.suppress(ReferenceError):  # the document is closed
                self.located.show(self.obj.JointPath, row)

    def show_point(self, layer: int, bead: int, position: Any) -> None:
        """Mark the line that deposits a point of a bead (3,), mm."""
        location = None if self.located is None else self.located.line_at(layer, bead, position)
        if self.located is None or location is None:
            return
        name, line = location
        self.choice.setCurrentText(name)
        self.filling = True
        mark(self.text, line, True)
        self.filling = False
        row = self.located.row_at(name, line)
        if row is not None:
            self._show_place(line, row)

    def _show_place(self, line: int, row: int) -> None:
        if self.located is not None:
            self.place.setText(tr("Line {}: {}").format(line + 1, self.located.text_at(row)))

    def _refused(self) -> str:
        """Return the reason why export is impossible, '' if it is possible."""
        refused = refusal(self.obj)
        return "" if refused is None else translated_error(refused)

    def _export(self, *_: Any) -> None:
        try:
            self.state.setText(export(self.obj, self.window))
        except ReferenceError:
            self.state.setText(tr("The document is closed; open it again to export."))


def _button(text: str, name: str, help: str, act: Any) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    button.setAutoDefault(False)
    button.clicked.connect(act)
    return button


def _clicked(view: Any, row: int) -> None:
    """Mark the line of a path point clicked in the 3D view, in all open programs of the path."""
    rows = view.rows
    if rows is None or row >= len(rows):
        return
    number = rows.bead_of(row)
    layer = int(rows.layers[number])
    bead = int(number - np.searchsorted(rows.layers, layer))
    for program in _shown:
        with contextlib.suppress(ReferenceError):  # the document of the program is closed
            if program.obj.JointPath is view.obj:
                program.show_point(layer, bead, rows.points[row])


path_view.listen_to_clicks(lambda: bool(_shown), _clicked)


_shown: list[ProgramWindow] = []  # keeps open windows alive


def show(obj: Any) -> None:
    """Show the text of a program in a non-modal window; reuse its open window."""
    program = _of(obj) or ProgramWindow(obj)
    program.window.show()
    program.window.raise_()


def renew(obj: Any) -> None:
    """Show the changed program in its window, if the window is open."""
    program = _of(obj)
    if program is not None:
        program.load()


def _of(obj: Any) -> ProgramWindow | None:
    return next((program for program in _shown if program.obj is obj), None)


def refusal(obj: Any) -> AmError | None:
    """Return the error that prevents the export of a program, or None."""
    try:
        files_of(obj)
    except AmError as error:
        return error
    return None


def export(obj: Any, window: Any = None) -> str:
    """Ask for a folder (default: the last one or the document's), write the files and return the
    result as text. If there is nothing to write, return the reason without asking.
    """
    if (refused := refusal(obj)) is not None:
        App.Console.PrintError(error_line(refused))
        Gui.getMainWindow().statusBar().showMessage(translated_error(refused), 5000)
        return translated_error(refused)
    proposal = preferences.programs_folder() or os.path.dirname(obj.Document.FileName)
    folder = QtGui.QFileDialog.getExistingDirectory(
        window or Gui.getMainWindow(), tr("Export program"), proposal
    )
    if not folder:
        return tr("Status: {}.").format(translated(obj.Status))
    try:
        paths = api.export(obj, folder)
    except AmError as error:
        App.Console.PrintError(error_line(error))
        return translated_error(error)
    preferences.keep("ExportFolder", folder)
    text = tr("Files written to {}: {}").format(folder, len(paths))
    Gui.getMainWindow().statusBar().showMessage(text, 5000)
    return text
