# SPDX-License-Identifier: LGPL-2.1-or-later
"""Starts and ends of beads at speeds of their own, in every post, motion and set-up: planned where the way along the bead
says, and a text that lays them at the bead's speed, or one move of them a little faster, is refused."""

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
    written,
)
from tests.programs import build

pytestmark = pytest.mark.any_version

FASTER = 1.05  # more than the coarsest steps of a text explain, of a hundredth of VJ


def laid_at(way, speed):
    """Codes of errors of the text of a job that is laid at these speeds (n,), against the job as it is planned."""
    cell, motion, program, _ = written(way)
    moves = motion.deposit & (motion.point > 0)
    duration = np.where(moves, motion.duration * motion.speed / speed, motion.duration)
    post, kind, feed, _ = way
    parameters = ProgramParameters(post=post, motion=kind, nc=NcParameters(feed=feed))
    other = build(
        dataclasses.replace(motion, speed=speed, duration=duration),
        cell,
        PROCESS,
        parameters,
        "job",
    )
    found = verify(
        cell, motion, program, catalogue.load(post).write(other), catalogue.load(post), CHORD_ERROR
    )
    return {issue.code for issue in found.issues if issue.level == ERROR}


def speeds(motion):
    """(n,) mm/s that rows are to have, by the way along their beads alone."""
    wanted = np.array(motion.speed)
    for layer in range(2):
        for side in range(SIDES):
            rows = np.flatnonzero(motion.deposit & (motion.layer == layer) & (motion.bead == side))
            along = np.r_[
                0.0, np.cumsum(np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1))
            ]
            wanted[rows[1:]] = wanted_speeds(side, along)
            if AT_ENDS[side]:
                first, _, last, _ = AT_ENDS[side]
                assert (
                    max(np.abs(along - border).min() for border in (first, along[-1] - last)) < 2e-3
                )
    return wanted


@pytest.mark.parametrize("way", WAYS, ids=" ".join)
def test_another_speed_at_a_start_or_an_end_is_refused(way):
    motion = written(way)[1]
    wanted, moves = speeds(motion), motion.deposit & (motion.point > 0)
    np.testing.assert_allclose(motion.speed[moves], wanted[moves], rtol=1e-9)
    assert laid_at(way, motion.speed) == set()
    differ = moves & (wanted != SPEED)
    assert set(wanted[differ]) == {5.0, 11.0, 4.0}
    refused = {"VERIFY_SPEED", "VERIFY_TIME"}
    assert (
        laid_at(way, np.where(differ, SPEED, motion.speed)) & refused
    )  # laid as the rest of the bead
    for row in (np.flatnonzero(differ)[0], np.flatnonzero(differ)[-1]):
        assert (
            laid_at(
                way, np.where(np.arange(len(wanted)) == row, FASTER * motion.speed, motion.speed)
            )
            & refused
        )


OWN_SCHEDULES = dataclasses.replace(
    PROCESS, schedule=9, start=BeadStart(4.0, 5.0, 4), end=BeadEnd(2.5, 11.0, 5)
)
LINUXCNC = [way for way in WAYS if way[0] == "linuxcnc"]


@functools.cache
def scheduled(way):
    cell, motion, _, _ = written(way)
    post, kind, feed, _ = way
    told = ScheduleParameters(output=20)
    parameters = ProgramParameters(
        post=post, motion=kind, nc=NcParameters(feed=feed), schedule=told
    )
    program = build(motion, cell, OWN_SCHEDULES, parameters, "job")
    return cell, motion, program, catalogue.load(post).write(program)


def refused(way, text):
    cell, motion, program, files = scheduled(way)
    (name,) = files
    try:
        found = verify(
            cell, motion, program, {name: text.encode()}, catalogue.load(way[0]), CHORD_ERROR
        )
    except InputError as error:
        return {error.code}
    return {issue.code for issue in found.issues if issue.level == ERROR}


@pytest.mark.parametrize("way", LINUXCNC, ids=" ".join)
def test_another_schedule_within_a_bead_another_place_or_way_of_telling_it_is_refused(way):
    (content,) = scheduled(way)[3].values()
    text = content.decode()
    assert refused(way, text) == set()
    lines = text.split("\n")
    told = [k for k, line in enumerate(lines) if line.startswith("M67 E19 Q")]
    ends = sum(bool(one) * (1 + (one[:1] != (0.0,))) for one in AT_ENDS)
    assert len(told) == 2 * ends  # into the bead from its start, and into its end
    for at in told:
        line = lines[at]
        move = next(k for k in range(at, len(lines)) if "G1 " in lines[k]) + 1
        last = next(k for k in range(at, 0, -1) if "G1 " in lines[k])
        moved = [*lines[:at], *lines[at + 1 : move], line, *lines[move:]]
        before = [*lines[:last], line, *lines[last:at], *lines[at + 1 :]]
        for changed in (
            [*lines[:at], line.replace("Q", "Q1"), *lines[at + 1 :]],
            [*lines[:at], line.replace("E19", "E18"), *lines[at + 1 :]],
            [*lines[:at], line.replace("M67", "M68"), *lines[at + 1 :]],
            [*lines[:at], *lines[at + 1 :]],
            [*lines[:at], line, *lines[at:]],
            moved,
            before,
        ):
            assert refused(way, "\n".join(changed)), (line, at)
    ahead = next(k for k, line in enumerate(lines) if line.startswith("M68 E19 Q"))
    later = [*lines[:ahead], lines[ahead].replace("M68", "M67"), *lines[ahead + 1 :]]
    assert refused(way, "\n".join(later))  # with the next move is after the deposit is on
