# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames against definitions and against scipy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry import frames


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def test_rotation_about_is_that_of_the_rotation_vector(rng):
    axes, angles = unit(rng.standard_normal((200, 3))), rng.uniform(-7, 7, 200)
    expected = Rotation.from_rotvec(axes * angles[:, None]).as_matrix()
    assert np.abs(frames.rotation_about(axes, angles) - expected).max() < 1e-14


def test_bryant_is_rx_ry_rz_and_comes_back(rng):
    six = rng.uniform(-3, 3, (500, 6))
    six[:, 4] = rng.uniform(-np.pi / 2, np.pi / 2, 500)
    poses = frames.bryant(six)
    assert (
        np.abs(poses[:, :3, :3] - Rotation.from_euler("XYZ", six[:, 3:]).as_matrix()).max() < 1e-14
    )
    assert np.array_equal(poses[:, :3, 3], six[:, :3])
    assert np.abs(frames.to_bryant(poses[:, :3, :3]) - six[:, 3:]).max() < 1e-9


@pytest.mark.parametrize("distance", [0.0, 1e-14, 1e-9, 1e-5])
@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_bryant_at_gimbal_lock_gives_the_rotation_back(rng, pitch, distance):
    six = rng.uniform(-3, 3, (100, 6))
    six[:, 4] = pitch - np.sign(pitch) * distance
    rotation = frames.bryant(six)[:, :3, :3]
    again = np.zeros((100, 6))
    again[:, 3:] = frames.to_bryant(rotation)
    assert np.abs(frames.bryant(again)[:, :3, :3] - rotation).max() < 1e-11


def test_rpy_is_rz_ry_rx(rng):
    rpy, origin = rng.uniform(-3, 3, (50, 3)), rng.uniform(-9, 9, (50, 3))
    poses = frames.from_rpy(origin, rpy)
    assert np.abs(poses[:, :3, :3] - Rotation.from_euler("xyz", rpy).as_matrix()).max() < 1e-14
    assert np.array_equal(poses[:, :3, 3], origin)


def test_inverse(rng):
    poses = frames.bryant(rng.uniform(-3, 3, (4, 5, 6)))
    assert np.abs(frames.inverse(poses) @ poses - np.eye(4)).max() < 1e-14


@pytest.mark.parametrize("bend", [0.0, 1e-12, 1e-6, 1.0, np.pi - 1e-6, np.pi - 1e-12, np.pi])
def test_smallest_rotation_takes_one_to_the_other_by_the_angle_between(rng, bend):
    start = unit(rng.standard_normal((100, 3)))
    across = unit(np.cross(start, rng.standard_normal((100, 3))))
    end = np.cos(bend) * start + np.sin(bend) * across
    rotation = frames.smallest_rotation(start, end)
    assert np.abs((rotation @ start[..., None])[..., 0] - end).max() < 1e-14
    assert np.abs(np.linalg.det(rotation) - 1.0).max() < 1e-13
    assert np.abs(Rotation.from_matrix(rotation).magnitude() - bend).max() < 3e-8
    # no twist: a vector normal to both stays
    normal = np.cross(start, across)
    if bend < 3.0:
        assert np.abs((rotation @ normal[..., None])[..., 0] - normal).max() < 1e-9
