# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms with an offset wrist: all solutions, also near singularities."""

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.chain import Chain
from freecad_am.core.kinematics.inverse import offset_wrist, recognition
from freecad_am.core.kinematics.inverse.offset_wrist import OffsetWristArm
from tests.core.kinematics.arms import (
    CROOKED_CRX,
    CRX_10IA,
    GOFA_5,
    GOFA_10,
    HC10,
    M710IC_50E,
    chain,
    joint_difference,
    numeric,
    second_opinion,
)

pytest.importorskip("PyKDL")
ARMS = {
    "CRX-10iA": CRX_10IA,
    "HC10": HC10,
    "GoFa 5": GOFA_5,
    "crooked": CROOKED_CRX,
    "GoFa 10": GOFA_10,
    "M-710iC/50E": M710IC_50E,
}


@pytest.fixture(params=ARMS, scope="module")
def arm(request):
    arm_chain = chain(ARMS[request.param])
    solver = recognition.arm_of(arm_chain)
    assert isinstance(solver, OffsetWristArm) and solver.followed
    return arm_chain, solver, second_opinion(arm_chain)


def _check(arm, q, exact=1e-6):
    """All solutions of the poses of q give the poses, and q is among them under its own
    configuration."""
    _, inverse, kdl = arm
    poses = kdl.forward(q)
    solutions, words = inverse.solutions(poses)
    assert solutions.shape == (16, len(q), 6) and np.array_equal(
        inverse.inverse(poses), solutions, equal_nan=True
    )
    reached = np.isfinite(solutions).all(axis=2)
    assert (
        np.array_equal(reached, words >= 0)
        and (reached == np.isfinite(solutions).any(axis=2)).all()
    )
    assert np.nanmax(np.abs(solutions)) <= np.pi + 1e-12
    # the first eight belong to the eight configurations
    assert (words[:8] == np.where(reached[:8], np.arange(8)[:, None], -1)).all()
    for row, is_solution, pose in zip(solutions.transpose(1, 0, 2), reached.T, poses):
        off = np.abs(kdl.forward(row[is_solution]) - pose)
        assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-9
    nearest = np.nanargmin(joint_difference(solutions, q), axis=0)
    indices = np.arange(len(q))
    assert joint_difference(solutions[nearest, indices], q).max() < exact
    return solutions, words, words[nearest, indices]


def test_every_pose_is_given_back_under_its_words(arm):
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (500, 6))
    *_, configurations = _check(arm, q)
    assert np.array_equal(arm[1].branch_of(q), configurations)
    for branch in (0, 5):
        assert np.array_equal(
            arm[1].inverse_branch(arm[0].forward(q[:50]), branch),
            arm[1].inverse(arm[0].forward(q[:50]))[branch],
            equal_nan=True,
        )


@pytest.mark.long
def test_ten_thousand_poses_are_given_back(arm):
    _check(arm, np.random.default_rng(4).uniform(-np.pi, np.pi, (10000, 6)), 1e-4)


def test_no_solution_is_lost_that_a_numeric_solver_finds(arm):
    """Every solution of a numeric solver is among the closed-form ones."""
    arm_chain, inverse, kdl = arm
    rng = np.random.default_rng(5)
    several = 0
    for pose in kdl.forward(rng.uniform(-np.pi, np.pi, (5, 6))):
        closed = inverse.inverse(pose[None])[:, 0]
        for solution in numeric(arm_chain, pose, rng, 80):
            several += 1
            assert np.nanmin(joint_difference(closed, solution)) < 1e-4
    assert several > 12


@pytest.mark.parametrize("near", [0.0, 1e-9, 1e-6, 1e-3])
@pytest.mark.always
def test_solutions_stay_near_singularities(arm, near):
    """The stretched elbow, and poses where wrist solutions coincide: the determinant of PyKDL's
    Jacobian is zero."""
    arm_chain, inverse, kdl = arm
    rng = np.random.default_rng(6)
    q = rng.uniform(-np.pi, np.pi, (60, 6))
    # the determinant over axis 5 changes sign where two solutions coincide
    for row in q[:30]:
        around = np.tile(row, (73, 1))
        around[:, 4] = np.linspace(-np.pi, np.pi, 73)
        size = np.linalg.det(kdl.jacobian(around))
        where = np.flatnonzero(size[1:] * size[:-1] < 0.0)
        if not len(where):
            continue
        low, high = around[where[0]], around[where[0] + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            same = (
                np.linalg.det(kdl.jacobian(middle[None]))[0]
                * np.linalg.det(kdl.jacobian(low[None]))[0]
                > 0.0
            )
            low, high = (middle, high) if same else (low, middle)
        row[:] = low
        row[4] += near
    zero_frames = arm_chain.frames(np.zeros(6))
    normal = zero_frames.directions[2]
    upper, fore = (
        zero_frames.origins[2] - zero_frames.origins[1],
        inverse.point - zero_frames.origins[2],
    )
    upper, fore = upper - normal * (normal @ upper), fore - normal * (normal @ fore)
    q[30:, 2] = np.arctan2(np.cross(fore, upper) @ normal, fore @ upper) + near
    poses = kdl.forward(q)
    solutions = inverse.inverse(poses)
    differences = np.nanmin(joint_difference(solutions, q), axis=0)
    # where two solutions coincide they move by the root of the pose's change
    assert (differences < 1e-4).all()
    for row, pose in zip(solutions.transpose(1, 0, 2), poses):
        row = row[np.isfinite(row).all(axis=1)]
        assert np.abs(kdl.forward(row) - pose).max() < 1e-6


@pytest.mark.parametrize("away", [0.0, 1e-9, 1e-6, 1e-3, 0.03, 1.0])
@pytest.mark.always
def test_solutions_stay_where_the_wrist_is_on_axis_1(arm, away):
    """With the point of axes 4 and 5 on axis 1, or a few mm off it, the point does not determine
    the plane of the arm."""
    arm_chain, inverse, kdl = arm
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (200, 6))
    zero_frames = arm_chain.frames(np.zeros(6))
    elbow = zero_frames.origins[2]

    def ahead(three):
        """The distance of the point from axis 1 along the arm's plane for other angles of axis 3
        (n,); by PyKDL up to axis 3."""
        moved = arm_chain.frames(np.column_stack([q[:, :2], three, q[:, 3:]]))
        fourth, through = moved.directions[:, 3], moved.origins[:, 3]
        point = through + fourth * (
            (inverse.point - zero_frames.origins[3]) @ zero_frames.directions[3]
        )
        normal = moved.directions[:, 1]
        return np.cross(point, normal)[:, 2] / np.hypot(normal[:, 0], normal[:, 1])

    # the distance is a sine of axis 3 about that of the elbow
    zero, quarter, half = (ahead(np.full(len(q), angle)) for angle in (0.0, 0.5 * np.pi, np.pi))
    middle, cos = 0.5 * (zero + half), 0.5 * (zero - half)
    sin = quarter - middle
    share = (away - middle) / np.hypot(cos, sin)
    reached = np.abs(share) < 0.999
    q[:, 2] = np.arctan2(sin, cos) + np.arccos(np.clip(share, -1.0, 1.0))
    fore = inverse.point - elbow
    upper = elbow - zero_frames.origins[1]
    folded = (
        np.abs(
            np.sin(
                q[:, 2]
                + np.arctan2(np.cross(upper, fore) @ zero_frames.directions[2], upper @ fore)
            )
        )
        < 0.01
    )
    q = q[reached & ~folded]
    assert len(q) > 60
    poses = kdl.forward(q)
    solutions = inverse.inverse(poses)
    assert (np.nanmin(joint_difference(solutions, q), axis=0) < 1e-5).all()
    for row, pose in zip(solutions.transpose(1, 0, 2), poses):
        off = np.abs(kdl.forward(row[np.isfinite(row).all(axis=1)]) - pose)
        assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-8


def test_poses_out_of_reach_and_pieces(arm, monkeypatch):
    """Unreachable poses give NaN, and splitting into chunks changes nothing."""
    arm_chain, inverse, _ = arm
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (40, 6))
    poses = arm_chain.forward(q)
    solutions = inverse.inverse(poses)
    monkeypatch.setattr(offset_wrist, "CHUNK", 16)
    np.testing.assert_allclose(inverse.inverse(poses), solutions, atol=1e-6)
    poses[:, :3, 3] += 5000.0
    assert np.isnan(inverse.inverse(poses)).all() and inverse.inverse(poses[:0]).shape == (16, 0, 6)


def test_words_change_at_singularities_alone(arm):
    """For one shoulder and elbow, flip and noflip change where the determinant of PyKDL's Jacobian
    is zero."""
    _, inverse, kdl = arm
    rng = np.random.default_rng(8)
    for begin, end in rng.uniform(-2.5, 2.5, (10, 2, 6)):
        q = begin + np.linspace(0.0, 1.0, 400)[:, None] * (end - begin)
        words = inverse.branch_of(q)
        size = np.linalg.det(kdl.jacobian(q))
        same = words[1:] >> 1 == words[:-1] >> 1
        assert np.array_equal((words[1:] != words[:-1])[same], (size[1:] * size[:-1] < 0.0)[same])


@pytest.mark.parametrize(
    ("joint", "shift", "reason"),
    [
        (3, (0, 12, 0), "axis 4 passes 12 mm off axis 1"),
        (4, (0, 0, 5), "the wrist is not spherical, and axes 4 and 5 do not meet"),
    ],
)
def test_what_does_not_hold_is_told(joint, shift, reason):
    arm_chain = chain(CRX_10IA)
    origins = arm_chain.origins.copy()
    origins[joint, :3, 3] += shift
    with pytest.raises(InputError, match=reason):
        recognition.arm_of(Chain(origins, arm_chain.directions, arm_chain.flange))


OFFSETS_RAD = (
    0.0,
    1e-9,
    1e-7,
    1e-6,
    1e-5,
    3e-5,
    1e-4,
    1e-3,
)  # rad of axis 5 from where two solutions meet


def meeting(arm_chain, count, seed):
    """Joint angles (m, 6) near coinciding solutions: axis 5 at a sign change of the Jacobian's
    determinant."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (count, 6))
    grid = np.linspace(-np.pi, np.pi, 73)
    size = np.stack(
        [determinant(arm_chain, np.insert(np.delete(q, 4, 1), 4, angle, 1)) for angle in grid],
        axis=1,
    )
    changes = size[:, 1:] * size[:, :-1] < 0.0
    selected = np.flatnonzero(changes.any(axis=1))
    q, step = q[selected], changes[selected].argmax(axis=1)
    low, high, start_determinant = grid[step], grid[step + 1], size[selected, step]
    for _ in range(52):
        q[:, 4] = 0.5 * (low + high)
        same = determinant(arm_chain, q) * start_determinant > 0.0
        low, high = np.where(same, q[:, 4], low), np.where(same, high, q[:, 4])
    q[:, 4] = low + rng.choice(OFFSETS_RAD, len(q)) * rng.choice([-1.0, 1.0], len(q))
    return q


def determinant(arm_chain, q):
    """Determinant (m,) of the Jacobian, half a metre per radian, by an independent product of
    transforms."""
    transform, axes, origins = np.broadcast_to(np.eye(4), (len(q), 4, 4)), [], []
    for k in range(6):
        transform = transform @ arm_chain.origins[k]
        axes.append(transform[:, :3, :3] @ arm_chain.directions[k])
        origins.append(transform[:, :3, 3])
        x, y, z = arm_chain.directions[k]
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, cosine = np.sin(q[:, k])[:, None, None], np.cos(q[:, k])[:, None, None]
        turn = np.tile(np.eye(4), (len(q), 1, 1))
        turn[:, :3, :3] += sine * cross + (1.0 - cosine) * (cross @ cross)
        transform = transform @ turn
    tip = (transform @ arm_chain.flange)[:, :3, 3]
    columns = [
        np.concatenate([np.cross(axis, (tip - origin) / 500.0), axis], axis=1)
        for axis, origin in zip(axes, origins)
    ]
    return np.linalg.det(np.stack(columns, axis=2))


@pytest.mark.parametrize("count", [120, pytest.param(10_000, marks=pytest.mark.long)])
def test_none_is_lost_where_two_solutions_meet(arm, count):
    """Random joint angles near such a pose are among the solutions of their pose, and each solution
    gives the pose. The bound reflects that a pose determines the angles to the cube root of its
    last digits."""
    arm_chain, inverse, kdl = arm
    q = meeting(arm_chain, count, 11)
    assert len(q) > 0.7 * count
    poses = kdl.forward(q)
    solutions = inverse.inverse(poses)
    differences = np.nan_to_num(joint_difference(solutions, q), nan=np.pi).min(axis=0)
    assert (differences < 1e-4).all()
    reached = np.isfinite(solutions).all(axis=2)
    off = np.abs(
        inverse.chain.forward(solutions[reached])
        - np.broadcast_to(poses, (16, *poses.shape))[reached]
    )
    assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-9
