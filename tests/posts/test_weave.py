# SPDX-License-Identifier: LGPL-2.1-or-later
"""The controller's own weave: each bead has that of its class between its start and end, and no
other. Any other text is rejected, and so is a weave that a controller cannot run."""

import dataclasses
import functools
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.bead_classes import CLASSES
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.program import DepositOff, DepositOn, Weave
from freecad_am.objects.program import refuse
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.fanuc_programs import GOLDEN_TABLE
from tests.posts.planned_jobs import CHORD_ERROR, PROCESS, planned
from tests.posts.test_yaskawa import GOLDENS, find_faults
from tests.programs import build

pytestmark = pytest.mark.any_version

SETUPS = {"fanuc": "fanuc tool-on-robot", "yaskawa": "yaskawa tool-on-robot"}
BEGINS = {"fanuc": r"Weave Sine\[(\d+)\]", "yaskawa": r"WVON WEV#\((\d+)\)"}
ENDS = {"fanuc": r"Weave End", "yaskawa": r"WVOF"}
WEAVE_ON, WEAVE_OFF = (
    {"fanuc": r"DO\[1\]=ON", "yaskawa": r"OT#\(1\) ON"},
    {"fanuc": r"DO\[1\]=OFF", "yaskawa": r"OT#\(1\) OFF"},
)
MOVE = {"fanuc": r"^ *\d+:([JL]) P\[", "yaskawa": r"^MOV([JL]) "}
REFUSED_BY_READER = {
    "yaskawa": ["UNREADABLE_PROGRAM"]
}  # their readers pair the starts and ends of weaves
CLASS_WEAVES = {
    "wall": 4,
    "contour": 2,
    "fill": None,
}  # the weave of the process, another one, and none


@functools.cache
def write_program(post, dry_run=False):
    cell, _, motion = planned(SETUPS[post])
    number = (motion.layer + motion.bead) % 3
    motion = dataclasses.replace(
        motion, bead_class=np.array([CLASSES.index(name) for name in CLASS_WEAVES])[number]
    )
    process = dataclasses.replace(PROCESS, weave=4, classes="contour: weave 2; fill: weave 0")
    program = build(
        motion,
        cell,
        process,
        ProgramParameters(post=post, motion="cartesian", dry_run=dry_run),
        "job",
    )
    return cell, motion, program, catalogue.load(post).write(program)


def codes(post, files):
    cell, motion, program, _ = write_program(post)
    try:
        result = verify(cell, motion, program, files, catalogue.load(post), CHORD_ERROR)
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


def instructions(files):
    return [line for name in sorted(files) for line in files[name].decode("latin-1").splitlines()]


@pytest.mark.parametrize("post", SETUPS)
@pytest.mark.parametrize("dry_run", [False, True])
def test_every_linear_move_of_a_bead_is_woven_as_its_class_says_and_no_rapid_is(post, dry_run):
    _, motion, _, files = write_program(post, dry_run)
    assert dry_run or codes(post, files) == set()
    weave, on, of_bead, moved = None, dry_run, [], False
    for line in instructions(files):
        if match := re.search(BEGINS[post], line):
            assert weave is None and on
            weave = int(match[1])
        elif re.search(ENDS[post], line):
            assert weave is not None and on
            weave = None
        elif re.search(WEAVE_ON[post], line):
            on = True
        elif re.search(WEAVE_OFF[post], line):
            assert weave is None
            on = False
        elif move := re.match(MOVE[post], line):
            straight = move[1] == "L"
            if straight and not moved:
                of_bead.append(weave)
            assert weave == (of_bead[-1] if straight else None)
            moved = straight
    begins = np.flatnonzero(motion.deposit & (motion.point == 0))
    assert of_bead == [CLASS_WEAVES[CLASSES[number]] for number in motion.bead_class[begins]]
    assert set(of_bead) == {4, 2, None} and weave is None


@pytest.mark.parametrize("post", SETUPS)
def test_a_text_with_another_weave_is_refused(post):
    files = write_program(post)[3]
    begin, end = (rf"(?m)^[^\n]*{pattern[post]}[^\n]*\n" for pattern in (BEGINS, ENDS))
    move = rf"(?m){MOVE[post]}[^\n]*\n"
    attempts = 0
    for name, content in files.items():
        text = content.decode("latin-1")
        for pattern in (begin, end):
            for match in list(re.finditer(pattern, text))[:4]:
                line, text_before, text_after = match[0], text[: match.start()], text[match.end() :]
                following = re.compile(move).search(text_after)
                earlier = list(re.finditer(move, text_before))
                changed = [text_before + text_after, text_before + line + line + text_after]
                if following:
                    changed.append(
                        text_before
                        + text_after[: following.end()]
                        + line
                        + text_after[following.end() :]
                    )
                if earlier:
                    changed.append(
                        text_before[: earlier[-1].start()]
                        + line
                        + text_before[earlier[-1].start() :]
                        + text_after
                    )
                if number := re.search(BEGINS[post], line):
                    changed.append(
                        text_before
                        + line.replace(number[1] + number[0][-1], f"9{number[0][-1]}")
                        + text_after
                    )
                for damaged in changed:
                    attempts += 1
                    assert codes(post, {**files, name: damaged.encode("latin-1")}) & {
                        "VERIFY_WEAVE",
                        "VERIFY_ORDER",
                        *REFUSED_BY_READER.get(post, ()),
                    }, line
    assert attempts > 20


def add_weave(source, number):
    """Return the program with the weave in its beads."""
    blocks = []
    for block in source.blocks:
        ends = [Weave(0)] if isinstance(block, DepositOff) else []
        blocks += [*ends, block, *([Weave(number)] if isinstance(block, DepositOn) else [])]
    return dataclasses.replace(source, blocks=tuple(blocks), name="woven")


def test_golden_programs_to_the_byte(root, assert_listings):
    listing = catalogue.load("fanuc").write(add_weave(GOLDEN_TABLE, 12))
    assert listing == {"WOVEN.LS": (root / "tests/golden/fanuc/WOVEN.LS").read_bytes()}
    assert_listings(listing)
    job = catalogue.load("yaskawa").write(add_weave(GOLDENS["linear"], 255))
    assert job == {"WOVEN.JBI": (root / "tests/golden/yaskawa/WOVEN.JBI").read_bytes()}
    assert list(find_faults("WOVEN.JBI", job["WOVEN.JBI"])) == []


@pytest.mark.parametrize("post", SETUPS)
def test_a_woven_bead_is_not_cut_apart_and_a_straight_one_is(post):
    program = write_program(post)[2]
    max_points = int(max(len(run) for run in program.moves)) - 1
    with pytest.raises(InputError) as error:
        catalogue.load(post).write(dataclasses.replace(program, max_points=max_points))
    assert (error.value.code, error.value.where) == ("BEAD_TOO_LONG", "program.max_points")
    assert "woven" in error.value.message
    straight = tuple(block for block in program.blocks if not isinstance(block, Weave))
    assert (
        len(
            catalogue.load(post).write(
                dataclasses.replace(program, blocks=straight, max_points=max_points)
            )
        )
        > 1
    )


@pytest.mark.parametrize(
    ("post", "motion", "setup", "where", "words"),
    [
        ("abb", "cartesian", "abb tool-on-robot", "process.weave", "ArcL"),
        ("kuka", "cartesian", "kuka tool-on-robot", "process.weave", "ArcTech"),
        ("ur", "cartesian", "ur tool-on-robot", "process.weave", "URScript"),
        ("staubli", "joint", "staubli tool-on-robot", "process.weave", "VAL 3"),
        ("siemens", "joint", "table", "process.weave", "five-axis"),
        ("linuxcnc", "joint", "table", "process.weave", "five-axis"),
        ("fanuc", "joint", "fanuc part-on-robot", "program.motion", "joint moves"),
        ("yaskawa", "joint", "yaskawa tool-on-robot", "program.motion", "joint moves"),
    ],
)
@pytest.mark.parametrize(
    "process", [ProcessParameters(weave=1), ProcessParameters(classes="fill: weave 3")]
)
def test_what_cannot_be_woven_is_refused_before_planning(
    post, motion, setup, where, words, process
):
    cell = planned(setup)[0]
    parameters = ProgramParameters(post=post, motion=motion)
    refuse(
        cell, ProcessParameters(weave=0, classes="fill: weave 0"), parameters
    )  # every controller can print straight beads
    with pytest.raises(InputError) as error:
        refuse(cell, process, parameters)
    assert (error.value.code, error.value.where) == ("WEAVE", where)
    assert (
        words in error.value.message
        and "fanuc, yaskawa; abb with program.schedule.by: arc" in error.value.message
    )


@pytest.mark.parametrize("post", SETUPS)
def test_posts_refuse_what_they_are_given_wrongly(post):
    program = write_program(post)[2]
    joint = dataclasses.replace(program, motion="joint")
    large = tuple(
        Weave(256) if isinstance(block, Weave) and block.number else block
        for block in program.blocks
    )
    for wrong in (joint, dataclasses.replace(program, blocks=large)):
        with pytest.raises(InputError) as error:
            catalogue.load(post).write(wrong)
        assert error.value.code == "WEAVE"


@pytest.mark.parametrize(
    "text", ["fill: weave 256", "fill: weave -1", "fill: weave 2.5", "fill: weave sine"]
)
def test_weaves_that_are_not_numbers_of_one_are_refused(text):
    with pytest.raises(InputError) as error:
        ProcessParameters(classes=text)
    assert error.value.code == "BAD_VALUE" and "fill" in f"{error.value}"
