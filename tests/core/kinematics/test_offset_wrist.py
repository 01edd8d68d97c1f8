# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms with an offset wrist: every solution, near singularities too."""

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
    apart,
    chain,
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
    of = chain(ARMS[request.param])
    found = recognition.arm_of(of)
    assert isinstance(found, OffsetWristArm) and found.followed
    return of, found, second_opinion(of)


def _check(arm, q, exact=1e-6):
    """All solutions of the poses of q give them back, and q is among them under its own words."""
    _, inverse, kdl = arm
    poses = kdl.forward(q)
    found, words = inverse.solutions(poses)
    assert found.shape == (16, len(q), 6) and np.array_equal(
        inverse.inverse(poses), found, equal_nan=True
    )
    reached = np.isfinite(found).all(axis=2)
    assert np.array_equal(reached, words >= 0) and (reached == np.isfinite(found).any(axis=2)).all()
    assert np.nanmax(np.abs(found)) <= np.pi + 1e-12
    # the first eight are those of the words
    assert (words[:8] == np.where(reached[:8], np.arange(8)[:, None], -1)).all()
    for row, there, pose in zip(found.transpose(1, 0, 2), reached.T, poses):
        off = np.abs(kdl.forward(row[there]) - pose)
        assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-9
    nearest = np.nanargmin(apart(found, q), axis=0)
    each = np.arange(len(q))
    assert apart(found[nearest, each], q).max() < exact
    return found, words, words[nearest, each]


def test_every_pose_is_given_back_under_its_words(arm):
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (500, 6))
    *_, own = _check(arm, q)
    assert np.array_equal(arm[1].branch_of(q), own)
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
    of, inverse, kdl = arm
    rng = np.random.default_rng(5)
    several = 0
    for pose in kdl.forward(rng.uniform(-np.pi, np.pi, (5, 6))):
        closed = inverse.inverse(pose[None])[:, 0]
        for one in numeric(of, pose, rng, 80):
            several += 1
            assert np.nanmin(apart(closed, one)) < 1e-4
    assert several > 12


@pytest.mark.parametrize("near", [0.0, 1e-9, 1e-6, 1e-3])
@pytest.mark.always
def test_solutions_stay_near_singularities(arm, near):
    """The stretched elbow, and where solutions of the wrist meet: the determinant of PyKDL's Jacobian is zero."""
    of, inverse, kdl = arm
    rng = np.random.default_rng(6)
    q = rng.uniform(-np.pi, np.pi, (60, 6))
    # the determinant over axis 5 changes its sign where two solutions meet
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
    rest = of.frames(np.zeros(6))
    normal = rest.directions[2]
    upper, fore = rest.origins[2] - rest.origins[1], inverse.point - rest.origins[2]
    upper, fore = upper - normal * (normal @ upper), fore - normal * (normal @ fore)
    q[30:, 2] = np.arctan2(np.cross(fore, upper) @ normal, fore @ upper) + near
    poses = kdl.forward(q)
    found = inverse.inverse(poses)
    away = np.nanmin(apart(found, q), axis=0)
    # where two solutions meet they move by the root of what the pose does
    assert (away < 1e-4).all()
    for row, pose in zip(found.transpose(1, 0, 2), poses):
        row = row[np.isfinite(row).all(axis=1)]
        assert np.abs(kdl.forward(row) - pose).max() < 1e-6


@pytest.mark.parametrize("away", [0.0, 1e-9, 1e-6, 1e-3, 0.03, 1.0])
@pytest.mark.always
def test_solutions_stay_where_the_wrist_is_on_axis_1(arm, away):
    """The point of axes 4 and 5 on axis 1, or so many mm beside it: the plane of the arm is not told by the point."""
    of, inverse, kdl = arm
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (200, 6))
    rest = of.frames(np.zeros(6))
    elbow = rest.origins[2]

    def ahead(three):
        """The point from axis 1, along the arm's plane, of q with other angles of axis 3 (n,); by PyKDL to axis 3 alone."""
        moved = of.frames(np.column_stack([q[:, :2], three, q[:, 3:]]))
        fourth, through = moved.directions[:, 3], moved.origins[:, 3]
        point = through + fourth * ((inverse.point - rest.origins[3]) @ rest.directions[3])
        normal = moved.directions[:, 1]
        return np.cross(point, normal)[:, 2] / np.hypot(normal[:, 0], normal[:, 1])

    # by axis 3 the way ahead is a sine about that of the elbow
    zero, quarter, half = (ahead(np.full(len(q), angle)) for angle in (0.0, 0.5 * np.pi, np.pi))
    middle, cos = 0.5 * (zero + half), 0.5 * (zero - half)
    sin = quarter - middle
    share = (away - middle) / np.hypot(cos, sin)
    reached = np.abs(share) < 0.999
    q[:, 2] = np.arctan2(sin, cos) + np.arccos(np.clip(share, -1.0, 1.0))
    fore = inverse.point - elbow
    upper = elbow - rest.origins[1]
    folded = (
        np.abs(
            np.sin(q[:, 2] + np.arctan2(np.cross(upper, fore) @ rest.directions[2], upper @ fore))
        )
        < 0.01
    )
    q = q[reached & ~folded]
    assert len(q) > 60
    poses = kdl.forward(q)
    found = inverse.inverse(poses)
    assert (np.nanmin(apart(found, q), axis=0) < 1e-5).all()
    for row, pose in zip(found.transpose(1, 0, 2), poses):
        off = np.abs(kdl.forward(row[np.isfinite(row).all(axis=1)]) - pose)
        assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-8


def test_poses_out_of_reach_and_pieces(arm, monkeypatch):
    of, inverse, _ = arm
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (40, 6))
    poses = of.forward(q)
    whole = inverse.inverse(poses)
    monkeypatch.setattr(offset_wrist, "CHUNK", 16)
    np.testing.assert_allclose(inverse.inverse(poses), whole, atol=1e-6)
    poses[:, :3, 3] += 5000.0
    assert np.isnan(inverse.inverse(poses)).all() and inverse.inverse(poses[:0]).shape == (16, 0, 6)


def test_words_change_at_singularities_alone(arm):
    """Of one shoulder and elbow, flip and noflip change where the determinant of PyKDL's Jacobian passes zero."""
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
    of = chain(CRX_10IA)
    origins = of.origins.copy()
    origins[joint, :3, 3] += shift
    with pytest.raises(InputError, match=reason):
        recognition.arm_of(Chain(origins, of.directions, of.flange))


NEAR = (
    0.0,
    1e-9,
    1e-7,
    1e-6,
    1e-5,
    3e-5,
    1e-4,
    1e-3,
)  # rad of axis 5 from where two solutions meet


def meeting(of, count, seed):
    """Joint angles (m, 6) next to where two solutions meet: axis 5 where the Jacobian's determinant changes its sign."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (count, 6))
    grid = np.linspace(-np.pi, np.pi, 73)
    size = np.stack(
        [determinant(of, np.insert(np.delete(q, 4, 1), 4, angle, 1)) for angle in grid], axis=1
    )
    changes = size[:, 1:] * size[:, :-1] < 0.0
    kept = np.flatnonzero(changes.any(axis=1))
    q, step = q[kept], changes[kept].argmax(axis=1)
    low, high, first = grid[step], grid[step + 1], size[kept, step]
    for _ in range(52):
        q[:, 4] = 0.5 * (low + high)
        same = determinant(of, q) * first > 0.0
        low, high = np.where(same, q[:, 4], low), np.where(same, high, q[:, 4])
    q[:, 4] = low + rng.choice(NEAR, len(q)) * rng.choice([-1.0, 1.0], len(q))
    return q


def determinant(of, q):
    """(m,) of the Jacobian, half a metre to a radian, by a product of transforms of its own."""
    place, axes, origins = np.broadcast_to(np.eye(4), (len(q), 4, 4)), [], []
    for k in range(6):
        place = place @ of.origins[k]
        axes.append(place[:, :3, :3] @ of.directions[k])
        origins.append(place[:, :3, 3])
        x, y, z = of.directions[k]
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, cosine = np.sin(q[:, k])[:, None, None], np.cos(q[:, k])[:, None, None]
        turn = np.tile(np.eye(4), (len(q), 1, 1))
        turn[:, :3, :3] += sine * cross + (1.0 - cosine) * (cross @ cross)
        place = place @ turn
    tip = (place @ of.flange)[:, :3, 3]
    columns = [
        np.concatenate([np.cross(axis, (tip - origin) / 500.0), axis], axis=1)
        for axis, origin in zip(axes, origins)
    ]
    return np.linalg.det(np.stack(columns, axis=2))


@pytest.mark.parametrize("count", [120, pytest.param(10_000, marks=pytest.mark.long)])
def test_none_is_lost_where_two_solutions_meet(arm, count):
    """Joint angles at random next to such a place: they are among the solutions of their pose, each of which gives it back.
    The bound is the one of angles that a pose tells to the cube root of its last digits."""
    of, inverse, kdl = arm
    q = meeting(of, count, 11)
    assert len(q) > 0.7 * count
    poses = kdl.forward(q)
    found = inverse.inverse(poses)
    away = np.nan_to_num(apart(found, q), nan=np.pi).min(axis=0)
    assert (away < 1e-4).all()
    reached = np.isfinite(found).all(axis=2)
    off = np.abs(
        inverse.chain.forward(found[reached]) - np.broadcast_to(poses, (16, *poses.shape))[reached]
    )
    assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-9
