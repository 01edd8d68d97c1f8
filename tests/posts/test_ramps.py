# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps between starts or ends of beads and the rest of them: planned as a steady change of the speed along the way, in
every post, and a text that changes the speed at once, or where a step is a little faster, is refused."""

import dataclasses
import re

import numpy as np
import pytest

from freecad_am.core.issues import ERROR
from freecad_am.core.parameters.program import NcParameters, ProgramParameters
from freecad_am.posts import catalogue
from freecad_am.verify import verify
from tests.posts.planned_jobs import (
    AT_ENDS,
    CHORD_ERROR,
    PROCESS,
    SIDES,
    SPANNING,
    SPEED,
    WAYS,
    written,
)
from tests.programs import build

pytestmark = pytest.mark.any_version

RAMPS = (5.0, 4.0)  # mm after the start and before the end
STEP = 0.1  # of the faster speed, that a step changes it by at most
USUAL = ("fanuc cartesian time fanuc tool-on-robot", "linuxcnc joint path table")


def refused(way, speed):
    """Codes of errors of the text of a job that is laid at these speeds (n,), against the job as it is planned."""
    cell, motion, program, _ = written(way, ramps=RAMPS)
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


def steady(side, place, length):
    """mm/s where a point is so far along a bead of a side that is so long, by straight lines between the speeds."""
    first, slow, last, late = AT_ENDS[side]
    up, down = RAMPS
    known = (
        [(0.0, slow), (first, slow), (first + up, SPEED)] if slow else [(0.0, SPEED)]
    )  # no ramp from no speed
    known += [(length - last - down, SPEED), (length - last, late), (length, late)]
    return np.interp(place, *zip(*known))


@pytest.mark.parametrize(
    "way",
    [
        way if " ".join(way) in USUAL else pytest.param(way, marks=pytest.mark.long)
        for way in WAYS
        if " ".join(way) in SPANNING or " ".join(way) in USUAL
    ],
    ids=" ".join,
)
def test_the_speed_changes_steadily_and_a_text_that_changes_it_at_once_is_refused(way):
    motion = written(way, ramps=RAMPS)[1]
    moves = motion.deposit & (motion.point > 0)
    ramped = np.zeros(len(moves), dtype=bool)
    for layer in range(2):
        for side in range(SIDES):
            rows = np.flatnonzero(motion.deposit & (motion.layer == layer) & (motion.bead == side))
            along = np.r_[
                0.0, np.cumsum(np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1))
            ]
            if not AT_ENDS[side]:
                assert (motion.speed[rows[1:]] == SPEED).all()
                continue
            middle, length = 0.5 * (along[1:] + along[:-1]), along[-1]
            wanted = steady(side, middle, length)
            off = np.abs(motion.speed[rows[1:]] - wanted)
            inside = np.abs(wanted - SPEED) > 1e-9
            assert (
                off.max() <= STEP * max(wanted.max(), SPEED)
                and off[~inside].max(initial=0.0) < 1e-9
            )
            steps = np.abs(np.diff(motion.speed[rows[1:]]))
            assert (
                steps.max() <= STEP * max(wanted.max(), SPEED) + 1e-9
            )  # without ramps it is 3 or 4 mm/s at once
            first, _, last, _ = AT_ENDS[side]
            in_ramp = ((middle > first) & (middle < first + RAMPS[0]) & (first > 0.0)) | (
                (middle > length - last - RAMPS[1]) & (middle < length - last)
            )
            ramped[rows[1:][in_ramp]] = True
            assert len(set(np.round(motion.speed[rows[1:]][in_ramp], 9))) >= 4
            # the time of a steady ramp, but for what steps are off it
            dense = (np.arange(20000) + 0.5) / 20000 * length
            lasts = length * (1.0 / steady(side, dense, length)).mean()
            assert motion.duration[rows[1:]].sum() == pytest.approx(lasts, rel=2e-3)
    assert refused(way, motion.speed) == set()
    assert refused(way, np.where(ramped, SPEED, motion.speed)) & {"VERIFY_SPEED", "VERIFY_TIME"}
    row = int(np.flatnonzero(ramped & moves)[2])
    assert refused(
        way, np.where(np.arange(len(moves)) == row, 1.05 * motion.speed, motion.speed)
    ) & {"VERIFY_SPEED", "VERIFY_TIME"}


FOLLOWING = {
    "siemens": re.compile(rb"(DO \$A_OUTA\[3\]=)([0-9.]+)"),
    "linuxcnc": re.compile(rb"(M67 E\d+ Q)([0-9.]+)"),
}


@pytest.mark.parametrize(
    "post, kind, feed, compress",
    [
        ("siemens", "joint", "time", False),
        ("siemens", "joint", "path", True),
        ("siemens", "cartesian", "time", True),
        pytest.param("linuxcnc", "joint", "time", False, marks=pytest.mark.long),
    ],
)
def test_a_wire_that_follows_the_speed_is_read_back_through_a_ramp(post, kind, feed, compress):
    """Every value that the text sets in a ramp counts: another one, or one that is missing, is refused."""
    cell, motion, _, _ = written((post, kind, feed, "table"), ramps=RAMPS)
    moves = motion.deposit & (motion.point > 0)
    motion = dataclasses.replace(motion, wire=np.where(motion.deposit, 12.5 * motion.speed, np.nan))
    nc = NcParameters(feed=feed, wire_output=3, wire_gain=0.01, compress=compress)
    program = build(motion, cell, PROCESS, ProgramParameters(post=post, motion=kind, nc=nc), "job")
    files = catalogue.load(post).write(program)

    def codes(of):
        found = verify(cell, motion, program, of, catalogue.load(post), CHORD_ERROR)
        return {issue.code for issue in found.issues if issue.level == ERROR}

    assert codes(files) == set()
    name = max(files, key=lambda one: len(FOLLOWING[post].findall(files[one])))
    places = list(FOLLOWING[post].finditer(files[name]))
    ramped = len(set(np.round(motion.speed[moves], 6)))
    assert len(places) >= ramped > 8  # each step of a ramp has a value of its own
    every = re.compile(
        rb"A_OUTA\[3\]=([0-9.]+)" if post == "siemens" else rb"M6[78] E\d+ Q([0-9.]+)"
    )
    told = np.array([float(one) for text in files.values() for one in every.findall(text)])
    for wanted in 0.06 * 0.01 * 12.5 * np.unique(motion.speed[moves]):
        assert np.abs(told - wanted).min() <= 1e-4
    for number in range(1, len(places), max(1, len(places) // 5)):
        one = places[number]
        text = files[name]
        other = text[: one.start(2)] + f"{1.02 * float(one[2]):.6f}".encode() + text[one.end(2) :]
        assert "VERIFY_WIRE" in codes(files | {name: other})
        line = text.rfind(b"\n", 0, one.start()), text.find(b"\n", one.end())
        assert "VERIFY_WIRE" in codes(files | {name: text[: line[0]] + text[line[1] :]})
