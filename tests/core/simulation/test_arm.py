# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms along a motion: every step of it is looked at, and what is told is what the arm touches there."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry.surroundings import disc
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.arm_contact import NONE, ArmContact
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.simulation import arm as arms
from freecad_am.core.simulation import link_rods, robot_links


@pytest.fixture(scope="module")
def contact():
    cell = cells.resolve(CellParameters(limits="paper", platform_diameter=0.0), np.eye(4))
    rods = [link_rods.of_solids(link) for link in robot_links.solids(cell.machine.chain)]
    return ArmContact(cell, rods, [disc(400.0, np.eye(4), "plate")])


def test_places_are_on_the_motion_and_no_farther_apart_than_a_step(a_motion):
    joints = a_motion(3).joints.copy()
    joints[11] = np.nan
    seen, row, step = arms.places(joints)
    moves = set(np.flatnonzero(np.diff(joints, axis=0, prepend=joints[:1]).any(axis=1))) - {11, 12}
    assert step == arms.STEP and (np.diff(row) >= 0).all() and set(row) - {0} == moves
    for q, k in zip(seen, row):
        before = joints[max(k - 1, 0)]
        way = joints[k] - before
        share = float((q - before) @ way / (way @ way)) if way.any() else 1.0
        assert np.abs(before + share * way - q).max() < 1e-9 and -1e-12 < share < 1 + 1e-12
    together = np.diff(row) <= 1
    near = np.abs(np.diff(seen, axis=0)).max(axis=1)
    assert near[together & ~np.isin(row[1:], (11, 12, 13))].max() < 2 * step


def test_long_motions_are_looked_at_at_so_many_places(a_motion, monkeypatch):
    monkeypatch.setattr(arms, "MOST", 500)
    seen, _, step = arms.places(a_motion(4).joints)
    assert step > arms.STEP and 500 <= len(seen) <= 502


def test_a_move_that_touches_on_the_way_alone_is_found(a_motion, contact):
    motion = a_motion(5, layers=1, beads=2)
    # bent to one side, then to the other the long way round through a pose that touches
    joints = np.tile([0.2, 0.1, 0.1, 0.0, np.radians(60.0), 0.0], (len(motion), 1))
    rapid = int(np.flatnonzero(~motion.deposit)[3])
    joints[rapid:, 3] = np.pi / 2
    joints[rapid, 4] = np.radians(139.0)
    quiet = dataclasses.replace(motion, joints=np.where(np.arange(len(motion))[:, None] < rapid, joints, joints[0]))
    assert (arms.arm_touches(quiet, contact).link == NONE).all()
    moved = dataclasses.replace(motion, joints=joints)
    found = arms.arm_touches(moved, contact)
    assert set(np.flatnonzero(found.link != NONE)) == {rapid, rapid + 1}
    assert found.link[rapid] == 4 and found.names[found.what[rapid]] == "plate"
    # there and back between two rows: neither row touches, the way does
    assert not contact.touches(joints[rapid + 1][None]).any.any()


def test_rows_nearer_than_a_step_are_told_too(a_motion, contact):
    motion = a_motion(6, layers=1, beads=1, points=400)
    joints = np.tile([0.2, 0.1, 0.1, 0.0, 0.0, 0.0], (len(motion), 1))
    joints[:, 4] = np.radians(np.linspace(100.0, 139.0, len(motion)))
    found = arms.arm_touches(dataclasses.replace(motion, joints=joints), contact)
    each = contact.touches(joints)
    assert each.any.any() and not each.any.all()
    # the border may be as far off as a step
    away = np.abs(joints[:, 4] - joints[np.argmax(each.any), 4])
    assert (found.link[away > found.step] == each.link[away > found.step]).all()


def test_the_deposit_of_a_motion_has_the_size_of_its_beads(a_motion):
    motion = a_motion(7)
    wide = dataclasses.replace(motion, width=np.where(motion.deposit, np.arange(len(motion)) % 5 + 2.0, np.nan))
    made = arms.laid(wide, 1.0, 0.5)
    assert len(made.points) == motion.deposit.sum()  # random points are far apart
    assert made.room == pytest.approx(np.hypot(3.0, 0.25))
    assert arms.laid(motion, 1.0, 0.5).room >= np.hypot(0.5, 0.25)
