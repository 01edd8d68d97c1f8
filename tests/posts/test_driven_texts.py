# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a text makes a cell do, found without the plan it was written from, is the plan; and PyKDL is at the same places."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.posts import catalogue
from freecad_am.read_back import followed
from tests.posts.driven import Drive
from tests.posts.planned_jobs import SPANNING, WAYS, written

pytestmark = pytest.mark.any_version

# mm and rad by which the digits of texts lead away, and s that they are rounded by
APART, TURNED, LATE = 0.03, np.radians(0.02), 0.1


def told(program):
    """What a program says of its cell alone."""
    return dataclasses.replace(program, blocks=(), remarks=())


@pytest.mark.parametrize("way", WAYS, ids=[" ".join(way) for way in WAYS])
@pytest.mark.always(*SPANNING)
def test_the_plan_is_found_again_in_the_text(way):
    cell, planned, program, files = written(way)
    read = catalogue.load(way[0]).read(files)
    motion = followed.drive(cell, told(program), read)
    for column in ("deposit", "layer", "bead", "point"):
        np.testing.assert_array_equal(
            getattr(motion, column), getattr(planned, column), err_msg=column
        )
    np.testing.assert_allclose(motion.position, planned.position, atol=APART)
    np.testing.assert_allclose(motion.tool, planned.tool, atol=TURNED)
    np.testing.assert_allclose(
        motion.duration[2:], planned.duration[2:], atol=LATE
    )  # the first move begins anywhere
    apart = motion.joints - planned.joints
    continuous = cell.limits.continuous
    apart[:, continuous] -= 2.0 * np.pi * np.rint(apart[:, continuous] / (2.0 * np.pi))
    assert np.abs(apart).max() < APART  # mm of axes that slide, rad of others
    assert np.abs(apart[:, ~cell.machine.chain.sliding]).max() < TURNED
    drive, rows = Drive(cell, read, planned.joints[0]), np.flatnonzero(motion.moves)
    for row in range(0, len(rows), 5):
        tip, axis = drive.ends(row)
        np.testing.assert_allclose(motion.position[rows[row]], tip, atol=2e-3)
        np.testing.assert_allclose(motion.tool[rows[row]], axis, atol=2e-5)


def test_the_deposit_is_in_beads_as_long_as_planned():
    cell, planned, program, files = written(WAYS[0])
    motion = followed.drive(cell, told(program), catalogue.load("fanuc").read(files))
    beads = followed.beads(motion)
    assert sum(len(bead.points) for bead in beads) == motion.deposit.sum()
    starts = planned.position[planned.deposit & (planned.point == 0)]
    np.testing.assert_allclose([bead.points[0] for bead in beads], starts, atol=APART)


def test_a_text_that_begins_with_a_position_needs_a_configuration():
    cell, _, program, files = written(next(way for way in WAYS if way[:2] == ("ur", "cartesian")))
    read = catalogue.load("ur").read(files)
    assert read.joints is None
    beside = followed.drive(dataclasses.replace(cell, branch=None), told(program), read)
    bare = dataclasses.replace(read, near=None)
    with pytest.raises(InputError, match=r"branch: \[front, up, flip\]"):
        followed.drive(dataclasses.replace(cell, branch=None), told(program), bare)
    motion = followed.drive(cell, told(program), bare)
    np.testing.assert_allclose(motion.position, beside.position, atol=1e-9)
    assert motion.reachable.all() and beside.reachable.all()
