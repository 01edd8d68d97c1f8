# SPDX-License-Identifier: LGPL-2.1-or-later
"""Schedules in the texts of every post: each bead is told its own before the deposit is on, by output, arc instruction or
call; another one, none, or one too many is refused; so is what a controller cannot be told."""

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
# the number of a schedule as the text of each controller tells it; {} is the output
TOLD = {
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
ON = re.compile(
    r"DO\[1\]=ON|Arc Start\[|SetDO do1,1|digital_out\(0, True\)|\$OUT\[1\]=TRUE|OT#\(1\) ON|ARCON|"
    r"#ArcOnAfter|H1=1|M64 P0|doDeposit=true|ArcLStart"
)
OF = {"contour": 3, "fill": 12}  # schedules, and 7 of the rest
WAYS = [
    (way, by)
    for way in ONE_EACH
    for by in ("output", "arc", "call")
    if by not in catalogue.load(way[0]).NO_SCHEDULE and (*way[:2], by) != ("abb", "joint", "arc")
]


def test_every_post_is_in_the_lists():
    missing = set(catalogue.NAMES) - {way[0] for way in ONE_EACH}
    assert not missing, f"add a way of {missing} to ONE_EACH, see docs/contributing/post.md"


def classed(motion):
    """The motion with beads of three classes in turn."""
    number = (motion.layer + motion.bead) % 3
    return dataclasses.replace(
        motion, bead_class=np.array([CLASSES.index(name) for name in ("wall", *OF)])[number]
    )


def process_of(**more):
    own = "contour: schedule 3, lead_on 0.75; fill: schedule 12, lead_off 1.5"
    return dataclasses.replace(PROCESS, **{"schedule": 7, "classes": own, **more})


# post-flow is in the weld data of ArcTech, and refused
NO_POST_FLOW = {"lead_off": 0.0, "classes": "contour: schedule 3, lead_on 0.75; fill: schedule 12"}


@functools.cache
def written(way, by):
    post, kind, feed, name = way
    cell, _, motion = planned(name)
    motion = classed(motion)
    parameters = ProgramParameters(
        post=post,
        motion=kind,
        nc=NcParameters(feed=feed),
        schedule=ScheduleParameters(by=by, output=20),
    )
    process = process_of(**NO_POST_FLOW) if (post, by) == ("kuka", "arc") else process_of()
    program = build(motion, cell, process, parameters, "job")
    return cell, motion, program, catalogue.load(post).write(program)


def codes(way, by, files):
    cell, motion, program, _ = written(way, by)
    try:
        found = verify(cell, motion, program, files, catalogue.load(way[0]), CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in found.issues if issue.level == ERROR}


def pattern(way, by):
    return TOLD.get((way[0], by)) or r"(?i)schedule(\d+)(?=[:()>;\s]|$)"


def lines_of(files):
    """All lines, program files after each other."""
    programs = [
        files[name].decode("latin-1")
        for name in sorted(files)
        if not name.endswith((".dtx", ".pjx"))
    ]
    return "\n".join(programs).splitlines()


@pytest.mark.parametrize(("way", "by"), WAYS, ids=str)
def test_every_bead_is_told_its_schedule_before_the_deposit_is_on(way, by):
    _, motion, _, files = written(way, by)
    assert codes(way, by, files) == set()
    begins = np.flatnonzero(motion.deposit & (motion.point == 0))
    wanted = [OF.get(CLASSES[number], 7) for number in motion.bead_class[begins]]
    assert len(set(wanted)) == 3
    told, of_bead = [], []
    for line in lines_of(files):
        found = re.search(pattern(way, by), line)
        told += [int(found[1])] if found else []
        if ON.search(line):
            of_bead.append(told[-1])
    assert of_bead == wanted and told == wanted


@pytest.mark.parametrize(("way", "by"), WAYS, ids=str)
def test_another_schedule_none_or_one_more_is_refused(way, by):
    files = written(way, by)[3]
    for name, content in files.items():
        if name.endswith((".dtx", ".pjx")):
            continue
        text = content.decode("latin-1")
        places = list(re.finditer(pattern(way, by), text))
        for number, place in enumerate(places):
            line = text.rfind("\n", 0, place.start()) + 1, text.find("\n", place.end()) + 1
            other = text[: place.start(1)] + str(int(place[1]) + 1 + number) + text[place.end(1) :]
            twice = text[: line[1]] + text[line[0] : line[1]] + text[line[1] :]
            damaged = [other, text[: line[0]] + text[line[1] :], twice] if number < 2 else [other]
            for changed in damaged:
                assert codes(way, by, {**files, name: changed.encode("latin-1")}), (name, place[0])


@pytest.mark.parametrize("way", [way for way, by in WAYS if by == "output"], ids=str)
def test_another_output_is_refused(way):
    files = written(way, "output")[3]
    renamed = {
        name: re.sub(
            rb"GO\[20\]|go20,|register\(20|\$OUT\[20\] TO|OG#\(20\)|H20=|E19 ",
            lambda found: re.sub(rb"20|19", b"24", found[0]),
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
    """Before anything is planned; whatever else is switched on, no word of it comes into a text."""
    cell, reason = planned(setup)[0], catalogue.load(post).NO_SCHEDULE[by]
    asked = ProgramParameters(
        post=post, motion=motion, schedule=ScheduleParameters(by=by, output=20)
    )
    with pytest.raises(InputError) as error:
        refuse(cell, process_of(), asked)
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
    way = next(way for way in ONE_EACH if way[0] == post)
    cell, _, motion = planned(way[3])
    parameters = ProgramParameters(post=post, motion=way[1], schedule=ScheduleParameters(**program))

    def write():
        return catalogue.load(post).write(
            build(classed(motion), cell, process_of(**process), parameters, "job")
        )

    if not code:
        assert write()
        return
    with pytest.raises(InputError) as error:
        write()
    assert error.value.code == code and words in f"{error.value}"


def test_a_dry_run_and_a_job_without_schedules_tell_none():
    way = ONE_EACH[0]
    cell, _, motion = planned(way[3])
    plain = build(motion, cell, PROCESS, ProgramParameters(), "job")
    assert (motion.bead_class == UNKNOWN).all()
    same = build(classed(motion), cell, PROCESS, ProgramParameters(), "job")
    assert catalogue.load("fanuc").write(plain) == catalogue.load("fanuc").write(same)
    for by in ("output", "arc", "call"):
        parameters = ProgramParameters(dry_run=True, schedule=ScheduleParameters(by=by))
        program = build(classed(motion), cell, process_of(), parameters, "job")
        text = b"".join(catalogue.load("fanuc").write(program).values())
        assert not re.search(rb"GO\[|Arc |SCHEDULE", text)
