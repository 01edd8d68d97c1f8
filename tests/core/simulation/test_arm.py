# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms along a motion: every step of it is looked at, and what is told is what the arm touches there."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import disc
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links import robot as robot_links
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.kinematics.links.self_collision import NONE
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.simulation import watch


@pytest.fixture(scope="module")
def contact():
    cell = cells.resolve(CellParameters(limits="paper", platform_diameter=0.0), np.eye(4))
    rods = [external_links.solid_cylinders(link) for link in robot_links.solids(cell.machine.chain)]
    return ArmContact(cell, rods, [disc(400.0, np.eye(4), "plate")])


def test_places_are_on_the_motion_and_no_farther_apart_than_a_step(a_motion):
    joints = a_motion(3).joints.copy()
    joints[11] = np.nan
    seen, row, step = watch.places(joints)
    moves = set(np.flatnonzero(np.diff(joints, axis=0, prepend=joints[:1]).any(axis=1))) - {11}
    assert (
        step == watch.STEP and (np.diff(row) >= 0).all() and set(row) - {0} == moves
    )  # 12 begins anew
    for q, k in zip(seen, row):
        before = joints[max(k - 1, 0)] if k != 12 else joints[k]
        way = joints[k] - before
        share = float((q - before) @ way / (way @ way)) if way.any() else 1.0
        assert np.abs(before + share * way - q).max() < 1e-9 and -1e-12 < share < 1 + 1e-12
    together = np.diff(row) <= 1
    near = np.abs(np.diff(seen, axis=0)).max(axis=1)
    assert near[together & ~np.isin(row[1:], (11, 12, 13))].max() < 2 * step


def test_long_motions_are_looked_at_at_so_many_places(a_motion, monkeypatch):
    monkeypatch.setattr(watch, "MAX_LOOKS", 500)
    seen, _, step = watch.places(a_motion(4).joints)
    assert step > watch.STEP and 500 <= len(seen) <= 502


def test_a_move_that_touches_on_the_way_alone_is_found(a_motion, contact):
    motion = a_motion(5, layers=1, beads=2)
    # bent to one side, then to the other the long way round through a pose that touches
    joints = np.tile([0.2, 0.1, 0.1, 0.0, np.radians(60.0), 0.0], (len(motion), 1))
    rapid = int(np.flatnonzero(~motion.deposit)[3])
    joints[rapid:, 3] = np.pi / 2
    joints[rapid, 4] = np.radians(139.0)
    quiet = dataclasses.replace(
        motion, joints=np.where(np.arange(len(motion))[:, None] < rapid, joints, joints[0])
    )
    assert (watch.arm_touches(quiet, contact).link == NONE).all()
    moved = dataclasses.replace(motion, joints=joints)
    found = watch.arm_touches(moved, contact)
    assert set(np.flatnonzero(found.link != NONE)) == {rapid, rapid + 1}
    assert found.link[rapid] == 4 and found.names[found.what[rapid]] == "plate"
    # there and back between two rows: neither row touches, the way does
    assert not contact.touches(joints[rapid + 1][None]).any.any()


def test_rows_nearer_than_a_step_are_told_too(a_motion, contact):
    motion = a_motion(6, layers=1, beads=1, points=400)
    joints = np.tile([0.2, 0.1, 0.1, 0.0, 0.0, 0.0], (len(motion), 1))
    joints[:, 4] = np.radians(np.linspace(100.0, 139.0, len(motion)))
    found = watch.arm_touches(dataclasses.replace(motion, joints=joints), contact)
    each = contact.touches(joints)
    assert each.any.any() and not each.any.all()
    # the border may be as far off as a step
    away = np.abs(joints[:, 4] - joints[np.argmax(each.any), 4])
    assert (found.link[away > found.step] == each.link[away > found.step]).all()


def with_gaps(joints, random):
    """Joints (n, 6) that bend the wrist to and fro by steps fine and coarse, some rows of them unreachable."""
    steps = np.radians(
        random.choice([0.1, 0.7, 4.0, 20.0], len(joints)) * random.choice([-1.0, 1.0], len(joints))
    )
    bent = np.radians(115.0) + np.radians(40.0) * np.sin(np.cumsum(steps))
    joints = np.tile([0.2, 0.1, 0.1, 0.0, 0.0, 0.0], (len(joints), 1))
    joints[:, 4] = bent
    joints[random.uniform(size=len(joints)) < 0.4] = np.nan
    return joints


def runs(joints):
    """First rows and ends of the runs of rows with joint values."""
    edge = np.flatnonzero(np.diff(np.r_[False, np.isfinite(joints[:, 0]), False]))
    return edge[::2], edge[1::2]


@pytest.mark.parametrize("seed", range(6))
def test_between_gaps_every_row_is_told_as_looking_everywhere_tells_it(a_motion, contact, seed):
    motion = a_motion(seed, layers=3, beads=2, points=40)
    joints = with_gaps(motion.joints, np.random.default_rng(seed))
    found = watch.arm_touches(dataclasses.replace(motion, joints=joints), contact)
    finest, seen = np.radians(0.05), 0
    for start, end in zip(*runs(joints)):
        run = joints[start:end]
        way = np.r_[0.0, np.cumsum(np.abs(np.diff(run, axis=0)).max(axis=1))]
        s = np.unique(np.r_[np.arange(0.0, way[-1], finest), way])
        bad = contact.touches(np.stack([np.interp(s, way, axis) for axis in run.T], axis=1)).any
        for k, row in enumerate(range(start, end)):
            low, high = way[max(k - 1, 0)], min(way[k] + found.step, way[-1])
            here = bad[(s >= low) & (s <= high)]
            told = found.link[row] != NONE
            assert here.any() or not told, (
                seed,
                row,
            )  # nothing else is told, least of all what is across a gap
            # what is bad for a step, or up to the end of the run, cannot be stepped over: it is told here or there
            ahead = bad[(s >= way[k]) & (s <= high)]
            there = start + np.searchsorted(way, high)
            assert (found.link[row : there + 1] != NONE).any() or not ahead.all(), (seed, row)
        seen += end - start == 1 and bool(bad.any())
    assert (found.link[np.isnan(joints[:, 0])] == NONE).all()
    assert seen  # lone rows that touch are among them


def test_the_deposit_of_a_motion_has_the_size_of_its_beads(a_motion):
    motion = a_motion(7)
    wide = dataclasses.replace(
        motion, width=np.where(motion.deposit, np.arange(len(motion)) % 5 + 2.0, np.nan)
    )
    made, plain = watch.deposit_obstacles(wide, 1.0, 0.5), watch.deposit_obstacles(motion, 1.0, 0.5)
    # sections of stadiums half a mm high: round by a quarter, and flat between
    assert np.unique(made.radius) == pytest.approx([0.25])
    for laid, low, high in ((made, 1.5, 5.5), (plain, 0.5, 0.5)):
        flat = np.linalg.norm(laid.corners[:, 1] - laid.corners[:, 0], axis=1)
        assert (flat > low - 1e-9).any() and (flat <= high + 1e-9).all()
    # each piece from the row at its end on
    assert set(made.since) <= set(range(int(motion.deposit.sum())))
