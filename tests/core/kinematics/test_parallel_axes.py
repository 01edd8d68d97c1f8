# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms with three parallel axes: every solution, near singularities too."""

import itertools

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.chain import Chain
from freecad_am.core.kinematics.inverse import recognition, spherical_wrist
from freecad_am.core.kinematics.inverse.five_axis import is_five_axis
from freecad_am.core.kinematics.inverse.parallel_axes import CHUNK, ParallelAxesArm
from tests.core.kinematics.arms import (
    CROOKED_UR,
    UR5E,
    UR10E,
    apart,
    chain,
    numeric,
    second_opinion,
)

pytest.importorskip("PyKDL")
ARMS = {"UR5e": UR5E, "UR10e": UR10E, "crooked": CROOKED_UR}


@pytest.fixture(params=ARMS, scope="module")
def arm(request):
    of = chain(ARMS[request.param])
    found = recognition.arm_of(of)
    assert isinstance(found, ParallelAxesArm)
    return of, found, second_opinion(of)


def _check(arm, q, exact=1e-8):
    """All solutions of the poses of q give them back, and q is the one of its words."""
    _, inverse, kdl = arm
    poses = kdl.forward(q)
    found = inverse.inverse(poses)
    assert found.shape == (8, len(q), 6)
    reached = np.isfinite(found).all(axis=2)
    assert (reached == np.isfinite(found).any(axis=2)).all()
    assert np.nanmax(np.abs(found)) <= np.pi + 1e-12
    for configuration in range(8):
        some = reached[configuration]
        off = np.abs(kdl.forward(found[configuration, some]) - poses[some])
        assert off[:, :3, 3].max(initial=0.0) < 1e-6 and off[:, :3, :3].max(initial=0.0) < 1e-9
        one = inverse.inverse_branch(poses, configuration)
        assert np.array_equal(one, found[configuration], equal_nan=True)
    own = inverse.branch_of(q)
    given = found[own, np.arange(len(q))]
    assert apart(given, q).max() < exact
    return found, reached


def test_every_pose_is_given_back_and_words_are_those_of_the_angles(arm):
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (2000, 6))
    q = q[np.abs(np.sin(arm[1].bend(q))) > 1e-3]
    found, reached = _check(arm, q)
    words = np.broadcast_to(np.arange(8)[:, None], reached.shape)
    assert np.array_equal(arm[1].branch_of(found)[reached], words[reached])


@pytest.mark.long
def test_ten_thousand_poses_are_given_back(arm):
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (10000, 6))
    _check(arm, q[arm[1].bend(q) > 1e-4], 1e-7)


def test_no_solution_is_lost_that_a_numeric_solver_finds(arm):
    of, inverse, kdl = arm
    rng = np.random.default_rng(5)
    q = rng.uniform(-np.pi, np.pi, (6, 6))
    several = 0
    for pose in kdl.forward(q):
        closed = inverse.inverse(pose[None])[:, 0]
        for one in numeric(of, pose, rng, 60):
            several += 1
            assert np.nanmin(apart(closed, one)) < 1e-4
    assert several > 24


@pytest.mark.parametrize("near", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_solutions_stay_near_singularities(arm, near):
    """The wrist with axis 6 parallel to axis 4, the stretched elbow, and both."""
    _of, inverse, kdl = arm
    rng = np.random.default_rng(6)
    theta = rng.uniform(-np.pi, np.pi, (300, 6))
    theta[:200, 4] = near * rng.choice((-1.0, 1.0), 200) + np.pi * rng.integers(0, 2, 200)
    theta[100 if near in (0.0, 1e-3) else 200 :, 2] = near
    poses = kdl.forward((theta - inverse.zeros) * inverse.signs)
    found = inverse.inverse(poses)
    reached = np.isfinite(found).all(axis=2)
    # what is stretched stays reached: a pair that grows into one may not be lost by rounding
    assert (reached.sum(axis=0) >= 2).all()
    for configuration in range(8):
        some = reached[configuration]
        off = np.abs(kdl.forward(found[configuration, some]) - poses[some]).max(axis=(1, 2))
        assert off.max(initial=0.0) < 1e-6


def test_poses_out_of_reach_and_pieces(arm):
    of, inverse, _kdl = arm
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (CHUNK + 3, 6))
    poses = of.forward(q)
    parts = np.concatenate([inverse.inverse(poses[:100]), inverse.inverse(poses[100:])], axis=1)
    assert np.array_equal(inverse.inverse(poses), parts, equal_nan=True)
    poses[:, :3, 3] += 5000.0
    assert np.isnan(inverse.inverse(poses)).all() and inverse.inverse(poses[:0]).shape == (8, 0, 6)


def test_words_mean_what_the_arm_looks_like():
    of = chain(UR10E)
    inverse = recognition.arm_of(of)
    q = np.radians(
        [[0, -120, 110, -80, -90, 0], [0, -60, -110, -10, -90, 0], [0, -120, 110, -80, 90, 0]]
    )
    words = [spherical_wrist.branch_name(int(index)) for index in inverse.branch_of(q)]
    elbows = of.frames(q).origins[:, 2:4]
    for (_, elbow, wrist), joints, angles in zip(words, elbows, q, strict=True):
        middle = 0.5 * (joints[1] + of.frames(angles).origins[1])
        assert (elbow == "up") == (joints[0, 2] > middle[2])
        assert wrist == ("flip" if angles[4] < 0.0 else "noflip")
    front = of.forward(np.zeros(6))[:2, 3]
    for (shoulder, *_), angles in zip(words, q, strict=True):
        centre = of.frames(angles).origins[4][:2]
        turned = of.frames(np.array([angles[0], *np.zeros(5)])).origins[4][:2]
        assert (shoulder == "front") == (float(centre @ turned) > 0.0) and np.hypot(*front) > 0.0


def test_seven_axes_are_refused():
    of = chain(UR10E)
    again = [0, 1, 2, 3, 4, 5, 0]
    seven = Chain(of.origins[again], of.directions[again], of.flange)
    with pytest.raises(
        InputError, match="it has 7 axes, 0 prismatic; choose a robot with six revolute axes"
    ):
        recognition.arm_of(seven)


def test_a_sliding_axis_before_six_that_turn_is_a_track_and_five_axis_machines_are_three_and_two():
    of = chain(UR10E)
    again = [0, 0, 1, 2, 3, 4, 5]
    rail = Chain(of.origins[again], of.directions[again], of.flange, np.arange(7) == 0)
    with pytest.raises(
        InputError,
        match=r"is prismatic and carries the six revolute axes, like a track; .*`cell\.external`",
    ):
        recognition.arm_of(rail)
    last = Chain(of.origins[again], of.directions[again], of.flange, np.arange(7) == 6)
    with pytest.raises(
        InputError, match="it has 7 axes, 1 prismatic; choose a robot with six revolute axes"
    ):
        recognition.arm_of(last)
    for count, sliding in itertools.product(range(1, 9), repeat=2):
        slides = np.arange(count) < sliding
        assert is_five_axis(slides) == (count == 5 and sliding == 3) == is_five_axis(slides[::-1])
