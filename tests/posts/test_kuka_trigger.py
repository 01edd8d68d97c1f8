# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triggers of KUKA modules in planned jobs: read back through two solvers as planned; one that is lost, doubled, moved, or
of another time, output or value is refused."""

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
def made(name, lead):
    cell, _, motion = planned(name)
    parameters = ProgramParameters(
        post="kuka", motion="cartesian", trigger=TriggerParameters(lead=lead)
    )
    program = build(motion, cell, BARE, parameters, "job")
    return cell, motion, program, kuka.write(program)["job.src"].decode()


def said(name, lead, text):
    cell, motion, program, _ = made(name, lead)
    try:
        found = verify(cell, motion, program, {"job.src": text.encode()}, kuka, CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in found.issues if issue.level == ERROR}


@pytest.mark.parametrize("lead", [0.0, 0.0456])
@pytest.mark.parametrize("name", NAMES)
def test_triggers_come_back_as_planned_and_none_may_be_another(name, lead):
    text = made(name, lead)[3]
    assert said(name, lead, text) == set()
    lines = text.split("\r\n")
    places = [n for n, line in enumerate(lines) if line.startswith("TRIGGER")]
    assert len(places) == 12 and all(f"DELAY={-round(1000 * lead)} " in lines[n] for n in places)
    assert not re.search(r"^\$OUT", text, re.MULTILINE)
    for n in (places[0], places[1], places[6], places[11]):
        before = max(k for k in range(n) if lines[k].startswith(("PTP", "LIN")))
        line, other = lines[n], "FALSE" if lines[n].endswith("TRUE") else "TRUE"
        changed = {
            "lost": [*lines[:n], *lines[n + 1 :]],
            "doubled": [*lines[:n], line, *lines[n:]],
            "of the move before": [*lines[:before], line, *lines[before:n], *lines[n + 1 :]],
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
            "the other way": [*lines[:n], re.sub("(TRUE|FALSE)$", other, line), *lines[n + 1 :]],
            "where it stands": [
                *lines[:n],
                lines[n + 1],
                "WAIT SEC 0",
                line.partition(" DO ")[2],
                *lines[n + 2 :],
            ],
        }
        passed = [
            what for what, those in changed.items() if not said(name, lead, "\r\n".join(those))
        ]
        assert passed == []


def test_a_lead_longer_than_the_move_is_by_whole_percents_is_refused():
    """The first way onto a bead takes 0.198 s at 5 %, and 0.2 s were planned."""
    text = made(NAMES[0], 0.198)[3]
    assert "BAS(#VEL_PTP,5)\r\nTRIGGER WHEN DISTANCE=1 DELAY=-198 DO $OUT[1]=TRUE" in text
    with pytest.raises(InputError) as error:
        made(NAMES[0], 0.1999)
    assert (error.value.code, str(error.value.where)) == ("TRIGGER_LEAD", "layer 0 bead 0")


@pytest.mark.parametrize("blend", [100, 30, 0])
def test_a_delay_does_not_reach_back_into_the_corner_before_the_last_move_of_a_bead(blend):
    """It would not come before that corner ends; where there is none, all of the move is before its end."""
    cell, _, motion = planned(NAMES[0])

    def ended(lead):
        asked = ProgramParameters(
            post="kuka", motion="cartesian", blend=blend, trigger=TriggerParameters(lead=lead)
        )
        program = build(motion, cell, BARE, asked, "job")
        blocks = [
            dataclasses.replace(one, ahead=None) if isinstance(one, DepositOn) else one
            for one in program.blocks
        ]
        return dataclasses.replace(program, blocks=tuple(blocks))

    text = kuka.write(ended(0.0))["job.src"].decode()
    corners = [float(size) for size in re.findall(r"APO\.CDIS=([\d.]+)", text)]
    assert bool(corners) == bool(blend)
    beads = [run for run in ended(0.0).moves if run.kind == "deposit"]
    free = []
    for run in beads:
        corner = 0.005 * blend * (run.speed * run.duration).min()  # mm, of half the shortest move
        assert not blend or min(abs(corner - size) for size in corners) <= 0.001
        free.append(run.duration[-1] - corner / run.speed[-1])
    least = min(free)
    assert 0.05 < least < 0.45
    kuka.write(ended(np.floor(1000.0 * least) / 1000.0))
    with pytest.raises(InputError) as error:
        kuka.write(ended(np.ceil(1000.0 * least) / 1000.0 + 0.002))
    assert error.value.code == "TRIGGER_LEAD" and ("corner" in error.value.message) == bool(blend)
    where = [
        f"layer {run.layer} bead {run.bead}"
        for run, there in zip(beads, free)
        if there <= least + 0.002
    ]
    assert str(error.value.where) in where
