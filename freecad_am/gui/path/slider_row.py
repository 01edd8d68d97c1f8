# SPDX-License-Identifier: LGPL-2.1-or-later
"""A number to choose by slider, arrows or keys."""

from __future__ import annotations

from typing import Any

from PySide import QtCore, QtGui

from ..texts.translation import tr
from ..widgets.steady import hold


class Row:
    """A slider with arrows at its ends and its number beside it; `moved` is called when the user has moved it."""

    def __init__(self, name: str, text: str, help: str, page: int) -> None:
        self.label, self.slider, self.box = (
            QtGui.QLabel(text),
            QtGui.QSlider(QtCore.Qt.Horizontal),
            QtGui.QSpinBox(),
        )
        self.back, self.on = QtGui.QToolButton(), QtGui.QToolButton()
        for button, arrow, step in (
            (self.back, QtCore.Qt.LeftArrow, -1),
            (self.on, QtCore.Qt.RightArrow, 1),
        ):
            button.setArrowType(arrow)
            button.setAutoRepeat(True)
            button.clicked.connect(lambda *_, step=step: self.box.setValue(self.box.value() + step))
        self.slider.setObjectName(f"{name}_slider")
        self.box.setObjectName(f"{name}_spin")
        self.back.setObjectName(f"{name}_back")
        self.on.setObjectName(f"{name}_on")
        self.slider.setPageStep(page)
        for widget in (self.slider, self.box):
            widget.setToolTip(help)
        self.back.setToolTip(tr("One back"))
        self.on.setToolTip(tr("One on"))
        self.moved: Any = lambda row: None
        self.slider.valueChanged.connect(self._slid)
        self.box.valueChanged.connect(lambda *_: self.moved(self))

    def add_to(self, grid: Any, row: int) -> None:
        """Put it into a row of a grid of five columns."""
        for column, widget in enumerate((self.label, self.back, self.slider, self.on, self.box)):
            grid.addWidget(widget, row, column)
        grid.setColumnStretch(2, 1)

    def _slid(self, value: int) -> None:
        if value != self.box.value():
            self.box.setValue(value)  # which tells

    def set(self, least: int, most: int, value: int) -> None:
        """Bounds and value; tells nobody."""
        for widget in (self.slider, self.box):
            blocked = widget.blockSignals(True)
            widget.setRange(least, most)
            widget.setValue(value)
            widget.blockSignals(blocked)
        hold(self.box)  # as wide as its widest number so far

    def value(self) -> int:
        """What is entered."""
        return int(self.box.value())

    def most(self) -> int:
        """The upper bound."""
        return int(self.box.maximum())
