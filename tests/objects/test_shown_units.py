# SPDX-License-Identifier: LGPL-2.1-or-later
"""Messages use the units of FreeCAD's scheme."""

import FreeCAD as App
import pytest

from freecad_am.core.geometry.formatting import place
from freecad_am.core.issues import Text, Word
from freecad_am.gui.in_language import in_language
from freecad_am.objects.fields.preferences import feet_and_inches, in_user_units, quantity_text

METRIC, MKS, US, IMPERIAL, EURO, BUILDING_US, CNC, CIVIL, FEM = range(9)


@pytest.fixture(autouse=True)
def schema():
    yield App.Units.setSchema
    App.Units.setSchema(METRIC)


def text_in_units(text):
    return in_language(text, lambda template: template, in_user_units)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (METRIC, "Plate 5 mm is 8 mm high, 30 cm3 at 6 mm/s"),
        (IMPERIAL, "Plate 5 mm is 0.315 in high, 1.83 in³ at 14.2 in/min"),
        (US, "Plate 5 mm is 0.315 in high, 1.83 in³ at 14.2 in/min"),
        (EURO, "Plate 5 mm is 0.8 cm high, 30 cm3 at 360 mm/min"),
        (CNC, "Plate 5 mm is 8 mm high, 30 cm3 at 360 mm/min"),
        (CIVIL, "Plate 5 mm is 0.0262 ft high, 1.83 in³ at 0.0134 mph"),
        (FEM, "Plate 5 mm is 8 mm high, 30 cm3 at 6 mm/s"),
    ],
)
def test_quantities_follow_and_names_stay(schema, number, text):
    message = Text("{} is {:g} mm high, {:g} cm3 at {:g} mm/s", "Plate 5 mm", 8.0, 30.0, 6.0)
    schema(number)
    assert text_in_units(message) == text
    assert message == "Plate 5 mm is 8 mm high, 30 cm3 at 6 mm/s"  # as in documents and commands


def test_texts_within_texts_places_and_units_as_values(schema):
    schema(IMPERIAL)
    inner = Text("; give {:g} mm", 25.4)
    message = Text("off at {}, by {} {}{}{}", place((25.4, 0, 50.8)), 5.08, "mm", inner, Word("."))
    assert text_in_units(message) == "off at (1, 0, 2) in, by 0.2 in; give 1 in."


def test_examples_of_what_may_be_typed_stay(schema):
    schema(IMPERIAL)
    text = Text("{!r} is not understood; give {}", "5 mmm", Text("a length such as 1 mm"))
    assert text_in_units(text) == "'5 mmm' is not understood; give a length such as 1 mm"


def test_what_a_remedy_says_may_be_typed(schema):
    schema(IMPERIAL)
    assert text_in_units(Text("give at most {:g} mm", 8.0)) == "give at most 0.314 in"
    assert 0.314 * 25.4 <= 8.0


def test_a_quantity_alone(schema):
    assert quantity_text(12.3456, "mm") == "12.35 mm"
    schema(IMPERIAL)
    assert quantity_text(25.4, "mm") == "1 in"
    assert quantity_text(1.0, "kg", 3) == "2.2 lb"
    assert quantity_text(30.0, "deg") == "30 deg"


@pytest.mark.parametrize(
    ("text", "length"),
    [
        ("1' 7+5/8\"", 498.475),
        ("-1' 3\"", -381.0),
        ("1 1/2 in", 38.1),
        ('1\' 1" + 1/8"', 333.375),
        ("5'", 1524.0),
        ('3/8"', 9.525),
    ],
)
def test_feet_and_inches(text, length):
    assert feet_and_inches(text) == pytest.approx(length)


@pytest.mark.parametrize("text", ["5", "auto", "", '1/0"', "5 mm", "1' mm"])
def test_other_texts_are_no_feet_and_inches(text):
    assert feet_and_inches(text) is None
