# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters that are records: their text, their JSON, and the strings of documents and macros of earlier versions."""

import json
import math

import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.bead_classes import BEAD_CLASSES, BeadClass
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.cell_records import (
    EXTERNAL,
    NOZZLE_SHAPE,
    OBSTACLES,
    TOUCHED,
    ExternalMechanism,
    NozzleShape,
    Obstacle,
    TouchedPoint,
)
from freecad_am.core.parameters.process import ProcessParameters

MECHANISMS = (
    ExternalMechanism("kuka-kl100-2", (0.0, 0.0, -3.5, 0.0, 0.0, math.radians(90.0)), "robot"),
    ExternalMechanism("my table.json", (1500.0, 0.25, 0.0, 0.0, math.radians(0.1), 0.0)),
)
BODIES = (
    Obstacle("table", (0.0, 0.0, -200.0, 0.0, 0.0, 0.0), "/tmp/a b/tablé.step"),
    Obstacle("post", (900.0, 200.0, 0.0, 0.0, 0.0, math.radians(30.0)), box=(60.0, 60.0, 400.5)),
)
POINTS = (
    TouchedPoint((0.0, 0.0, 0.0), (900.4, 2.1, -99.7)),
    TouchedPoint((100.0, 0.0, 1 / 3), (1000.3, 1.2, -99.9)),
)
CASES = [
    pytest.param(EXTERNAL, MECHANISMS, id="external"),
    pytest.param(OBSTACLES, BODIES, id="obstacles"),
    pytest.param(TOUCHED, POINTS, id="touched"),
    pytest.param(NOZZLE_SHAPE, NozzleShape("/tmp/torch 1.step"), id="shape"),
]
# as in documents and macros of earlier versions
STRINGS = [
    (EXTERNAL, MECHANISMS[0], "kuka-kl100-2 at 0 0 -3.5 0 0 90 carries robot"),
    (EXTERNAL, MECHANISMS[1], "my table.json at 1500, 0.25, 0, 0, 0.1, 0 carries part"),
    (OBSTACLES, BODIES[0], "table = /tmp/a b/tablé.step at 0 0 -200 0 0 0"),
    (OBSTACLES, BODIES[1], "post = box 60 60 400.5 at 900 200 0 0 0 30"),
    (TOUCHED, POINTS[0], "0 0 0 = 900.4 2.1 -99.7"),
]


@pytest.mark.parametrize(("notation", "records"), CASES)
def test_json_returns_the_same_records(notation, records):
    text = notation.to_json(records)
    assert notation.read(text) == records
    assert json.loads(text)


@pytest.mark.parametrize(("notation", "record", "text"), STRINGS)
def test_strings_of_earlier_versions_are_read(notation, record, text):
    assert notation.read(text) == (record,)
    assert notation.read(f" {text} ; ") == (record,)
    assert notation.read(notation.text((record,))) == (record,)


@pytest.mark.parametrize("notation", [EXTERNAL, OBSTACLES, TOUCHED, NOZZLE_SHAPE])
@pytest.mark.parametrize("text", ["none", "", " none "])
def test_no_records(notation, text):
    empty = None if notation.single else ()
    assert notation.read(text) == empty
    assert notation.to_json(empty) == notation.text(empty) == "none"


def test_json_has_the_keys_and_units_of_a_job_file():
    assert json.loads(EXTERNAL.to_json(MECHANISMS)) == [
        {"machine": "kuka-kl100-2", "pose": [0.0, 0.0, -3.5, 0.0, 0.0, 90.0], "carries": "robot"},
        {"machine": "my table.json", "pose": [1500.0, 0.25, 0.0, 0.0, 0.1, 0.0]},
    ]
    assert json.loads(OBSTACLES.to_json(BODIES))[1] == {
        "name": "post",
        "pose": [900.0, 200.0, 0.0, 0.0, 0.0, 30.0],
        "box": [60.0, 60.0, 400.5],
    }


@pytest.mark.parametrize(
    "text",
    [
        '[{"machine": "kuka-kl100-2"}]',
        '[{"machine": "kuka-kl100-2", "pose": [0, 0, 0]}]',
        '[{"machine": "kuka-kl100-2", "pose": "zero"}]',
        '[{"machine": "kuka-kl100-2", "pose": [0, 0, 0, 0, 0, 0], "colour": 1}]',
        '[{"machine"',
    ],
)
def test_other_json_is_refused(text):
    with pytest.raises(InputError, match="names no external axes") as error:
        EXTERNAL.read(text)
    assert (error.value.code, error.value.where) == ("BAD_VALUE", "cell.external")


def test_a_cell_of_texts_holds_records():
    cell = CellParameters(
        external=EXTERNAL.text(MECHANISMS),
        obstacles=OBSTACLES.to_json(BODIES),
        touched="none",
        nozzle=NozzleParameters(shape="torch.step"),
    )
    assert (cell.external, cell.obstacles, cell.touched) == (MECHANISMS, BODIES, ())
    assert cell.nozzle.shape == NozzleShape("torch.step")


def test_obstacles_of_equal_names_are_refused():
    with pytest.raises(InputError, match="2 obstacles are called 'post'"):
        CellParameters(obstacles=(BODIES[1], BODIES[1]))


def test_bead_classes_have_json_and_texts_of_earlier_versions():
    text = "first_layer: travel_speed 4.5, schedule 2; fill: lead -5, lead_on 0.25, weave 2"
    classes = BEAD_CLASSES.read(text)
    assert ProcessParameters(classes=text).classes == classes
    assert classes[1] == BeadClass("fill", lead=math.radians(-5.0), lead_on=0.25, weave=2)
    stored = BEAD_CLASSES.to_json(classes)
    assert json.loads(stored)[0] == {"name": "first_layer", "travel_speed": 4.5, "schedule": 2}
    assert BEAD_CLASSES.read(stored) == classes and BEAD_CLASSES.text(classes) == text
    with pytest.raises(InputError, match="fill is defined twice"):
        ProcessParameters(classes=(classes[1], classes[1]))
