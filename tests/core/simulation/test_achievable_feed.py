# SPDX-License-Identifier: LGPL-2.1-or-later
"""The achievable feed: against shares of axis speeds, and against motions with a known shortest
time."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.motion import Motion
from freecad_am.core.simulation.achievable_feed import achievable_feed


def run(joints, duration, speed=10.0, bead=None):
    """A single bead through joint vectors (n, axes), `duration` s per segment."""
    joints = np.asarray(joints, float)
    n = len(joints)
    bead = np.zeros(n, dtype=np.int64) if bead is None else np.asarray(bead)
    axis = np.tile([0.0, 0.0, 1.0], (n, 1))
    time = np.broadcast_to(np.asarray(duration, float), (n,)).copy()
    time[0] = 0.0
    return Motion(
        deposit=np.ones(n, dtype=bool),
        layer=np.zeros(n, dtype=np.int64),
        bead=bead,
        point=np.arange(n),
        position=np.zeros((n, 3)),
        build=axis,
        tool=axis,
        speed=np.full(n, speed),
        width=np.full(n, np.nan),
        joints=joints,
        duration=time,
    )


def test_no_axis_is_ever_faster_than_it_can_be_and_the_slowest_is_just_that():
    """No axis exceeds its speed limit, and the limiting axis of a slowed segment reaches it
    exactly."""
    random = np.random.default_rng(1)
    motion = run(
        np.cumsum(random.normal(0.0, 1.0, (2000, 6)), axis=0), random.uniform(0.2, 2.0, 2000)
    )
    max_speed = random.uniform(1.0, 4.0, 6)
    feed = achievable_feed(motion, max_speed)
    used_share = np.abs(np.diff(motion.joints, axis=0)) / feed.duration[1:, None] / max_speed
    assert used_share.max() <= 1.0 + 1e-9
    slow = feed.slowed[1:]
    assert 100 < slow.sum() < 1900  # both kinds occur
    assert np.allclose(used_share[slow].max(axis=1), 1.0)
    assert (used_share[slow].argmax(axis=1) == feed.axis[1:][slow]).all()
    assert (feed.duration[1:][~slow] == motion.duration[1:][~slow]).all() and (
        feed.axis[1:][~slow] == -1
    ).all()
    assert np.allclose(feed.achieved * feed.duration, motion.speed * motion.duration)
    assert feed.lost == pytest.approx(feed.duration.sum() - motion.duration.sum())
    planned_share = np.abs(np.diff(motion.joints, axis=0)) / motion.duration[1:, None] / max_speed
    assert np.allclose(feed.ratio[1:], planned_share.max(axis=1))


def test_unknown_speeds_forbid_nothing_and_unreachable_rows_are_left_alone():
    """Unknown speeds do not limit, and unreachable rows stay unchanged."""
    motion = run(np.random.default_rng(2).normal(0.0, 9.0, (50, 6)), 0.1)
    assert not achievable_feed(motion, np.full(6, np.inf)).slowed.any()
    joints = motion.joints.copy()
    joints[20] = np.nan
    feed = achievable_feed(dataclasses.replace(motion, joints=joints), np.ones(6))
    assert not feed.slowed[20:22].any() and feed.slowed[1:20].all()
    assert np.isfinite(feed.duration).all()


@pytest.mark.parametrize("count", [2, 5, 1000])
def test_a_straight_way_from_rest_to_rest_takes_the_time_of_the_trapezoid(count):
    """A straight move from rest to rest takes the time of the trapezoidal profile."""
    distance, speed, acceleration = 4.0, 0.5, 0.8  # the ramps take 0.3 of the distance
    motion = run(
        np.linspace([0.0, 0.0], [distance, -0.5 * distance], count), distance / speed / (count - 1)
    )
    feed = achievable_feed(motion, [9.0, 9.0], [acceleration, 99.0])
    assert feed.duration.sum() == pytest.approx(distance / speed + speed / acceleration, rel=1e-9)
    if count > 10:
        middle = slice(count // 3, 2 * count // 3)
        assert not feed.slowed[middle].any() and feed.slowed[[1, -1]].all()
        assert feed.axis[1] == 0


def test_a_way_too_short_for_its_speed_takes_the_time_of_the_triangle():
    """A move too short for its speed takes the time of the triangular profile."""
    distance, acceleration = 0.2, 0.8
    motion = run(np.linspace([0.0], [distance], 400), distance / 3.0 / 399)
    duration = achievable_feed(motion, [9.0], [acceleration]).duration.sum()
    assert duration == pytest.approx(2.0 * np.sqrt(distance / acceleration), rel=1e-9)


def test_on_a_circle_the_pace_is_where_its_acceleration_is_the_largest():
    """On a circle the acceleration limits the feed where an axis reverses."""
    count, rate, radius = 20_000, 2.0, 0.7
    angle = np.linspace(0.0, 20.0 * np.pi, count)
    motion = run(
        radius * np.column_stack([np.cos(angle), np.sin(angle)]), 20.0 * np.pi / rate / (count - 1)
    )
    acceleration = 1.1
    feed = achievable_feed(motion, [9.0, 9.0], [acceleration, acceleration])
    middle = slice(count // 4, 3 * count // 4)
    share = (feed.achieved / feed.asked)[middle]
    # radius * (rate * feed)^2 is the acceleration limit of an axis at its reversal; between
    # reversals it could move faster
    bound = np.sqrt(acceleration / (radius * rate**2))
    at_end = np.abs(np.sin(2.0 * angle[middle])) < 8e-3
    assert at_end.sum() > 10 and share[at_end].max() <= bound * (1.0 + 1e-3)
    assert share.min() >= bound * 0.98
    assert feed.slowed[middle].all()


def test_accelerations_along_the_motion_as_it_will_be_are_kept():
    # a smooth path through dense points, so that differences over the resulting times give
    # accelerations
    u = np.linspace(0.0, 1.0, 6001)
    joints = np.column_stack([np.sin(7 * u), 0.6 * np.cos(11 * u + 0.4), 0.9 * u**2])
    motion = run(joints, 3.0 / 6000)
    max_speed, max_acceleration = np.array([3.0, 2.5, 9.0]), np.array([12.0, 9.0, 30.0])
    feed = achievable_feed(motion, max_speed, max_acceleration)
    times = np.cumsum(feed.duration)
    speed = np.diff(joints, axis=0) / np.diff(times)[:, None]
    middles = 0.5 * (times[1:] + times[:-1])
    acceleration = np.abs(np.diff(speed, axis=0) / np.diff(middles)[:, None])[20:-20]
    assert np.abs(speed / max_speed).max() <= 1.0 + 1e-9
    assert (acceleration / max_acceleration).max() <= 1.02
    assert (acceleration / max_acceleration).max() >= 0.9  # the motion is not slower than necessary
    assert feed.duration.sum() < 3.0 * 2.0


def test_a_program_stops_between_beads():
    joints = np.concatenate([np.linspace([0.0], [2.0], 101), np.linspace([2.0], [4.0], 101)])
    motion = run(joints, 0.02, bead=np.repeat([0, 1], 101))
    duration = motion.duration.copy()
    duration[101] = 0.0
    motion = dataclasses.replace(motion, duration=duration)
    speed, acceleration = 1.0, 4.0
    feed = achievable_feed(motion, [9.0], [acceleration])
    assert feed.duration.sum() == pytest.approx(2 * (2.0 / speed + speed / acceleration), rel=1e-9)
