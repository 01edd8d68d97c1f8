# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arm contacts along a motion: every step is checked, and each reported contact exists."""

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
    """Sampled joint positions are on the motion and at most a step apart."""
    joints = a_motion(3).joints.copy()
    joints[11] = np.nan
    samples, row, step = watch.places(joints)
    moves = set(np.flatnonzero(np.diff(joints, axis=0, prepend=joints[:1]).any(axis=1))) - {11}
    assert (
        step == watch.STEP and (np.diff(row) >= 0).all() and set(row) - {0} == moves
    )  # row 12 starts again after the gap
    for q, k in zip(samples, row):
        previous = joints[max(k - 1, 0)] if k != 12 else joints[k]
        segment = joints[k] - previous
        share = float((q - previous) @ segment / (segment @ segment)) if segment.any() else 1.0
        assert np.abs(previous + share * segment - q).max() < 1e-9 and -1e-12 < share < 1 + 1e-12
    together = np.diff(row) <= 1
    steps = np.abs(np.diff(samples, axis=0)).max(axis=1)
    assert steps[together & ~np.isin(row[1:], (11, 12, 13))].max() < 2 * step


def test_long_motions_are_looked_at_at_so_many_places(a_motion, monkeypatch):
    """Long motions are sampled with a limited number of positions."""
    monkeypatch.setattr(watch, "MAX_LOOKS", 500)
    samples, _, step = watch.places(a_motion(4).joints)
    assert step > watch.STEP and 500 <= len(samples) <= 502


def test_a_move_that_touches_on_the_way_alone_is_found(a_motion, contact):
    """A move that touches only between its rows is detected."""
    motion = a_motion(5, layers=1, beads=2)
    # bent to one side, then to the other through a pose that touches
    joints = np.tile([0.2, 0.1, 0.1, 0.0, np.radians(60.0), 0.0], (len(motion), 1))
    rapid = int(np.flatnonzero(~motion.deposit)[3])
    joints[rapid:, 3] = np.pi / 2
    joints[rapid, 4] = np.radians(139.0)
    quiet = dataclasses.replace(
        motion, joints=np.where(np.arange(len(motion))[:, None] < rapid, joints, joints[0])
    )
    assert (watch.arm_touches(quiet, contact).link == NONE).all()
    moved = dataclasses.replace(motion, joints=joints)
    contacts = watch.arm_touches(moved, contact)
    assert set(np.flatnonzero(contacts.link != NONE)) == {rapid, rapid + 1}
    assert contacts.link[rapid] == 4 and contacts.names[contacts.what[rapid]] == "plate"
    # between two rows: neither row touches, the move between does
    assert not contact.touches(joints[rapid + 1][None]).any.any()


def test_rows_nearer_than_a_step_are_told_too(a_motion, contact):
    """Rows closer together than a step are reported too."""
    motion = a_motion(6, layers=1, beads=1, points=400)
    joints = np.tile([0.2, 0.1, 0.1, 0.0, 0.0, 0.0], (len(motion), 1))
    joints[:, 4] = np.radians(np.linspace(100.0, 139.0, len(motion)))
    contacts = watch.arm_touches(dataclasses.replace(motion, joints=joints), contact)
    exact_contacts = contact.touches(joints)
    assert exact_contacts.any.any() and not exact_contacts.any.all()
    # the transition may be off by one step
    distances = np.abs(joints[:, 4] - joints[np.argmax(exact_contacts.any), 4])
    assert (
        contacts.link[distances > contacts.step] == exact_contacts.link[distances > contacts.step]
    ).all()


def bend_wrist(joints, random):
    """Joint positions (n, 6) that bend the wrist to and fro in fine and coarse steps, with some
    unreachable rows."""
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
    """Between gaps each row is reported as by sampling everywhere."""
    motion = a_motion(seed, layers=3, beads=2, points=40)
    joints = bend_wrist(motion.joints, np.random.default_rng(seed))
    contacts = watch.arm_touches(dataclasses.replace(motion, joints=joints), contact)
    finest, lone_contacts = np.radians(0.05), 0
    for start, end in zip(*runs(joints)):
        run = joints[start:end]
        path_length = np.r_[0.0, np.cumsum(np.abs(np.diff(run, axis=0)).max(axis=1))]
        s = np.unique(np.r_[np.arange(0.0, path_length[-1], finest), path_length])
        bad = contact.touches(
            np.stack([np.interp(s, path_length, axis) for axis in run.T], axis=1)
        ).any
        for k, row in enumerate(range(start, end)):
            low, high = (
                path_length[max(k - 1, 0)],
                min(path_length[k] + contacts.step, path_length[-1]),
            )
            nearby = bad[(s >= low) & (s <= high)]
            is_reported = contacts.link[row] != NONE
            assert nearby.any() or not is_reported, (
                seed,
                row,
            )  # no false report, in particular none across a gap
            # a contact that lasts a step, or to the end of the run, cannot be missed: one of these
            # rows reports it
            ahead = bad[(s >= path_length[k]) & (s <= high)]
            last_row = start + np.searchsorted(path_length, high)
            assert (contacts.link[row : last_row + 1] != NONE).any() or not ahead.all(), (seed, row)
        lone_contacts += end - start == 1 and bool(bad.any())
    assert (contacts.link[np.isnan(joints[:, 0])] == NONE).all()
    assert lone_contacts  # single rows that touch are among them


def test_the_deposit_of_a_motion_has_the_size_of_its_beads(a_motion):
    """The deposit of a motion has the size of its beads."""
    motion = a_motion(7)
    wide = dataclasses.replace(
        motion, width=np.where(motion.deposit, np.arange(len(motion)) % 5 + 2.0, np.nan)
    )
    deposit, plain = (
        watch.deposit_obstacles(wide, 1.0, 0.5),
        watch.deposit_obstacles(motion, 1.0, 0.5),
    )
    # stadium sections half a mm high: rounded by a quarter and flat between
    assert np.unique(deposit.radius) == pytest.approx([0.25])
    for obstacles_of, low, high in ((deposit, 1.5, 5.5), (plain, 0.5, 0.5)):
        flat = np.linalg.norm(obstacles_of.corners[:, 1] - obstacles_of.corners[:, 0], axis=1)
        assert (flat > low - 1e-9).any() and (flat <= high + 1e-9).all()
    # each segment counts from the row at its end on
    assert set(deposit.since) <= set(range(int(motion.deposit.sum())))
