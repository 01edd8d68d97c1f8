# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of the dock of paths: which one, its colours and look, the layers and points that are shown of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtGui

from ..texts.translation import tr
from ..widgets.steady import SteadyText
from .slider_row import Row

LINES = 3  # of what is told of a point, at most
LABEL = 14  # letters of a choice that are to be seen, at least
_LAYER_PAGE, _POINT_PAGE = 10, 100


class PathForm(QtGui.QWidget):
    """In the language of the window of now."""

    def __init__(self) -> None:
        super().__init__()
        column, self.controls = QtGui.QVBoxLayout(self), QtGui.QWidget()
        column.setContentsMargins(9, 4, 9, 4)
        column.setSpacing(3)
        self.choice = _combo("path", tr("The toolpath or joint path to show"))
        self.colouring = _combo("colouring", tr("Quantity shown by the colours of the beads"))
        self.look = _combo(
            "look", tr("Draw beads as lines, or as tubes of their width and layer height")
        )
        self.directions = QtGui.QCheckBox(tr("Build directions"))
        self.directions.setObjectName("directions")
        self.single = QtGui.QCheckBox(tr("One layer only"))
        self.single.setObjectName("single")
        self.all = QtGui.QPushButton(tr("Show all"))
        self.all.setObjectName("all")
        self.from_, self.to, self.point = (
            Row("from", tr("From layer"), tr("The first layer shown"), _LAYER_PAGE),
            Row("to", tr("To layer"), tr("The last layer shown"), _LAYER_PAGE),
            Row(
                "point",
                tr("Point"),
                tr("The last point shown, counted from 0 in the last layer"),
                _POINT_PAGE,
            ),
        )
        self.facts = SteadyText("facts", LINES)
        column.addLayout(self._choices())
        column.addWidget(self.controls)
        grid = QtGui.QGridLayout(self.controls)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(2)
        for number, row in enumerate((self.from_, self.to, self.point)):
            row.add_to(grid, number)
        column.addWidget(self.facts)
        column.addStretch(1)

    def enable(self, there: bool) -> None:
        """Whether there is a path to choose something of."""
        for widget in (
            self.controls,
            self.colouring,
            self.look,
            self.directions,
            self.single,
            self.all,
        ):
            widget.setEnabled(there)

    def _choices(self) -> Any:
        lines = QtGui.QVBoxLayout()
        what, how = QtGui.QHBoxLayout(), QtGui.QHBoxLayout()
        for line, text, widget in (
            (what, tr("Path"), self.choice),
            (what, tr("Colours"), self.colouring),
            (how, tr("Look"), self.look),
        ):
            line.addWidget(QtGui.QLabel(text))
            line.addWidget(widget)
        what.addStretch(1)
        for box in (self.directions, self.single):
            how.addWidget(box)
        how.addStretch(1)
        how.addWidget(self.all)
        lines.addLayout(what)
        lines.addLayout(how)
        return lines


def offer(combo: Any, names: list[str], chosen: int, label: Callable[[str], str] = str) -> None:
    """Choices of a combo box, changed only where they differ."""
    if [combo.itemData(index) for index in range(combo.count())] != list(names):
        combo.clear()
        for name in names:
            combo.addItem(label(name), name)
    combo.setCurrentIndex(chosen)


def _combo(name: str, help: str) -> Any:
    combo = QtGui.QComboBox()
    combo.setObjectName(name)
    combo.setToolTip(help)
    combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToContents)
    combo.setMinimumWidth(
        LABEL * combo.fontMetrics().averageCharWidth()
    )  # a long label widens no window
    return combo
