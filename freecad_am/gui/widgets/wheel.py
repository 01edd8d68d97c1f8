# SPDX-License-Identifier: LGPL-2.1-or-later
"""The wheel of the mouse scrolls a panel; it changes a field only where that has the focus."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from .present import present


class _Guard(QtCore.QObject):
    """Lets the wheel pass by fields without the focus, to the panel that scrolls."""

    def eventFilter(self, widget: Any, event: Any) -> bool:
        """Called by Qt."""
        # PySide may take an event for what lay at its address before
        if (
            isinstance(event, QtCore.QEvent)
            and event.type() == QtCore.QEvent.Wheel
            and not widget.hasFocus()
        ):
            event.ignore()
            return True
        return False


_guard = _Guard()


def scrolls(form: Any) -> None:
    """Let the wheel scroll over all fields of a panel; by default it would give them the focus, and turn their values."""
    for kind in (QtGui.QAbstractSpinBox, QtGui.QComboBox, QtGui.QAbstractSlider):
        for field in present(form, kind):
            _scrolls(field)


def _scrolls(field: Any) -> None:
    if field.focusPolicy() == QtCore.Qt.WheelFocus:
        field.setFocusPolicy(QtCore.Qt.StrongFocus)
    if not isinstance(field, QtGui.QScrollBar):
        field.installEventFilter(_guard)
