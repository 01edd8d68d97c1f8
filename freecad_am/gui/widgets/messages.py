# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel tells, above its fields, in a place of fixed height: fields stay where they are as messages grow and go."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ..colours import set_role
from .wrapped import WrappedLabel

MARGIN = 2  # pixels
NARROW, MAX_LINES = (
    30,
    12,
)  # letters of a line in a panel as FreeCAD opens it, and lines that are held


class Messages(QtGui.QScrollArea):
    """Labels below each other; what has no room is scrolled to."""

    def __init__(self, lines: int) -> None:
        super().__init__()
        self.setObjectName("messages")
        self.setFrameShape(QtGui.QFrame.NoFrame)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        inner = QtGui.QWidget()
        self.column = QtGui.QVBoxLayout(inner)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(MARGIN)
        self.column.addStretch(1)
        self.setWidget(inner)
        inner.setAutoFillBackground(False)
        self.viewport().setAutoFillBackground(False)
        self._hold(lines)

    def add(self, name: str, role: str) -> Any:
        """A label below those that are there, hidden."""
        label = WrappedLabel()
        label.setObjectName(name)
        label.setAlignment(QtCore.Qt.AlignLeft | QtCore.Qt.AlignTop)
        set_role(label, role)
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        label.hide()
        self.column.insertWidget(self.column.count() - 1, label)
        return label

    def hold(self, label: Any) -> None:
        """Room for all of a label in a narrow panel, up to MAX_LINES lines, and no less than there is. Before the panel is
        seen: then fields are to stay in place."""
        metrics = self.fontMetrics()
        needed = label.heightForWidth(NARROW * metrics.averageCharWidth())
        if needed + 2 * MARGIN > self.height():
            self._hold(min(-(-needed // metrics.lineSpacing()), MAX_LINES))

    def _hold(self, lines: int) -> None:
        self.setFixedHeight(lines * self.fontMetrics().lineSpacing() + 2 * MARGIN)

    def to_top(self) -> None:
        """Show what stands first, such as an error."""
        self.verticalScrollBar().setValue(0)
