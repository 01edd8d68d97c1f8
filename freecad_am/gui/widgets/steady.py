# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts and numbers that change in every frame without moving their neighbours.

A plain label has the size of its text. On each change Qt repeats the layout of the window and
composes it again, which costs as much as a small image. A fixed size avoids both.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from PySide import QtCore, QtGui

LEAST_HEIGHT = 60  # pixels


class Scrolled(QtGui.QScrollArea):
    """Scroll area with the size of its content, at least LEAST_HEIGHT high. narrowest: pixels,
    minimum width.
    """

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


class SteadyLabel(QtGui.QLabel):
    """A single line that reserves the width of its widest text from the start."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(name)

    def reserve_width(self, texts: Iterable[str]) -> None:
        """Reserve the width of these texts and the current one."""
        current = self.text()
        sizes = [self._size(text) for text in (*texts, current)]
        self.setFixedSize(max(size.width() for size in sizes), max(size.height() for size in sizes))

    def show_text(self, text: str) -> None:
        """Show a text; widen the label if needed."""
        if text != self.text():
            size = self._size(text)
            if size.width() > self.minimumWidth():
                self.setFixedWidth(size.width())

    def _size(self, text: str) -> Any:
        self.setText(text)
        return self.sizeHint()


class SteadyText(QtGui.QWidget):
    """A wrapped text with space for some lines, and for more once they were needed."""

    def __init__(self, name: str, lines: int) -> None:
        super().__init__()
        self.label = QtGui.QLabel(self)  # in no layout, so that its size affects nothing
        self.label.setObjectName(name)
        self.label.setWordWrap(True)
        self.label.setAlignment(QtCore.Qt.AlignTop)
        self.setMinimumHeight(lines * self.label.fontMetrics().lineSpacing())

    def show_text(self, text: str) -> None:
        """Show a text."""
        self.label.setText(text)
        self._fit()

    def resizeEvent(self, event: Any) -> None:
        """Fit the text to the new width."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        self.label.setGeometry(self.rect())
        needed = self.label.heightForWidth(self.width())
        if needed > self.minimumHeight():
            self.setMinimumHeight(needed)


def hold(widget: Any) -> None:
    """Fix a field at its largest size so far."""
    size = widget.sizeHint().expandedTo(widget.minimumSize())
    if size != widget.minimumSize():
        widget.setFixedSize(size)
