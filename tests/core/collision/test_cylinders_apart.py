# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders nearer than a gap, against alternating projections onto both, which share no code with
the tested function."""

import numpy as np

from freecad_am.core.collision.separation import PlacedCylinders, nearer

ROD_SIZE, PEER_SIZE = (220.0, 35.0), (60.0, 90.0)  # length and radius, mm


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def project_points(rods, points):
    """Return the points of cylinders nearest to points."""
    along = np.einsum("ij,ij->i", points - rods.start, rods.axis)
    across = points - rods.start - along[:, None] * rods.axis
    size = np.linalg.norm(across, axis=1)
    across *= np.minimum(1.0, rods.radius / np.maximum(size, 1e-12))[:, None]
    return rods.start + np.clip(along, 0.0, rods.length)[:, None] * rods.axis + across


def distance(body, peer):
    """Return distances (k,) in mm: alternating projections onto two convex bodies converge to it
    from above."""
    peer_point = peer.start.copy()
    for _ in range(4000):
        point = project_points(body, peer_point)
        peer_point = project_points(peer, point)
    return np.linalg.norm(point - peer_point, axis=1)


def test_rods_are_nearer_than_a_gap_where_projections_say_so():
    """`nearer` agrees with alternating projections for random, parallel and perpendicular
    cylinders."""
    chance = np.random.default_rng(15)
    count = 1200
    rods = PlacedCylinders(
        chance.uniform(-150, 150, (count, 3)), unit(chance.normal(size=(count, 3))), *ROD_SIZE
    )
    axis = unit(chance.normal(size=(count, 3)))
    axis[:200] = rods.axis[:200]  # perpendicular
    axis[200:300] = -rods.axis[200:300]
    axis[300:400] = unit(np.cross(rods.axis[300:400], axis[300:400]))  # perpendicular
    peers = PlacedCylinders(chance.uniform(-250, 250, (count, 3)), axis, *PEER_SIZE)
    gaps = distance(rods, peers)
    assert (gaps < 0.4).sum() > 100 and (gaps > 10.0).sum() > 400
    for gap in (0.4, 10.0, 60.0):
        clear = np.abs(gaps - gap) > 0.05  # alternating projections converge slowly
        assert clear.sum() > 1150
        assert (nearer(rods, peers, gap) == (gaps < gap))[clear].all()
        assert (nearer(peers, rods, gap) == nearer(rods, peers, gap))[clear].all()


def test_faces_and_sides_are_where_analysis_says():
    """Parallel, end to end, and one end above the other's side."""
    up, ahead = np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
    post = PlacedCylinders(np.zeros((1, 3)), up, 100.0, 20.0)
    beside, above, across = (
        ([50.0, 0.0, 30.0], up, 20.0),
        ([5.0, 5.0, 112.0], up, 12.0),
        ([-10.0, 3.0, 128.0], ahead, 18.0),
    )
    for start, axis, gap in (beside, above, across):
        neighbour = PlacedCylinders(np.array([start]), axis, 40.0, 10.0)
        assert (
            nearer(post, neighbour, gap + 1e-3)[0] and not nearer(post, neighbour, gap - 1e-3)[0]
        ), start
