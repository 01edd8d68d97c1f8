# SPDX-License-Identifier: LGPL-2.1-or-later
"""A table of typed or pasted numbers; errors name row and column."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from PySide import QtCore, QtGui

from ...core.issues import InputError
from ...core.types import Array
from ..colours import INVALID, of, set_role
from ..in_language import sentence, tr, translated_error


class Page(QtGui.QWizardPage):
    """A page that completes the wizard's draft by one step.

    `fill` shows a draft from another source. `take` stores the entries in the draft and raises
    InputError.
    """

    def __init__(self, wizard: Any, name: str, title: str, explanation: str) -> None:
        super().__init__(wizard)
        self.owner = wizard
        self.filled_with: object = None
        self.setObjectName(name)
        self.setTitle(title)
        self.column = QtGui.QVBoxLayout(self)
        self.add_text(explanation)
        self.error = self.add_text("")
        self.error.setObjectName("error")
        set_role(self.error, INVALID)
        self.error.hide()

    def add_text(self, text: str) -> Any:
        """Add a paragraph."""
        label = QtGui.QLabel(text)
        label.setWordWrap(True)
        label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.column.addWidget(label)
        return label

    def say(self, text: str) -> None:
        """Show a problem; '' hides it."""
        self.error.setText(text)
        self.error.setVisible(bool(text))

    def fill(self) -> None:
        """Show the draft."""

    def take(self) -> None:
        """Store the entries in the draft."""

    def initializePage(self) -> None:
        """Called by Qt when the page opens; entries stay unless the machine changed."""
        self.say("")
        if self.filled_with is not self.owner.origin:
            self.filled_with = self.owner.origin
            self.fill()

    def cleanupPage(self) -> None:
        """Called by Qt for Back; keep all entries."""

    def validatePage(self) -> bool:
        """Called by Qt for Next."""
        self.say("")
        try:
            self.take()
        except InputError as error:
            self.say(error_text(error))
            return False
        return True


def error_text(error: InputError) -> str:
    """Format an error, with its location if the user knows it."""
    return (
        sentence(error.message)
        if error.where in ("geometry", "flange", "table")
        else translated_error(error)
    )


def choice(name: str, entries: list[tuple[str, Any]]) -> Any:
    """Create a combo box of texts with their values."""
    box = QtGui.QComboBox()
    box.setObjectName(name)
    for text, value in entries:
        box.addItem(text, value)
    return box


def heading(text: str) -> Any:
    """Create a heading within a page."""
    label = QtGui.QLabel(f"<b>{text}</b>")
    label.setWordWrap(True)
    return label


def axis_names(owner: Any) -> list[str]:
    """Return the names of the draft's axes: numbers, or the names of a machine tool."""
    draft = owner.draft
    if draft.chain.sliding.any():
        return [
            tr("{} (mm)").format(name) if slides else tr("{} (deg)").format(name)
            for name, slides in zip(draft.joints, draft.chain.sliding.tolist())
        ]
    return [f"J{number}" for number in range(1, draft.chain.axes + 1)]


CELL_PADDING = 12  # pixels in a cell next to its text
ROW_HEIGHT = 24
MOST_SHOWN = 9  # maximum number of visible rows


class FigureTable:
    """The table `widget`: numbers in rows and columns. Empty cells are NaN if `blank` allows them."""

    def __init__(
        self, name: str, rows: Sequence[str], columns: Sequence[str], helps: Sequence[str] = ()
    ) -> None:
        self.widget = _Table(self.paste)
        self.widget.setObjectName(name)
        self.widget.verticalHeader().setDefaultSectionSize(ROW_HEIGHT)
        self.widget.setHorizontalScrollMode(QtGui.QAbstractItemView.ScrollPerPixel)
        self.helps = tuple(helps)
        self.read_only: frozenset[int] = frozenset()
        self.set_shape(rows, columns)

    def set_shape(self, rows: Sequence[str], columns: Sequence[str]) -> None:
        """Set rows and columns by their headings; keep the content of remaining cells."""
        self.widget.setRowCount(len(rows))
        self.widget.setColumnCount(len(columns))
        self.widget.setVerticalHeaderLabels(list(rows))
        self.widget.setHorizontalHeaderLabels(list(columns))
        for row in range(len(rows)):
            for column in range(len(columns)):
                if self.widget.item(row, column) is None:
                    self.widget.setItem(row, column, QtGui.QTableWidgetItem(""))
        for column, text in enumerate(self.helps[: len(columns)]):
            self.widget.horizontalHeaderItem(column).setToolTip(text)
        self.widget.horizontalHeader().setSectionResizeMode(QtGui.QHeaderView.Stretch)
        self.widget.setTextElideMode(QtCore.Qt.ElideNone)  # '0.7071', not '0.…', in a narrow column
        self.widget.setWordWrap(False)  # wrapping would break a number at its point
        self.fit()

    def fit(self) -> None:
        """Fit the height to the number of rows."""
        row_count = min(self.widget.rowCount(), MOST_SHOWN)
        self.widget.setFixedHeight(
            ROW_HEIGHT * row_count + self.widget.horizontalHeader().sizeHint().height() + 4
        )

    def widen(self, columns: Sequence[int], widest: str) -> None:
        """Fit columns to the widest number; the other columns share the remaining width."""
        header, width = (
            self.widget.horizontalHeader(),
            self.widget.fontMetrics().boundingRect(widest).width() + CELL_PADDING,
        )
        for column in columns:
            header.setSectionResizeMode(column, QtGui.QHeaderView.Fixed)
            header.resizeSection(column, width)

    def lock(self, *columns: int) -> None:
        """Make columns read-only for computed values."""
        self.read_only = frozenset(columns)
        for row in range(self.widget.rowCount()):
            for column in columns:
                item = self.widget.item(row, column)
                item.setFlags(item.flags() & ~QtCore.Qt.ItemIsEditable)

    def fill(self, values: Any) -> None:
        """Show numbers (rows, columns); NaN and infinity become empty cells."""
        self.widget.blockSignals(True)
        for row, line in enumerate(np.asarray(values, float).tolist()):
            for column, value in enumerate(line):
                self.widget.item(row, column).setText(format_figure(value))
        self.widget.blockSignals(False)

    def text(self, row: int, column: int) -> str:
        """Return the text of a cell."""
        item = self.widget.item(row, column)
        return "" if item is None else str(item.text()).strip()

    def show(self, row: int, column: int, text: str, colour: str | None = None) -> None:
        """Show a text in a cell."""
        item = self.widget.item(row, column)
        item.setText(text)
        item.setForeground(QtGui.QBrush() if colour is None else QtGui.QBrush(of(colour)))

    def row(self, row: int, count: int | None = None, blank: bool = False) -> Array:
        """Return the numbers of a row, of the first `count` columns. Raises InputError BAD_VALUE,
        naming the cell.
        """
        columns = range(self.widget.columnCount() if count is None else count)
        return np.array([self.figure(row, column, blank) for column in columns])

    def figures(self, blank: bool = False) -> Array:
        """Return all numbers (rows, columns)."""
        return np.stack([self.row(row, None, blank) for row in range(self.widget.rowCount())])

    def figure(self, row: int, column: int, blank: bool = False) -> float:
        """Return the number in a cell. Raises InputError BAD_VALUE without a number."""
        text = self.text(row, column)
        if not text and blank:
            return math.nan
        where = f"{self.widget.verticalHeaderItem(row).text()}, {self.widget.horizontalHeaderItem(column).text()}"
        if not text:
            raise InputError("BAD_VALUE", where, tr("the field is empty; enter a number"))
        return number(text, where)

    def has_entries(self, row: int, count: int) -> bool:
        """Whether any of the first cells of a row has a text."""
        return any(self.text(row, column) for column in range(count))

    def paste(self) -> None:
        """Fill cells from the clipboard, starting at the current cell; tabs, blanks or semicolons
        separate numbers.
        """
        text = str(QtGui.QApplication.clipboard().text())
        top_row, left_column = max(0, self.widget.currentRow()), max(0, self.widget.currentColumn())
        for down, line in enumerate(line for line in text.splitlines() if line.strip()):
            words = line.replace(";", " ").split()
            for right, word in enumerate(words):
                row, column = top_row + down, left_column + right
                if (
                    row < self.widget.rowCount()
                    and column < self.widget.columnCount()
                    and column not in self.read_only
                ):
                    self.widget.item(row, column).setText(word)


class _Table(QtGui.QTableWidget):
    """A table that accepts pasted numbers; Enter moves to the cell below instead of closing the
    dialog.
    """

    def __init__(self, paste: Callable[[], None]) -> None:
        super().__init__()
        self.paste = paste

    def keyPressEvent(self, event: Any) -> None:
        if event.matches(QtGui.QKeySequence.Paste):
            self.paste()
        elif event.key() in (QtCore.Qt.Key_Return, QtCore.Qt.Key_Enter):
            self.setCurrentCell(
                min(self.currentRow() + 1, self.rowCount() - 1), self.currentColumn()
            )
        else:
            super().keyPressEvent(event)


def format_figure(value: float) -> str:
    """Format a number as a user types it; '' for a non-finite number."""
    return f"{value:.10g}" if math.isfinite(value) else ""


def number(text: str, where: str) -> float:
    """Parse a number with the decimal point of the language or a plain point.

    Raises InputError BAD_VALUE for other text.
    """
    point = str(QtCore.QLocale().decimalPoint())
    try:
        value = float(text.replace(point, "."))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(
            "BAD_VALUE",
            where,
            tr("{} is not a number; enter a number such as 12.5").format(repr(text)),
        )
    return value
