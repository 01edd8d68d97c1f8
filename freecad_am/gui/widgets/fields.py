# SPDX-License-Identifier: LGPL-2.1-or-later
"""One widget per parameter, built from its row; the widget shows and reads outer units."""

from __future__ import annotations

import contextlib
import html
import math
import re
from collections.abc import Callable
from typing import Any

from PySide import QtGui

from ...core.issues import InputError
from ...core.parameters import field as f
from ...objects.fields import pendants, preferences
from ...objects.fields.preferences import field_text, in_user_units, typed_text
from ...objects.fields.quantities import split
from ...objects.fields.rows import FOLLOW, LENGTH_OR_POSE, MIXED, TEXT_LIST, Row, is_expression
from ..colours import INVALID, PLAIN, set_role
from ..in_language import tr, translated
from . import choices
from .quantity import QuantityField
from .upright import present


class PendantLine:
    """A choice of pendants, and a line with the pose as the pendant shows it.

    `read` and `show` access the fields above: x y z RX RY RZ in mm and deg.
    """

    def __init__(
        self,
        name: str,
        read_pose: Callable[[], tuple[Any, ...]],
        show: Callable[[tuple[float, ...]], None],
    ) -> None:
        self.name, self.read, self.show = name, read_pose, show
        self.put = ""  # last text set by the program
        self.choice, self.line = QtGui.QComboBox(), QtGui.QLineEdit()
        self.choice.setObjectName(f"{name}Pendant")
        self.line.setObjectName(f"{name}Shown")
        self.choice.addItem(tr("as on the pendant of"), "")
        for controller, pendant in pendants.pendants().items():
            self.choice.addItem(pendant.maker, controller)
        self.choice.setToolTip(
            tr("Type the pose as shown on the pendant of this controller, X Y Z in mm first")
        )
        self.line.hide()
        self.choice.currentIndexChanged.connect(lambda *_: self.refresh())
        self.line.editingFinished.connect(self.enter)

    def refresh(self) -> None:
        """Show the fields' pose in the line as on the chosen pendant."""
        controller = self.choice.currentData()
        self.line.setVisible(bool(controller))
        self._wrong("")
        if not controller:
            return
        pendant = pendants.pendants()[controller]
        self.line.setPlaceholderText(" ".join(("X", "Y", "Z", *pendant.letters)))
        self.line.clear()
        with contextlib.suppress(
            InputError, TypeError, ValueError
        ):  # a field holds an expression, or is empty
            x, y, z, *angles = self.read()
            numbers = pendants.pendant_values(controller, (x, y, z, *map(math.radians, angles)))
            text = " ".join(
                f"{number + 0.0:.{3 if k < 3 else pendant.digits}f}"
                for k, number in enumerate(numbers)
            )
            self.line.setText(text.replace(".", str(self.line.locale().decimalPoint())))
        self.put = self.line.text()
        self.line.setCursorPosition(0)

    def enter(self) -> None:
        """Enter the typed pose into the fields; report an unreadable pose and keep the fields."""
        controller = self.choice.currentData()
        if not controller or self.line.text() == self.put or not self.line.text().strip():
            return
        try:
            point = str(self.line.locale().decimalPoint())
            words = self.line.text().replace(point, ".").replace(",", " ").split()
            pose = pendants.six([controller, *words], self.name)
        except InputError as error:
            self._wrong(translated(error.message))
            return
        self._wrong("")
        self.put = self.line.text()
        self.show((*pose[:3], *(round(math.degrees(angle), 10) for angle in pose[3:])))

    def _wrong(self, text: str) -> None:
        self.line.setToolTip(text)
        set_role(self.line, INVALID if text else PLAIN)


_QUANTITIES = (f.LENGTH, f.ANGLE, f.SPEED, f.TIME)
_NUMBERS = (*_QUANTITIES, f.TURN_RATE, f.NUMBER, f.RATIO)
_POSE_UNITS = ("mm", "mm", "mm", "deg", "deg", "deg")
_POSE_NAMES = ("X", "Y", "Z", "RX", "RY", "RZ")
_PLAIN = re.compile(r"[-+]?(?:\d+|\d*\.\d+)(?:[eE][-+]?\d+)?")
Texts = Callable[[], list[tuple[str, str]]]
_MAX_INT32 = 2_147_483_647


class Field:
    """A widget with functions to read and show outer values.

    `value` raises InputError, naming the field, for unreadable entries. An expression is a text
    that starts with `=`.
    """

    def __init__(
        self, row: Row, widget: Any, read_value: Callable[[], Any], show: Callable[[Any], None]
    ) -> None:
        self.row = row
        self.widget = widget
        self.read = read_value
        self._show = show
        self.label = translated(row.label)
        self.shown = read_value()
        widget.setObjectName(row.name)
        widget.setToolTip(translated(row.spec.help))

    @property
    def value(self) -> Any:
        """Return the widget's value in outer units, as a macro passes it."""
        return self.read()

    def show(self, value: Any) -> None:
        """Show another value in outer units, or an expression."""
        self._show(value)

    @property
    def changed(self) -> bool:
        """Whether the value differs from the initial or last applied value."""
        return bool(self.read() != self.shown)

    def differs_from(self, value: Any) -> None:
        """Compare future entries with this inner default."""
        self.shown = self.row.outer(value)

    def applied(self) -> None:
        """Store the value as the state of the document."""
        self.shown = self.read()

    @property
    def heading(self) -> str:
        """The label, with the unit if the widget does not show it."""
        shows_unit = self.row.form in (*_QUANTITIES, f.POSE, MIXED, LENGTH_OR_POSE)
        unit = self.row.spec.unit or ("" if shows_unit else self.row.unit)
        return f"{self.label} ({unit})" if unit else self.label


def make(
    row: Row, value: Any, suggestions: Texts | None = None, expression: str = "", section: str = ""
) -> Field:
    """Create the field of a row that shows an inner value, or the expression that it follows.

    suggestions: texts to choose from, with labels. section: of the job file, for the help.
    """
    field = _make(row, value, suggestions, expression)
    for widget in (field.widget, *present(field.widget, QtGui.QWidget)):
        widget.setWhatsThis(whats_this(row, section))
    return field


def whats_this(row: Row, section: str) -> str:
    """Return a field's help: its meaning, choices, default, and name in jobs and macros."""
    spec, default = row.spec, in_user_units(row.text(row.default))
    unit = row.unit if row.form in (f.RATIO, f.TURN_RATE) else ""
    lines = [translated(spec.help)]
    if spec.choices or spec.words:
        lines.append(tr("Words: {}.").format(", ".join((*spec.choices, *spec.words))))
    allowed = f.range_text(spec) if spec.low is not None or spec.high is not None else ""
    if allowed:
        lines.append(tr("Allowed: {}.").format(translated(allowed)))
    if row.form in FOLLOW:
        lines.append(
            tr("The value may follow an expression: {}.").format("=Spreadsheet.height / 2")
        )
    if default:
        lines.append(
            tr("By default: {}.").format(
                f"{default} {unit}".strip() if unit not in default else default
            )
        )
    job = ".".join(map(str, (section, *row.path))) if section else ""
    lines.append(tr("In a job file: {}; in macros: {}.").format(job, row.key))
    return "<b>{}</b><p>{}</p>".format(translated(row.label), "<br>".join(map(html.escape, lines)))


def _make(row: Row, value: Any, suggestions: Texts | None, expression: str) -> Field:
    outer_value = row.outer(value)
    if row.form == f.POSE:
        return _pose(row, outer_value)
    if row.form == f.SPEED:
        return _speed(row, outer_value, expression)
    if row.form in _QUANTITIES:
        quantity = QuantityField(outer_value, row.unit, row.label, expression)
        return Field(row, quantity.box, quantity.read, quantity.show)
    if row.form == f.CHOICE:
        return _choice(row, outer_value)
    if row.form == f.FLAG:
        check = QtGui.QCheckBox()
        check.setChecked(outer_value)
        return Field(row, check, check.isChecked, check.setChecked)
    if row.form == f.COUNT:
        box = QtGui.QSpinBox()
        box.setRange(
            -_MAX_INT32, _MAX_INT32
        )  # the core reports values out of range, so do not clip them here
        box.setValue(outer_value)
        return (
            Field(row, box, box.value, box.setValue)
            if not expression
            else _text(row, value, expression)
        )
    if suggestions is not None:
        return _suggested(row, outer_value, suggestions())
    return _text(row, value, expression)


def _speed(row: Row, value: float, expression: str) -> Field:
    """Create a speed field in the user's preferred unit; its value is in mm/s."""
    unit = preferences.preferred_speed_unit()
    quantity = QuantityField(value, row.unit, row.label, expression, unit)
    quantity.box.setButtonSymbols(
        QtGui.QAbstractSpinBox.NoButtons
    )  # saves space for "100 mm/s" in a narrow panel
    quantity.make_room()
    return Field(row, quantity.box, quantity.read, quantity.show)


def _text(row: Row, value: Any, expression: str = "") -> Field:
    if row.form in (MIXED, LENGTH_OR_POSE) and row.spec.kind in _QUANTITIES:
        return _quantity_or_word(row, value, expression)
    edit = QtGui.QLineEdit()
    numeric = row.spec.kind in (*_NUMBERS, f.POSE) or row.form == TEXT_LIST

    def show(outer_value: Any) -> None:
        text = _outer_text(row, outer_value)
        edit.setText(
            _replace_decimal_point(text, ".", _point(edit))
            if numeric and not is_expression(text)
            else text
        )

    show(expression or row.outer(value))
    if row.form == TEXT_LIST:
        return Field(
            row,
            edit,
            lambda: tuple(
                split(_replace_decimal_point(str(edit.text()), _point(edit), "."), row.label)
            ),
            show,
        )
    _add_placeholder(edit, row, row.unit)

    def entered() -> str:
        entry = str(edit.text()).strip()
        return _replace_decimal_point(entry, _point(edit), ".") if numeric else entry

    if row.form == f.NUMBER:
        return Field(row, edit, lambda: _number(entered(), row.label), show)
    return Field(row, edit, entered, show)


def _add_placeholder(edit: Any, row: Row, unit: str) -> None:
    """Set a short placeholder with the unit and words that the line accepts."""
    alternatives = ([unit] if unit else []) + list(row.spec.words)
    if alternatives or row.spec.optional:
        words = tr(" or ").join(alternatives)
        none = tr("{} or empty").format(words) if words else tr("(empty: none)")
        edit.setPlaceholderText(none if row.spec.optional else words)


def _quantity_or_word(row: Row, value: Any, expression: str) -> Field:
    """Create a plain line for a quantity, a word such as `auto`, an empty entry or a pose.

    A number without a unit is in the unit that the line or its placeholder shows.
    """
    edit = QtGui.QLineEdit()
    display = preferences.preferred_speed_unit() if row.spec.kind == f.SPEED else ""
    last_shown: dict[str, Any] = {}

    def show(outer_value: Any) -> None:
        is_number = isinstance(outer_value, (int, float)) and not isinstance(outer_value, bool)
        text, per_bare, unit = field_text(
            float(outer_value) if is_number else 0.0, row.unit, display
        )
        text = text if is_number else row.outer_text(outer_value)
        stored_text = row.outer_text(outer_value)
        if not is_expression(text):
            text = _replace_decimal_point(text, ".", _point(edit))
        edit.setText(text)
        last_shown.update(text=str(edit.text()).strip(), held=stored_text, per_bare=per_bare)
        _add_placeholder(edit, row, unit)

    def read() -> str:
        entry = str(edit.text()).strip()
        if entry == last_shown["text"]:
            return str(last_shown["held"])
        return typed_text(
            _replace_decimal_point(entry, _point(edit), "."), row.unit, last_shown["per_bare"]
        )

    show(expression or row.outer(value))
    return Field(row, edit, read, show)


def _outer_text(row: Row, outer_value: Any) -> str:
    if row.form == TEXT_LIST:
        return " ".join(outer_value)
    return row.outer_text(outer_value) if row.form in (MIXED, LENGTH_OR_POSE) else f"{outer_value}"


def _point(edit: Any) -> str:
    """Return the decimal separator of the window's language."""
    return str(edit.locale().decimalPoint())


def _replace_decimal_point(text: str, old: str, new: str) -> str:
    """Replace the decimal point in a text of a single number, with or without a unit, or of several
    numbers separated by blanks. Return any other text unchanged.
    """
    numbers = re.split(r"[ \t]+", text.strip())  # no-break spaces occur within a number
    if len(numbers) > 1 and all(_PLAIN.fullmatch(number.replace(old, ".")) for number in numbers):
        return " ".join(number.replace(old, new) for number in numbers)
    return re.sub(
        rf"^([-+]?\d*){re.escape(old)}(\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s.,].*)?)$",
        rf"\g<1>{new}\2",
        text,
    )


def _number(text: str, name: str) -> float | str:
    if is_expression(text):
        return text.strip()
    try:
        return float(text)
    except ValueError:
        raise InputError(
            "BAD_VALUE", name, "{!r} is not a number; enter a number such as 0.1", text
        ) from None


def _choice(row: Row, key: str) -> Field:
    combo = QtGui.QComboBox()
    for choice in row.spec.choices:  # job files and macros use the key itself
        combo.addItem(choices.worded(choice), choice)
    choices.shrink(combo)
    combo.setCurrentIndex(row.spec.choices.index(key))
    return Field(
        row,
        combo,
        combo.currentData,
        lambda value: combo.setCurrentIndex(row.spec.choices.index(value)),
    )


def _suggested(row: Row, key: str, texts: list[tuple[str, str]]) -> Field:
    combo = QtGui.QComboBox()
    combo.setEditable(True)
    choices.offer(combo, texts)
    choices.enter(combo, key)
    return Field(
        row, combo, lambda: choices.entered(combo), lambda value: choices.enter(combo, value)
    )


def _pose(row: Row, pose: tuple[float, ...]) -> Field:
    widget = QtGui.QWidget()
    grid = QtGui.QGridLayout(widget)
    grid.setContentsMargins(12, 0, 0, 0)
    grid.setColumnStretch(1, 1)
    quantities = []
    for index, (number, unit, name) in enumerate(zip(pose, _POSE_UNITS, _POSE_NAMES, strict=True)):
        quantity = QuantityField(number, unit, f"{row.label} {name}", can_follow=False)
        quantity.box.setObjectName(f"{row.name}{name}")
        quantity.box.setToolTip(tr("{}: {}").format(name, translated(row.spec.help)))
        grid.addWidget(QtGui.QLabel(name), index, 0)
        grid.addWidget(quantity.box, index, 1)
        quantities.append(quantity)

    def show(numbers: tuple[float, ...]) -> None:
        for quantity, number in zip(quantities, numbers, strict=True):
            quantity.show(number)

    def read() -> tuple[Any, ...]:
        return tuple(quantity.read() for quantity in quantities)

    line = PendantLine(row.name, read, show)
    grid.addWidget(line.choice, len(pose), 0, 1, 2)
    grid.addWidget(line.line, len(pose) + 1, 0, 1, 2)
    return Field(row, widget, read, show)
