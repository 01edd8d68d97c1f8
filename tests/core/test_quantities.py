# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers and quantities as people read them."""

import pytest

from freecad_am.core.issues import Text
from freecad_am.core.number_texts import exact_or_rounded, in_other_units


def inches(value, unit):
    return {
        "mm": (1 / 25.4, "in"),
        "mm/s": (60 / 25.4, "in/min"),
        "cm^3": (1 / 16.387064, "in³"),
    }.get(unit)


@pytest.mark.parametrize(
    ("form", "value", "text"),
    [
        ("{:.2g} %", 187.0, "190 %"),
        ("{:.3g} mm", 7.13e-05, "0.0000713 mm"),
        ("{:g} mm", 12345678.0, "12345700 mm"),
        ("{:g}", 0.5, "0.5"),
        ("{:.2g}", 0.0, "0"),
        ("{:.1e}", 1e-3, "1.0e-03"),
        ("{:.3g}", float("inf"), "inf"),
    ],
)
def test_numbers_in_messages_have_no_exponent(form, value, text):
    assert Text(form, value) == text


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("it is 25.4 mm high", "it is 1 in high"),
        ("2.54 to 5.08 mm/s", "6 to 12 in/min"),
        ("boxes of 25.4 x 50.8 mm", "boxes of 1 x 2 in"),
        ("at 25.4, 50.8, -76.2 mm from it", "at 1, 2, -3 in from it"),
        ("5 of 8.4 cm3 of it", "0.305 of 0.513 in³ of it"),
        ("5 of its 8.4 cm3", "0.305 of its 0.513 in³"),
        ("5 de ses 8.4 cm3", "0.305 de ses 0.513 in³"),
        ("in layer 3, 25.4 mm away", "in layer 3, 1 in away"),
        ("use at most 8 mm", "use at most 0.314 in"),
        ("use at least 8 mm", "use at least 0.315 in"),
        ("1,234.5 mm", "48.602 in"),
        ("0 mm", "0 in"),
        ("in mm, 3 layers", "in mm, 3 layers"),
        ("cm3 2", "cm3 2"),
        ("5 mm2", "5 mm2"),
        ("6-axis 5 kg", "6-axis 5 kg"),
    ],
)
def test_quantities_of_a_text_are_rewritten(text, shown):
    assert in_other_units(text, inches) == shown


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0393700787401575, "0.03937"),
        (0.25, "0.25"),
        (14.173228346456694, "14.173"),
        (1234.56789, "1234.56789"),
        (48.60503503937008, "48.605"),
        (0.1 + 0.2, "0.3"),
        (1e-7, "0.0000001"),
        (123456.5, "123456.5"),
        (0.0, "0"),
    ],
)
def test_a_field_shows_all_of_a_short_number_and_the_beginning_of_a_long_one(value, text):
    assert exact_or_rounded(value) == text
