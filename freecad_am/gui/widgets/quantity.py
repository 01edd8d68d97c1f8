# SPDX-License-Identifier: LGPL-2.1-or-later
"""A field for a quantity; a number typed without a unit is in the displayed unit.

An untouched field keeps its value exactly, regardless of the displayed digits. A text that starts
with `=` is an expression that determines the number.

FreeCAD's own field is not used, for four reasons: it groups digits ('1,5' is 15 with a decimal
point), it rejects keys that create a quantity of another dimension, it restores the last readable
text, and on leaving it stores the displayed value ('0' for 0.01 mm in feet and inches).
"""

from __future__ import annotations

import contextlib
import math
import re
import weakref
from typing import Any

import FreeCAD as App
from PySide import QtCore, QtGui

from ...core.issues import InputError, Text, Word
from ...objects.fields.preferences import feet_and_inches, field_text, round_conversion
from ...objects.fields.quantities import plain_blanks
from ...objects.fields.quantities import quantity as quantity_of
from ...objects.fields.rows import MARK, is_expression
from ..in_language import tr
from ..signals import connect

_LEAST_WIDTH, _MOST_LETTERS = 70, 16
_LINE_MARGINS = 10  # px; left and right of the text in a line
_PROBE = QtCore.QSize(400, 40)  # size of a box for style queries
_LEFT_OF_UNIT = re.compile(r"[-+]?[\d.,]+(?= \D)")
# icons of FreeCAD
_SET, _UNSET = ":/icons/bound-expression.svg", ":/icons/bound-expression-unset.svg"


class UnitBox(QtGui.QAbstractSpinBox):
    """The spin box of a `QuantityField`."""

    def __init__(self, field: QuantityField) -> None:
        super().__init__()
        # a reference cycle would keep both alive after the panel closes
        self._field = weakref.ref(field)

    @property
    def field(self) -> QuantityField | None:
        """The owning field; None once it is deleted."""
        return self._field()

    def stepBy(self, steps: int) -> None:
        """Called by Qt for the arrows and the wheel."""
        if self.field is not None:
            self.field.step(steps)

    def stepEnabled(self) -> Any:
        """Called by Qt."""
        if self.isReadOnly():
            return QtGui.QAbstractSpinBox.StepNone
        return QtGui.QAbstractSpinBox.StepUpEnabled | QtGui.QAbstractSpinBox.StepDownEnabled

    def focusInEvent(self, event: Any) -> None:
        """Select the number only, so that its unit stays when another number is typed."""
        super().focusInEvent(event)
        if event.reason() in (QtCore.Qt.TabFocusReason, QtCore.Qt.BacktabFocusReason):
            number = _LEFT_OF_UNIT.match(self.lineEdit().text())
            if number is not None:
                self.lineEdit().setSelection(0, number.end())

    def sizeHint(self) -> Any:
        """Called by Qt; include the number with its unit."""
        size = super().sizeHint()
        return QtCore.QSize(self.minimumWidth(), size.height())

    def showEvent(self, event: Any) -> None:
        """Called by Qt. A style sheet sets its own minimum width once, just before a box is first
        shown.
        """
        super().showEvent(event)
        self._fit()

    def _fit(self) -> None:
        """Fit the width to the text, unless the line is already deleted because the panel closes."""
        with contextlib.suppress(RuntimeError):
            if self.field is not None:
                self.field.make_room()

    def width_beside_line(self) -> int:
        """Return the width of frame and arrows, px, in the current style."""
        option = QtGui.QStyleOptionSpinBox()
        self.initStyleOption(option)
        option.rect = QtCore.QRect(QtCore.QPoint(0, 0), _PROBE)
        style = self.style()
        line = style.subControlRect(
            QtGui.QStyle.CC_SpinBox, option, QtGui.QStyle.SC_SpinBoxEditField, self
        )
        return _PROBE.width() - line.width()

    def changeEvent(self, event: Any) -> None:
        """Fit the width to a new font or style."""
        super().changeEvent(event)
        kinds = (QtCore.QEvent.FontChange, QtCore.QEvent.StyleChange)
        if event.type() in kinds:
            self._fit()

    def _raw_value(self) -> float:
        return math.nan if self.field is None else self.field.internal_value()

    rawValue = QtCore.Property(float, _raw_value)


class QuantityField:
    """The field `box` that shows a number in a unit."""

    def __init__(
        self,
        value: float,
        unit: str,
        name: str,
        expression: str = "",
        display: str = "",
        can_follow: bool = True,
    ) -> None:
        """Create the field.

        value: number in the unit. expression: expression that determines the number, '' for none.
        display: displayed unit, '' for the unit of FreeCAD's unit scheme. can_follow: whether an
        expression may determine the number.
        """
        self.unit, self.name, self.display = unit, name, display
        self.can_follow = can_follow
        self.dimension = App.Units.Quantity(f"1 {unit}").Unit
        self.box = UnitBox(self)
        self.line = self.box.lineEdit()
        self.shown: float | str = value
        self.known_text = ""
        self.show(value)
        if expression:
            self.show(expression)
        if can_follow:
            self._add_mark()
        self.make_room()
        connect(self.line, "cursorPositionChanged(int,int)", self._begin_in_sight)
        connect(self.box, "editingFinished()", self._settle)

    def show(self, number: float | str) -> None:
        """Show another number in the field's unit, or an expression."""
        self.shown = number
        if isinstance(number, str):
            _, self.per_bare, self.shown_unit = field_text(0.0, self.unit, self.display)
            self._put(number)
            return
        text, self.per_bare, self.shown_unit = field_text(number, self.unit, self.display)
        self._put(text.replace(".", str(self.box.locale().decimalPoint())))

    def _put(self, text: str) -> None:
        self.line.setText(text)
        self.line.setCursorPosition(0)
        self.known_text = self.line.text()
        self.make_room()

    def make_room(self) -> None:
        """Make the field as wide as its text with the unit, in the current font and style."""
        metrics = self.line.fontMetrics()
        text = "" if isinstance(self.shown, str) else self.known_text
        letters = text if len(text) <= _MOST_LETTERS else text[-_MOST_LETTERS:]
        style = self.box.style()
        # space that QLineEdit reserves for an action
        icon = style.pixelMetric(QtGui.QStyle.PM_SmallIconSize) + 6
        width = metrics.horizontalAdvance(letters) + icon + icon // 4 + _LINE_MARGINS
        width += self.box.width_beside_line()
        self.box.setMinimumWidth(min(max(_LEAST_WIDTH, width), self.box.maximumWidth()))

    def _add_mark(self) -> None:
        self.mark = self.line.addAction(QtGui.QIcon(_UNSET), QtGui.QLineEdit.TrailingPosition)
        self.mark.setToolTip(
            tr("Let the value follow an expression, such as {}Spreadsheet.height / 2").format(MARK)
        )
        connect(self.mark, "triggered(bool)", self._begin)
        self._show_mark()
        connect(self.line, "textChanged(QString)", self._show_mark)

    def read(self) -> float | str:
        """Return the number in the field's unit, or the expression. Raises InputError BAD_VALUE for
        other text.
        """
        text = str(self.line.text())
        if text == self.known_text:
            return self.shown
        if not is_expression(text):
            return self._number(text)
        if self.can_follow:
            return text.strip()
        remedy = Text("this field takes no expression, give a quantity in {}", self.shown_unit)
        raise self._wrong(text, remedy)

    def internal_value(self) -> float:
        """Return FreeCAD's raw value in mm, mm/s and so on; NaN for unreadable text and
        expressions.
        """
        try:
            number = self.read()
        except InputError:
            return math.nan
        if isinstance(number, str):
            return math.nan
        return float(App.Units.Quantity(f"{number!r} {self.unit}").Value)

    def step(self, steps: int) -> None:
        """Add steps to the number, in the displayed unit."""
        try:
            number = self.read()
        except InputError:
            return
        if not isinstance(number, str):
            self.show(round_conversion(number + steps * self.per_bare))

    def _number(self, text: str) -> float:
        locale = self.box.locale()
        point, group = str(locale.decimalPoint()), str(locale.groupSeparator())
        inches = feet_and_inches(text.replace(point, "."))
        if inches is not None and self.dimension == App.Units.Length:
            return float(App.Units.Quantity(f"{inches!r} mm").getValueAs(self.unit).Value)
        if (group.strip() and group in text) or re.search(r"\d[\s’]+\d", text):
            example = Text("1{}5 {}", point, self.shown_unit)
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
                "BAD_VALUE",
                self.name,
                "the field is empty; enter a quantity in {}",
                self.shown_unit,
            )
        try:
            quantity = quantity_of(text.replace(point, "."))
        except (ValueError, TypeError, ArithmeticError):
            raise self._wrong(text, Text("give a quantity in {}", self.shown_unit)) from None
        is_bare = quantity.Unit == App.Units.Unit()
        if not (is_bare or quantity.Unit == self.dimension) or not math.isfinite(quantity.Value):
            raise self._wrong(text, Text("give a quantity in {}", self.shown_unit))
        if is_bare:
            return round_conversion(float(quantity.Value) * self.per_bare)
        return float(quantity.getValueAs(self.unit))

    def _wrong(self, text: str, remedy: str) -> InputError:
        return InputError(
            "BAD_VALUE", self.name, "{!r} is not understood; {}", plain_blanks(text), remedy
        )

    # ---- user actions

    def _settle(self, *_: Any) -> None:
        """Show the entry in the field's unit; unreadable text stays, scrolled to its start."""
        text = str(self.line.text())
        if text != self.known_text and not is_expression(text):
            with contextlib.suppress(InputError):
                self.show(self._number(text))
        self.line.setCursorPosition(0)

    def _begin_in_sight(self, *_: Any) -> None:
        """Scroll a narrow field to the first digits of its number: '1000 m', not '000 mm'."""
        if not self.box.hasFocus() and not self.line.hasFocus():
            self.line.setCursorPosition(0)

    def _begin(self, *_: Any) -> None:
        """Start an expression, or select the existing expression for typing over."""
        if not is_expression(self.line.text()):
            self.line.setText(MARK)
        self.line.setFocus()
        self.line.setSelection(len(MARK), len(self.line.text()))

    def _show_mark(self, *_: Any) -> None:
        self.mark.setIcon(QtGui.QIcon(_SET if is_expression(self.line.text()) else _UNSET))


class PlainQuantity(QuantityField):
    """A quantity field in its own unit, whatever FreeCAD's unit scheme is."""

    def __init__(self, value: float, unit: str, name: str, expression: str = "") -> None:
        super().__init__(value, unit, name, expression, unit)
