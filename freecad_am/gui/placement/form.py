# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the dock of a placement holds: the box of poses, what is told of them, the best as a table, buttons."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ...core.parameters.place import SIDES, PlaceParameters
from ...core.placement.place import Placed
from ...objects.checks.placed import change_parameters
from ...objects.fields.rows import flat, rows
from ..colours import PLAIN, WRONG, set_role
from ..texts.translation import tr
from ..widgets import fields
from ..widgets.fold import Fold
from . import figures

SECTION, HIGH = "place", 160  # pixels of the table at least


class Form(QtGui.QWidget):
    """The widgets at their places; whoever makes it connects them. values: what the fields show, as a macro has them."""

    def __init__(self, values: dict[str, Any]) -> None:
        super().__init__()
        column = QtGui.QVBoxLayout(self)
        self.fields: dict[str, fields.Field] = {}
        box, more = Fold(tr("Poses to try"), True), Fold(tr("More"), False)
        current = flat(change_parameters(None, values))
        for row in rows(PlaceParameters):
            field = fields.make(row, current[row.key], None, "", SECTION)
            self.fields[row.key] = field
            heading = f"± {field.heading}" if row.key in SIDES else field.heading
            (more if row.spec.advanced else box).add(heading, field.widget)
        column.addWidget(box.widget)
        column.addWidget(more.widget)
        self.compute = _button(
            "compute", tr("Compute"), tr("Try all poses in the background; can be cancelled")
        )
        self.use = _button(
            "use", tr("Use this"), tr("Enter the pose selected in the table into the cell")
        )
        self.reach = _reach()
        self.colour = QtGui.QComboBox()
        self.colour.setObjectName("colour")
        self.colour.setToolTip(tr("Quantity shown by the colours of the places"))
        for name in figures.NAMES:
            self.colour.addItem(figures.heading(name), name)
        self.key, self.summary = QtGui.QLabel(), QtGui.QLabel()
        self.key.setObjectName("key")
        self.summary.setObjectName("told")
        for label, most in (
            (self.key, 1),
            (self.summary, 2),
        ):  # lines, with which what is below stays where it is
            label.setWordWrap(True)
            label.setMinimumHeight(most * label.fontMetrics().lineSpacing())
            label.setAlignment(QtCore.Qt.AlignLeft | QtCore.Qt.AlignTop)
        self.table = _table()
        buttons = QtGui.QHBoxLayout()
        buttons.addWidget(self.compute)
        buttons.addWidget(self.use)
        column.addLayout(buttons)
        for widget in (self.reach, self.summary, self.colour, self.key, self.table):
            column.addWidget(widget)
        column.addStretch(1)

    def values(self) -> dict[str, Any]:
        """What is entered, as a macro passes it. InputError for what cannot be read."""
        return {key: field.value for key, field in self.fields.items()}

    def tell(self, text: str, wrong: bool = False) -> None:
        """Say what goes on, or what came of it."""
        self.summary.setText(text)
        set_role(self.summary, WRONG if wrong else PLAIN)

    def tell_colours(self, shown: figures.Coloured | None) -> None:
        """What the colours mean."""
        if shown is None or shown.least != shown.least:
            self.key.setText("")
            return
        self.key.setText(
            tr("blue {:.4g} … yellow {:.4g}; grey: not feasible").format(shown.least, shown.most)
        )

    def fill(self, found: Placed | None, numbers: list[int]) -> None:
        """The rows of the table."""
        self.table.setRowCount(0 if found is None else len(numbers))
        for row, number in enumerate(numbers if found is not None else ()):
            assert found is not None
            for column, text in enumerate(figures.texts(found, number)):
                item = QtGui.QTableWidgetItem(text)
                item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
                self.table.setItem(row, column, item)
        self.table.resizeColumnsToContents()
        if numbers and found is not None:
            self.table.selectRow(0)


def _button(name: str, text: str, help: str) -> Any:
    button = QtGui.QPushButton(text)
    button.setObjectName(name)
    button.setToolTip(help)
    return button


def _reach() -> Any:
    box = QtGui.QCheckBox(tr("Reach of the robot"))
    box.setObjectName("reach")
    box.setSizePolicy(
        QtGui.QSizePolicy.Fixed, QtGui.QSizePolicy.Fixed
    )  # Qt takes clicks on its text alone
    box.setToolTip(
        tr("Show the workspace of the robot: blue for few directions, yellow for all directions")
    )
    return box


def _table() -> Any:
    table = QtGui.QTableWidget(0, len(figures.heads()))
    table.setObjectName("poses")
    table.setHorizontalHeaderLabels(figures.heads())
    table.verticalHeader().hide()
    table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
    table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
    table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
    table.setMinimumHeight(HIGH)
    return table
