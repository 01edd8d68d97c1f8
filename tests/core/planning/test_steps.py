# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads in too quick succession: which are programmed, and where the omitted ones are."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.motion import APPROACH, DEPOSIT, TRAVEL, Motion
from freecad_am.core.planning.beads import steps
from freecad_am.posts import catalogue

UR = catalogue.controller("ur")
CHORD, SPEED, LEVER = 0.02, 20.0, 1000.0


def bead(layer, points, speed=SPEED):
    """Rows of a rapid and a bead through points (n, 2) in mm for an arm whose first two axes act
    like prismatic ones."""
    points = np.c_[points, np.zeros(len(points))]
    rows = np.r_[0, 0, np.arange(len(points))]
    deposit = np.r_[False, False, np.ones(len(points), bool)]
    lengths = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)
    joints = np.zeros((len(rows), 6))
    joints[:, :2] = points[rows, :2] / LEVER
    up = np.tile([0.0, 0.0, 1.0], (len(rows), 1))
    return {
        "deposit": deposit,
        "layer": np.full(len(rows), layer),
        "bead": np.zeros(len(rows), int),
        "point": np.r_[0, 0, np.arange(len(points))],
        "position": points[rows],
        "build": up,
        "tool": up,
        "speed": np.where(deposit, speed, 100.0),
        "width": np.full(len(rows), np.nan),
        "joints": joints,
        "duration": np.r_[0.5, 0.1, lengths / speed],
        "role": np.r_[TRAVEL, APPROACH, np.full(len(points), DEPOSIT)],
    }


def motion(*beads):
    return Motion(
        **{
            name: np.concatenate([rows_of_bead[name] for rows_of_bead in beads])
            for name in beads[0]
        }
    )


@pytest.fixture(scope="module")
def wild():
    """Random beads with points from a hundredth of a millisecond to a second apart, in bends of all
    sizes."""
    random = np.random.default_rng(13)
    beads = []
    for layer in range(60):
        lengths = 10.0 ** random.uniform(-4.0, 1.0, random.integers(2, 40))
        heading = np.cumsum(random.normal(0.0, random.choice([0.01, 0.3, 2.0]), len(lengths)))
        steps = lengths[:, None] * np.c_[np.cos(heading), np.sin(heading)]
        beads.append(bead(layer, np.r_[[[0.0, 0.0]], np.cumsum(steps, axis=0)]))
    return motion(*beads)


def test_others_are_told_all(wild):
    """Other controllers receive all points."""
    programmed, rows = steps.programmed(wild, catalogue.controller("abb"), CHORD, 50.0)
    assert programmed is wild and (rows == np.arange(len(wild))).all()


def test_what_comes_late_enough_stays_to_the_bit():
    """Points far enough apart in time are unchanged to the bit."""
    turn = np.linspace(0.0, 6.0, 200)
    motion_ = motion(
        bead(0, 8.0 * np.c_[np.cos(turn), np.sin(turn)]),
        bead(1, [[0.0, 0.0], [0.0401, 0.0], [0.0401, 0.0401]]),
    )
    programmed, rows = steps.programmed(motion_, UR, CHORD, 50.0)
    assert (rows == np.arange(len(motion_))).all()
    for field in dataclasses.fields(Motion):
        assert np.array_equal(
            getattr(programmed, field.name), getattr(motion_, field.name), equal_nan=True
        ), field.name


def test_no_move_is_shorter_than_a_step_and_no_point_lies_off_the_way(wild):
    """No move is shorter than a step, and no omitted point is off the path."""
    programmed, _ = steps.programmed(wild, UR, CHORD, 50.0)
    assert 0.5 * len(wild) < len(programmed) < 0.9 * len(wild)
    inside = programmed.deposit & (programmed.point > 0)
    assert programmed.duration[inside].min() >= 0.002
    lengths = np.linalg.norm(
        np.diff(programmed.position, axis=0, prepend=programmed.position[:1]), axis=1
    )
    assert np.abs(lengths - programmed.speed * programmed.duration)[inside].max() < 1e-9
    for layer in range(60):
        is_original, is_programmed = (
            compared.deposit & (compared.layer == layer) for compared in (wild, programmed)
        )
        points, line = wild.position[is_original, :2], programmed.position[is_programmed, :2]
        assert (points[[0, -1]] == line[[0, -1]]).all()
        a, b = line[:-1], line[1:]
        share = ((points[:, None] - a) * (b - a)).sum(axis=2) / np.maximum(
            ((b - a) ** 2).sum(axis=1), 1e-300
        )
        distances = np.linalg.norm(
            points[:, None] - a - np.clip(share, 0.0, 1.0)[..., None] * (b - a), axis=2
        ).min(axis=1)
        assert distances.max() < 0.4 * CHORD + 1e-9
        # the torch is no faster, and slower only by the steps that corners need
        assert wild.duration[is_original].sum() - 1e-9 <= programmed.duration[is_programmed].sum()
        assert programmed.duration[is_programmed].sum() <= wild.duration[
            is_original
        ].sum() + 0.0021 * len(line)
    assert np.array_equal(programmed.duration[~programmed.deposit], wild.duration[~wild.deposit])


def test_a_corner_that_is_needed_takes_a_step(wild):
    """A lateral step of 0.015 mm within 0.75 ms: omitting it would exceed the allowed deviation."""
    motion_ = motion(bead(0, [[0.0, 0.0], [5.0, 0.0], [5.0, 0.015], [5.0, 5.0]]))
    finer, rows = steps.programmed(motion_, UR, 0.01, 50.0)
    assert rows.tolist() == list(range(6)) and finer.duration[4] == pytest.approx(0.002, rel=1e-3)
    assert finer.speed[4] == pytest.approx(7.5, rel=1e-3) and finer.speed[3] == SPEED
    coarser, rows = steps.programmed(motion_, UR, 0.05, 50.0)
    assert rows.tolist() in ([0, 1, 2, 4, 5], [0, 1, 2, 3, 5])
    assert coarser.duration[2:].sum() == pytest.approx(motion_.duration[2:].sum(), rel=1e-12)


def test_points_too_near_for_a_blend_go_however_slow():
    """Points too near for a blend are omitted at any speed."""
    motion_ = motion(bead(0, [[0.0, 0.0], [3.0, 0.0], [3.004, 0.0], [8.0, 0.0]], speed=1.0))
    assert steps.programmed(motion_, UR, CHORD, 50.0)[1].tolist() in (
        [0, 1, 2, 4, 5],
        [0, 1, 2, 3, 5],
    )
    assert (
        len(steps.programmed(motion_, UR, CHORD, 100.0)[1])
        == len(steps.programmed(motion_, UR, CHORD, 0.0)[1])
        == len(motion_)
    )


def test_points_stay_where_axes_turn_far():
    """As where the torch rotates around the normal over almost no distance."""
    motion_ = motion(bead(0, [[0.0, 0.0], [3.0, 0.0], [3.01, 0.0], [3.02, 0.0], [8.0, 0.0]]))
    joints = motion_.joints.copy()
    joints[5:, 4] += 0.2
    joints[4, 4] += 0.1
    turned = dataclasses.replace(motion_, joints=joints)
    assert (
        len(steps.programmed(motion_, UR, CHORD, 50.0)[1])
        < len(motion_)
        == len(steps.programmed(turned, UR, CHORD, 50.0)[1])
    )


@pytest.mark.parametrize("lead", np.linspace(3.0, 3.0026, 9))
def test_a_bead_that_turns_round_within_a_blend_has_no_point_too_near_another(lead):
    """As where lines of a fill are joined: the distance along the bead is long enough, the distance
    between two points is not."""
    turn = [[lead, 0.0], [lead, 0.0016], [lead + 0.0006, 0.0], [8.0, 0.5], [8.0, 3.0]]
    motion_ = motion(bead(0, [[0.0, 0.0], *turn], speed=1.0))
    programmed, rows = steps.programmed(motion_, UR, CHORD, 100.0)
    inside = programmed.deposit[1:] & (programmed.point[1:] > 0)
    lengths = np.linalg.norm(np.diff(programmed.position, axis=0), axis=1)
    assert lengths[inside].min() >= steps.MIN_STEP_SHARE * UR.least_blend
    # every omitted point is near the remaining path
    for row in sorted(set(range(2, len(motion_))) - set(rows.tolist())):
        start, end = rows[rows < row][-1], rows[rows > row][0]
        line = motion_.position[end] - motion_.position[start]
        share = np.clip(
            (motion_.position[row] - motion_.position[start]) @ line / (line @ line), 0, 1
        )
        off = np.linalg.norm(motion_.position[row] - motion_.position[start] - share * line)
        assert off <= steps.OMITTED_DEVIATION_SHARE * CHORD + 1e-12
