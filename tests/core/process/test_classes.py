# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of bead classes restore their values, and errors in them are reported."""

import math
import random

import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters import bead_classes
from freecad_am.core.parameters.bead_classes import BEAD_CLASSES, CLASSES, BeadClass
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.process.classes import fill_bead_class, leaning, wall_bead_class

KEYS = {
    "travel_speed": (0.1, 50.0),
    "lead": (-1.5, 1.5),
    "tilt": (-1.5, 1.5),
    "lead_on": (0.0, 9.0),
    "lead_off": (0.0, 9.0),
}


@pytest.mark.parametrize("seed", range(20))
def test_texts_read_back(seed):
    rng = random.Random(seed)
    classes = {}
    for name in rng.sample(CLASSES, rng.randint(0, len(CLASSES))):
        values = {key: rng.uniform(*ends) for key, ends in KEYS.items() if rng.random() < 0.6}
        schedule = rng.choice([None, rng.randint(1, 65535)])
        classes[name] = BeadClass(name, **values, schedule=schedule)
    records = BEAD_CLASSES.read(BEAD_CLASSES.text(classes.values()))
    read_classes = {bead_class.name: bead_class for bead_class in records}
    assert set(read_classes) == {
        name for name, bead_class in classes.items() if bead_class.own_values()
    }
    for name, bead_class in read_classes.items():
        assert (
            set(bead_class.own_values()) == set(classes[name].own_values())
            and bead_class.schedule == classes[name].schedule
        )
        for key, value in bead_class.own_values().items():
            assert math.isclose(
                value, classes[name].own_values()[key], rel_tol=1e-11, abs_tol=1e-11
            )
    from_json = BEAD_CLASSES.read(BEAD_CLASSES.to_json(records))
    assert [bead_class.name for bead_class in from_json] == [
        bead_class.name for bead_class in records
    ]
    for bead_class, original in zip(from_json, records, strict=True):
        assert bead_class.own_values() == pytest.approx(original.own_values(), rel=1e-15)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("contour", "is not a class of beads"),
        ("contour: travel_speed 0", "more than 0"),
        ("outer: lead 5", "'outer' is not a valid choice"),
        ("contour: lead 5; contour: tilt 5", "contour is defined twice"),
        ("fill: speed 5", "no setting 'speed'"),
        ("fill: lead", "has no number"),
        ("fill: schedule 2.5", "whole number"),
        ("fill: schedule 0", "at least 1"),
        ("wall: lead 91", "at most 90 deg"),
        ("wall: lead_on -1", "at least 0"),
        ("wall: travel_speed nan", "is not a number"),
    ],
)
def test_what_is_wrong_is_named(text, words):
    with pytest.raises(InputError) as error:
        ProcessParameters(classes=text)
    assert error.value.code == "BAD_VALUE" and words in error.value.message
    assert error.value.where.startswith(bead_classes.WHERE)


def test_a_class_changes_what_it_names_alone():
    """A class overrides only the values that it names."""
    process = ProcessParameters(
        travel_speed=6.0, schedule=2, lead_on=0.5, classes="fill: travel_speed 9, lead 10"
    )
    fill, wall = process.for_class("fill"), process.for_class("wall")
    assert (fill.travel_speed, fill.schedule, fill.lead_on) == (9.0, 2, 0.5) and wall is process
    build = BuildDirectionParameters(lead=0.2, tilt=0.1)
    assert leaning(build, process, "wall") is build
    leant = leaning(build, process, "fill")
    assert math.isclose(leant.lead, math.radians(10.0)) and leant.tilt == 0.1


def test_which_class_a_bead_is_of():
    kinds = ("contour", "connected", "line", "zigzag", "spiral", "centre", "closing")
    assert [fill_bead_class(kind, 3) for kind in kinds] == ["contour"] * 2 + ["fill"] * 4 + [
        "closing"
    ]
    assert (
        {fill_bead_class(kind, 0) for kind in kinds}
        == {wall_bead_class(0), wall_bead_class(0, True)}
        == {"first_layer"}
    )
    assert (wall_bead_class(2), wall_bead_class(2, True)) == ("wall", "closing")
