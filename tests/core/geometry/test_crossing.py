# SPDX-License-Identifier: LGPL-2.1-or-later
"""Intersecting triangles against a test of every pair; a connected mesh that intersects itself is
rejected."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.mesh.near_triangles import find_crossings
from freecad_am.core.geometry.mesh.repair import repair_mesh
from freecad_am.core.issues import InputError


def tube(course, radius=2.0, sides=12):
    """A closed tube with flat ends about a course (n, 3) that does not run along Z."""
    tangents = np.gradient(course, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    across = np.cross(tangents, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across, axis=1)[:, None]
    up = np.cross(across, tangents)
    turn = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[:, None]
    rings = [
        point + radius * (np.cos(turn) * a + np.sin(turn) * b)
        for point, a, b in zip(course, across, up)
    ]
    points = np.vstack([*rings, course[:1], course[-1:]])
    i = np.arange(sides)
    j = (i + 1) % sides
    faces = []
    for ring in range(len(course) - 1):
        low, high = ring * sides, (ring + 1) * sides
        faces += [np.c_[low + i, low + j, high + j], np.c_[low + i, high + j, high + i]]
    last_ring, ends = (len(course) - 1) * sides, len(course) * sides
    faces += [
        np.c_[j, i, np.full(sides, ends)],
        np.c_[last_ring + i, last_ring + j, np.full(sides, ends + 1)],
    ]
    return points, np.vstack(faces).astype(np.intp)


def looped(rise):
    """A course that runs around once and passes over itself with a vertical distance `rise` near
    (0, 0)."""
    t = np.linspace(-0.3, np.pi + 0.3, 60)
    return np.c_[30.0 * np.sin(t), 30.0 * np.sin(2.0 * t), rise * t / np.pi]


def passes(a, b, corners):
    """Return whether the line from a to b passes through a triangle, by the signs of volumes."""

    def side(p, q, r, s):
        return np.sign(np.dot(np.cross(q - p, r - p), s - p))

    p, q, r = corners
    if side(p, q, r, a) == side(p, q, r, b):
        return False
    return side(a, b, p, q) == side(a, b, q, r) == side(a, b, r, p)


@pytest.mark.parametrize("seed", range(4))
def test_pairs_are_those_found_one_by_one(seed):
    """The pairs agree with a test of every pair."""
    chance = np.random.default_rng(seed)
    middles = chance.uniform(-20.0, 20.0, (150, 1, 3))
    corners = middles + chance.normal(size=(150, 3, 3)) * chance.uniform(0.5, 8.0, (150, 1, 1))
    pairs = find_crossings(corners.reshape(-1, 3), np.arange(450).reshape(-1, 3), 0.0).pairs
    crossing_pairs = {(min(pair), max(pair)) for pair in pairs.tolist()}
    expected_pairs = set()
    low, high = corners.min(axis=1), corners.max(axis=1)
    for i in range(150):
        for j in range(i):
            if (low[i] > high[j]).any() or (low[j] > high[i]).any():  # disjoint bounding boxes
                continue
            corners_a, corners_b = corners[i], corners[j]
            if any(
                passes(corners_a[k], corners_a[k - 1], corners_b)
                or passes(corners_b[k], corners_b[k - 1], corners_a)
                for k in range(3)
            ):
                expected_pairs.add((j, i))
    assert len(expected_pairs) > 40 and crossing_pairs == expected_pairs


def test_neighbours_and_flat_faces_do_not_cross():
    points, faces = tube(looped(40.0), sides=40)
    turned = points @ Rotation.from_euler("xyz", [0.3, 0.7, 1.1]).as_matrix()
    for vertices in (points, turned, turned.astype(np.float32).astype(float)):
        assert len(find_crossings(vertices, faces, 1e-3).pairs) == 0
    assert len(repair_mesh(turned, faces, "loop").solids) == 1


def test_triangles_that_share_a_vertex_may_cross():
    points = np.array([[0, 0, 0], [10, -5, 0], [10, 5, 0], [10, 0, -5], [10, 0, 5]], dtype=float)
    crossings = find_crossings(points, np.array([[0, 1, 2], [0, 3, 4]]), 0.01)
    assert crossings.pairs.tolist() == [[0, 1]] or crossings.pairs.tolist() == [[1, 0]]
    assert crossings.length == pytest.approx([10.0])
    assert crossings.positions == pytest.approx(np.array([[5.0, 0.0, 0.0]]))


@pytest.mark.parametrize("deep", [-0.004, 0.0, 0.004])
def test_what_only_touches_does_not_cross(deep):
    """Contact is not an intersection: a vertex of one triangle on the face of another, and coplanar
    faces."""
    face = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]]
    tip = [[0.0, 0.0, -deep], [-2.0, 1.0, 5.0], [2.0, 0.0, 5.0]]
    beside = [[1.0, -1.0, 0.0], [3.0, 30.0, 0.0], [-3.0, 30.0, 0.0]]
    points = np.array([*face, *tip, *beside])
    assert len(find_crossings(points, np.arange(9).reshape(-1, 3), 0.01).pairs) == 0
    points[3, 2] = -0.5
    assert len(find_crossings(points, np.arange(9).reshape(-1, 3), 0.01).pairs) == 1


@pytest.mark.parametrize(
    "turn", [np.eye(3), Rotation.from_euler("xyz", [0.4, 1.2, -0.3]).as_matrix()]
)
def test_a_mesh_that_cuts_itself_is_refused_with_the_place(turn):
    """A self-intersecting mesh is rejected with the position of the intersection."""
    points, faces = tube(looped(1.0))
    with pytest.raises(InputError) as caught:
        repair_mesh(points @ turn, faces, "loop")
    assert caught.value.code == "SELF_CROSSING" and caught.value.where == "loop"
    position = [
        float(number) for number in caught.value.message.split("(")[1].split(")")[0].split(",")
    ]
    assert np.linalg.norm(turn @ position) < 5.0  # the tube crosses itself at the origin
    repair_mesh(tube(looped(40.0))[0] @ turn, faces, "loop")


def test_long_triangles_and_flat_faces_of_many_are_no_work():
    """Long triangles of a fine cylinder, whose axis-aligned boxes all overlap, are still checked
    quickly."""
    from freecad_am.core.geometry.mesh.near_triangles import near_pairs

    course = np.c_[np.linspace(0.0, 100.0, 2), np.zeros((2, 2))]
    points, faces = tube(course, 50.0, 2000)
    corners = (points @ Rotation.from_euler("xyz", [0.3, 0.7, 1.1]).as_matrix())[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    assert sum(len(pairs) for pairs in near_pairs(corners, normals, 0.01)) < 10 * len(faces)
