# SPDX-License-Identifier: LGPL-2.1-or-later
"""ArcTech in KUKA modules: it lights and ends the beads of planned jobs, which read back through
two solvers. Any of its lines that is lost, doubled, moved or has another number is rejected, and so
is an approach that was not checked."""

import dataclasses
import functools
import re
from types import SimpleNamespace

import numpy as np
import pytest

from freecad_am import kdl as kdl_chain
from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.bead_classes import BeadStart
from freecad_am.core.parameters.program import ProgramParameters, ScheduleParameters
from freecad_am.core.planning import linear_approach
from freecad_am.core.toolpath import BeadRole
from freecad_am.objects.program import Job, posted
from freecad_am.posts import catalogue
from freecad_am.posts.kuka import post as kuka
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, HEIGHT, PROCESS, SETUPS, planned
from tests.posts.test_kuka import JOB, light_arc
from tests.programs import build

ARC = ProgramParameters(post="kuka", motion="cartesian", schedule=ScheduleParameters(by="arc"))
LIT = dataclasses.replace(PROCESS, schedule=7, lead_off=0.0)
NAMES = [
    "kuka tool-on-robot",
    pytest.param("kuka positioner"),
    pytest.param("kuka track", marks=pytest.mark.long),
    pytest.param("kuka track and positioner", marks=pytest.mark.long),
]


@functools.cache
def plan_program(name):
    """Return cell, motion, program and files of a planned job that ArcTech lights."""
    cell, _, motion = planned(name)
    motion = linear_approach.shorten_approaches(motion, cell)
    program = build(motion, cell, LIT, ARC, "job")
    return cell, motion, program, kuka.write(program)


def find_errors(name, text):
    cell, motion, program, _ = plan_program(name)
    try:
        result = verify(
            cell, motion, program, {"job.src": "\r\n".join(text).encode()}, kuka, CHORD_ERROR
        )
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def text_of(name):
    (content,) = plan_program(name)[3].values()
    return content.decode().split("\r\n")


@pytest.mark.parametrize("name", NAMES)
def test_beads_are_lit_and_ended_and_their_speeds_are_told_again(name):
    text = text_of(name)
    assert find_errors(name, text) == set()
    assert not [line for line in text if line.startswith("$OUT")]
    beads = [n for n, line in enumerate(text) if "(#ArcOnAfterMoveStd,WDAT7," in line]
    ends = [n for n, line in enumerate(text) if "(#ArcOffAfterMoveStd,WDATOFF7," in line]
    assert len(beads) == len(ends) == 6 and all(on < off for on, off in zip(beads, ends))
    for on, off in zip(beads, ends):
        # the last move stops, and its speed is stated again after an instruction that may have set
        # another one
        assert text[off - 1].startswith("LIN") and text[off - 1].endswith("}")
        call = max(n for n in range(off) if "(#ArcOffBeforeMoveStd,WDATOFF7," in text[n])
        settings = text[call + 1 : off - 1]
        assert call > on and all(line.startswith("$VEL") for line in settings)
        assert any(line.startswith("$VEL.CP=") for line in settings)
        first_move = next(n for n in range(on + 1, off) if text[n].startswith("LIN"))
        assert any(line.startswith("$VEL.CP=") for line in text[on:first_move])
        assert text[on - 1].startswith("LIN") and "C_DIS" not in text[on - 1]
    readback = kuka.read(plan_program(name)[3])
    switched = [
        (event.kind, *event.value) for event in readback.events if event.kind in ("on", "off")
    ]
    assert switched == [("on", 7.0, "ARC"), ("off", 7.0, "ARC")] * 6


def test_every_line_of_it_that_is_lost_doubled_moved_or_of_other_data_is_refused():
    name = "kuka tool-on-robot"
    text = text_of(name)
    arc_lines = [n for n, line in enumerate(text) if "ArcMainNG" in line]
    assert len(arc_lines) == 6 * 9
    for n in arc_lines[: 2 * 9]:
        line = text[n]
        changed = [*text[:n], line.replace("7", "8"), *text[n + 1 :]]
        assert (
            find_errors(name, changed)
            and find_errors(name, [*text[:n], *text[n + 1 :]])
            and find_errors(name, [*text[:n], line, *text[n:]])
        )
        assert find_errors(name, [*text[: n - 1], line, text[n - 1], *text[n + 1 :]])
        assert find_errors(
            name,
            [*text[:n], re.sub(r"DELAY=(0|\w+\(.*?\))", "DELAY=20", line) + " ", *text[n + 1 :]],
        )
        assert find_errors(name, [*text[:n], line.replace("WSEAM", "WOTHER"), *text[n + 1 :]])


def test_whole_instructions_that_are_lost_or_of_another_schedule_are_refused():
    name, line_count = "kuka tool-on-robot", 9
    text = text_of(name)
    arc_lines = [n for n, line in enumerate(text) if "ArcMainNG" in line]
    for bead in (0, 3):
        of_bead = arc_lines[bead * line_count : (bead + 1) * line_count]
        for lines in (of_bead, of_bead[:5], of_bead[5:]):  # both, the arc's start, its end
            assert find_errors(name, [line for n, line in enumerate(text) if n not in lines])
            changed = [
                line.replace("7", "8", 2) if n in lines else line for n, line in enumerate(text)
            ]
            renumbered = [
                re.sub(r"(WDAT(?:OFF)?)7\b", r"\g<1>8", line) if n in lines else line
                for n, line in enumerate(text)
            ]
            assert find_errors(name, changed) and find_errors(name, renumbered)


@pytest.mark.parametrize(("pattern", "new", "codes"), [
    (r"LIN (\{[^\r\n]*\})\r\nArcMainNG\(#ArcOnAfter", r"LIN \1 C_DIS\r\nArcMainNG(#ArcOnAfter", {"UNREADABLE_PROGRAM"}),
    (r"LIN (\{[^\r\n]*\})\r\nArcMainNG\(#ArcOffAfter", r"LIN \1 C_DIS\r\nArcMainNG(#ArcOffAfter", {"UNREADABLE_PROGRAM"}),
    (r"\$VEL.CP=0.100000\r\n", "", {"UNREADABLE_PROGRAM"}),
    (r"\$VEL.CP=0.100000", "$VEL.CP=0.101000", {"VERIFY_SPEED"}),
    (r"(ArcOffBeforeMoveStd[^\r\n]*\r\n)\$VEL.CP=0.011000\r\n", r"\1", {"UNREADABLE_PROGRAM"}),
    (r"(ArcOffBeforeMoveStd[^\r\n]*\r\n)\$VEL.CP=0.011000", r"\1$VEL.CP=0.010000", {"VERIFY_SPEED"}),
    (r"(ArcOffBeforeMoveStd[^\r\n]*\r\n)", r"\1WAIT SEC 0.5\r\n", {"UNREADABLE_PROGRAM"}),
    (r"(ArcOnAfterMoveStd[^\r\n]*\r\n)", r"\1$OUT[1]=TRUE\r\n", {"UNREADABLE_PROGRAM"}),
    (r"(0.100000\r\nLIN \{X )50.8", r"\g<1>50.9", {"VERIFY_POINT", "VERIFY_ROTATION", "VERIFY_BETWEEN"}),
    (r"(ArcOffBeforeMoveStd[^\r\n]*\r\n)", r"\1BAS(#CP_PARAMS,gArcBasVelDefinition)\r\n", {"UNREADABLE_PROGRAM"}),
])  # fmt: skip
def test_other_moves_at_its_instructions_are_refused(pattern, new, codes):
    name = "kuka tool-on-robot"
    text = "\r\n".join(text_of(name))
    changed = re.sub(pattern, new, text, count=1)
    assert changed != text
    error_codes = find_errors(name, changed.split("\r\n"))
    assert error_codes and error_codes <= codes


def test_the_way_onto_a_bead_stays_by_the_one_that_was_looked_at():
    """The added rows lie on the approach, straight in joint space. A linear move leaves it by at
    most 0.2 mm, by PyKDL; without the rows it would leave it further, which building and reading
    back reject."""
    cell, _, motion_ = planned("kuka positioner")
    motion = linear_approach.shorten_approaches(motion_, cell)
    added = len(motion) - len(motion_)
    assert added and motion.total_time == pytest.approx(motion_.total_time, abs=1e-9)
    solver, checked_rows = kdl_chain.KdlArm(cell.machine), 0
    share = np.linspace(0.0, 1.0, 201)[:, None]
    for end in np.flatnonzero(~motion.deposit[:-1] & motion.deposit[1:]):
        start = np.flatnonzero((motion_.joints == motion.joints[end - 1]).all(axis=1))
        if not len(start):  # an added row, on the line between its neighbours
            previous, current, following = motion.joints[end - 2 : end + 1]
            along = (
                (current - previous)
                @ (following - previous)
                / ((following - previous) @ (following - previous))
            )
            np.testing.assert_allclose(
                current, previous + along * (following - previous), atol=1e-12
            )
            checked_rows += 1
        joints = motion.joints[end - 1] + share * (motion.joints[end] - motion.joints[end - 1])
        tip = cell.tip_in_part(solver.forward(joints))[0]
        straight = motion.position[end - 1] + share * (
            motion.position[end] - motion.position[end - 1]
        )
        assert np.linalg.norm(tip - straight, axis=1).max() <= 0.2
    assert checked_rows == added
    with pytest.raises(InputError) as error:
        build(motion_, cell, LIT, ARC, "job")
    assert error.value.code == "SCHEDULE" and "would leave the checked path" in error.value.message


def test_a_way_that_was_not_looked_at_is_found_by_reading_back(monkeypatch):
    cell, _, motion_ = planned("kuka positioner")
    monkeypatch.setattr(linear_approach, "OFF_WAY_MM", 1.0)
    program = build(motion_, cell, LIT, ARC, "job")
    result = verify(cell, motion_, program, kuka.write(program), kuka, CHORD_ERROR)
    assert {issue.code for issue in result.issues} == {"VERIFY_BETWEEN"}


def test_a_document_cuts_the_ways_onto_beads_and_passes():
    name = "kuka positioner"
    motion = planned(name)[2]
    layers = [SimpleNamespace(wait=0.0, first=0)] * 2
    toolpath = SimpleNamespace(
        frame=np.eye(4), family="developable", chord_error=CHORD_ERROR, layers=layers, height=HEIGHT
    )
    paths = SimpleNamespace(
        beads=[SimpleNamespace(bead=SimpleNamespace(role=BeadRole(returns=True)), layer=9, index=9)]
    )
    path = SimpleNamespace(motion=motion, joint_path=paths)
    job = Job(lambda: path, lambda: toolpath, SETUPS[name].cell, (), LIT, ARC, "job")
    made_of = posted(job)
    assert (
        len(made_of.motion) == len(plan_program(name)[1]) > len(motion)
        and made_of.files == plan_program(name)[3]
    )


def test_a_dry_run_moves_the_same_without_the_arc():
    cell, motion, _, files = plan_program("kuka tool-on-robot")
    dry = kuka.write(build(motion, cell, LIT, dataclasses.replace(ARC, dry_run=True), "job"))
    assert b"Arc" not in dry["job.src"]
    texts = [program_files["job.src"].decode().split("\r\n") for program_files in (files, dry)]
    moving = [[line for line in text if line.startswith(("LIN", "PTP"))] for text in texts]
    assert moving[0] == moving[1]


def test_what_arctech_has_in_its_own_data_or_was_not_confirmed_is_refused():
    cell, motion = plan_program("kuka tool-on-robot")[:2]

    def refusal(process, code, words):
        with pytest.raises(InputError) as error:
            kuka.write(build(motion, cell, process, ARC, "job"))
        assert error.value.code == code and words in error.value.message, error.value.message

    refusal(dataclasses.replace(LIT, lead_off=0.2), "SCHEDULE", "crater time of WDATOFF7")
    refusal(dataclasses.replace(LIT, schedule=None), "NO_SCHEDULE", "arc instructions need")
    refusal(dataclasses.replace(LIT, schedule=256), "SCHEDULE", "up to 255, not 256")
    refusal(
        dataclasses.replace(LIT, start=BeadStart(4.0, 5.0, 4)),
        "SCHEDULE",
        "only an output can change the schedule",
    )


def test_a_program_that_begins_at_a_bead_is_refused():
    cell, _, motion = planned("kuka tool-on-robot")
    first_row = int(np.argmax(motion.deposit))
    columns = {
        field.name: getattr(motion, field.name)[first_row - 1 :]
        for field in dataclasses.fields(motion)
    }
    with pytest.raises(InputError) as error:
        build(type(motion)(**columns), cell, LIT, ARC, "job")
    assert error.value.code == "SCHEDULE" and "begins at the bead" in error.value.message


def test_the_head_tells_the_speeds_that_belong_to_weld_data():
    text = kuka.write(light_arc(JOB))["arc.src"].decode()
    assert "; WDAT3, WDATOFF3: $VEL.CP is 0.006000 m/s\r\n" in text
    assert "; WDAT4, WDATOFF4: $VEL.CP is 0.007500 m/s\r\n" in text
    assert catalogue.load("kuka").NO_SCHEDULE == {}
