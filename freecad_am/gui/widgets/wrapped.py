# SPDX-License-Identifier: LGPL-2.1-or-later
"""A text of several lines that has room for all of them, however narrow it is."""

from __future__ import annotations

import contextlib
from typing import Any

from PySide import QtCore, QtGui


class WrappedLabel(QtGui.QLabel):
    """Layouts give other labels that are wrapped the height of a wider one, and cut off the last lines."""

    def __init__(self, text: str = "") -> None:
        super().__init__(text)
        self.setWordWrap(True)

    def minimumSizeHint(self) -> Any:
        """Called by Qt."""
        hint = super().minimumSizeHint()
        return QtCore.QSize(hint.width(), max(hint.height(), self.heightForWidth(self.width())))

    def resizeEvent(self, event: Any) -> None:
        """Called by Qt: another width may take more lines, or fewer."""
        super().resizeEvent(event)
        if event.oldSize().width() != event.size().width():
            # the layout that gives it the width would overlook it
            QtCore.QTimer.singleShot(0, self._renew)

    def _renew(self) -> None:
        with contextlib.suppress(RuntimeError):  # the panel is closed
            self.updateGeometry()
