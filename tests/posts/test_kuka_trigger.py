# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triggers of KUKA modules in planned jobs read back through two solvers as planned. A lost,
doubled or moved trigger, or one with another time, output or value, is rejected."""

import dataclasses
import functools
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.program import ProgramParameters, TriggerParameters
from freecad_am.core.program import DepositOn
from freecad_am.posts.kuka import post as kuka
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.programs import build

BARE = dataclasses.replace(PROCESS, lead_on=0.0, lead_off=0.0)
NAMES = ["kuka tool-on-robot", pytest.param("kuka positioner", marks=pytest.mark.long)]


@functools.cache
def plan_program(name, lead):
    cell, _, motion = planned(name)
    parameters = ProgramParameters(
        post="kuka", motion="cartesian", trigger=TriggerParameters(lead=lead)
    )
    program = build(motion, cell, BARE, parameters, "job")
    return cell, motion, program, kuka.write(program)["job.src"].decode()


def find_errors(name, lead, text):
    cell, motion, program, _ = plan_program(name, lead)
    try:
        result = verify(cell, motion, program, {"job.src": text.encode()}, kuka, CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


@pytest.mark.parametrize("lead", [0.0, 0.0456])
@pytest.mark.parametrize("name", NAMES)
def test_triggers_come_back_as_planned_and_none_may_be_another(name, lead):
    text = plan_program(name, lead)[3]
    assert find_errors(name, lead, text) == set()
    lines = text.split("\r\n")
    trigger_lines = [n for n, line in enumerate(lines) if line.startswith("TRIGGER")]
    assert len(trigger_lines) == 12 and all(
        f"DELAY={-round(1000 * lead)} " in lines[n] for n in trigger_lines
    )
    assert not re.search(r"^\$OUT", text, re.MULTILINE)
    for n in (trigger_lines[0], trigger_lines[1], trigger_lines[6], trigger_lines[11]):
        previous_move = max(k for k in range(n) if lines[k].startswith(("PTP", "LIN")))
        line, opposite = lines[n], "FALSE" if lines[n].endswith("TRUE") else "TRUE"
        changed = {
            "lost": [*lines[:n], *lines[n + 1 :]],
            "doubled": [*lines[:n], line, *lines[n:]],
            "of the move before": [
                *lines[:previous_move],
                line,
                *lines[previous_move:n],
                *lines[n + 1 :],
            ],
            "of the move after": [*lines[:n], lines[n + 1], line, *lines[n + 2 :]],
            "sooner": [
                *lines[:n],
                re.sub(r"DELAY=-?\d+", f"DELAY={-round(1000 * lead) - 1}", line),
                *lines[n + 1 :],
            ],
            "later": [
                *lines[:n],
                re.sub(r"DELAY=-?\d+", f"DELAY={-round(1000 * lead) + 1}", line),
                *lines[n + 1 :],
            ],
            "of the start": [*lines[:n], line.replace("DISTANCE=1", "DISTANCE=0"), *lines[n + 1 :]],
            "of another output": [*lines[:n], line.replace("$OUT[1]", "$OUT[2]"), *lines[n + 1 :]],
            "the other way": [*lines[:n], re.sub("(TRUE|FALSE)$", opposite, line), *lines[n + 1 :]],
            "where it stands": [
                *lines[:n],
                lines[n + 1],
                "WAIT SEC 0",
                line.partition(" DO ")[2],
                *lines[n + 2 :],
            ],
        }
        passed = [
            what
            for what, changed_lines in changed.items()
            if not find_errors(name, lead, "\r\n".join(changed_lines))
        ]
        assert passed == []


def test_a_lead_longer_than_the_move_is_by_whole_percents_is_refused():
    """The first approach takes 0.198 s at 5 %, whole percents being the only choice, but was
    planned with 0.2 s."""
    text = plan_program(NAMES[0], 0.198)[3]
    assert "BAS(#VEL_PTP,5)\r\nTRIGGER WHEN DISTANCE=1 DELAY=-198 DO $OUT[1]=TRUE" in text
    with pytest.raises(InputError) as error:
        plan_program(NAMES[0], 0.1999)
    assert (error.value.code, str(error.value.where)) == ("TRIGGER_LEAD", "layer 0 bead 0")


@pytest.mark.parametrize("blend", [100, 30, 0])
def test_a_delay_does_not_reach_back_into_the_corner_before_the_last_move_of_a_bead(blend):
    """The trigger would not come before the corner ends; without a corner, all of the move is
    before its end."""
    cell, _, motion = planned(NAMES[0])

    def build_with_lead(lead):
        parameters = ProgramParameters(
            post="kuka", motion="cartesian", blend=blend, trigger=TriggerParameters(lead=lead)
        )
        program = build(motion, cell, BARE, parameters, "job")
        blocks = [
            dataclasses.replace(block, ahead=None) if isinstance(block, DepositOn) else block
            for block in program.blocks
        ]
        return dataclasses.replace(program, blocks=tuple(blocks))

    text = kuka.write(build_with_lead(0.0))["job.src"].decode()
    corners = [float(size) for size in re.findall(r"APO\.CDIS=([\d.]+)", text)]
    assert bool(corners) == bool(blend)
    beads = [run for run in build_with_lead(0.0).moves if run.kind == "deposit"]
    free = []
    for run in beads:
        # mm, within half of the shortest move
        corner = 0.005 * blend * (run.speed * run.duration).min()
        assert not blend or min(abs(corner - size) for size in corners) <= 0.001
        free.append(run.duration[-1] - corner / run.speed[-1])
    shortest = min(free)
    assert 0.05 < shortest < 0.45
    kuka.write(build_with_lead(np.floor(1000.0 * shortest) / 1000.0))
    with pytest.raises(InputError) as error:
        kuka.write(build_with_lead(np.ceil(1000.0 * shortest) / 1000.0 + 0.002))
    assert error.value.code == "TRIGGER_LEAD" and ("corner" in error.value.message) == bool(blend)
    where = [
        f"layer {run.layer} bead {run.bead}"
        for run, free_time in zip(beads, free)
        if free_time <= shortest + 0.002
    ]
    assert str(error.value.where) in where
