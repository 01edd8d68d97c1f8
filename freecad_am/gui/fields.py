# SPDX-License-Identifier: LGPL-2.1-or-later
"""One widget per parameter, made from its row: what is shown, and what was typed in outer units."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide import QtGui

from ..core.issues import InputError
from ..core.parameters import field as f
from ..objects.rows import LENGTH_OR_POSE, MIXED, TEXT_LIST, Row
from .quantity import QuantityField

_QUANTITIES = (f.LENGTH, f.ANGLE, f.SPEED, f.TIME)
_POSE_UNITS = ("mm", "mm", "mm", "deg", "deg", "deg")
_POSE_NAMES = ("X", "Y", "Z", "RX", "RY", "RZ")
_LARGEST = 2_147_483_647


class Field:
    """A widget and how to read it. `value` raises InputError naming the field for what cannot be read."""

    def __init__(self, row: Row, widget: Any, read: Callable[[], Any]) -> None:
        self.row = row
        self.widget = widget
        self.read = read
        self.label = label_of(row)
        self.shown = read()
        widget.setObjectName(row.name)
        widget.setToolTip(row.spec.help)

    @property
    def value(self) -> Any:
        """What the widget holds, in outer units as a macro passes it."""
        return self.read()

    @property
    def changed(self) -> bool:
        """True when it holds something else than at first."""
        return bool(self.read() != self.shown)


def label_of(row: Row) -> str:
    """'Layer height' for layer_height; the group is told by its box."""
    words = [("from", "to")[step] if isinstance(step, int) else step for step in row.path]
    words = words[1:] if len(words) > 1 and words[-1] not in ("from", "to") else words
    text = " ".join(words).replace("_", " ")
    return "RZ" if text == "rz" else text[0].upper() + text[1:]


def make(row: Row, value: Any, suggestions: Callable[[], list[str]] | None = None) -> Field:
    """The field of a row that shows an inner value; `suggestions` are texts to choose from."""
    shown = row.outer(value)
    if row.form == f.POSE:
        return _pose(row, shown)
    if row.form in _QUANTITIES:
        quantity = QuantityField(shown, row.unit, label_of(row))
        return Field(row, quantity.box, quantity.read)
    if row.form == f.CHOICE:
        return _choice(row, shown)
    if row.form == f.FLAG:
        check = QtGui.QCheckBox()
        check.setChecked(shown)
        return Field(row, check, check.isChecked)
    if row.form == f.COUNT:
        spin = QtGui.QSpinBox()
        spin.setRange(-_LARGEST, _LARGEST)  # what is out of range is told by the core, not cut off here
        spin.setValue(shown)
        return Field(row, spin, spin.value)
    if suggestions is not None:
        return _suggested(row, shown, suggestions())
    return _text(row, value)


def _text(row: Row, value: Any) -> Field:
    edit = QtGui.QLineEdit()
    if row.form == TEXT_LIST:
        edit.setText(" ".join(value))
        return Field(row, edit, lambda: tuple(edit.text().replace(",", " ").split()))
    edit.setText(row.text(value) if row.form in (MIXED, LENGTH_OR_POSE) else f"{row.outer(value)}")
    words = " or ".join((row.unit and f"a quantity in {row.unit}", *row.spec.words)).removeprefix(" or ")
    if words or row.spec.optional:
        edit.setPlaceholderText(words + (" (empty: none)" if row.spec.optional else ""))
    if row.form == f.NUMBER:
        return Field(row, edit, lambda: _number(edit.text(), label_of(row)))
    return Field(row, edit, lambda: edit.text().strip())


def _number(text: str, name: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError("BAD_VALUE", name, f"{text!r} is not a number; give one such as 0.1") from None


def _choice(row: Row, shown: str) -> Field:
    combo = QtGui.QComboBox()
    combo.addItems(list(row.spec.choices))
    _shrink(combo)
    combo.setCurrentIndex(row.spec.choices.index(shown))
    return Field(row, combo, combo.currentText)


def _suggested(row: Row, shown: str, texts: list[str]) -> Field:
    combo = QtGui.QComboBox()
    combo.setEditable(True)
    combo.addItems(texts)
    _shrink(combo)
    combo.setEditText(shown)
    combo.lineEdit().setCursorPosition(0)
    return Field(row, combo, lambda: combo.currentText().strip())


def _shrink(combo: Any) -> None:
    """Let a box be narrower than its longest text: the panel is narrow."""
    combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    combo.setMinimumContentsLength(8)


def _pose(row: Row, shown: tuple[float, ...]) -> Field:
    widget = QtGui.QWidget()
    grid = QtGui.QGridLayout(widget)
    grid.setContentsMargins(12, 0, 0, 0)
    grid.setColumnStretch(1, 1)
    reads = []
    for index, (number, unit, name) in enumerate(zip(shown, _POSE_UNITS, _POSE_NAMES, strict=True)):
        quantity = QuantityField(number, unit, f"{label_of(row)} {name}")
        quantity.box.setObjectName(f"{row.name}{name}")
        quantity.box.setToolTip(f"{name}: {row.spec.help}")
        grid.addWidget(QtGui.QLabel(name), index, 0)
        grid.addWidget(quantity.box, index, 1)
        reads.append(quantity.read)
    return Field(row, widget, lambda: tuple(read() for read in reads))
