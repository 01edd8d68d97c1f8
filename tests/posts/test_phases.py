# SPDX-License-Identifier: LGPL-2.1-or-later
"""Starts and ends of beads have their own speeds in every post, motion and set-up. The plan follows
the distance along the bead, and a text that prints an end at the bead's speed, or one move of it a
little faster, is rejected."""

import dataclasses
import functools

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.parameters.bead_classes import BeadEnd, BeadStart
from freecad_am.core.parameters.program import NcParameters, ProgramParameters, ScheduleParameters
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import (
    AT_ENDS,
    CHORD_ERROR,
    PROCESS,
    SIDES,
    SPEED,
    WAYS,
    wanted_speeds,
    write_program,
)
from tests.programs import build

pytestmark = pytest.mark.any_version

FASTER = 1.05  # more than the coarsest step of a text, a hundredth of VJ, explains


def verify_at_speed(variant, speed):
    """Return the error codes of a text with these speeds (n,), verified against the planned job."""
    cell, motion, program, _ = write_program(variant)
    moves = motion.deposit & (motion.point > 0)
    duration = np.where(moves, motion.duration * motion.speed / speed, motion.duration)
    post, kind, feed, _ = variant
    parameters = ProgramParameters(post=post, motion=kind, nc=NcParameters(feed=feed))
    changed = build(
        dataclasses.replace(motion, speed=speed, duration=duration),
        cell,
        PROCESS,
        parameters,
        "job",
    )
    result = verify(
        cell,
        motion,
        program,
        catalogue.load(post).write(changed),
        catalogue.load(post),
        CHORD_ERROR,
    )
    return {issue.code for issue in result.issues if issue.level == ERROR}


def speeds(motion):
    """Return the expected speeds (n,) in mm/s of the rows, from the distance along their beads
    only."""
    expected = np.array(motion.speed)
    for layer in range(2):
        for side in range(SIDES):
            rows = np.flatnonzero(motion.deposit & (motion.layer == layer) & (motion.bead == side))
            along = np.r_[
                0.0, np.cumsum(np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1))
            ]
            expected[rows[1:]] = wanted_speeds(side, along)
            if AT_ENDS[side]:
                start_length, _, end_length, _ = AT_ENDS[side]
                assert (
                    max(
                        np.abs(along - border).min()
                        for border in (start_length, along[-1] - end_length)
                    )
                    < 2e-3
                )
    return expected


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_another_speed_at_a_start_or_an_end_is_refused(way):
    motion = write_program(way)[1]
    expected, moves = speeds(motion), motion.deposit & (motion.point > 0)
    np.testing.assert_allclose(motion.speed[moves], expected[moves], rtol=1e-9)
    assert verify_at_speed(way, motion.speed) == set()
    differ = moves & (expected != SPEED)
    assert set(expected[differ]) == {5.0, 11.0, 4.0}
    refused = {"VERIFY_SPEED", "VERIFY_TIME"}
    assert (
        verify_at_speed(way, np.where(differ, SPEED, motion.speed)) & refused
    )  # printed at the speed of the rest of the bead
    for row in (np.flatnonzero(differ)[0], np.flatnonzero(differ)[-1]):
        assert (
            verify_at_speed(
                way, np.where(np.arange(len(expected)) == row, FASTER * motion.speed, motion.speed)
            )
            & refused
        )


OWN_SCHEDULES = dataclasses.replace(
    PROCESS, schedule=9, start=BeadStart(4.0, 5.0, 4), end=BeadEnd(2.5, 11.0, 5)
)
LINUXCNC = [variant for variant in WAYS if variant[0] == "linuxcnc"]


@functools.cache
def plan_schedules(variant):
    cell, motion, _, _ = write_program(variant)
    post, kind, feed, _ = variant
    schedule = ScheduleParameters(output=20)
    parameters = ProgramParameters(
        post=post, motion=kind, nc=NcParameters(feed=feed), schedule=schedule
    )
    program = build(motion, cell, OWN_SCHEDULES, parameters, "job")
    return cell, motion, program, catalogue.load(post).write(program)


def find_errors(variant, text):
    cell, motion, program, files = plan_schedules(variant)
    (name,) = files
    try:
        result = verify(
            cell, motion, program, {name: text.encode()}, catalogue.load(variant[0]), CHORD_ERROR
        )
    except InputError as error:
        return {error.code}
    return {issue.code for issue in result.issues if issue.level == ERROR}


@pytest.mark.parametrize("way", LINUXCNC, ids=" ".join)
def test_another_schedule_within_a_bead_another_place_or_way_of_telling_it_is_refused(way):
    (content,) = plan_schedules(way)[3].values()
    text = content.decode()
    assert find_errors(way, text) == set()
    lines = text.split("\n")
    schedule_lines = [k for k, line in enumerate(lines) if line.startswith("M67 E19 Q")]
    ends = sum(bool(end_speeds) * (1 + (end_speeds[:1] != (0.0,))) for end_speeds in AT_ENDS)
    assert len(schedule_lines) == 2 * ends  # after the bead's start, and before its end
    for number in schedule_lines:
        line = lines[number]
        move = next(k for k in range(number, len(lines)) if "G1 " in lines[k]) + 1
        last_move = next(k for k in range(number, 0, -1) if "G1 " in lines[k])
        moved = [*lines[:number], *lines[number + 1 : move], line, *lines[move:]]
        moved_up = [*lines[:last_move], line, *lines[last_move:number], *lines[number + 1 :]]
        for changed in (
            [*lines[:number], line.replace("Q", "Q1"), *lines[number + 1 :]],
            [*lines[:number], line.replace("E19", "E18"), *lines[number + 1 :]],
            [*lines[:number], line.replace("M67", "M68"), *lines[number + 1 :]],
            [*lines[:number], *lines[number + 1 :]],
            [*lines[:number], line, *lines[number:]],
            moved,
            moved_up,
        ):
            assert find_errors(way, "\n".join(changed)), (line, number)
    ahead = next(k for k, line in enumerate(lines) if line.startswith("M68 E19 Q"))
    later = [*lines[:ahead], lines[ahead].replace("M68", "M67"), *lines[ahead + 1 :]]
    assert find_errors(way, "\n".join(later))  # with the next move, the deposit is already on
