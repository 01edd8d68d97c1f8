# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program in a window: to be read, line by line."""

from __future__ import annotations

from typing import Any

from PySide import QtGui

FAINT = 70  # of 255, the ground of a marked line


def listing(name: str) -> Any:
    """Return a read-only field of that name for unwrapped lines in a monospaced font."""
    text = QtGui.QPlainTextEdit()
    text.setObjectName(name)
    text.setReadOnly(True)
    text.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
    font = QtGui.QFont("monospace")
    font.setStyleHint(QtGui.QFont.TypeWriter)
    text.setFont(font)
    return text


def mark(text: Any, line: int, focus: bool = False) -> None:
    """Mark a line, from 0; `focus`: also move the cursor into it and scroll to it."""
    cursor = QtGui.QTextCursor(text.document().findBlockByNumber(line))
    if focus:
        text.setTextCursor(cursor)
        text.centerCursor()
    marked = QtGui.QTextEdit.ExtraSelection()
    marked.cursor = cursor
    ground = text.palette().color(QtGui.QPalette.Highlight)
    ground.setAlpha(FAINT)
    marked.format.setBackground(ground)
    marked.format.setProperty(QtGui.QTextFormat.FullWidthSelection, True)
    text.setExtraSelections([marked])
