# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forward kinematics of joint frames against the product of matrices that defines it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.chain import Chain
from freecad_am.core.kinematics.machines import machine


def product(chain, q):
    """Link poses and flange of one joint vector by definition."""
    pose, links = np.eye(4), []
    for origin, direction, angle in zip(chain.origins, chain.directions, q, strict=True):
        pose = (
            pose
            @ origin
            @ frames.pose(Rotation.from_rotvec(angle * direction).as_matrix(), np.zeros(3))
        )
        links.append(pose)
    return links, pose @ chain.flange


@pytest.fixture
def skewed():
    """A chain of three joints in general position, unlike any robot."""
    rng = np.random.default_rng(4)
    directions = rng.standard_normal((3, 3))
    return Chain(
        frames.bryant(rng.uniform(-2, 2, (3, 6)) * np.array((100, 100, 100, 1, 1, 1))),
        directions / np.linalg.norm(directions, axis=1, keepdims=True),
        frames.bryant((5.0, 6.0, 7.0, 0.3, 0.2, 0.1)),
    )


@pytest.mark.parametrize(
    "name", ["skewed", "kuka-kr16-r2010-2", "motoman-ar2010", "staubli-rx60bl"]
)
def test_forward_and_frames_are_the_product_of_matrices(name, skewed):
    chain = skewed if name == "skewed" else machine.load(name).chain
    q = np.random.default_rng(6).uniform(-7, 7, (20, chain.axes))
    got = chain.frames(q)
    for row, angles in enumerate(q):
        links, flange = product(chain, angles)
        assert np.abs(got.flange[row] - flange).max() < 1e-10
        for axis, link in enumerate(links):
            assert (
                np.abs(got.directions[row, axis] - link[:3, :3] @ chain.directions[axis]).max()
                < 1e-13
            )
            assert np.abs(got.origins[row, axis] - link[:3, 3]).max() < 1e-10
    assert np.array_equal(chain.forward(q), got.flange)


def test_any_leading_dimensions(skewed):
    q = np.random.default_rng(6).uniform(-7, 7, (4, 5, 3))
    flange = skewed.forward(q)
    assert flange.shape == (4, 5, 4, 4)
    assert np.abs(skewed.forward(q[2, 3]) - flange[2, 3]).max() < 1e-12
    assert skewed.frames(q[2, 3]).directions.shape == (3, 3)
    assert skewed.forward(q[:0]).shape == (0, 5, 4, 4)
    repeated = np.tile(q.reshape(-1, 3), (500, 1))
    assert np.abs(skewed.forward(repeated)[-20:] - flange.reshape(-1, 4, 4)).max() < 1e-12


@pytest.mark.parametrize("name", ["skewed", "staubli-rx60bl", "head-table-xyzbc"])
def test_links_of_one_vector_are_the_product_of_matrices(name, skewed):
    chain = skewed if name == "skewed" else machine.load(name).chain
    q = np.random.default_rng(8).uniform(-7, 7, chain.axes)
    links = chain.links(q)
    assert np.array_equal(links[0], np.eye(4))
    assert np.abs(links[-1] @ chain.flange - chain.forward(q)).max() < 1e-10
    joint_frames = chain.frames(q)
    for axis, link in enumerate(links[1:]):
        assert (
            np.abs(joint_frames.directions[axis] - link[:3, :3] @ chain.directions[axis]).max()
            < 1e-13
        )
        slid = q[axis] * joint_frames.directions[axis] if chain.sliding[axis] else 0.0
        assert np.abs(joint_frames.origins[axis] + slid - link[:3, 3]).max() < 1e-10
