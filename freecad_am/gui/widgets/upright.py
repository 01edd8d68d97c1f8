# SPDX-License-Identifier: LGPL-2.1-or-later
"""Restrict panels to vertical scrolling.

Qt also scrolls sideways when it reveals a note or field above or below. FreeCAD's task view then
cuts off the left edge and shows no scroll bar.
"""

from __future__ import annotations

import contextlib
from typing import Any

import FreeCADGui as Gui
from PySide import QtCore, QtGui

# ---- Children of a widget


def present(parent: Any, kind: Any) -> list[Any]:
    """Return the child widgets of a kind, without widgets that PySide considers deleted.

    PySide finds wrappers by memory address, which an older widget may have had (docs/versions.md).
    """
    widgets = []
    for widget in parent.findChildren(kind):
        with contextlib.suppress(RuntimeError):
            widget.objectName()
            widgets.append(widget)
    return widgets


class _Guard(QtCore.QObject):
    """Passes wheel events on fields without focus to the scrolling panel."""

    def eventFilter(self, widget: Any, event: Any) -> bool:
        """Called by Qt."""
        # PySide may confuse an event with an earlier object at its address
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
    """Let the wheel scroll over all fields of a panel; by default it would focus them and change
    their values.
    """
    for kind in (QtGui.QAbstractSpinBox, QtGui.QComboBox, QtGui.QAbstractSlider):
        for field in present(form, kind):
            _scrolls(field)


def _scrolls(field: Any) -> None:
    if field.focusPolicy() == QtCore.Qt.WheelFocus:
        field.setFocusPolicy(QtCore.Qt.StrongFocus)
    if not isinstance(field, QtGui.QScrollBar):
        field.installEventFilter(_guard)


class _Upright(QtCore.QObject):
    """Scrolls a panel back to its left edge, as long as the panel is visible."""

    def eventFilter(self, widget: Any, event: Any) -> bool:
        """Called by Qt for the panel and the content of its scroll areas."""
        # PySide may confuse an event with an earlier object at its address
        if isinstance(event, QtCore.QEvent):
            with contextlib.suppress(RuntimeError):  # the scroll area is deleted
                if event.type() == QtCore.QEvent.Show and widget is self.parent():
                    for area in scroll_areas_of(widget):
                        area.widget().installEventFilter(self)
                elif (
                    event.type() == QtCore.QEvent.Move
                    and widget is not self.parent()
                    and widget.x() < 0
                ):
                    for area in scroll_areas_of(self.parent()):
                        area.horizontalScrollBar().setValue(0)
        return False


def upright(form: Any) -> None:
    """Restrict a panel to vertical scrolling."""
    form.installEventFilter(_Upright(form))


def scroll_areas_of(form: Any) -> list[Any]:
    """Return the scroll areas that contain a panel."""
    return [
        area for area in present(Gui.getMainWindow(), QtGui.QScrollArea) if area.isAncestorOf(form)
    ]
