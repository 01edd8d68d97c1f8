# SPDX-License-Identifier: LGPL-2.1-or-later
"""A number with a unit in FreeCAD's own field, read so that nothing typed becomes another number unseen.

A text that starts with `=` is an expression, which the number follows; FreeCAD's own way to enter one would change the
document before OK.

FreeCAD's field leaves out the characters it groups digits by ('1,5' is 15 where decimals have a point), refuses keys
that make a quantity of another kind (of 'mm/min' the m, so that 'in' is left; '20 s' would be 20 mm/s), and on leaving
goes back to the last text it could read ('1.2.3' becomes 1.23).
"""

from __future__ import annotations

import contextlib
import math
import re
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from ...core.issues import InputError, Text, Word
from ...objects.fields.expressions import MARK, is_expression
from ...objects.fields.rows import plain_blanks
from ...objects.fields.rows import quantity as quantity_of
from ..signals import connect
from ..texts.translation import tr

_DIGITS = 10
_OURS = re.compile(r"\d\s*ms\s*$")  # that FreeCAD's field does not know
_LEAST_WIDTH = 70
_TRIES = 20
_SET, _UNSET = ":/icons/bound-expression.svg", ":/icons/bound-expression-unset.svg"  # of FreeCAD


def _made() -> tuple[Any, Any]:
    """FreeCAD's field, and the line that is typed into; another one where PySide takes either for one that was deleted, or
    the line for one of another kind, which was at its place in memory (docs/versions.md)."""
    unusable = []  # which keep their places
    for _ in range(_TRIES):
        box = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
        with contextlib.suppress(RuntimeError):
            line = box.findChild(QtGui.QLineEdit)
            if line is not None:
                line.objectName()
                return box, line
        unusable.append(box)
    raise RuntimeError("no field can be made")


class QuantityField:
    """The field `box` that shows a number in a unit."""

    def __init__(self, shown: float, unit: str, name: str, expression: str = "") -> None:
        """shown: the number in the unit; expression: what it follows, '' where it follows nothing."""
        self.unit, self.name = unit, name
        self.dimension = App.Units.Quantity(f"1 {unit}").Unit
        self.box, self.line = _made()
        self.box.setProperty("unit", unit)
        self.box.setMinimumWidth(_LEAST_WIDTH)
        self.line.setValidator(None)  # it refuses keys, unseen; `read` tells what is wrong
        self.show(shown)
        if expression:
            self.show(expression)
        self._add_mark()
        connect(self.line, "textEdited(QString)", self._keep)
        connect(self.line, "textChanged(QString)", self._forget)
        connect(self.line, "cursorPositionChanged(int,int)", self._begin_in_sight)
        connect(self.box, "editingFinished()", self._restore)
        connect(self.box, "editingFinished()", self._begin_in_sight)

    def show(self, number: float | str) -> None:
        """Show another number, in the field's unit, or an expression, in place of what is there."""
        self.shown: float | str = number
        self.typed: str | None = None
        if isinstance(number, str):
            self.typed = number
            self._put(number)
            return
        quantity = App.Units.Quantity(f"{number!r} {self.unit}")
        # the display would be cut to the decimals of the preferences, and the value with it
        quantity.Format = {"NumberFormat": "g", "Precision": _DIGITS, "Denominator": 8}
        self.box.setProperty("value", quantity)
        self.line.setCursorPosition(0)
        self.first_text = self.plain = (
            self.line.text()
        )  # plain: what the field goes back to by itself

    def _put(self, text: str) -> None:
        self.line.setText(text)
        self.line.setCursorPosition(0)
        self.first_text = self.line.text()

    def _add_mark(self) -> None:
        self.mark = self.line.addAction(QtGui.QIcon(_UNSET), QtGui.QLineEdit.TrailingPosition)
        self.mark.setToolTip(
            tr("Let it follow an expression, such as {}Spreadsheet.height / 2").format(MARK)
        )
        connect(self.mark, "triggered(bool)", self._begin)
        self._show_mark()
        connect(self.line, "textChanged(QString)", self._show_mark)

    def read(self) -> float | str:
        """The number in the field's unit, or the expression. InputError 'BAD_VALUE' for what is neither."""
        text = self.line.text() if self.typed is None else self.typed
        if text == self.first_text:
            return self.shown
        if is_expression(text):
            return text.strip()
        number = self._number(text)
        return float(self.box.property("rawValue")) if self.typed is None else number

    def _number(self, text: str) -> float:
        locale = self.box.locale()
        point, group = str(locale.decimalPoint()), str(locale.groupSeparator())
        if (group.strip() and group in text) or re.search(r"\d[\s’]+\d", text):
            example = Text("1{}5 {}", point, self.unit)
            raise self._wrong(
                text,
                Text(
                    "write decimals with '{}', as in {}, and do not group digits",
                    point,
                    Word(example),
                ),
            )
        if not text.strip():
            raise InputError(
                "BAD_VALUE", self.name, "it is empty; give a quantity in {}", self.unit
            )
        try:
            quantity = quantity_of(text.replace(point, "."))
        except (ValueError, TypeError, ArithmeticError):
            raise self._wrong(text, Text("give a quantity in {}", self.unit)) from None
        if quantity.Unit not in (self.dimension, App.Units.Unit()) or not math.isfinite(
            quantity.Value
        ):
            raise self._wrong(text, Text("give a quantity in {}", self.unit))
        plain = quantity.Unit == App.Units.Unit()
        return float(quantity.Value if plain else quantity.getValueAs(self.unit))

    def _wrong(self, text: str, remedy: str) -> InputError:
        return InputError(
            "BAD_VALUE", self.name, "{!r} is not understood; {}", plain_blanks(text), remedy
        )

    # ---- the field changes its own text when it is left

    def _keep(self, text: str) -> None:
        self.typed = text

    def _forget(self, text: str) -> None:
        if is_expression(self.typed) and text == self.plain:
            QtCore.QTimer.singleShot(0, self._restore)
        elif text != self.typed and self.box.hasFocus():  # by the arrows or the wheel
            self.typed = None

    def _begin_in_sight(self, *_: Any) -> None:
        """Where the field is too narrow for the number, its first digits are seen: '1000 m', not '000 mm'."""
        if not self.box.hasFocus() and not self.line.hasFocus():
            self.line.setCursorPosition(0)

    def _restore(self, *_: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the panel is closed
            if self.typed is None or self.line.text() == self.typed:
                return
            try:
                if not is_expression(self.typed) and not _OURS.search(self.typed):
                    self._number(self.typed)
                    return
            except InputError:
                pass
            self.line.setText(
                self.typed
            )  # an expression, a unit of ours, or what is refused, stays to be seen
            self.line.setCursorPosition(0)

    # ---- expressions

    def _begin(self, *_: Any) -> None:
        """Begin an expression, or mark the one there is, to be typed over."""
        if not is_expression(self.line.text()):
            self.typed = MARK
            self.line.setText(MARK)
        self.line.setFocus()
        self.line.setSelection(len(MARK), len(self.line.text()))

    def _show_mark(self, *_: Any) -> None:
        self.mark.setIcon(QtGui.QIcon(_SET if is_expression(self.line.text()) else _UNSET))


class PlainQuantity(QuantityField):
    """The same in a plain line, for units other than those that FreeCAD shows in its own field."""

    def __init__(self, shown: float, unit: str, name: str, expression: str = "") -> None:
        self.unit, self.name = unit, name
        self.dimension = App.Units.Quantity(f"1 {unit}").Unit
        self.box = self.line = QtGui.QLineEdit()
        self.line.setMinimumWidth(_LEAST_WIDTH)
        self.typed = None  # only a field of FreeCAD changes what was typed
        self.show(shown)
        if expression:
            self.show(expression)
        self._add_mark()

    def show(self, number: float | str) -> None:
        """Show another number, in the field's unit, or an expression, in place of what is there."""
        self.shown: float | str = number
        plain = "" if isinstance(number, str) else f"{number:.{_DIGITS}g} {self.unit}"
        self._put(plain.replace(".", str(self.box.locale().decimalPoint())) or str(number))

    def read(self) -> float | str:
        """The number in the field's unit, or the expression. InputError 'BAD_VALUE' for what is neither."""
        text = str(self.line.text())
        if text == self.first_text:
            return self.shown
        return text.strip() if is_expression(text) else self._number(text)
