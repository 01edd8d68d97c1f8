# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit switched on the move itself, ahead of its position: on which beads, and in the text
of each controller that can do it. Another time, position or output, or none, is rejected, and so is
the option for other controllers."""

import dataclasses
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.motion import UNKNOWN
from freecad_am.core.parameters.bead_classes import CLASSES
from freecad_am.core.parameters.process import CoolingParameters
from freecad_am.core.parameters.program import (
    ProgramParameters,
    ScheduleParameters,
    TriggerParameters,
)
from freecad_am.core.planning import linear_approach
from freecad_am.core.program import DepositOff, DepositOn, Moves, WaitBelow
from freecad_am.core.read_moves import Event
from freecad_am.objects.program import refuse
from freecad_am.posts import catalogue
from freecad_am.posts.parts import switching
from freecad_am.posts.refusals import refuse_triggers
from freecad_am.read_back.events import _alike
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.programs import build

CELL = {
    "fanuc": "fanuc tool-on-robot",
    "staubli": "staubli tool-on-robot",
    "ur": "ur tool-on-robot",
    "siemens": "table",
    "linuxcnc": "table",
    "yaskawa": "yaskawa tool-on-robot",
    "abb": "abb tool-on-robot",
    "kuka": "kuka tool-on-robot",
}
CANNOT = [post for post in catalogue.NAMES if catalogue.load(post).NO_TRIGGER]


def find_switches(process, **program):
    """Return DepositOn and DepositOff of a job with beads of three classes in turn, by class."""
    cell, _, motion = planned("fanuc tool-on-robot")
    names = ("wall", "contour", "fill")
    number = (motion.layer + motion.bead) % 3
    assert (motion.bead_class == UNKNOWN).all()
    motion = dataclasses.replace(
        motion, bead_class=number * 0 + [CLASSES.index(names[k]) for k in number]
    )
    parameters = ProgramParameters(trigger=TriggerParameters(lead=0.05), **program)
    blocks = build(motion, cell, dataclasses.replace(PROCESS, **process), parameters, "job").blocks
    events = {}
    for previous, block, following in zip(blocks, blocks[1:], blocks[2:]):
        if isinstance(block, (DepositOn, DepositOff)):
            moves = following if isinstance(block, DepositOn) else previous
            assert isinstance(moves, Moves) and moves.kind == "deposit"
            events.setdefault(names[(moves.layer + moves.bead) % 3], set()).add(
                (type(block).__name__, block.ahead)
            )
    return events


def test_what_waits_is_switched_where_the_robot_stands():
    class_options = "contour: lead_on 0, lead_off 0; fill: lead_on 0"
    assert find_switches({"classes": class_options, "lead_on": 0.5, "lead_off": 0.25}) == {
        "wall": {("DepositOn", None), ("DepositOff", None)},
        "contour": {("DepositOn", 0.05), ("DepositOff", 0.05)},
        "fill": {("DepositOn", 0.05), ("DepositOff", None)},
    }
    bare = {"lead_on": 0.0, "lead_off": 0.0, "schedule": 3}
    leads = {
        ("DepositOn", None),
        ("DepositOff", 0.05),
    }  # the schedule is set at the standstill, before the deposit is on
    assert find_switches(bare) == dict.fromkeys(("wall", "contour", "fill"), leads)
    assert find_switches(bare, schedule=ScheduleParameters(by="call")) == dict.fromkeys(
        ("wall", "contour", "fill"), leads
    )


@pytest.mark.parametrize("post", CANNOT)
def test_controllers_that_cannot_refuse_it_before_planning_and_by_themselves(post):
    cell, _, motion = planned(CELL[post])
    for kind in ("joint", "cartesian"):
        parameters = ProgramParameters(post=post, motion=kind, trigger=TriggerParameters(lead=0.0))
        try:
            refuse(cell, PROCESS, dataclasses.replace(parameters, trigger=TriggerParameters()))
        except InputError:
            continue
        with pytest.raises(InputError) as error:
            refuse(cell, PROCESS, parameters)
        assert (error.value.code, error.value.where) == ("TRIGGER", "program.trigger.lead")
        assert catalogue.load(post).NO_TRIGGER in error.value.message
        # a dry run switches nothing
        refuse(cell, PROCESS, dataclasses.replace(parameters, dry_run=True))
        if kind == "joint" or post in ("abb", "kuka"):
            with pytest.raises(InputError) as error:
                catalogue.load(post).write(
                    build(
                        motion, cell, dataclasses.replace(PROCESS, lead_off=0.0), parameters, "job"
                    )
                )
            assert error.value.code == "TRIGGER"


def test_a_lead_longer_than_the_move_it_stands_on_is_refused_with_its_bead():
    cell, _, motion = planned("fanuc tool-on-robot")
    process = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
    for lead, refused in ((0.05, False), (0.5, True)):
        program = build(
            motion, cell, process, ProgramParameters(trigger=TriggerParameters(lead=lead)), "job"
        )
        assert {
            block.ahead for block in program.blocks if isinstance(block, (DepositOn, DepositOff))
        } == {lead}
        shortest = min(run.duration[-1] for run in program.moves[:-1])
        assert bool(shortest < lead) == refused
        if refused:
            with pytest.raises(InputError) as error:
                refuse_triggers(program, "")
            assert error.value.code == "TRIGGER_LEAD" and error.value.where.startswith("layer ")
            ends = [
                run.duration[-1]
                for run, following in zip(program.blocks, program.blocks[1:], strict=False)
                if isinstance(run, Moves) and isinstance(following, (DepositOn, DepositOff))
            ]
            assert (
                f"takes {min(ends):.4g} s" in error.value.message
            )  # so that one correction is enough
            refuse_triggers(dataclasses.replace(program, dry_run=True), "")
        else:
            refuse_triggers(program, "")


def largest_lead(error):
    """Return the largest lead, in s, that a refusal states."""
    return float(re.search(r"program\.trigger\.lead of at most ([\d.]+) s", error.value.message)[1])


@pytest.mark.parametrize(
    ("post", "motion", "blend"),
    [
        ("fanuc", "joint", 100),
        ("fanuc", "cartesian", 100),
        ("abb", "cartesian", 100),
        ("kuka", "cartesian", 100),
        ("kuka", "cartesian", 30),
        ("kuka", "cartesian", 0),
    ],
)
@pytest.mark.parametrize("only", [None, DepositOn, DepositOff])
def test_the_largest_lead_is_told_and_read_back_and_more_is_refused(post, motion, blend, only):
    """The largest lead of all switches, of starts only and of ends only is written and read back.
    One millisecond more, or the next writable value, is rejected."""
    cell, _, motion_ = planned(CELL[post])
    process = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
    if post == "abb":
        motion_ = linear_approach.shorten_approaches(motion_, cell)

    def build_with_lead(lead):
        parameters = ProgramParameters(
            post=post, motion=motion, blend=blend, trigger=TriggerParameters(lead=lead)
        )
        program = build(motion_, cell, process, parameters, "job")
        blocks = [
            dataclasses.replace(block, ahead=None)
            if isinstance(block, (DepositOn, DepositOff)) and only not in (None, type(block))
            else block
            for block in program.blocks
        ]
        return dataclasses.replace(program, blocks=tuple(blocks))

    with pytest.raises(InputError) as error:
        catalogue.load(post).write(build_with_lead(0.5))
    assert error.value.code == "TRIGGER_LEAD"
    largest_s = largest_lead(error)
    assert 0.0 < largest_s < 0.499
    program = build_with_lead(largest_s)
    files = catalogue.load(post).write(program)
    if (
        post == "fanuc"
    ):  # it writes hundredths of a second: none is longer than its move, and one more would be
        ends = [run.duration[-1] for run, block in switching(program) if block.ahead is not None]
        written = [
            float(value)
            for text in files.values()
            for value in re.findall(rb"TB +([\d.]+)sec", text)
        ]
        assert (
            len(written) == len(ends)
            and set(written) == {largest_s}
            and largest_s <= min(ends) < largest_s + 0.01
        )
        assert (
            catalogue.load(post).write(build_with_lead(largest_s + 0.004)) == files
        )  # written the same
    result = verify(cell, motion_, program, files, catalogue.load(post), CHORD_ERROR)
    assert not [issue for issue in result.issues if issue.level == ERROR]
    with pytest.raises(InputError) as error:
        catalogue.load(post).write(
            build_with_lead(largest_s + (0.006 if post == "fanuc" else 0.001))
        )
    assert largest_lead(error) == largest_s


def test_a_controller_of_linear_triggers_goes_straight_onto_beads_and_waits_for_cooling_before():
    cell, _, motion = planned("abb tool-on-robot")
    bare = dataclasses.replace(PROCESS, lead_on=0.0, cooling=CoolingParameters(below=150.0))
    ahead = ProgramParameters(post="abb", motion="cartesian", trigger=TriggerParameters(lead=0.02))
    returns = {(1, 0), (1, 1)}
    short = linear_approach.shorten_approaches(motion, cell)
    blocks = build(short, cell, bare, ahead, "job", returns=returns).blocks
    waits = [k for k, block in enumerate(blocks) if isinstance(block, WaitBelow)]
    assert [(blocks[k].layer, blocks[k].bead) for k in waits] == sorted(returns)
    for k, block in enumerate(blocks):
        if isinstance(block, DepositOn):
            onto = blocks[k - 1]
            assert (onto.kind, onto.interpolation, len(onto), block.ahead) == (
                "rapid",
                "linear",
                1,
                0.02,
            )
    # the same moves, waits and points as without, except for the points added on the approach
    plain = build(
        motion,
        cell,
        bare,
        dataclasses.replace(ahead, trigger=TriggerParameters()),
        "job",
        returns=returns,
    )
    assert all(run.interpolation == "joint" for run in plain.moves if run.kind == "rapid")
    waits_before = [
        plain.blocks[k - 1].joints[-1]
        for k, block in enumerate(plain.blocks)
        if isinstance(block, WaitBelow)
    ]
    np.testing.assert_array_equal([blocks[k - 1].joints[-1] for k in waits], waits_before)
    assert sum(map(len, plain.moves)) <= sum(
        len(block) for block in blocks if isinstance(block, Moves)
    )


def test_a_program_that_begins_at_a_bead_cannot_go_straight_onto_it():
    cell, _, motion = planned("abb tool-on-robot")
    first_row = int(np.argmax(motion.deposit))
    bare = dataclasses.replace(
        motion,
        **{
            field.name: getattr(motion, field.name)[first_row - 1 :]
            for field in dataclasses.fields(motion)
        },
    )
    ahead = ProgramParameters(post="abb", motion="cartesian", trigger=TriggerParameters(lead=0.02))
    with pytest.raises(InputError) as error:
        build(bare, cell, PROCESS, ahead, "job")
    assert error.value.code == "TRIGGER" and "program.trigger.lead" in error.value.message


@pytest.mark.parametrize("post", ["fanuc", "kuka"])
def test_a_bead_onto_which_nothing_moves_or_that_the_program_begins_at_is_switched_on_where_the_robot_stands(
    post,
):
    """The deposit is switched at the standstill, because the duration of the first move is unknown,
    and a move to the current position takes no time."""
    cell, _, motion = planned(CELL[post])
    first_switch, last_switch = (
        int(np.argmax(motion.deposit)),
        int(np.flatnonzero(motion.deposit & (motion.point == 0))[-1]),
    )
    bare = dataclasses.replace(
        motion,
        **{
            field.name: getattr(motion, field.name)[first_switch - 1 :]
            for field in dataclasses.fields(motion)
        },
    )
    assert not bare.deposit[0] and bare.deposit[1]
    joints = bare.joints.copy()
    joints[last_switch - first_switch] = joints[
        last_switch - first_switch - 1
    ]  # already at the position where the approach to the last bead begins
    bare = dataclasses.replace(bare, joints=joints)
    process = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
    parameters = ProgramParameters(
        post=post,
        motion="cartesian" if post == "kuka" else "joint",
        trigger=TriggerParameters(lead=0.02),
    )
    program = build(bare, cell, process, parameters, "job")
    on = [block.ahead for block in program.blocks if isinstance(block, DepositOn)]
    assert on == [None, *(0.02,) * (len(on) - 2), None] and len(on) > 3
    assert {block.ahead for block in program.blocks if isinstance(block, DepositOff)} == {0.02}
    events = catalogue.load(post).read(catalogue.load(post).write(program)).events
    assert [event.ahead for event in events if event.kind == "on"] == on


@pytest.mark.parametrize(
    ("found", "due", "alike"),
    [
        (None, None, True),
        (None, 0.0, False),
        (0.0, None, False),
        (0.05, 0.0504, True),
        (0.05, 0.051, False),
    ],
)
def test_how_long_ahead_is_told_to_its_last_digit(found, due, alike):
    event, expected_event = (Event(3, "on", (1.0,), 0.0005, value) for value in (found, due))
    assert _alike(_Robot, event, expected_event) is alike


class _Robot:
    """A stub of a program whose deposit a digital output switches."""

    class nc:
        deposit_on = ""


@pytest.mark.parametrize("lead", [-0.1, 0.6, float("nan")])
def test_leads_out_of_range_are_refused(lead):
    with pytest.raises(InputError) as error:
        TriggerParameters(lead=lead)
    assert (error.value.code, error.value.where) == ("BAD_VALUE", "program.trigger.lead")
