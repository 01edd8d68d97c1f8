# SPDX-License-Identifier: LGPL-2.1-or-later
"""Directions and axes are the same from a text, a list and numbers, and their text restores them
exactly."""

import random

import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.filled import BaseParameters, SolidParameters
from freecad_am.core.parameters.vectors import Axis, axis_text, direction_text
from freecad_am.sections import fields

OPTIONAL, REQUIRED, AXIS = direction_text("k", "auto"), direction_text("k"), axis_text("k")


@pytest.mark.parametrize("value", ["0 -1 0.5", "0, -1, 0.5", (0.0, -1.0, 0.5), [0, "-1", 0.5]])
def test_texts_and_numbers_give_the_same_direction(value):
    assert OPTIONAL.read(value) == REQUIRED.read(value) == (0.0, -1.0, 0.5)


def test_an_axis_is_a_point_and_a_direction():
    axis = Axis((0.0, 10.0, 280.0), (0.0, 0.0, 1.0))
    for value in ("0 10 280 0 0 1", [[0, 10, 280], [0, 0, 1]], axis):
        assert AXIS.read(value) == axis
    assert AXIS.text(axis) == "0 10 280 0 0 1"
    base = fields.build(BaseParameters, {"axis": [["0 mm", "1 cm", 280], [0, 0, 1]]}, "base")
    assert base.axis == axis


def test_a_text_gives_the_numbers_exactly():
    rng = random.Random(3)
    for _ in range(200):
        value = tuple(rng.uniform(-1e3, 1e3) for _ in range(3))
        assert REQUIRED.read(REQUIRED.text(value)) == value
    assert REQUIRED.text((0.1, 1.0, -2.0)) == "0.1 1 -2"


def test_auto_is_no_direction_where_it_is_allowed():
    assert OPTIONAL.read("auto") is None and OPTIONAL.text(None) == "auto"
    assert SolidParameters(direction="auto").direction is None
    assert CellParameters().world_up == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("notation", "value"),
    [
        (REQUIRED, "auto"),
        (REQUIRED, "0 0 0"),
        (REQUIRED, [0, 1]),
        (REQUIRED, "0 nan 1"),
        (REQUIRED, 5),
        (AXIS, [0, 0, 1]),
        (AXIS, "0 0 0 0 0 0"),
        (AXIS, "0 0 inf 0 0 1"),
    ],
)
def test_other_values_are_refused(notation, value):
    with pytest.raises(InputError) as caught:
        notation.read(value)
    assert (caught.value.code, caught.value.where) == ("BAD_VALUE", "k")
