# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collapsible sections of a panel, with labels and notes that layouts do not cut off."""

from __future__ import annotations

import contextlib
from typing import Any

from PySide import QtCore, QtGui

from ..colours import INVALID, set_role
from .upright import present


class WrappedLabel(QtGui.QLabel):
    """A wrapped label with a sufficient height; layouts give other wrapped labels the height of a
    wider label and cut off the last lines.
    """

    def __init__(self, text: str = "") -> None:
        super().__init__(text)
        self.setWordWrap(True)

    def minimumSizeHint(self) -> Any:
        """Called by Qt."""
        hint = super().minimumSizeHint()
        return QtCore.QSize(hint.width(), max(hint.height(), self.heightForWidth(self.width())))

    def resizeEvent(self, event: Any) -> None:
        """Called by Qt; another width may change the number of lines."""
        super().resizeEvent(event)
        if event.oldSize().width() != event.size().width():
            # the layout that sets the width would ignore an immediate update
            QtCore.QTimer.singleShot(0, self._renew)

    def _renew(self) -> None:
        with contextlib.suppress(RuntimeError):  # the panel is closed
            self.updateGeometry()


MARGIN = 2  # pixels
NARROW, MAX_LINES = (
    30,
    12,
)  # letters per line in a panel at FreeCAD's initial width, and maximum number of reserved lines


class Messages(QtGui.QScrollArea):
    """Labels below each other, in a scroll area."""

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
        """Add a hidden label at the end."""
        label = WrappedLabel()
        label.setObjectName(name)
        label.setAlignment(QtCore.Qt.AlignLeft | QtCore.Qt.AlignTop)
        set_role(label, role)
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        label.hide()
        self.column.insertWidget(self.column.count() - 1, label)
        return label

    def hold(self, label: Any) -> None:
        """Reserve space for a whole label in a narrow panel, up to MAX_LINES lines, and never less
        than now.

        Call it before the panel is visible, so that fields do not move later.
        """
        metrics = self.fontMetrics()
        needed = label.heightForWidth(NARROW * metrics.averageCharWidth())
        if needed + 2 * MARGIN > self.height():
            self._hold(min(-(-needed // metrics.lineSpacing()), MAX_LINES))

    def _hold(self, lines: int) -> None:
        self.setFixedHeight(lines * self.fontMetrics().lineSpacing() + 2 * MARGIN)

    def to_top(self) -> None:
        """Scroll to the first label, such as an error."""
        self.verticalScrollBar().setValue(0)


KEEP_MS = 2500  # ms; how long the space of a removed note is kept
WIDEST_LABEL = 78  # pixels; longer labels wrap
LONGEST_ROW = 2  # maximum number of fields next to a label; more fields go below it
# pixels; maximum text width of a choice next to its label; wider choices go below the label
WIDEST_CHOICE = 84


class Note(QtGui.QLabel):
    """A text with space for all its lines; in a narrow form, other labels lose their last lines.

    The space of a hidden note is kept for a while. Otherwise a corrected field would move the
    fields below it just when the user clicks the next field.
    """

    def __init__(self) -> None:
        super().__init__()
        self.setWordWrap(True)
        self.tallest = 0  # current height in pixels

    def minimumSizeHint(self) -> Any:
        """Called by Qt."""
        hint = super().minimumSizeHint()
        return QtCore.QSize(hint.width(), max(hint.height(), self.heightForWidth(self.width())))

    def heightForWidth(self, width: int) -> int:
        """Called by Qt."""
        return max(super().heightForWidth(width), self.tallest)

    def showEvent(self, event: Any) -> None:
        """Called by Qt; from now on the note keeps its space."""
        super().showEvent(event)
        policy = self.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.setSizePolicy(policy)

    def hideEvent(self, event: Any) -> None:
        """Called by Qt; release the space after a while, when the user has entered the next field."""
        super().hideEvent(event)
        QtCore.QTimer.singleShot(KEEP_MS, self._close_gap)

    def _close_gap(self) -> None:
        with contextlib.suppress(RuntimeError):  # the panel is closed
            if not self.isHidden():
                return
            if QtGui.QApplication.mouseButtons() != QtCore.Qt.NoButton:
                QtCore.QTimer.singleShot(KEEP_MS, self._close_gap)
                return
            policy = self.sizePolicy()
            policy.setRetainSizeWhenHidden(False)
            self.setSizePolicy(policy)
            self.tallest = 0

    def resizeEvent(self, event: Any) -> None:
        """Called by Qt; another width may change the number of lines."""
        super().resizeEvent(event)
        self.tallest = (
            max(self.tallest, event.size().height())
            if event.oldSize().width() == event.size().width()
            else 0
        )
        if event.oldSize().width() != event.size().width():
            QtCore.QTimer.singleShot(
                0, self._renew
            )  # the layout that sets the width would ignore an immediate update

    def _renew(self) -> None:
        with contextlib.suppress(RuntimeError):  # the panel is closed
            self.updateGeometry()


class Name(QtGui.QLabel):
    """Label of a field with space for all its lines; a form cuts off other labels next to a lower
    field.
    """

    def minimumSizeHint(self) -> Any:
        """Called by Qt."""
        hint = super().minimumSizeHint()
        high = self.heightForWidth(self.maximumWidth()) if self.wordWrap() else 0
        return QtCore.QSize(hint.width(), max(hint.height(), high))

    def sizeHint(self) -> Any:
        """Called by Qt."""
        hint = super().sizeHint()
        return hint.expandedTo(self.minimumSizeHint()) if self.wordWrap() else hint


class Fold:
    """A heading with an arrow that folds and unfolds the form below it. widest_label: pixels."""

    def __init__(self, title: str, unfolded: bool, widest_label: int = WIDEST_LABEL) -> None:
        self.widest_label = widest_label
        self.widget = QtGui.QWidget()
        column = QtGui.QVBoxLayout(self.widget)
        column.setContentsMargins(0, 4, 0, 0)
        column.setSpacing(2)
        self.heading = QtGui.QToolButton()
        self.heading.setObjectName(f"Fold{title.replace(' ', '')}")
        self.heading.setText(title)
        self.heading.setCheckable(True)
        self.heading.setAutoRaise(True)
        self.heading.setToolButtonStyle(QtCore.Qt.ToolButtonTextBesideIcon)
        self.heading.setStyleSheet("QToolButton { font-weight: bold; border: none; }")
        self.body = QtGui.QWidget()
        self.form = QtGui.QFormLayout(self.body)
        self.form.setContentsMargins(4, 0, 0, 4)
        self.form.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        self.form.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        self.rows: dict[
            str, tuple[Any, Any]
        ] = {}  # label, and container of the field and its note, by field name
        column.addWidget(self.heading)
        column.addWidget(self.body)
        self.heading.toggled.connect(self._show)
        self.heading.setChecked(unfolded)
        self._show(unfolded)

    def add(self, label: str, widget: Any) -> Any:
        """Add a row to the form; return the hidden note for problems under the widget."""
        name = Name(label)
        name.setToolTip(widget.toolTip())
        for child in (widget, *present(widget, QtGui.QWidget), name):
            if not child.whatsThis():  # without What's This text, Qt would use the parent's help
                child.setWhatsThis(widget.whatsThis() or child.toolTip() or widget.toolTip())
        note = Note()
        note.setObjectName(f"{widget.objectName()}Note")
        set_role(note, INVALID)
        note.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        note.hide()
        container = QtGui.QWidget()
        column = QtGui.QVBoxLayout(container)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(1)
        column.addWidget(widget)
        column.addWidget(note)
        if _is_long(widget):
            self.form.addRow(name)
            self.form.addRow(container)
        else:
            if name.sizeHint().width() > self.widest_label:
                name.setWordWrap(True)
                name.setFixedWidth(self.widest_label)
            self.form.addRow(name, container)
        self.rows[widget.objectName()] = (name, container)
        return note

    def enable(self, widget: Any, on: bool) -> None:
        """Enable a field and its label, or grey them out."""
        widget.setEnabled(on)
        self.rows[widget.objectName()][0].setEnabled(on)

    def show(self, widget: Any, on: bool) -> None:
        """Show or hide the row of a field; hide the section if it has no visible row."""
        for cell in self.rows[widget.objectName()]:
            cell.setVisible(on)
        self.widget.setVisible(any(not name.isHidden() for name, _ in self.rows.values()))

    def add_below(self, widget: Any, new_widget: Any) -> None:
        """Add a row of full width directly below a field."""
        container = self.rows[widget.objectName()][1]
        items = (
            (row, self.form.itemAt(row, QtGui.QFormLayout.FieldRole))
            for row in range(self.form.rowCount())
        )
        self.form.insertRow(
            next(row for row, item in items if item is not None and item.widget() is container) + 1,
            new_widget,
        )

    def _show(self, unfolded: bool) -> None:
        self.body.setVisible(unfolded)
        self.heading.setArrowType(QtCore.Qt.DownArrow if unfolded else QtCore.Qt.RightArrow)


def _is_long(widget: Any) -> bool:
    """Whether a field needs the full panel width: several fields, or a choice with long texts."""
    if isinstance(widget, QtGui.QComboBox):
        measure = widget.fontMetrics().boundingRect
        return any(
            measure(widget.itemText(row)).width() > WIDEST_CHOICE for row in range(widget.count())
        )
    return widget.layout() is not None and widget.layout().count() > LONGEST_ROW
