# SPDX-License-Identifier: LGPL-2.1-or-later
"""A widget in what lets it be higher than the room it gets: it is scrolled up and down alone."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

LEAST_HEIGHT = 60  # pixels


class Scrolled(QtGui.QScrollArea):
    """It asks for the size of what it holds, and can be as low as LEAST_HEIGHT. narrowest: pixels of its width."""

    def __init__(self, widget: Any, narrowest: int = 0) -> None:
        super().__init__()
        self.narrowest = narrowest
        self.setWidgetResizable(True)
        self.setFrameShape(QtGui.QFrame.NoFrame)
        self.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        self.setWidget(widget)
        self.setMinimumWidth(self._least_width())

    def _least_width(self) -> int:
        hint, bar = self.widget().minimumSizeHint(), self.verticalScrollBar().sizeHint()
        return int(max(self.narrowest, hint.width() + bar.width()))

    def minimumSizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(self._least_width(), LEAST_HEIGHT)

    def sizeHint(self) -> Any:
        """Called by Qt."""
        hint, bar = self.widget().sizeHint(), self.verticalScrollBar().sizeHint()
        return QtCore.QSize(hint.width() + bar.width(), hint.height())
