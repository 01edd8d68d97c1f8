# SPDX-License-Identifier: LGPL-2.1-or-later
"""One table of texts for all three inputs: the job file, the property and the macro."""

import math
from types import SimpleNamespace

import FreeCAD as App
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.macro.arguments import set_parameters
from freecad_am.objects.fields import properties, quantities, rows
from freecad_am.objects.stage_parts import Section
from freecad_am.sections import fields

# a parameter of each kind whose property holds a text
LENGTH = (ProcessParameters, "process", "stand_off")
SPEED = (ProcessParameters, "process", "start_travel_speed")
NUMBER = (ProcessParameters, "process", "temperature")
ANGLE = (JointParameters, "joints", "rz")
TIME = (ProgramParameters, "program", "trigger_lead")
RATIO = (SolidParameters, "strategy", "bead_overlap")
TURN_RATE = (BuildDirectionParameters, "build_direction", "max_turn")
LENGTH_OR_POSE = (CellParameters, "cell", "platform")
POSE_OR_WORD = (ProgramParameters, "program", "origin")

RIGHT_ANGLE = math.pi / 2
GOOD = [
    (LENGTH, "12", 12.0),
    (LENGTH, "12 mm", 12.0),
    (LENGTH, " 1.2cm ", 12.0),
    (LENGTH, "+12 mm", 12.0),
    (LENGTH, "\N{MINUS SIGN}12 mm", -12.0),
    (LENGTH, "1.2e1 mm", 12.0),
    (LENGTH, "0.012\N{NO-BREAK SPACE}m", 12.0),
    (LENGTH, "12000 \N{MICRO SIGN}m", 12.0),
    (LENGTH, "12000 \N{GREEK SMALL LETTER MU}m", 12.0),
    (LENGTH, "0.5 in", 12.7),
    (LENGTH, '.5"', 12.7),
    (LENGTH, "1/2 in", 12.7),
    (LENGTH, "(1 + 1) * 6 mm", 12.0),
    (LENGTH, "1 ft 3 in", 381.0),
    (LENGTH, "2'", 609.6),
    (ANGLE, "90", RIGHT_ANGLE),
    (ANGLE, "90 deg", RIGHT_ANGLE),
    (ANGLE, "90\N{DEGREE SIGN}", RIGHT_ANGLE),
    (ANGLE, "1 rad", 1.0),
    (ANGLE, "100 gon", RIGHT_ANGLE),
    (ANGLE, "auto", "auto"),
    (SPEED, "6", 6.0),
    (SPEED, "360 mm/min", 6.0),
    (SPEED, "6 mm / s", 6.0),
    (SPEED, "6e-3 mm/ms", 6.0),
    (SPEED, "0.36 m/min", 6.0),
    (TIME, "0.25", 0.25),
    (TIME, "250 ms", 0.25),
    (TIME, "1/4 s", 0.25),
    (RATIO, "20", 0.2),
    (RATIO, "20 %", 0.2),
    (RATIO, "20%", 0.2),
    (RATIO, "40/2", 0.2),
    (NUMBER, "1_000", 1000.0),
    (NUMBER, "2e3 / 2", 1000.0),
    (TURN_RATE, "180", math.pi),
    (TURN_RATE, "180 deg/mm", math.pi),
    (TURN_RATE, "10 rad / cm", 1.0),
    (TURN_RATE, "auto", "auto"),
    (LENGTH_OR_POSE, "1.2 cm", 12.0),
    (LENGTH_OR_POSE, "1 / 2 in", 12.7),
    (LENGTH_OR_POSE, "0 0 12 0 0 0", (0, 0, 12, 0, 0, 0)),
    (LENGTH_OR_POSE, "0, 0, 12, 0, 0, 90", (0, 0, 12, 0, 0, RIGHT_ANGLE)),
    (LENGTH_OR_POSE, "kuka 0 0 12 90 0 0", (0, 0, 12, 0, 0, RIGHT_ANGLE)),
    (POSE_OR_WORD, "0 0 12 0 0 90", (0, 0, 12, 0, 0, RIGHT_ANGLE)),
    (POSE_OR_WORD, "auto", "auto"),
]
BAD = [  # the value as the message shows it, and the remedy
    (LENGTH, "1,5 mm", "'1,5 mm'", "use a decimal point, as in 1.5 mm"),
    (LENGTH, "1,234.5 mm", "'1,234.5 mm'", "give a length such as 1 mm"),
    (LENGTH, "1\N{NARROW NO-BREAK SPACE}234 mm", "'1 234 mm'", "give a length such as 1 mm"),
    (LENGTH, "90 deg", "'90 deg' is an angle", "give a length such as 1 mm"),
    (LENGTH, "1 kg", "'1 kg' has another dimension", "give a length such as 1 mm"),
    (LENGTH, "1 parsec", "'1 parsec'", "give a length such as 1 mm"),
    (LENGTH, "20 %", "'20 %' is a percentage", "give a length such as 1 mm"),
    (LENGTH, "1e999 mm", "'1e999 mm' is too large", "give a length such as 1 mm"),
    (LENGTH, "inf", "'inf' is too large", "give a length such as 1 mm"),
    (LENGTH, "nan", "'nan'", "give a length such as 1 mm"),
    (LENGTH, "2 mm [about", "'2 mm [about'", "give a length such as 1 mm"),
    (LENGTH, "x" * 500, "xxx...", "give a length such as 1 mm"),
    (ANGLE, "some", "'some'", "give an angle such as 30 deg or auto"),
    (ANGLE, "3 mm", "'3 mm' is a length", "give an angle such as 30 deg or auto"),
    (SPEED, "1 mm", "'1 mm' is a length", "give a speed such as 6 mm/s or 360 mm/min"),
    (TIME, "0,05", "'0,05'", "use a decimal point, as in 0.05"),
    (RATIO, "20 %%", "'20 %%'", "give a percentage such as 20 %"),
    (RATIO, "20 mm", "'20 mm' is a length", "give a percentage such as 20 %"),
    (NUMBER, "0,5", "'0,5'", "use a decimal point, as in 0.5"),
    (NUMBER, "5 mm", "'5 mm' is a length", "give a number without a unit such as 0.1"),
    (TURN_RATE, "10 deg", "'10 deg' is an angle", "give a turn per length such as 10 deg/mm"),
    (LENGTH_OR_POSE, "1,5 mm", "'1,5 mm'", "use a decimal point, as in 1.5 mm"),
    (LENGTH_OR_POSE, "0 0 1 2", "'0 0 1 2'", "give x y z in mm and RX RY RZ in deg"),
    (LENGTH_OR_POSE, "10,5 20,5 30,5", "'10,5 20,5 30,5'", "write decimals with a point"),
    (LENGTH_OR_POSE, "kuka 1 2", "'kuka 1 2'", "use the form: kuka X Y Z A B C"),
    (POSE_OR_WORD, "here", "'here'", "give x y z in mm and RX RY RZ in deg or auto"),
    (POSE_OR_WORD, "0 0 x", "'0 0 x'", "give x y z in mm and RX RY RZ in deg or auto"),
]


def row_of(parameter):
    return next(row for row in rows.rows(parameter[0]) if row.key == parameter[2])


def by_job(obj, parameter, text):
    cls, section, _ = parameter
    value = text
    for step in reversed(row_of(parameter).path):
        value = {step: value}
    return fields.build(cls, value, section)


def by_property(obj, parameter, text):
    cls, section, _ = parameter
    properties.add(obj, cls, "Group")
    setattr(obj, row_of(parameter).name, text)
    return properties.read(obj, cls, section)


def by_macro(obj, parameter, text):
    cls, section, key = parameter
    properties.add(obj, cls, "Group")
    stage = SimpleNamespace(
        sections=(Section(cls, section, "Group"),),
        parameters=lambda obj, cls: properties.read(obj, cls, section),
    )
    set_parameters(obj, stage, (), {key: text})
    return properties.read(obj, cls, section)


ENTRANCES = (by_job, by_property, by_macro)


@pytest.fixture
def holder(doc):
    return doc.addObject("App::FeaturePython", "Holder")


@pytest.mark.parametrize(("parameter", "text", "value"), GOOD)
def test_a_text_means_the_same_in_job_file_property_and_macro(holder, parameter, text, value):
    expected = value if isinstance(value, str) else pytest.approx(value, rel=1e-14, abs=1e-14)
    for entrance in ENTRANCES:
        parameters = entrance(holder, parameter, text)
        assert rows.flat(parameters)[parameter[2]] == expected, entrance.__name__


@pytest.mark.parametrize(("parameter", "text", "shown", "remedy"), BAD)
def test_a_bad_text_is_rejected_everywhere_with_field_value_and_remedy(
    holder, parameter, text, shown, remedy
):
    messages = set()
    for entrance in ENTRANCES:
        with pytest.raises(InputError) as caught:
            entrance(holder, parameter, text)
        dotted = ".".join(row_of(parameter).path)
        names = (f"{parameter[1]}.{dotted}", f"Holder.{row_of(parameter).name}")
        assert caught.value.where in (*names, f"{parameter[1]}.{parameter[2]}")
        assert caught.value.code in ("BAD_VALUE", "BAD_UNIT")
        messages.add(str(caught.value.message))
    assert len(messages) == 1
    assert shown in (message := messages.pop()) and remedy in message
    assert len(message) < 250


@pytest.mark.parametrize(
    "value",
    [
        [0, 0, 12, 0, 0, 90],
        ["0 mm", 0, "1.2 cm", 0, 0, "90 deg"],
        ["kuka", 0, 0, 12, 90, 0, 0],
    ],
)
def test_a_list_is_the_same_pose_in_job_file_and_macro(holder, value):
    for entrance in (by_job, by_macro):
        platform = entrance(holder, LENGTH_OR_POSE, value).platform
        assert platform == pytest.approx((0, 0, 12, 0, 0, RIGHT_ANGLE), abs=1e-12)


@pytest.mark.parametrize("value", ["0 0 12", "0, 0, 12", [0, 0, 12]])
def test_only_a_job_file_requires_the_rotation_of_a_pose(holder, value):
    assert by_macro(holder, LENGTH_OR_POSE, value).platform == (0, 0, 12, 0, 0, 0)
    with pytest.raises(InputError, match="six numbers, not 3; give") as caught:
        by_job(holder, LENGTH_OR_POSE, value)
    assert (caught.value.code, caught.value.where) == ("BAD_VALUE", "cell.platform")


def test_a_quantity_of_freecad_is_read_as_its_text_is():
    length = App.Units.Quantity("1.2 cm")
    assert quantities.read(length, "length", "key") == 12.0
    with pytest.raises(InputError, match="is a length; give an angle such as 30 deg") as caught:
        quantities.read(length, "angle", "key")
    assert caught.value.code == "BAD_UNIT"


@pytest.mark.parametrize("value", [True, None, [1], {}, object()])
def test_what_is_neither_text_nor_number_is_rejected(value):
    with pytest.raises(InputError, match="is not a quantity; give a length such as 1 mm"):
        quantities.read(value, "length", "key")
