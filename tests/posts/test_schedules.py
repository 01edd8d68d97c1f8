# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedules in the texts of every post: each bead gets its own before the deposit is on, by output,
arc instruction or call. A wrong, missing or extra one is rejected, and so is a schedule that a
controller cannot set."""

import dataclasses
import functools
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.motion import UNKNOWN
from freecad_am.core.parameters.bead_classes import CLASSES
from freecad_am.core.parameters.program import NcParameters, ProgramParameters, ScheduleParameters
from freecad_am.objects.program import refuse
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.programs import build

pytestmark = pytest.mark.any_version

ONE_EACH = (
    ("fanuc", "joint", "time", "fanuc tool-on-robot"),
    ("fanuc", "cartesian", "time", "fanuc tool-on-robot"),
    ("staubli", "joint", "time", "staubli tool-on-robot"),
    ("ur", "joint", "time", "ur tool-on-robot"),
    ("abb", "joint", "time", "abb tool-on-robot"),
    ("abb", "cartesian", "time", "abb positioner"),
    ("yaskawa", "joint", "time", "yaskawa tool-on-robot"),
    ("kuka", "cartesian", "time", "kuka tool-on-robot"),
    ("siemens", "joint", "time", "table"),
    ("linuxcnc", "cartesian", "time", "table"),
)
# the number of a schedule in the text of each controller; {} is the output
SCHEDULE_PATTERNS = {
    ("fanuc", "output"): r"GO\[20\]=(\d+) ;",
    ("fanuc", "arc"): r"Arc Start\[(\d+)\]    ;",
    ("abb", "output"): r"SetGO go20,(\d+);",
    ("abb", "arc"): r"ArcLStart .*,seam(\d+),",
    ("ur", "output"): r"write_output_integer_register\(20, (\d+)\)",
    ("kuka", "output"): r"am_schedule=(\d+)",
    ("kuka", "arc"): r"ArcMainNG\(#ArcOnAfterMoveStd,WDAT(\d+),WSEAM\)",
    ("yaskawa", "output"): r"DOUT OG#\(20\) (\d+)",
    ("yaskawa", "arc"): r"ARCON ASF#\((\d+)\)",
    ("siemens", "output"): r"H20=(\d+)",
    ("linuxcnc", "output"): r"M68 E19 Q(\d+)",
}
DEPOSIT_ON = re.compile(
    r"DO\[1\]=ON|Arc Start\[|SetDO do1,1|digital_out\(0, True\)|\$OUT\[1\]=TRUE|OT#\(1\) ON|ARCON|"
    r"#ArcOnAfter|H1=1|M64 P0|doDeposit=true|ArcLStart"
)
CLASS_SCHEDULES = {"contour": 3, "fill": 12}  # schedules of two classes; the others have 7
WAYS = [
    (variant, by)
    for variant in ONE_EACH
    for by in ("output", "arc", "call")
    if by not in catalogue.load(variant[0]).NO_SCHEDULE
    and (*variant[:2], by) != ("abb", "joint", "arc")
]


def test_every_post_is_in_the_lists():
    missing = set(catalogue.NAMES) - {variant[0] for variant in ONE_EACH}
    assert not missing, f"add a way of {missing} to ONE_EACH, see docs/contributing/post.md"


def assign_classes(motion):
    """Return the motion with beads of three classes in turn."""
    number = (motion.layer + motion.bead) % 3
    return dataclasses.replace(
        motion,
        bead_class=np.array([CLASSES.index(name) for name in ("wall", *CLASS_SCHEDULES)])[number],
    )


def process_of(**options):
    class_options = "contour: schedule 3, lead_on 0.75; fill: schedule 12, lead_off 1.5"
    return dataclasses.replace(PROCESS, **{"schedule": 7, "classes": class_options, **options})


# ArcTech has post-flow in its weld data, so the post rejects it here
NO_POST_FLOW = {"lead_off": 0.0, "classes": "contour: schedule 3, lead_on 0.75; fill: schedule 12"}


@functools.cache
def write_program(variant, by):
    post, kind, feed, name = variant
    cell, _, motion = planned(name)
    motion = assign_classes(motion)
    parameters = ProgramParameters(
        post=post,
        motion=kind,
        nc=NcParameters(feed=feed),
        schedule=ScheduleParameters(by=by, output=20),
    )
    process = process_of(**NO_POST_FLOW) if (post, by) == ("kuka", "arc") else process_of()
    program = build(motion, cell, process, parameters, "job")
    return cell, motion, program, catalogue.load(post).write(program)


def codes(variant, by, files):
    cell, motion, program, _ = write_program(variant, by)
    try:
        result = verify(cell, motion, program, files, catalogue.load(variant[0]), CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def pattern(variant, by):
    return SCHEDULE_PATTERNS.get((variant[0], by)) or r"(?i)schedule(\d+)(?=[:()>;\s]|$)"


def lines_of(files):
    """Return all lines, one program file after the other."""
    programs = [
        files[name].decode("latin-1")
        for name in sorted(files)
        if not name.endswith((".dtx", ".pjx"))
    ]
    return "\n".join(programs).splitlines()


@pytest.mark.parametrize(("way", "by"), WAYS, ids=str)
def test_every_bead_is_told_its_schedule_before_the_deposit_is_on(way, by):
    _, motion, _, files = write_program(way, by)
    assert codes(way, by, files) == set()
    begins = np.flatnonzero(motion.deposit & (motion.point == 0))
    expected = [CLASS_SCHEDULES.get(CLASSES[number], 7) for number in motion.bead_class[begins]]
    assert len(set(expected)) == 3
    schedules, of_bead = [], []
    for line in lines_of(files):
        match = re.search(pattern(way, by), line)
        schedules += [int(match[1])] if match else []
        if DEPOSIT_ON.search(line):
            of_bead.append(schedules[-1])
    assert of_bead == expected and schedules == expected


@pytest.mark.parametrize(("way", "by"), WAYS, ids=str)
def test_another_schedule_none_or_one_more_is_refused(way, by):
    files = write_program(way, by)[3]
    for name, content in files.items():
        if name.endswith((".dtx", ".pjx")):
            continue
        text = content.decode("latin-1")
        matches = list(re.finditer(pattern(way, by), text))
        for number, match in enumerate(matches):
            line = text.rfind("\n", 0, match.start()) + 1, text.find("\n", match.end()) + 1
            changed_text = (
                text[: match.start(1)] + str(int(match[1]) + 1 + number) + text[match.end(1) :]
            )
            twice = text[: line[1]] + text[line[0] : line[1]] + text[line[1] :]
            damaged = (
                [changed_text, text[: line[0]] + text[line[1] :], twice]
                if number < 2
                else [changed_text]
            )
            for changed in damaged:
                assert codes(way, by, {**files, name: changed.encode("latin-1")}), (name, match[0])


@pytest.mark.parametrize("way", [variant for variant, by in WAYS if by == "output"], ids=str)
def test_another_output_is_refused(way):
    files = write_program(way, "output")[3]
    renamed = {
        name: re.sub(
            rb"GO\[20\]|go20,|register\(20|\$OUT\[20\] TO|OG#\(20\)|H20=|E19 ",
            lambda match: re.sub(rb"20|19", b"24", match[0]),
            content,
        )
        for name, content in files.items()
    }
    assert renamed != files and codes(way, "output", renamed)


@pytest.mark.parametrize(
    ("post", "by", "motion", "setup", "why"),
    [
        ("staubli", "output", "joint", "staubli tool-on-robot", "VAL 3"),
        ("ur", "arc", "joint", "ur tool-on-robot", "URScript"),
        ("siemens", "arc", "joint", "table", ""),
        ("linuxcnc", "arc", "joint", "table", ""),
        ("staubli", "arc", "joint", "staubli tool-on-robot", ""),
    ],
)
def test_what_a_controller_cannot_be_told_is_refused_and_its_page_says_so(
    post, by, motion, setup, why, root
):
    """The post rejects such a schedule before planning, and its page says so; no other option
    brings a schedule into the text."""
    cell, reason = planned(setup)[0], catalogue.load(post).NO_SCHEDULE[by]
    parameters = ProgramParameters(
        post=post, motion=motion, schedule=ScheduleParameters(by=by, output=20)
    )
    with pytest.raises(InputError) as error:
        refuse(cell, process_of(), parameters)
    assert error.value.code == "SCHEDULE" and reason in error.value.message and why in reason
    page = (root / "docs" / "posts" / f"{post}.md").read_text(encoding="utf-8")
    assert ("(`SCHEDULE`)" in page or "rc instructions there are none" in page) and why in page


@pytest.mark.parametrize(
    ("process", "program", "code", "words"),
    [
        ({"schedule": None}, {}, "NO_SCHEDULE", "beads of the class wall"),
        ({}, {"output": 20, "post": "yaskawa"}, "", ""),
        ({"schedule": 300}, {"post": "yaskawa"}, "SCHEDULE", "up to 255, not 300"),
        ({"schedule": 300}, {"post": "yaskawa", "by": "arc"}, "", ""),
        ({"schedule": 300}, {"post": "kuka"}, "SCHEDULE", "up to 255, not 300"),
        ({}, {"post": "ur", "output": 48}, "SCHEDULE", "need an output from 1 to 47, not 48"),
        ({}, {"post": "kuka", "output": 1}, "SCHEDULE", "includes the output of the deposit"),
        ({}, {"post": "siemens", "output": 1}, "SCHEDULE", "H1 switches the deposit"),
        (
            {"classes": "none", "schedule": None},
            {"post": "fanuc", "by": "arc"},
            "NO_SCHEDULE",
            "which arc instructions need",
        ),
        ({}, {"post": "fanuc", "by": "call", "call": "9 lives"}, "PROGRAM_NAME", "9 lives"),
    ],
)
def test_numbers_that_cannot_be_told_are_refused(process, program, code, words):
    post = program.pop("post", "fanuc")
    variant = next(variant for variant in ONE_EACH if variant[0] == post)
    cell, _, motion = planned(variant[3])
    parameters = ProgramParameters(
        post=post, motion=variant[1], schedule=ScheduleParameters(**program)
    )

    def write():
        return catalogue.load(post).write(
            build(assign_classes(motion), cell, process_of(**process), parameters, "job")
        )

    if not code:
        assert write()
        return
    with pytest.raises(InputError) as error:
        write()
    assert error.value.code == code and words in f"{error.value}"


def test_a_dry_run_and_a_job_without_schedules_tell_none():
    variant = ONE_EACH[0]
    cell, _, motion = planned(variant[3])
    plain = build(motion, cell, PROCESS, ProgramParameters(), "job")
    assert (motion.bead_class == UNKNOWN).all()
    same = build(assign_classes(motion), cell, PROCESS, ProgramParameters(), "job")
    assert catalogue.load("fanuc").write(plain) == catalogue.load("fanuc").write(same)
    for by in ("output", "arc", "call"):
        parameters = ProgramParameters(dry_run=True, schedule=ScheduleParameters(by=by))
        program = build(assign_classes(motion), cell, process_of(), parameters, "job")
        text = b"".join(catalogue.load("fanuc").write(program).values())
        assert not re.search(rb"GO\[|Arc |SCHEDULE", text)
