# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit shown is the unit typed, in every unit scheme of FreeCAD and every kind of field."""

import re

import FreeCAD as App
import pytest

from freecad_am.core.parameters import field as parameters
from freecad_am.gui.widgets import fields
from freecad_am.gui.widgets.fold import Fold
from freecad_am.gui.widgets.quantity import QuantityField
from freecad_am.objects.fields import preferences
from freecad_am.objects.fields.rows import LENGTH_OR_POSE, MIXED, rows
from tests.gui import test_fields
from tests.gui.test_fields import STAGES, typed

window = test_fields.window  # a fixture

SCHEMES = range(len(App.Units.listSchemas()))
STANDARD, MKS, US, IMPERIAL, EURO, BUILDING_US, CNC, CIVIL = range(8)
QUANTITIES = (parameters.LENGTH, parameters.ANGLE, parameters.SPEED, parameters.TIME)
# mm, mm/s, deg, s in one of each unit, from tables instead of FreeCAD
UNITS = {
    "nm": 1e-6,
    "µm": 1e-3,
    "mm": 1.0,
    "cm": 10.0,
    "m": 1000.0,
    "km": 1e6,
    "in": 25.4,
    '"': 25.4,
    "thou": 0.0254,
    "ft": 304.8,
    "'": 304.8,
    "yd": 914.4,
    "mm/s": 1.0,
    "mm/min": 1 / 60,
    "m/min": 1000 / 60,
    "m/s": 1000.0,
    "in/min": 25.4 / 60,
    "in/s": 25.4,
    "ft/min": 5.08,
    "ft/s": 304.8,
    "mph": 447.04,
    "°": 1.0,
    "deg": 1.0,
    "s": 1.0,
}


@pytest.fixture
def scheme():
    """Set a unit scheme, and restore the earlier one afterwards."""
    original_scheme = App.ParamGet("User parameter:BaseApp/Preferences/Units").GetInt(
        "UserSchema", 0
    )
    yield App.Units.setSchema
    App.Units.setSchema(original_scheme)


def unit_of(text):
    """Return the unit after the number, as in UNITS."""
    text = text.rstrip()
    if re.search(r"\d[\"']$", text):
        return "in"  # feet and inches: a bare number is inches
    return text.rpartition(" ")[2]


@pytest.mark.parametrize("number", SCHEMES)
def test_a_bare_number_is_in_the_unit_that_the_field_shows(person, scheme, number):
    """This test covers all quantities of all stages: their fields, combined fields of a quantity or
    a word, and poses."""
    scheme(number)
    count = 0
    for section in (section for stage in STAGES for section in stage.sections):
        for row in rows(section.cls):
            field = fields.make(row, row.default, section=section.prefix)
            boxes = (
                [(box.field.line, box.field) for box in quantity_boxes(person, field.widget)]
                if row.form in (*QUANTITIES, parameters.POSE)
                else []
            )
            for line, quantity in boxes:
                unit = unit_of(line.text())
                line.setText("2")
                assert quantity.read() == pytest.approx(2.0 * UNITS[unit], rel=1e-12), (
                    row.key,
                    unit,
                )
                count += 1
            if row.form in (MIXED, LENGTH_OR_POSE) and row.spec.kind in QUANTITIES:
                field_text = field.widget.text()
                unit = (
                    unit_of(field_text)
                    if field_text[:1].isdigit()
                    else field.widget.placeholderText().split()[0]
                )
                field.widget.setText("2")
                inner = row.outer(row.inner(field.value, row.key))
                assert inner == pytest.approx(2.0 * UNITS[unit], rel=1e-12), (row.key, unit)
                count += 1
    assert count > 60


def quantity_boxes(person, widget):
    boxes = [widget] if hasattr(widget, "field") else []
    return boxes + [
        box for box in widget.findChildren(person.widgets.QAbstractSpinBox) if hasattr(box, "field")
    ]


@pytest.mark.parametrize(
    ("number", "value", "unit", "shown", "text", "stored"),
    [
        (STANDARD, 0.01, "mm", "10 µm", "5", 0.005),
        (CNC, 6.0, "mm/s", "360 mm/min", "500", 500 / 60),
        (IMPERIAL, 1.0, "mm", "0.03937 in", "2", 50.8),
        (IMPERIAL, 6.0, "mm/s", "14.173 in/min", "20", 20 * 25.4 / 60),
        (US, 1.0, "mm", "39.37 thou", "3", 0.0762),
        (BUILDING_US, 0.01, "mm", "0.0003937 in", "2", 50.8),
        (BUILDING_US, 333.375, "mm", "1' 1+1/8\"", "2", 50.8),
        (BUILDING_US, 25.4, "mm", '1"', "-1' 1 1/2\"", -342.9),
        (BUILDING_US, 25.4, "mm", '1"', "3/8", 9.525),
        (MKS, 0.0, "mm", "0 mm", "2", 2.0),
        (EURO, 30.0, "mm", "3 cm", "2", 20.0),
        (CIVIL, 304.8, "mm", "1 ft", "2", 609.6),
        (IMPERIAL, 0.5, "s", "0.5 s", "2", 2.0),
        (IMPERIAL, 30.0, "deg", "30 °", "45", 45.0),
        (IMPERIAL, 1.0, "mm", "0.03937 in", "2 mm", 2.0),
        (IMPERIAL, 1.0, "mm", "0.03937 in", "1 1/2 in", 38.1),
    ],
)
def test_what_is_shown_and_what_is_typed(
    person,
    window,
    scheme,
    number,
    value,
    unit,
    shown,
    text,
    stored,
):
    scheme(number)
    field = QuantityField(value, unit, "Field")
    window.addWidget(field.box)
    person.idle(0.05)
    assert field.line.text().replace('" + ', "+") == shown  # FreeCAD 1.0 writes 1' 1" + 1/8"
    typed(person, field, text)
    assert field.read() == pytest.approx(stored, rel=1e-12)
    settled = field.line.text()
    typed(person, field, "7")
    assert field.read() == pytest.approx(7.0 * UNITS[unit_of(settled)], rel=1e-12), settled


@pytest.mark.parametrize("number", SCHEMES)
def test_an_untouched_field_keeps_its_value_bit_for_bit(person, window, scheme, number):
    scheme(number)
    elsewhere = window.itemAt(0).widget()
    for unit in ("mm", "mm/s", "deg", "s"):
        for value in (0.01, 1.0 / 3.0, 11.547005383792516, 1234.5678912345, 0.1 + 0.2, -1e-7):
            field = QuantityField(value, unit, "Field")
            window.addWidget(field.box)
            for _ in range(2):
                field.line.setFocus()
                person.idle(0.02)
                elsewhere.setFocus()
                person.idle(0.02)
            assert field.read() == value, (unit, field.line.text())
            field.box.hide()


@pytest.mark.parametrize("number", SCHEMES)
@pytest.mark.parametrize("size", [9, 14, 20])
def test_number_and_unit_are_seen_whole(person, window, scheme, number, size):
    scheme(number)
    for value, unit in ((1.0, "mm"), (6.0, "mm/s"), (11.547005383792516, "mm"), (123.456, "deg")):
        field = QuantityField(value, unit, "Field")
        font = field.box.font()
        font.setPointSize(size)
        field.box.setFont(font)
        window.addWidget(field.box)
        person.idle(0.02)
        field.box.resize(field.box.minimumWidth(), field.box.height())
        text = field.line.text()
        digits = re.sub(r"\D", "", text.split()[0]).lstrip("0") if " " in text else ""
        assert len(digits) <= 8, text
        # the mark of the expression at the right of the field
        mark = field.line.findChild(person.widgets.QToolButton)
        assert field.line.fontMetrics().boundingRect(text).width() + 4 <= mark.x(), text
        field.box.hide()


def test_number_and_unit_are_seen_whole_under_a_style_sheet(person, window, scheme):
    """A theme sets its own minimum width, and wider arrows."""
    scheme(IMPERIAL)
    application = person.widgets.QApplication.instance()
    sheet = (
        "QAbstractSpinBox { min-width: 50px; padding: 3px; }"
        "QAbstractSpinBox::up-button { width: 26px; }"
    )
    try:
        application.setStyleSheet(sheet)
        person.idle(0.2)
        field = QuantityField(0.01, "mm", "Field")
        window.addWidget(field.box)
        field.box.show()
        person.idle(0.1)
        field.box.resize(field.box.minimumWidth(), field.box.height())
        person.idle(0.02)
        mark = field.line.findChild(person.widgets.QToolButton)
        text = field.line.text()
        assert text.endswith(" in")
        assert field.line.fontMetrics().boundingRect(text).width() + 4 <= mark.x(), text
        field.line = person.widgets.QLineEdit()  # a style changes while a panel is deleted
        person.qt.delete(field.line)
    finally:
        application.setStyleSheet("")
        person.idle(0.2)


def test_a_field_is_below_its_name_where_both_do_not_fit(person, window, scheme):
    scheme(IMPERIAL)
    fold = Fold("Layers", True)
    field = QuantityField(1234.5678, "mm", "Field")
    field.box.setObjectName("Field")
    fold.add("A name of some words", field.box)
    window.addWidget(fold.widget)
    fold.widget.setFixedWidth(field.box.minimumWidth() + 40)
    person.idle(0.1)
    name = fold.rows["Field"][0]
    assert field.box.width() >= field.box.minimumWidth()
    assert field.box.mapTo(fold.widget, field.box.rect().topLeft()).y() >= name.geometry().bottom()


@pytest.mark.parametrize(
    ("unit", "shown", "stored"),
    [("in/min", "14.173 in/min", 8.466666666666667), ("ft/min", "1.181 ft/min", 101.6)],
)
def test_the_unit_of_speeds_may_be_imperial(person, scheme, unit, shown, stored):
    scheme(STANDARD)
    from freecad_am.core.parameters.process import ProcessParameters

    row = next(row for row in rows(ProcessParameters) if row.key == "travel_speed")
    preferences.keep("SpeedUnit", unit)
    try:
        field = fields.make(row, 6.0)
        assert field.widget.text() == shown and field.value == 6.0
        field.widget.lineEdit().setText("20")
        assert field.value == pytest.approx(stored, rel=1e-12)
        assert preferences.speed(6.0) == pytest.approx(6.0 / UNITS[unit])
    finally:
        preferences.keep("SpeedUnit", "")
