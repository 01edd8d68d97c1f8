# SPDX-License-Identifier: LGPL-2.1-or-later
"""A text driven without its plan makes the cell follow the plan, and PyKDL reaches the same
positions."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.posts import catalogue
from freecad_am.read_back import followed
from tests.posts.driven import Drive
from tests.posts.planned_jobs import SPANNING, WAYS, write_program

pytestmark = pytest.mark.any_version

# largest effect of rounding: mm, rad and s
MAX_DEVIATION, MAX_TURN, MAX_DELAY = 0.03, np.radians(0.02), 0.1


def strip_plan(program):
    """Return what the program alone states about its cell."""
    return dataclasses.replace(program, blocks=(), remarks=())


@pytest.mark.parametrize("way", WAYS, ids=[" ".join(variant) for variant in WAYS])
@pytest.mark.always(*SPANNING)
def test_the_plan_is_found_again_in_the_text(way):
    cell, planned, program, files = write_program(way)
    readback = catalogue.load(way[0]).read(files)
    motion = followed.drive(cell, strip_plan(program), readback)
    for column in ("deposit", "layer", "bead", "point"):
        np.testing.assert_array_equal(
            getattr(motion, column), getattr(planned, column), err_msg=column
        )
    np.testing.assert_allclose(motion.position, planned.position, atol=MAX_DEVIATION)
    np.testing.assert_allclose(motion.tool, planned.tool, atol=MAX_TURN)
    np.testing.assert_allclose(
        motion.duration[2:], planned.duration[2:], atol=MAX_DELAY
    )  # the first move may begin anywhere
    joint_errors = motion.joints - planned.joints
    continuous = cell.limits.continuous
    joint_errors[:, continuous] -= (
        2.0 * np.pi * np.rint(joint_errors[:, continuous] / (2.0 * np.pi))
    )
    assert np.abs(joint_errors).max() < MAX_DEVIATION  # mm for prismatic axes, rad for the others
    assert np.abs(joint_errors[:, ~cell.machine.chain.sliding]).max() < MAX_TURN
    drive, rows = Drive(cell, readback, planned.joints[0]), np.flatnonzero(motion.moves)
    for row in range(0, len(rows), 5):
        tip, axis = drive.ends(row)
        np.testing.assert_allclose(motion.position[rows[row]], tip, atol=2e-3)
        np.testing.assert_allclose(motion.tool[rows[row]], axis, atol=2e-5)


def test_the_deposit_is_in_beads_as_long_as_planned():
    cell, planned, program, files = write_program(WAYS[0])
    motion = followed.drive(cell, strip_plan(program), catalogue.load("fanuc").read(files))
    beads = followed.beads(motion)
    assert sum(len(bead.points) for bead in beads) == motion.deposit.sum()
    starts = planned.position[planned.deposit & (planned.point == 0)]
    np.testing.assert_allclose([bead.points[0] for bead in beads], starts, atol=MAX_DEVIATION)


def test_a_text_that_begins_with_a_position_needs_a_configuration():
    cell, _, program, files = write_program(
        next(variant for variant in WAYS if variant[:2] == ("ur", "cartesian"))
    )
    readback = catalogue.load("ur").read(files)
    assert readback.joints is None
    beside = followed.drive(dataclasses.replace(cell, branch=None), strip_plan(program), readback)
    bare = dataclasses.replace(readback, near=None)
    with pytest.raises(InputError, match=r"branch: \[front, up, flip\]"):
        followed.drive(dataclasses.replace(cell, branch=None), strip_plan(program), bare)
    motion = followed.drive(cell, strip_plan(program), bare)
    np.testing.assert_allclose(motion.position, beside.position, atol=1e-9)
    assert motion.reachable.all() and beside.reachable.all()
