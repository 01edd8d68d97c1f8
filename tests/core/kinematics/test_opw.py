# SPDX-License-Identifier: LGPL-2.1-or-later
"""The closed form of every machine against its joint frames: round trips, configurations,
singularities."""

import numpy as np
import pytest

from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.kinematics.machines import machine
from tests.core.kinematics.arms import EXAMPLES

MACHINES = [name for name in EXAMPLES if machine.load(name).opw is not None]


@pytest.fixture(params=MACHINES)
def arm(request):
    return machine.load(request.param)


def turned_apart(angles_a, angles_b):
    """The difference of angles modulo whole turns."""
    return np.abs((angles_a - angles_b + np.pi) % (2 * np.pi) - np.pi)


def random_joints(arm, count, seed=11):
    """Joint vectors over full turns, a third within the manufacturer's limits."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (count, 6))
    limits = arm.limits("maker")
    q[::3] = rng.uniform(limits.lower, limits.upper, q[::3].shape)
    return q


def test_forward_agrees_with_the_joint_frames(arm):
    q = random_joints(arm, 500)
    assert np.abs(arm.opw.forward(q) - arm.chain.forward(q)).max() < 1e-9
    assert arm.opw.forward(q[0]).shape == (4, 4)
    assert (
        np.abs(
            arm.opw.forward(q.reshape(5, 100, 6)) - arm.chain.forward(q.reshape(5, 100, 6))
        ).max()
        < 1e-9
    )


def test_inverse_finds_the_joints_and_every_branch_gives_the_pose(arm):
    q = random_joints(arm, 5000)
    poses = arm.chain.forward(q)
    solutions = arm.opw.inverse(poses)
    assert solutions.shape == (8, len(q), 6)
    assert np.nanmax(np.abs(solutions)) <= np.pi
    missing = np.isnan(solutions)
    assert np.array_equal(missing.any(axis=-1), missing.all(axis=-1))
    reached = ~missing[..., 0]
    back = arm.chain.forward(solutions)
    off = np.abs(back - poses)[reached]
    assert off[:, :3, 3].max() < 1e-8
    assert off[:, :3, :3].max() < 1e-10
    # the original joint angles are the solution of their own configuration
    own_solutions = solutions[arm.opw.branch_of(q), np.arange(len(q))]
    clear = np.abs(np.sin(q[:, 4])) > 1e-3
    assert turned_apart(own_solutions, q)[clear].max() < 1e-7
    # and the eight configurations are distinct
    branches = np.broadcast_to(np.arange(8)[:, None], reached.shape)
    assert np.array_equal(arm.opw.branch_of(solutions)[reached], branches[reached])


def test_one_branch_is_the_same_as_in_all(arm):
    poses = arm.chain.forward(random_joints(arm, 300))
    solutions = arm.opw.inverse(poses)
    for branch in range(8):
        assert np.array_equal(
            arm.opw.inverse_branch(poses, branch), solutions[branch], equal_nan=True
        )


def test_pieces_do_not_show(arm):
    """Splitting poses into chunks changes nothing."""
    q = random_joints(arm, spherical_wrist.CHUNK + 3)
    poses = arm.chain.forward(q)
    joined = np.concatenate([arm.opw.inverse(poses[:100]), arm.opw.inverse(poses[100:])], axis=1)
    assert np.array_equal(arm.opw.inverse(poses), joined, equal_nan=True)
    assert arm.opw.inverse(poses[:0]).shape == (8, 0, 6)


@pytest.mark.parametrize("bend", [0.0, 1e-300, 1e-16, 1e-12, 1e-9, 1e-6, 1e-4])
def test_a_straight_wrist_keeps_its_pose(arm, bend):
    q = random_joints(arm, 400)
    q[:, 4] = bend * np.sign(q[:, 4])
    poses = arm.chain.forward(q)
    solutions = arm.opw.inverse(poses)
    # both through the pose's configuration and its flip
    for flip in (0, 1):
        solutions_of_flip = solutions[(arm.opw.branch_of(q) & 6) + flip, np.arange(len(q))]
        assert np.isfinite(solutions_of_flip).all()
        off = np.abs(arm.chain.forward(solutions_of_flip) - poses)
        assert off[:, :3, 3].max() < 1e-8
        assert off[:, :3, :3].max() < 1e-10


def test_a_straight_wrist_turns_axis_6_alone(arm):
    q = random_joints(arm, 50)
    q[:, 3:5] = 0.0
    poses = arm.opw.forward(q)
    # exactly straight: the tool along the forearm
    own_solutions = arm.opw.inverse(poses)[arm.opw.branch_of(q), np.arange(len(q))]
    sign = arm.opw.signs[3] * arm.opw.signs[5]
    assert (
        turned_apart(
            own_solutions[:, 3] + sign * own_solutions[:, 5], q[:, 3] + sign * q[:, 5]
        ).max()
        < 1e-9
    )


def test_wrist_centre_on_axis_1_and_stretched_arm(arm):
    """At the singularities of shoulder and elbow the solutions give the pose too."""
    rng = np.random.default_rng(5)
    straight = -np.arctan2(arm.opw.a2, arm.opw.c3)
    opw_q = rng.uniform(-2, 2, (50, 6))
    opw_q[:25, 2] = straight
    # turn axis 2 until the wrist centre is on the axis
    bend = opw_q[25:, 2] - straight
    up, out = arm.opw.c2 + arm.opw.forearm * np.cos(bend), arm.opw.forearm * np.sin(bend)
    assert (np.hypot(up, out) > abs(arm.opw.a1)).all()
    opw_q[25:, 1] = -np.arcsin(arm.opw.a1 / np.hypot(up, out)) - np.arctan2(out, up)
    q = (opw_q + np.array(arm.opw.offsets)) * np.array(arm.opw.signs)
    poses = arm.chain.forward(q)
    solutions = arm.opw.inverse(poses)
    reached = np.isfinite(solutions[..., 0])
    assert reached.any(axis=0).all()
    assert np.abs(arm.chain.forward(solutions) - poses)[reached].max() < 1e-6


def test_out_of_reach_is_nan_in_all_six_and_leaves_the_others_alone(arm):
    poses = arm.chain.forward(random_joints(arm, 20))
    poses[3, :3, 3] = (9000.0, 0.0, 0.0)
    poses[7] = np.nan
    solutions = arm.opw.inverse(poses)
    assert np.isnan(solutions[:, [3, 7]]).all()
    reachable = [i for i in range(20) if i not in (3, 7)]
    assert np.array_equal(
        solutions[:, reachable], arm.opw.inverse(poses[reachable]), equal_nan=True
    )


def test_an_arm_folded_on_its_shoulder_is_not_reached():
    """Where upper arm and forearm are equally long the wrist centre can be on axis 2, and axis 2 is
    free."""
    arm = machine.load("staubli-rx60bl")
    q = np.zeros((1, 6))
    q[0, 2] = np.pi
    assert np.isnan(arm.opw.inverse(arm.chain.forward(q))).all()


def test_words_of_a_branch():
    assert spherical_wrist.branch_index(("front", "up", "noflip")) == 0
    assert spherical_wrist.branch_index(("front", "up", "flip")) == 1
    assert spherical_wrist.branch_index(["back", "down", "flip"]) == 7
    assert [
        spherical_wrist.branch_index(spherical_wrist.branch_name(index)) for index in range(8)
    ] == list(range(8))
    with pytest.raises(ValueError):
        spherical_wrist.branch_index(("front", "left", "flip"))


def test_branches_mean_what_the_words_say(arm):
    """From the joint frames only: positions of wrist centre and elbow, and the sign of q5."""
    q = random_joints(arm, 3000, seed=3)
    poses = arm.chain.forward(q)
    solutions = arm.opw.inverse(poses)
    for branch in range(8):
        shoulder, elbow, wrist = spherical_wrist.branch_name(branch)
        joints = solutions[branch]
        joints = joints[np.isfinite(joints[:, 0])]
        frames = arm.chain.frames(joints)
        centre = meeting_point(frames, 4, 5)
        # direction of the arm's plane: at q1 = 0 along base_link's X for every machine here
        z = np.array([0.0, 0.0, 1.0])
        angle = joints[:, 0] * arm.chain.directions[0, 2] * np.sign(arm.chain.origins[0, 2, 2])
        ahead = np.stack((np.cos(angle), np.sin(angle), np.zeros_like(angle)), axis=-1)
        side = (centre * ahead).sum(axis=-1)
        clear = np.abs(side) > 1e-3
        assert ((side > 0) == (shoulder == "front"))[clear].all()
        # in the plane, seen with the wrist centre's side of axis 1 to the right
        right = ahead if shoulder == "front" else -ahead
        start = frames.origins[:, 1]
        tip = axis_point(frames, 2, start)
        line, bow = centre - start, tip - start
        line_right, line_up = (line * right).sum(axis=-1), line @ z
        bow_right, bow_up = (bow * right).sum(axis=-1), bow @ z
        left_of_line = line_right * bow_up - line_up * bow_right
        clear = np.abs(left_of_line) > 1e-3
        assert ((left_of_line > 0) == (elbow == "up"))[clear].all()
        # clearly above the line wherever it does not lean backwards
        leaning = line_right > 1.0
        height = bow_up - line_up / np.where(leaning, line_right, 1.0) * bow_right
        clear = leaning & (np.abs(height) > 1e-3)
        assert clear.sum() > 500
        assert ((height > 0) == (elbow == "up"))[clear].all()
        clear = np.abs(joints[:, 4]) > 1e-9
        assert ((joints[:, 4] < 0) == (wrist == "flip"))[clear].all()


def meeting_point(frames, axis_a, axis_b):
    """Intersection (n, 3) of two axes, which must intersect."""
    d1, d2 = frames.directions[:, axis_a], frames.directions[:, axis_b]
    o1, o2 = frames.origins[:, axis_a], frames.origins[:, axis_b]
    normal = np.cross(d1, d2)
    squared = (normal**2).sum(axis=-1)
    along = (np.cross(o2 - o1, d2) * normal).sum(axis=-1) / np.where(
        squared > 1e-12, squared, np.nan
    )
    point = o1 + along[:, None] * d1
    # axes 5 and 6 intersect for every q5; their intersection is also on axis 6
    gap = np.cross(point - o2, d2)
    assert np.abs(gap).max() < 1e-6
    return point


def axis_point(frames, axis, references):
    """Points (n, 3) of an axis closest to `references`: the elbow, in the plane of the shoulder."""
    direction, origin = frames.directions[:, axis], frames.origins[:, axis]
    along = ((references - origin) * direction).sum(axis=-1)
    return origin + along[:, None] * direction
