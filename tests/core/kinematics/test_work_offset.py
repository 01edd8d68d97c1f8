# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.touched`: the part's pose from touched points, against scipy's fit of rotations; and
rejected inputs."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry import frames
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.cell import work_offset
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import TOUCHED, TouchedPoint
from tests.kdl_links import KdlLinks

POINTS = np.array([[0.0, 0.0, 0.0], [120.0, 0.0, 5.0], [0.0, 80.0, 0.0], [110.0, 90.0, -3.0]])


def pairs(part_points, robot_points):
    return tuple(
        TouchedPoint(tuple(part_point), tuple(robot_point))
        for part_point, robot_point in zip(part_points.tolist(), robot_points.tolist(), strict=True)
    )


@pytest.mark.parametrize("seed", range(8))
def test_the_best_rigid_motion_and_what_is_left(seed):
    """The best rigid motion and its residuals agree with scipy."""
    rng = np.random.default_rng(seed)
    part_points = rng.normal(scale=100.0, size=(3 + seed, 3))
    turn, move = Rotation.random(random_state=seed), rng.normal(scale=800.0, size=3)
    robot_points = turn.apply(part_points) + move + rng.normal(scale=0.1, size=part_points.shape)
    offset = work_offset(pairs(part_points, robot_points), 5.0)
    best, _ = Rotation.align_vectors(
        robot_points - robot_points.mean(axis=0), part_points - part_points.mean(axis=0)
    )
    assert np.abs(offset.pose[:3, :3] - best.as_matrix()).max() < 1e-9
    assert (
        np.abs(
            offset.pose[:3, 3] - (robot_points.mean(axis=0) - best.apply(part_points.mean(axis=0)))
        ).max()
        < 1e-7
    )
    residuals = np.linalg.norm(
        best.apply(part_points - part_points.mean(axis=0))
        + robot_points.mean(axis=0)
        - robot_points,
        axis=1,
    )
    assert np.allclose(offset.residual, residuals, atol=1e-9)
    assert np.linalg.det(offset.pose[:3, :3]) == pytest.approx(1.0)
    six = offset.six()
    assert np.abs(frames.bryant((*six[:3], *np.radians(six[3:]))) - offset.pose).max() < 1e-9


def test_plane_points_are_not_mirrored():
    flat = POINTS * [1.0, 1.0, 0.0]
    turn = Rotation.from_euler("xyz", [10.0, -5.0, 170.0], degrees=True)
    offset = work_offset(pairs(flat, turn.apply(flat) + 500.0), 0.1)
    assert np.abs(offset.pose[:3, :3] - turn.as_matrix()).max() < 1e-9


@pytest.mark.parametrize(
    ("part", "robot", "says"),
    [
        (POINTS[:2], POINTS[:2], "2 point"),
        (
            POINTS[[0, 1, 1]] * [[1], [1], [2]],
            POINTS[[0, 1, 1]] * [[1], [1], [2]],
            "points on the part are collinear",
        ),
        (POINTS, POINTS[[0, 1, 1, 1]] * [[1], [1], [2], [3]], "points touched are collinear"),
        (POINTS, POINTS * 25.4, "25.4 times as far apart as planned; one set is in inches"),
        (POINTS, POINTS * 1e-3, "one set is in m;"),
        (POINTS, POINTS * 1.3, "belong to another part"),
        (POINTS, POINTS * [1.0, 1.0, -1.0], r"point \d is \d\.\d+ mm from its touched position"),
        (POINTS, POINTS[[1, 0, 2, 3]], r"point \d is \d+\.?\d* mm from its touched position"),
        (
            POINTS,
            POINTS + [[0, 0, 0], [0, 0, 0], [0, 0, 6.0], [0, 0, 0]],
            r"point \d is 1\.\d+ mm .* more than cell.touched_tolerance = 1 mm",
        ),
    ],
)
def test_what_is_refused(part, robot, says):
    with pytest.raises(InputError, match=says) as error:
        work_offset(pairs(part, robot + 700.0), 1.0)
    assert (error.value.code, error.value.where) == ("TOUCHED", "cell.touched")


def test_points_of_the_toolpath_are_met_where_they_were_touched():
    """By PyKDL: with the joint values of a point the tip is at the touched position."""
    turn = Rotation.from_euler("xyz", [2.0, -3.0, 25.0], degrees=True)
    move = np.array([880.0, 60.0, -120.0])
    text = "; ".join(map(str, pairs(POINTS, turn.apply(POINTS) + move)))
    assert TOUCHED.read(text) == pairs(
        *(
            np.array([getattr(touched_point, side) for touched_point in TOUCHED.read(text)])
            for side in ("part", "robot")
        )
    )
    settings = CellParameters(setup="tool-on-robot", branch=("front", "up", "flip"), touched=text)
    cell = cells.resolve(settings, frames.pose(np.eye(3), [3.0, -4.0, 10.0]))
    position, tool = POINTS + [0.0, 0.0, 20.0], np.tile([0.0, 0.0, 1.0], (4, 1))
    flange = cell.pose_frames(position, tool).flange_poses(np.zeros(4))
    arm = KdlLinks(cell.machine)
    expected = turn.apply(position) + move
    joints = cell.machine.arm.inverse_branch(flange, cell.branch)
    assert np.isfinite(joints).all()
    for q, point in zip(joints, expected, strict=True):
        pose = np.linalg.inv(cell.machine.base) @ arm.frame(q) @ cell.poses.carried
        assert np.abs(pose[:3, 3] - point).max() < 1e-6


@pytest.mark.parametrize(
    "values",
    [
        {"setup": "part-on-robot"},
        {"external": "motoman-motopos-d500 at 1500 0 0 0 0 0 carries part"},
    ],
)
def test_only_a_part_that_stands_is_touched(values):
    text = "; ".join(map(str, pairs(POINTS, POINTS + 700.0)))
    settings = dataclasses.replace(CellParameters(setup="tool-on-robot", touched=text), **values)
    with pytest.raises(InputError, match="but here the part is fixed"):
        cells.resolve(settings, np.eye(4))
