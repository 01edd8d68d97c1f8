# SPDX-License-Identifier: LGPL-2.1-or-later
"""FANUC's post rejects names, set-ups, turns and speeds that no controller accepts."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.program import Call, LayerStart
from freecad_am.posts import catalogue
from freecad_am.posts.fanuc import post as fanuc
from tests.posts.fanuc_programs import GOLDEN_JOINT, GOLDEN_TABLE, beads, moves, program, refusal

pytestmark = pytest.mark.any_version


@pytest.mark.parametrize(("name", "why", "proposal"), [
    ("", "empty", "AM"),
    ("my part", "letters", "MY_PART"),
    ("Größe", "letters", "GROSSE"),
    ("teil-1", "letters", "TEIL_1"),
    ("tube.v2", "letters", "TUBE_V2"),
    ("2nd", "start with a letter", "AM_2ND"),
    ("_x", "start with a letter", "X"),
    ("Ω", "letters", "AM"),
    ("x" * 37, "36 characters", "X" * 32),
    ("con", "reserved", "AM_CON"),
    ("Lpt3", "reserved", "AM_LPT3"),
    ("call", "reserved", "AM_CALL"),
])  # fmt: skip
def test_names_the_controller_refuses(name, why, proposal):
    message = refusal(
        program(moves("rapid", np.zeros(6)), name=name), code="PROGRAM_NAME", where="name"
    )
    assert why in message and message.endswith(f"use {proposal!r}") and repr(name) in message
    fanuc.write(program(moves("rapid", np.zeros(6)), name=proposal))


@pytest.mark.parametrize("name", ["a", "part_7", "x" * 36, "Hemisphere"])
def test_names_the_controller_takes_are_in_upper_case(name):
    assert list(fanuc.write(program(moves("rapid", np.zeros(6)), name=name))) == [
        f"{name.upper()}.LS"
    ]


def test_a_name_without_room_for_the_digits_of_its_parts_is_refused():
    fanuc.write(beads(3, 20, name="x" * 34, max_points=25))
    message = refusal(beads(3, 20, name="x" * 35, max_points=25), code="PROGRAM_NAME", where="name")
    assert "2 digits" in message and fanuc.write(beads(3, 20, name="X" * 32, max_points=25))


def test_called_programs_are_judged_by_the_same_rules():
    where = "process.between_layers.call"
    source = program(moves("rapid", np.zeros(6)), Call("nozzle clean"))
    assert "'NOZZLE_CLEAN'" in refusal(source, code="PROGRAM_NAME", where=where)
    assert "program of the job" in refusal(
        program(moves("rapid", np.zeros(6)), Call("Part")), code="PROGRAM_NAME", where=where
    )
    split = beads(3, 20, max_points=25)
    clashing = dataclasses.replace(split, blocks=(*split.blocks, Call("PART02")))
    assert "program of the job" in refusal(clashing, code="PROGRAM_NAME", where=where)


# ---- further refusals


def test_remote_tcp_is_refused_with_its_reason():
    message = refusal(
        dataclasses.replace(GOLDEN_TABLE, setup="part-on-robot"),
        code="REMOTE_TCP",
        where="program.motion",
    )
    assert "remote TCP" in message and "not documented" in message and "`motion: joint`" in message


def test_other_setups_and_axes_are_refused():
    refusal(
        dataclasses.replace(GOLDEN_JOINT, setup="tool-on-robot+positioner"),
        code="UNSUPPORTED_SETUP",
        where="cell.setup",
    )
    refusal(
        program(moves("rapid", np.zeros(5)), continuous=(False,) * 5),
        code="UNSUPPORTED_AXES",
        where="program.post",
    )
    refusal(program(LayerStart(0)), code="NOTHING_TO_WRITE")
    refusal(program(moves("rapid", [0, 0, 0, np.nan, 0, 0])), code="UNREACHABLE")


@pytest.mark.parametrize(("axis", "degrees"), [(0, 181.0), (3, -190.0), (4, 180.0), (3, 179.9996)])
def test_turns_of_other_axes_than_the_last_are_refused_in_cartesian_positions(axis, degrees):
    run = GOLDEN_TABLE.blocks[2]
    joints = run.joints.copy()
    joints[1, axis] = np.radians(degrees)
    blocks = (
        *GOLDEN_TABLE.blocks[:2],
        dataclasses.replace(run, joints=joints),
        *GOLDEN_TABLE.blocks[3:],
    )
    assert f"axis {axis + 1} is at" in refusal(
        dataclasses.replace(GOLDEN_TABLE, blocks=blocks), code="TURN_NUMBER"
    )


@pytest.mark.parametrize(("degrees", "turn"), [
    (0.0, 0), (179.999, 0), (-179.999, 0), (180.0, 1), (-180.0, -1), (179.9996, 1), (359.9, 1), (-450.0, -1),
    (540.0, 2),
])  # fmt: skip
def test_the_turn_number_of_axis_6(degrees, turn):
    run = GOLDEN_TABLE.blocks[0]
    joints = run.joints.copy()
    joints[0, 5] = np.radians(degrees)
    source = dataclasses.replace(GOLDEN_TABLE, blocks=(dataclasses.replace(run, joints=joints),))
    assert f"CONFIG : 'N U T, 0, 0, {turn}'".encode() in fanuc.write(source)["TABLE.LS"]


def test_cartesian_positions_of_an_arm_bent_backwards_are_refused():
    run = dataclasses.replace(GOLDEN_TABLE.blocks[0], configuration=(("back", "up", "flip"),))
    refusal(dataclasses.replace(GOLDEN_TABLE, blocks=(run,)), code="ARM_BACKWARDS")


@pytest.mark.parametrize("speed", [0.04, 2000.1, np.nan])
def test_speeds_that_cannot_be_written_are_refused(speed):
    run = dataclasses.replace(GOLDEN_TABLE.blocks[2], speed=np.array([6.0, speed]))
    refusal(
        dataclasses.replace(GOLDEN_TABLE, blocks=(run,)), code="MOVE_SPEED", where="layer 0 bead 0"
    )


def test_the_catalogue():
    assert catalogue.load("fanuc") is fanuc and catalogue.NAMES[:2] == ("fanuc", "staubli")
    with pytest.raises(InputError) as raised:
        catalogue.load("fanuk")
    assert (
        raised.value.code == "UNKNOWN_POST"
        and "'fanuk'" in raised.value.message
        and "fanuc" in raised.value.message
    )
