# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links drawn from a chain: every machine has closed, outward links that follow its axes."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.kinematics.links import external_links, solids
from freecad_am.core.kinematics.links import robot as robot_links
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.simulation import table_links
from tests.core.kinematics.arms import EXAMPLES

NAMES = EXAMPLES
ROBOTS = [name for name in NAMES if machine.load(name).free]
TABLES = [name for name in NAMES if name not in ROBOTS]


def links_of(name):
    loaded = machine.load(name)
    link_solids = (robot_links if loaded.free else table_links).solids(loaded.chain)
    return loaded, link_solids


def volume(solid):
    """Signed volume by the divergence theorem, with triangles oriented by their normals."""
    corners = solid.points[solid.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outward = np.einsum("ij,ij->i", across, solid.normals[solid.triangles].mean(axis=1))
    sides = np.einsum("ij,ij->i", corners.mean(axis=1), across * np.sign(outward)[:, None])
    return sides.sum() / 6.0


PRIMITIVES = {
    "cylinder": (solids.cylinder([1, 2, 3], [1, 2, 13], 5.0, bevel=0.0), np.pi * 25 * 10),
    "cone": (
        solids.revolve([(0, 0), (6, 0), (3, 1), (0, 1)], [5, 0, 0], [0, 12, 0]),
        np.pi * 13 / 3 * (36 + 18 + 9),
    ),
    "capsule": (solids.capsule([0, 0, 0], [0, 8, 0], 3.0, 3.0), np.pi * 9 * 8 + 4 / 3 * np.pi * 27),
    "box": (solids.box([9, 9, 9], [0, 1, 0], [0, 0, 1], (2.0, 3.0, 4.0)), 24.0),
    "rod": (solids.strut([0, 0, 0], [10, 0, 0], [0, 0, 1], 2.0, 2.0, 3.0), 3.0 * (np.pi * 4 + 40)),
}


@pytest.mark.parametrize("name", PRIMITIVES)
def test_primitives_are_closed_and_turned_outwards(name):
    solid, exact = PRIMITIVES[name]
    assert np.abs(np.linalg.norm(solid.normals, axis=1) - 1.0).max() < 1e-9
    assert volume(solid) == pytest.approx(exact, rel=0.02)
    rounded = solid.points.round(6)
    _, vertex_index = np.unique(rounded, axis=0, return_inverse=True)
    corners = vertex_index.reshape(-1)[solid.triangles]
    corners = corners[
        (corners[:, 0] != corners[:, 1])
        & (corners[:, 1] != corners[:, 2])
        & (corners[:, 2] != corners[:, 0])
    ]
    edges = np.sort(
        np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1
    )
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()


@pytest.mark.parametrize("name", NAMES)
def test_every_machine_is_drawn_where_its_axes_are(name):
    loaded, link_solids = links_of(name)
    chain = loaded.chain
    assert len(link_solids) == chain.axes + 1 and sum(map(len, link_solids)) >= 8
    poses = chain.links(np.zeros(chain.axes))
    for pose, link in zip(poses, link_solids):
        for solid in link:
            assert (
                np.isfinite(solid.points).all()
                and np.abs(np.linalg.norm(solid.normals, axis=1) - 1.0).max() < 1e-9
            )
            moved = solid.move(pose)
            assert np.abs(moved.points - (solid.points @ pose[:3, :3].T + pose[:3, 3])).max() < 1e-9
    # the last link reaches the flange but not beyond
    last_link_points = np.concatenate([solid.move(poses[-1]).points for solid in link_solids[-1]])
    flange = chain.forward(np.zeros(chain.axes))
    over = (last_link_points - flange[:3, 3]) @ flange[:3, 2]
    assert over.max() <= 1.0 and over.max() > -5.0


@pytest.mark.parametrize("name", ROBOTS)
def test_neighbouring_links_of_robots_meet_whatever_the_joints(name):
    """Neighbouring links of robots touch for all joint positions."""
    loaded, link_solids = links_of(name)
    bones = robot_links.skeleton(loaded.chain)
    for q in np.random.default_rng(3).uniform(-2, 2, (3, 6)):
        poses = loaded.chain.links(q)
        clouds = [
            np.concatenate([solid.move(pose).points for solid in link])
            for pose, link in zip(poses, link_solids)
        ]
        for axis, (lower, upper) in enumerate(zip(clouds, clouds[1:])):
            distance = cKDTree(upper).query(lower)[0].min()
            assert distance < 1.2 * bones.radius(axis), (axis, distance)


def test_the_fanuc_s_bones_are_those_of_its_drawing():
    bones = robot_links.skeleton(machine.load("fanuc-arcmate120ic").chain)
    enter = [
        [0, 0, 0],
        [150, 0, 525],
        [150, 0, 1315],
        [150, 0, 1565],
        [985, 0, 1565],
        [985, 0, 1565],
    ]
    leave = [
        [0, 0, 525],
        [150, 0, 525],
        [150, 0, 1315],
        [985, 0, 1565],
        [985, 0, 1565],
        [1085, 0, 1565],
    ]
    assert np.abs(bones.enter - enter).max() < 1e-9 and np.abs(bones.leave - leave).max() < 1e-9
    assert bones.size == pytest.approx(525 + 150 + 790 + 250 + 835 + 100)


@pytest.mark.parametrize("name", TABLES)
def test_of_tables_the_bearings_stand_still_and_the_last_axis_turns_the_disc_in_itself(name):
    """The bearings of a table are fixed, and its last axis rotates the disc about itself."""
    loaded, link_solids = links_of(name)
    chain = loaded.chain
    stands = table_links.standing_link(chain)
    assert chain.sliding[stands - 1] and not chain.sliding[stands:].any()
    assert link_solids[stands] and all(
        not link for link in link_solids[int(np.flatnonzero(chain.sliding)[0]) + 1 : stands]
    )
    if stands < chain.axes:
        disc = max(link_solids[-1], key=lambda solid: np.ptp(solid.points, axis=0).max())
        axis = chain.directions[-1]
        radius = np.linalg.norm(disc.points - (disc.points @ axis)[:, None] * axis, axis=1)
        assert radius.max() == pytest.approx(table_links.RADIUS, rel=1e-6)


@pytest.mark.parametrize("name", ROBOTS)
def test_rods_hold_all_that_is_drawn_of_a_link_and_little_more(name):
    """Capsules contain all drawn solids of a link and are not much larger."""
    loaded, link_solids = links_of(name)
    for link, rods in zip(link_solids, external_links.robot_cylinders(loaded.chain)):
        for solid in link:
            assert any(rod.holds(solid.points).all() for rod in rods)
        solid_volume = sum(volume(solid) for solid in link)
        capsule_volume = sum(np.pi * rod.length * rod.radius**2 for rod in rods)
        # plates are enclosed as round, and tapering solids by their maximum width
        assert capsule_volume < 4.0 * solid_volume


def test_of_links_with_a_shape_of_their_own_that_is_held():
    """Capsules of a link with its own shape contain that shape."""
    loaded, _ = links_of("kuka-kr16-2")
    block = solids.box([300.0, 0.0, 40.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], (700.0, 160.0, 120.0))
    shapes = [None, None, (block.points, block.triangles), None, None, None, None]
    plain, capsules = (
        external_links.robot_cylinders(loaded.chain),
        external_links.robot_cylinders(loaded.chain, shapes),
    )
    inside = np.random.default_rng(1).uniform([-50, -80, -20], [650, 80, 100], (2000, 3))
    for points in (block.points, inside):
        assert np.any([rod.holds(points) for rod in capsules[2]], axis=0).all()
    for custom, default in list(zip(capsules, plain))[3:]:
        assert [rod.radius for rod in custom] == [rod.radius for rod in default]
