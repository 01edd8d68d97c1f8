# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads that come too soon after others: which are told, and where those that are not lie."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.motion import APPROACH, DEPOSIT, TRAVEL, Motion
from freecad_am.core.planning.beads import steps
from freecad_am.posts import catalogue

UR = catalogue.controller("ur")
CHORD, SPEED, LEVER = 0.02, 20.0, 1000.0


def bead(layer, points, speed=SPEED):
    """Rows of a rapid and a bead through points (n, 2) mm by an arm whose first two axes move it as slides would."""
    points = np.c_[points, np.zeros(len(points))]
    rows = np.r_[0, 0, np.arange(len(points))]
    deposit = np.r_[False, False, np.ones(len(points), bool)]
    way = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)
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
        "duration": np.r_[0.5, 0.1, way / speed],
        "role": np.r_[TRAVEL, APPROACH, np.full(len(points), DEPOSIT)],
    }


def motion(*beads):
    return Motion(**{name: np.concatenate([one[name] for one in beads]) for name in beads[0]})


@pytest.fixture(scope="module")
def wild():
    """Beads that wander, with points from a hundredth of a millisecond to a second apart, in bends of all sizes."""
    random = np.random.default_rng(13)
    made = []
    for layer in range(60):
        way = 10.0 ** random.uniform(-4.0, 1.0, random.integers(2, 40))
        heading = np.cumsum(random.normal(0.0, random.choice([0.01, 0.3, 2.0]), len(way)))
        steps = way[:, None] * np.c_[np.cos(heading), np.sin(heading)]
        made.append(bead(layer, np.r_[[[0.0, 0.0]], np.cumsum(steps, axis=0)]))
    return motion(*made)


def test_others_are_told_all(wild):
    told, rows = steps.programmed(wild, catalogue.controller("abb"), CHORD, 50.0)
    assert told is wild and (rows == np.arange(len(wild))).all()


def test_what_comes_late_enough_stays_to_the_bit():
    turn = np.linspace(0.0, 6.0, 200)
    one = motion(
        bead(0, 8.0 * np.c_[np.cos(turn), np.sin(turn)]),
        bead(1, [[0.0, 0.0], [0.0401, 0.0], [0.0401, 0.0401]]),
    )
    told, rows = steps.programmed(one, UR, CHORD, 50.0)
    assert (rows == np.arange(len(one))).all()
    for field in dataclasses.fields(Motion):
        assert np.array_equal(
            getattr(told, field.name), getattr(one, field.name), equal_nan=True
        ), field.name


def test_no_move_is_shorter_than_a_step_and_no_point_lies_off_the_way(wild):
    told, _ = steps.programmed(wild, UR, CHORD, 50.0)
    assert 0.5 * len(wild) < len(told) < 0.9 * len(wild)
    inside = told.deposit & (told.point > 0)
    assert told.duration[inside].min() >= 0.002
    way = np.linalg.norm(np.diff(told.position, axis=0, prepend=told.position[:1]), axis=1)
    assert np.abs(way - told.speed * told.duration)[inside].max() < 1e-9
    for layer in range(60):
        before, after = (one.deposit & (one.layer == layer) for one in (wild, told))
        points, line = wild.position[before, :2], told.position[after, :2]
        assert (points[[0, -1]] == line[[0, -1]]).all()
        a, b = line[:-1], line[1:]
        share = ((points[:, None] - a) * (b - a)).sum(axis=2) / np.maximum(
            ((b - a) ** 2).sum(axis=1), 1e-300
        )
        away = np.linalg.norm(
            points[:, None] - a - np.clip(share, 0.0, 1.0)[..., None] * (b - a), axis=2
        ).min(axis=1)
        assert away.max() < 0.4 * CHORD + 1e-9
        # the torch is no faster, and slower only by the steps that corners need
        assert wild.duration[before].sum() - 1e-9 <= told.duration[after].sum()
        assert told.duration[after].sum() <= wild.duration[before].sum() + 0.0021 * len(line)
    assert np.array_equal(told.duration[~told.deposit], wild.duration[~wild.deposit])


def test_a_corner_that_is_needed_takes_a_step(wild):
    """A step aside of 0.015 mm, within 0.75 ms: leaving it out would be off by more than is allowed."""
    one = motion(bead(0, [[0.0, 0.0], [5.0, 0.0], [5.0, 0.015], [5.0, 5.0]]))
    finer, rows = steps.programmed(one, UR, 0.01, 50.0)
    assert rows.tolist() == list(range(6)) and finer.duration[4] == pytest.approx(0.002, rel=1e-3)
    assert finer.speed[4] == pytest.approx(7.5, rel=1e-3) and finer.speed[3] == SPEED
    coarser, rows = steps.programmed(one, UR, 0.05, 50.0)
    assert rows.tolist() in ([0, 1, 2, 4, 5], [0, 1, 2, 3, 5])
    assert coarser.duration[2:].sum() == pytest.approx(one.duration[2:].sum(), rel=1e-12)


def test_points_too_near_for_a_blend_go_however_slow():
    one = motion(bead(0, [[0.0, 0.0], [3.0, 0.0], [3.004, 0.0], [8.0, 0.0]], speed=1.0))
    assert steps.programmed(one, UR, CHORD, 50.0)[1].tolist() in ([0, 1, 2, 4, 5], [0, 1, 2, 3, 5])
    assert (
        len(steps.programmed(one, UR, CHORD, 100.0)[1])
        == len(steps.programmed(one, UR, CHORD, 0.0)[1])
        == len(one)
    )


def test_points_stay_where_axes_turn_far():
    """As where the torch goes round the normal on next to no way."""
    one = motion(bead(0, [[0.0, 0.0], [3.0, 0.0], [3.01, 0.0], [3.02, 0.0], [8.0, 0.0]]))
    joints = one.joints.copy()
    joints[5:, 4] += 0.2
    joints[4, 4] += 0.1
    turned = dataclasses.replace(one, joints=joints)
    assert (
        len(steps.programmed(one, UR, CHORD, 50.0)[1])
        < len(one)
        == len(steps.programmed(turned, UR, CHORD, 50.0)[1])
    )


@pytest.mark.parametrize("lead", np.linspace(3.0, 3.0026, 9))
def test_a_bead_that_turns_round_within_a_blend_has_no_point_too_near_another(lead):
    """As where lines of a filling are joined: the way along the bead is long enough, the way between two points is not."""
    turn = [[lead, 0.0], [lead, 0.0016], [lead + 0.0006, 0.0], [8.0, 0.5], [8.0, 3.0]]
    one = motion(bead(0, [[0.0, 0.0], *turn], speed=1.0))
    told, rows = steps.programmed(one, UR, CHORD, 100.0)
    inside = told.deposit[1:] & (told.point[1:] > 0)
    way = np.linalg.norm(np.diff(told.position, axis=0), axis=1)
    assert way[inside].min() >= steps.MIN_STEP_SHARE * UR.least_blend
    # all that is left out lies near the way that stays
    for row in sorted(set(range(2, len(one))) - set(rows.tolist())):
        start, end = rows[rows < row][-1], rows[rows > row][0]
        line = one.position[end] - one.position[start]
        share = np.clip((one.position[row] - one.position[start]) @ line / (line @ line), 0, 1)
        off = np.linalg.norm(one.position[row] - one.position[start] - share * line)
        assert off <= steps.OMITTED_DEVIATION_SHARE * CHORD + 1e-12
