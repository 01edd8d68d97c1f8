# SPDX-License-Identifier: LGPL-2.1-or-later
"""A number with a unit in FreeCAD's own field, read so that nothing typed becomes another number unseen.

FreeCAD's field leaves out the characters it groups digits by ('1,5' is 15 where decimals have a point), takes other
units ('3 deg' is 3 mm), and on leaving goes back to the last text it could read ('1.2.3' becomes 1.23).
"""

from __future__ import annotations

import math
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ..core.issues import InputError

_DIGITS = 10
_LEAST_WIDTH = 70


class QuantityField:
    """The field `box` that shows a number in a unit."""

    def __init__(self, shown: float, unit: str, name: str) -> None:
        self.shown, self.unit, self.name = shown, unit, name
        self.box = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
        self.box.setProperty("unit", unit)
        quantity = App.Units.Quantity(f"{shown!r} {unit}")
        self.dimension = quantity.Unit
        # the display would be cut to the decimals of the preferences, and the value with it
        quantity.Format = {"NumberFormat": "g", "Precision": _DIGITS, "Denominator": 8}
        self.box.setProperty("value", quantity)
        self.box.setMinimumWidth(_LEAST_WIDTH)
        self.line = self.box.findChild(QtGui.QLineEdit)
        self.line.setCursorPosition(0)
        self.first_text = self.line.text()
        self.typed: str | None = None
        self.line.textEdited.connect(self._keep)
        self.line.textChanged.connect(self._forget)
        self.box.editingFinished.connect(self._restore)

    def read(self) -> float:
        """The number in the field's unit. InputError 'BAD_VALUE' for what is not one."""
        text = self.line.text() if self.typed is None else self.typed
        if text == self.first_text:
            return self.shown
        number = self._number(text)
        return float(self.box.property("rawValue")) if self.typed is None else number

    def _number(self, text: str) -> float:
        locale = self.box.locale()
        point, group = str(locale.decimalPoint()), str(locale.groupSeparator())
        if group.strip() and group in text:
            example = f"1{point}5 {self.unit}"
            raise self._wrong(text, f"write decimals with '{point}', as in {example}, and do not group digits")
        if not text.strip():
            raise InputError("BAD_VALUE", self.name, f"it is empty; give a quantity in {self.unit}")
        try:
            quantity = App.Units.Quantity(text.replace(point, "."))
        except (ValueError, TypeError, ArithmeticError):
            raise self._wrong(text, f"give a quantity in {self.unit}") from None
        if quantity.Unit not in (self.dimension, App.Units.Unit()) or not math.isfinite(quantity.Value):
            raise self._wrong(text, f"give a quantity in {self.unit}")
        plain = quantity.Unit == App.Units.Unit()
        return float(quantity.Value if plain else quantity.getValueAs(self.unit))

    def _wrong(self, text: str, remedy: str) -> InputError:
        return InputError("BAD_VALUE", self.name, f"{text!r} is not understood; {remedy}")

    # ---- the field changes its own text when it is left

    def _keep(self, text: str) -> None:
        self.typed = text

    def _forget(self, text: str) -> None:
        if text != self.typed and self.box.hasFocus():  # by the arrows or the wheel
            self.typed = None

    def _restore(self, *_: Any) -> None:
        if self.typed is None:
            return
        try:
            self._number(self.typed)
        except InputError:
            self.line.setText(self.typed)  # what is refused stays to be seen
