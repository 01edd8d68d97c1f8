# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms with three parallel axes: all solutions, also near singularities."""

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
    chain,
    joint_difference,
    numeric,
    second_opinion,
)

pytest.importorskip("PyKDL")
ARMS = {"UR5e": UR5E, "UR10e": UR10E, "crooked": CROOKED_UR}


@pytest.fixture(params=ARMS, scope="module")
def arm(request):
    arm_chain = chain(ARMS[request.param])
    solver = recognition.arm_of(arm_chain)
    assert isinstance(solver, ParallelAxesArm)
    return arm_chain, solver, second_opinion(arm_chain)


def _check(arm, q, exact=1e-8):
    """All solutions of the poses of q give the poses, and q is the one of its configuration."""
    _, inverse, kdl = arm
    poses = kdl.forward(q)
    solutions = inverse.inverse(poses)
    assert solutions.shape == (8, len(q), 6)
    reached = np.isfinite(solutions).all(axis=2)
    assert (reached == np.isfinite(solutions).any(axis=2)).all()
    assert np.nanmax(np.abs(solutions)) <= np.pi + 1e-12
    for configuration in range(8):
        mask = reached[configuration]
        off = np.abs(kdl.forward(solutions[configuration, mask]) - poses[mask])
        assert off[:, :3, 3].max(initial=0.0) < 1e-6 and off[:, :3, :3].max(initial=0.0) < 1e-9
        single = inverse.inverse_branch(poses, configuration)
        assert np.array_equal(single, solutions[configuration], equal_nan=True)
    configurations = inverse.branch_of(q)
    own_solutions = solutions[configurations, np.arange(len(q))]
    assert joint_difference(own_solutions, q).max() < exact
    return solutions, reached


def test_every_pose_is_given_back_and_words_are_those_of_the_angles(arm):
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (2000, 6))
    q = q[np.abs(np.sin(arm[1].bend(q))) > 1e-3]
    solutions, reached = _check(arm, q)
    words = np.broadcast_to(np.arange(8)[:, None], reached.shape)
    assert np.array_equal(arm[1].branch_of(solutions)[reached], words[reached])


@pytest.mark.long
def test_ten_thousand_poses_are_given_back(arm):
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (10000, 6))
    _check(arm, q[arm[1].bend(q) > 1e-4], 1e-7)


def test_no_solution_is_lost_that_a_numeric_solver_finds(arm):
    """Every solution of a numeric solver is among the closed-form ones."""
    arm_chain, inverse, kdl = arm
    rng = np.random.default_rng(5)
    q = rng.uniform(-np.pi, np.pi, (6, 6))
    several = 0
    for pose in kdl.forward(q):
        closed = inverse.inverse(pose[None])[:, 0]
        for solution in numeric(arm_chain, pose, rng, 60):
            several += 1
            assert np.nanmin(joint_difference(closed, solution)) < 1e-4
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
    solutions = inverse.inverse(poses)
    reached = np.isfinite(solutions).all(axis=2)
    # a stretched pose stays reachable: rounding must not lose a pair of solutions that merge
    assert (reached.sum(axis=0) >= 2).all()
    for configuration in range(8):
        mask = reached[configuration]
        off = np.abs(kdl.forward(solutions[configuration, mask]) - poses[mask]).max(axis=(1, 2))
        assert off.max(initial=0.0) < 1e-6


def test_poses_out_of_reach_and_pieces(arm):
    arm_chain, inverse, _kdl = arm
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (CHUNK + 3, 6))
    poses = arm_chain.forward(q)
    joined = np.concatenate([inverse.inverse(poses[:100]), inverse.inverse(poses[100:])], axis=1)
    assert np.array_equal(inverse.inverse(poses), joined, equal_nan=True)
    poses[:, :3, 3] += 5000.0
    assert np.isnan(inverse.inverse(poses)).all() and inverse.inverse(poses[:0]).shape == (8, 0, 6)


def test_words_mean_what_the_arm_looks_like():
    arm_chain = chain(UR10E)
    inverse = recognition.arm_of(arm_chain)
    q = np.radians(
        [[0, -120, 110, -80, -90, 0], [0, -60, -110, -10, -90, 0], [0, -120, 110, -80, 90, 0]]
    )
    words = [spherical_wrist.branch_name(int(index)) for index in inverse.branch_of(q)]
    elbows = arm_chain.frames(q).origins[:, 2:4]
    for (_, elbow, wrist), joints, angles in zip(words, elbows, q, strict=True):
        middle = 0.5 * (joints[1] + arm_chain.frames(angles).origins[1])
        assert (elbow == "up") == (joints[0, 2] > middle[2])
        assert wrist == ("flip" if angles[4] < 0.0 else "noflip")
    front = arm_chain.forward(np.zeros(6))[:2, 3]
    for (shoulder, *_), angles in zip(words, q, strict=True):
        centre = arm_chain.frames(angles).origins[4][:2]
        turned = arm_chain.frames(np.array([angles[0], *np.zeros(5)])).origins[4][:2]
        assert (shoulder == "front") == (float(centre @ turned) > 0.0) and np.hypot(*front) > 0.0


def test_seven_axes_are_refused():
    arm_chain = chain(UR10E)
    again = [0, 1, 2, 3, 4, 5, 0]
    seven = Chain(arm_chain.origins[again], arm_chain.directions[again], arm_chain.flange)
    with pytest.raises(
        InputError,
        match="the machine has 7 axes, 0 prismatic; choose a robot with six revolute axes",
    ):
        recognition.arm_of(seven)


def test_a_sliding_axis_before_six_that_turn_is_a_track_and_five_axis_machines_are_three_and_two():
    arm_chain = chain(UR10E)
    again = [0, 0, 1, 2, 3, 4, 5]
    rail = Chain(
        arm_chain.origins[again], arm_chain.directions[again], arm_chain.flange, np.arange(7) == 0
    )
    with pytest.raises(
        InputError,
        match=r"is prismatic and carries the six revolute axes, like a track; .*`cell\.external`",
    ):
        recognition.arm_of(rail)
    tool_axis_chain = Chain(
        arm_chain.origins[again], arm_chain.directions[again], arm_chain.flange, np.arange(7) == 6
    )
    with pytest.raises(
        InputError,
        match="the machine has 7 axes, 1 prismatic; choose a robot with six revolute axes",
    ):
        recognition.arm_of(tool_axis_chain)
    for count, sliding in itertools.product(range(1, 9), repeat=2):
        slides = np.arange(count) < sliding
        assert is_five_axis(slides) == (count == 5 and sliding == 3) == is_five_axis(slides[::-1])
