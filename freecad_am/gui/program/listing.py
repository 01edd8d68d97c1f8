# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of a program in a window: to be read, line by line."""

from __future__ import annotations

from typing import Any

from PySide import QtGui


def listing(name: str) -> Any:
    """A field of that name for lines that are shown as they stand, in letters of one width."""
    text = QtGui.QPlainTextEdit()
    text.setObjectName(name)
    text.setReadOnly(True)
    text.setLineWrapMode(QtGui.QPlainTextEdit.NoWrap)
    font = QtGui.QFont("monospace")
    font.setStyleHint(QtGui.QFont.TypeWriter)
    text.setFont(font)
    return text
