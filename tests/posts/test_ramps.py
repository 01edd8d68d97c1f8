# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ramps between the starts or ends of beads and their middle: every post plans a steady change of
the speed along the bead, and a text with a sudden change, or with a slightly faster step, is
rejected."""

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
    write_program,
)
from tests.programs import build

pytestmark = pytest.mark.any_version

RAMPS = (5.0, 4.0)  # mm after the start and before the end
MAX_STEP_SHARE = 0.1  # largest change of a step, as a share of the faster speed
USUAL_VARIANTS = ("fanuc cartesian time fanuc tool-on-robot", "linuxcnc joint path table")


def find_errors(variant, speed):
    """Return the error codes of a text with these speeds (n,), verified against the planned job."""
    cell, motion, program, _ = write_program(variant, ramps=RAMPS)
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


def ramp_speed(side, position, length):
    """Return the speed in mm/s at a position along a bead of a side, linear between the speeds of
    the phases."""
    start_length, start_speed, end_length, end_speed = AT_ENDS[side]
    up, down = RAMPS
    knots = (
        [(0.0, start_speed), (start_length, start_speed), (start_length + up, SPEED)]
        if start_speed
        else [(0.0, SPEED)]
    )  # a ramp needs a speed to start from
    knots += [
        (length - end_length - down, SPEED),
        (length - end_length, end_speed),
        (length, end_speed),
    ]
    return np.interp(position, *zip(*knots))


@pytest.mark.parametrize(
    "way",
    [
        variant
        if " ".join(variant) in USUAL_VARIANTS
        else pytest.param(variant, marks=pytest.mark.long)
        for variant in WAYS
        if " ".join(variant) in SPANNING or " ".join(variant) in USUAL_VARIANTS
    ],
    ids=" ".join,
)
def test_the_speed_changes_steadily_and_a_text_that_changes_it_at_once_is_refused(way):
    motion = write_program(way, ramps=RAMPS)[1]
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
            expected = ramp_speed(side, middle, length)
            off = np.abs(motion.speed[rows[1:]] - expected)
            inside = np.abs(expected - SPEED) > 1e-9
            assert (
                off.max() <= MAX_STEP_SHARE * max(expected.max(), SPEED)
                and off[~inside].max(initial=0.0) < 1e-9
            )
            steps = np.abs(np.diff(motion.speed[rows[1:]]))
            assert (
                steps.max() <= MAX_STEP_SHARE * max(expected.max(), SPEED) + 1e-9
            )  # without ramps it changes by 3 or 4 mm/s at once
            start_length, _, end_length, _ = AT_ENDS[side]
            in_ramp = (
                (middle > start_length) & (middle < start_length + RAMPS[0]) & (start_length > 0.0)
            ) | ((middle > length - end_length - RAMPS[1]) & (middle < length - end_length))
            ramped[rows[1:][in_ramp]] = True
            assert len(set(np.round(motion.speed[rows[1:]][in_ramp], 9))) >= 4
            # the time of a steady ramp, up to the error of the steps
            dense = (np.arange(20000) + 0.5) / 20000 * length
            lasts = length * (1.0 / ramp_speed(side, dense, length)).mean()
            assert motion.duration[rows[1:]].sum() == pytest.approx(lasts, rel=2e-3)
    assert find_errors(way, motion.speed) == set()
    assert find_errors(way, np.where(ramped, SPEED, motion.speed)) & {"VERIFY_SPEED", "VERIFY_TIME"}
    row = int(np.flatnonzero(ramped & moves)[2])
    assert find_errors(
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
    """Every value that the text sets in a ramp counts: a changed or missing value is rejected."""
    cell, motion, _, _ = write_program((post, kind, feed, "table"), ramps=RAMPS)
    moves = motion.deposit & (motion.point > 0)
    motion = dataclasses.replace(motion, wire=np.where(motion.deposit, 12.5 * motion.speed, np.nan))
    nc = NcParameters(feed=feed, wire_output=3, wire_gain=0.01, compress=compress)
    program = build(motion, cell, PROCESS, ProgramParameters(post=post, motion=kind, nc=nc), "job")
    files = catalogue.load(post).write(program)

    def codes(program_files):
        result = verify(cell, motion, program, program_files, catalogue.load(post), CHORD_ERROR)
        return {issue.code for issue in result.issues if issue.level == ERROR}

    assert codes(files) == set()
    name = max(files, key=lambda file_name: len(FOLLOWING[post].findall(files[file_name])))
    value_matches = list(FOLLOWING[post].finditer(files[name]))
    ramped = len(set(np.round(motion.speed[moves], 6)))
    assert len(value_matches) >= ramped > 8  # each step of a ramp has its own value
    wire_value = re.compile(
        rb"A_OUTA\[3\]=([0-9.]+)" if post == "siemens" else rb"M6[78] E\d+ Q([0-9.]+)"
    )
    values = np.array(
        [float(value) for text in files.values() for value in wire_value.findall(text)]
    )
    for expected in 0.06 * 0.01 * 12.5 * np.unique(motion.speed[moves]):
        assert np.abs(values - expected).min() <= 1e-4
    for number in range(1, len(value_matches), max(1, len(value_matches) // 5)):
        match = value_matches[number]
        text = files[name]
        changed = (
            text[: match.start(2)] + f"{1.02 * float(match[2]):.6f}".encode() + text[match.end(2) :]
        )
        assert "VERIFY_WIRE" in codes(files | {name: changed})
        line = text.rfind(b"\n", 0, match.start()), text.find(b"\n", match.end())
        assert "VERIFY_WIRE" in codes(files | {name: text[: line[0]] + text[line[1] :]})
