# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cuts of meshes with cones and cylinders: on the cone, on the mesh, closed, and with the solid on
the correct side."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.geometry.developable import TURN, Developable
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.solids.equidistant import Facets


def hull(points):
    """Vertices, outward faces and half-spaces (k, 4) of the convex hull of points."""
    convex_hull = ConvexHull(points)
    faces = convex_hull.simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * convex_hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    used = np.unique(faces)
    return points[used], np.searchsorted(used, faces), convex_hull.equations


def count_windings(loops, theta, z):
    """Count how often the loops enclose points of the surface, along rays up the hub, including
    loops around the hub."""
    count = np.full(len(theta), sum(loop.turns for loop in loops))
    for loop in loops:
        start = np.arctan2(loop.points[:, 1], loop.points[:, 0])
        end = start + np.remainder(np.roll(start, -1) - start + math.pi, TURN) - math.pi
        start_z, end_z = loop.points[:, 2], np.roll(loop.points[:, 2], -1)
        for turn in (-TURN, 0.0, TURN):
            turned_start, turned_end = start + turn, end + turn
            passes = (turned_start > theta[:, None]) != (turned_end > theta[:, None])
            crossing_z = start_z + (theta[:, None] - turned_start) * (end_z - start_z) / np.where(
                turned_end == turned_start, 1.0, turned_end - turned_start
            )
            count += np.where(
                passes & (crossing_z > z[:, None]), np.where(turned_end < turned_start, 1, -1), 0
            ).sum(axis=1)
    return count


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.always
def test_cuts_of_a_convex_body_enclose_its_inside(seed):
    rng = np.random.default_rng(seed)
    base = Developable(
        rng.uniform(5.0, 60.0), math.inf if seed % 3 == 0 else rng.uniform(20.0, 300.0)
    )
    # near the hub and around it: axis inside, pierced facets, edges crossed twice, contours around the axis
    vertices, faces, spaces = hull(
        rng.normal(size=3) * rng.choice([0.0, 20.0, 60.0])
        + rng.uniform(5, 60) * rng.normal(size=(rng.integers(5, 40), 3))
    )
    facets = Facets(base, vertices, faces)
    for distance in np.linspace(facets.distances.min(), facets.distances.max(), 9)[1:-1]:
        if base.radius + distance / math.cos(base.taper) <= 0.0:
            continue
        surface = base.offset(distance)
        loops = facets.cut(distance, 1e-3)
        for loop in loops:
            assert np.abs(base.distance(loop.points) - distance).max() < 1e-9
            assert np.abs((loop.points @ spaces[:, :3].T + spaces[:, 3]).max(axis=1)).max() < 1e-8
            middle = 0.5 * (loop.points + np.roll(loop.points, -1, axis=0))
            middles_on_mesh = middle[
                (middle @ spaces[:, :3].T + spaces[:, 3]).max(axis=1) < 1e-7
            ]  # on the mesh: no corner is cut off
            assert len(middles_on_mesh) == len(middle)
            assert np.abs(base.distance(middle) - distance).max() < 1.1e-3
        theta, z = (
            rng.uniform(-math.pi, math.pi, 300),
            rng.uniform(vertices[:, 2].min(), vertices[:, 2].max(), 300),
        )
        theta, z = theta[z < surface.height], z[z < surface.height]
        rho = surface.radius * (1.0 - z / surface.height)
        depth = (
            np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1) @ spaces[:, :3].T
            + spaces[:, 3]
        )
        is_clear = np.abs(depth.max(axis=1)) > 0.05
        np.testing.assert_array_equal(
            count_windings(loops, theta, z)[is_clear], (depth.max(axis=1) < 0.0)[is_clear]
        )


def make_box(low, high):
    """Vertices and outward faces of a box."""
    x, y, z = (np.array(pair) for pair in zip(low, high))
    vertices = np.array([[x[i], y[j], z[k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def test_cuts_of_a_box_around_the_axis_are_rings_on_its_lids():
    facets = Facets(Developable(10.0), *make_box((-50, -50, 0), (50, 50, 30)))
    loops = sorted(facets.cut(5.0, 1e-3), key=lambda loop: loop.points[:, 2].mean())
    assert [loop.turns for loop in loops] == [1, -1]
    for loop, height in zip(loops, (0.0, 30.0)):
        np.testing.assert_allclose(np.hypot(loop.points[:, 0], loop.points[:, 1]), 15.0, atol=1e-12)
        np.testing.assert_allclose(loop.points[:, 2], height, atol=1e-12)


def test_edges_along_generatrices_and_vertices_on_the_surface_leave_no_gap():
    # a wedge with two edges and its corners on the cylinder that cuts it
    angle = np.array([-0.4, 0.4])
    ring = np.stack([20.0 * np.cos(angle), 20.0 * np.sin(angle)], axis=1)
    bottom = np.vstack([np.c_[ring, [0.0, 0.0]], [[40.0, 0.0, 0.0]]])
    vertices, faces, _ = hull(np.vstack([bottom, bottom + [0.0, 0.0, 25.0]]))
    facets = Facets(Developable(20.0), vertices, faces)
    for distance in (0.0, 1e-12, -1e-12, 20.0, 19.999999, -1.0):
        for loop in facets.cut(distance, 1e-3):
            assert loop.turns == 0 and len(loop.points) >= 3
    # material continues beyond the chord between the two edges: one contour from lid to lid
    assert len(facets.cut(0.0, 1e-3)) == 1
    assert len(facets.cut(20.0, 1e-3)) == 0  # the cut only touches an edge


def test_neighbouring_layers_are_equidistant():
    base = Developable(60.0, 200.0)
    rng = np.random.default_rng(5)
    vertices, faces, _ = hull(np.array([90.0, 0.0, 60.0]) + 30.0 * rng.normal(size=(30, 3)))
    facets = Facets(base, vertices, faces)
    for index, distance in enumerate(3.0 * np.arange(1, 12)):
        below = base.offset(distance - 3.0)
        for loop in facets.cut(distance, 1e-3):
            np.testing.assert_allclose(
                below.distance(loop.points), 3.0, atol=1e-9, err_msg=str(index)
            )


def test_an_open_mesh_is_rejected_with_its_position():
    vertices, faces = make_box((10, -5, 0), (20, 5, 30))
    with pytest.raises(InputError, match=r"blade: 3 edges .* \(1\d, 0, 30\) mm") as caught:
        Facets(Developable(10.0), vertices, faces[:-1], "blade")
    assert caught.value.code == "OPEN_MESH"


def test_the_order_of_faces_does_not_matter():
    base = Developable(40.0, 150.0)
    rng = np.random.default_rng(8)
    vertices, faces, _ = hull(np.array([50.0, 10.0, 20.0]) + 25.0 * rng.normal(size=(40, 3)))
    order = rng.permutation(len(faces))
    rotated = np.array(
        [np.roll(face, k) for face, k in zip(faces[order], rng.integers(0, 3, len(faces)))]
    )
    for distance in (2.0, 9.0, 20.0):
        lengths = []
        for ordered_faces in (faces, rotated):
            loops = Facets(base, vertices, ordered_faces).cut(distance, 1e-4)
            lengths.append(
                sorted(np.linalg.norm(np.diff(loop.points, axis=0), axis=1).sum() for loop in loops)
            )
        np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-3)
