# SPDX-License-Identifier: LGPL-2.1-or-later
"""FANUC listings switch the deposit on the move itself (TB): in the form of controllers, read back
through two solvers as planned, over parts, resumed, dry and woven. A lost, doubled or moved
trigger, or one with another time, output or value, is rejected."""

import dataclasses
import functools
import re

import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.program import ProgramParameters, StartParameters, TriggerParameters
from freecad_am.core.planning.program import rows_from
from freecad_am.core.program import DepositOff, DepositOn, Moves, Weave
from freecad_am.posts.fanuc import post as fanuc
from freecad_am.verify import verify
from tests.posts.fanuc_programs import (
    GOLDEN_JOINT,
    GOLDEN_TABLE,
    beads,
    put_tool_on_robot,
    refusal,
    switch_on_moves,
)
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.posts.test_fanuc import add_second_group, body
from tests.posts.test_fanuc_read import by_hand
from tests.programs import build

GROUPED = switch_on_moves(
    add_second_group(beads(1, 12, layers=2, max_points=8)), 0.0, name="earlygrp"
)
GOLDENS = {
    "EARLY.LS": switch_on_moves(put_tool_on_robot(GOLDEN_JOINT)),
    "EARLYTAB.LS": switch_on_moves(GOLDEN_TABLE, 0.1, name="earlytab"),
    "EARLYGRP*.LS": GROUPED,
}


@pytest.mark.parametrize("names", GOLDENS)
def test_golden_listings_to_the_byte(root, names, assert_listings):
    files = fanuc.write(GOLDENS[names])
    assert files == {
        path.name: path.read_bytes() for path in (root / "tests/golden/fanuc").glob(names)
    }
    if names != "EARLYGRP*.LS":  # which judges listings with one group
        assert_listings(files)


def test_it_stands_on_the_moves_that_end_there_as_controllers_write_it():
    source = switch_on_moves(put_tool_on_robot(GOLDEN_JOINT))
    switch_lines = [line for line in body(fanuc.write(source)["EARLY.LS"]) if "DO[" in line]
    assert switch_lines == [
        "J P[2] 2500msec FINE TB    .05sec,DO[1]=ON    ;",
        "J P[5] 33.0sec FINE TB    .05sec,DO[1]=OFF    ;",
    ]
    switch_lines = [
        line for line in body(fanuc.write(GOLDENS["EARLYTAB.LS"])["EARLYTAB.LS"]) if "DO[" in line
    ]
    assert switch_lines == [
        "J P[1] 10% FINE TB    .10sec,DO[7]=ON    ;",
        "L P[3] 6.0mm/sec FINE TB    .10sec,DO[7]=OFF    ;",
    ]
    readback = fanuc.read(fanuc.write(source))
    assert [
        (e.row, e.kind, *e.value, e.ahead, e.digits) for e in readback.events if e.ahead is not None
    ] == [(2, "on", 1.0, "DO", 0.05, 0.005), (5, "off", 1.0, "DO", 0.05, 0.005)]
    assert (
        readback.deposit.tolist()
        == fanuc.read(fanuc.write(put_tool_on_robot(GOLDEN_JOINT))).deposit.tolist()
    )
    # cut inside the beads: the output stays on, and is switched off on the very last move
    files = fanuc.write(GROUPED)
    switched = [
        (name, re.findall(r"TB   0\.00sec,DO\[1\]=(ON|OFF)    ;\r", text.decode()))
        for name, text in files.items()
    ]
    assert [switch for switch in switched if switch[1]] == [
        (f"EARLYGRP0{n}.LS", [word]) for n, word in ((1, "ON"), (2, "OFF"), (3, "ON"), (4, "OFF"))
    ]
    refusal(
        switch_on_moves(GOLDEN_TABLE, 0.11), code="TRIGGER_LEAD", where="layer 0 bead 0"
    )  # moves take 0.1 s


@pytest.mark.parametrize(("old", "new", "why"), [
    ("CNT100 ", "CNT100 TB    .05sec,DO[5]=OFF ", "corner is rounded"),
    *((".5sec FINE", f".5sec FINE {option}", why) for option, why in (
        ("TB .05sec,DO[6]=ON", "second output"), ("TB .05sec,CALL ON", "'TB .05sec,CALL ON'"), ("TA .05sec,DO[5]=ON", "TA"),
        ("DB 5.0mm,DO[5]=ON", "DB"), ("TB -.05sec,DO[5]=ON", "'TB -.05sec"), ("TB .05sec,DO[5]=PULSE", "PULSE"),
        ("TB R[1]sec,DO[5]=ON", "R[1]"), ("TB .05sec,P-SPS", "P-SPS"))),
    ("CALL ELSEWHERE", "TB .05sec,DO[5]=ON", "not understood"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(old, new, why):
    with pytest.raises(InputError) as raised:
        fanuc.read(by_hand(re.escape(old), new))
    assert raised.value.code == "UNREADABLE_PROGRAM" and why in raised.value.message


# ---- planned jobs

BARE = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
WAYS = [
    ("fanuc tool-on-robot", "joint", 0.0456),
    ("fanuc tool-on-robot", "cartesian", 0.0),
    *(
        pytest.param(*variant, marks=pytest.mark.long)
        for variant in (
            ("fanuc positioner", "joint", 0.0456),
            ("fanuc track and positioner", "joint", 0.02),
            ("fanuc tool-on-robot", "joint", 0.0),
            ("fanuc tool-on-robot", "cartesian", 0.0456),
        )
    ),
]


@functools.cache
def plan_program(name, kind, lead, weave=0, **options):
    cell, _, motion = planned(name)
    parameters = ProgramParameters(
        post="fanuc", motion=kind, trigger=TriggerParameters(lead=lead), **options
    )
    program = build(motion, cell, dataclasses.replace(BARE, weave=weave), parameters, "job")
    return cell, motion, program, fanuc.write(program)


def find_errors(cell, motion, program, files):
    try:
        result = verify(cell, motion, program, files, fanuc, CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


@pytest.mark.parametrize(("name", "kind", "lead"), WAYS)
def test_triggers_come_back_as_planned_and_none_may_be_another(name, kind, lead):
    cell, motion, program, files = plan_program(name, kind, lead)
    assert find_errors(cell, motion, program, files) == set()
    lines = files["JOB.LS"].decode().split("\r\n")
    trigger_lines = [n for n, line in enumerate(lines) if " TB " in line]
    time_text = f"TB{f'{lead:7.2f}'.replace(' 0.0', '  .0') if lead else '   0.00'}sec,"
    assert len(trigger_lines) == 12 and all(time_text in lines[n] for n in trigger_lines)
    assert not [line for line in lines if "DO[" in line and " TB " not in line]
    for n in (trigger_lines[0], trigger_lines[1], trigger_lines[6], trigger_lines[11]):
        previous_move = max(k for k in range(n) if re.match(r" *\d+:[JL] P", lines[k]))
        next_move = min(k for k in range(n + 1, len(lines)) if re.match(r" *\d+:[JL] P", lines[k]))
        option = re.search(r" TB .*?(?= {4};)", lines[n])[0]
        bare, opposite = lines[n].replace(option, ""), "OFF" if option.endswith("ON") else "ON"
        blended = re.compile(r"(FINE|CNT\d+)(?= {4};)")
        changed = {
            "lost": {n: bare},
            "doubled": {n: lines[n].replace(option, 2 * option)},
            "of the move before": {
                previous_move: blended.sub(rf"FINE{option}", lines[previous_move]),
                n: bare,
            },
            "of the move before too": {
                previous_move: blended.sub(rf"\1{option}", lines[previous_move])
            },
            "of the move after": {
                n: bare,
                next_move: blended.sub(rf"FINE{option}", lines[next_move]),
            },
            "sooner": {n: re.sub(r"TB +[\d.]+", f"TB    .{round(100 * lead + 1.1):02d}", lines[n])},
            "later": {
                n: re.sub(r"TB +[\d.]+", f"TB    .{round(abs(100 * lead - 1.1)):02d}", lines[n])
            },
            "behind its end": {n: lines[n].replace(" TB ", " TA ")},
            "of another output": {n: lines[n].replace("DO[1]", "DO[2]")},
            "the other way": {n: re.sub(r"=(ON|OFF)", f"={opposite}", lines[n])},
            "where it stands": {n: f"{bare}\r\n   0:  {option.partition(',')[2]} ;"},
        }
        passed = [
            what
            for what, changed_lines in changed.items()
            if not find_errors(
                cell,
                motion,
                program,
                {
                    "JOB.LS": "\r\n".join(
                        changed_lines.get(k, line) for k, line in enumerate(lines)
                    ).encode()
                },
            )
        ]
        assert passed == []


def test_a_woven_bead_ends_before_its_weave_does():
    cell, motion, program, files = plan_program("fanuc tool-on-robot", "cartesian", 0.05, weave=3)
    assert find_errors(cell, motion, program, files) == set()
    for previous, block in zip(program.blocks, program.blocks[1:]):
        assert not isinstance(block, DepositOff) or isinstance(previous, Moves)
        assert not isinstance(block, Weave) or isinstance(
            previous, DepositOn if block.number else DepositOff
        )
    lines = body(files["JOB.LS"])
    ends = [n for n, line in enumerate(lines) if line == "  Weave End ;"]
    assert len(ends) == 6 and all(
        lines[n - 1].endswith("FINE TB    .05sec,DO[1]=OFF    ;") for n in ends
    )


def test_parts_rests_and_dry_runs_tell_it_as_the_whole_does():
    variant = ("fanuc tool-on-robot", "joint", 0.05)
    cell, motion, _, files = plan_program(*variant)
    complete = fanuc.read(files)
    cut = plan_program(*variant, max_points=10)
    assert len(cut[3]) > 12 and find_errors(*cut) == set()
    in_parts = fanuc.read(cut[3])
    assert (
        in_parts.events == complete.events
        and in_parts.deposit.tolist() == complete.deposit.tolist()
    )
    start = StartParameters(layer=1)
    resumed = fanuc.read(plan_program(*variant, start_at=start)[3])
    first_row = len(complete.deposit) - len(resumed.deposit)
    assert first_row > 0 and not rows_from(motion, start).all()
    events = [(e.row, e.kind, e.value, e.ahead) for e in resumed.events if e.kind in ("on", "off")]
    assert events == [
        (e.row - first_row, e.kind, e.value, e.ahead)
        for e in complete.events
        if e.ahead is not None and e.row > first_row
    ]
    assert len(events) == 6
    dry = plan_program(*variant, dry_run=True)
    assert find_errors(*dry) == set() and b" TB " not in dry[3]["JOB.LS"]
    plain = build(
        motion, cell, BARE, ProgramParameters(post="fanuc", motion="joint", dry_run=True), "job"
    )
    assert dry[3] == fanuc.write(plain)


def test_what_waits_keeps_a_line_of_its_own():
    cell, _, motion = planned("fanuc tool-on-robot")
    parameters = ProgramParameters(
        post="fanuc", motion="joint", trigger=TriggerParameters(lead=0.05)
    )
    for process, on, off in (
        ({"lead_on": 0.3, "lead_off": 0.0}, 0, 6),
        ({"lead_on": 0.0, "lead_off": 0.2}, 6, 0),
        ({"lead_on": 0.0, "lead_off": 0.0, "schedule": 4}, 0, 6),
    ):
        program = build(motion, cell, dataclasses.replace(PROCESS, **process), parameters, "job")
        files = fanuc.write(program)
        assert find_errors(cell, motion, program, files) == set()
        lines = body(files["JOB.LS"])
        output_lines = [
            sum(line.endswith(f" TB    .05sec,DO[1]={word}    ;") for line in lines)
            for word in ("ON", "OFF")
        ]
        assert output_lines == [on, off]
        assert [lines.count(f"  DO[1]={word} ;") for word in ("ON", "OFF")] == [6 - on, 6 - off]
