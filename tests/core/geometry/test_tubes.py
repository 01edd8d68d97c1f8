# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tubes are closed bodies with the stated volume, width and height and outward triangles."""

import numpy as np
import pytest

from freecad_am.core.geometry import tubes


def volume(mesh):
    corners = mesh.points[mesh.triangles]
    return np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0


def area(sides):
    x, y = np.array(tubes.SECTIONS[sides]).T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def build_tube(points, build, closed, sides, width=3.0, height=2.0):
    starts, n = np.array([0, len(points)]), len(points)
    across = tubes.frames(points, build, starts, np.array([closed]))
    ends = np.zeros(n, dtype=bool)
    ends[-1] = True
    return tubes.mesh(points, across, np.full(n, width), np.full(n, height), ends, sides), across


@pytest.mark.parametrize("sides", [4, 6, 8])
def test_a_straight_tube_has_its_volume_and_stands_on_its_points(sides):
    rng = np.random.default_rng(sides)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = np.outer(np.linspace(0.0, 10.0, 7), turn[0])
    mesh, _ = build_tube(points, np.tile(turn[2], (7, 1)), False, sides)
    assert volume(mesh) == pytest.approx(10.0 * area(sides) * 3.0 * 2.0 / 4.0, rel=1e-12)
    assert np.ptp(mesh.points @ turn[1]) == pytest.approx(3.0) and np.ptp(
        mesh.points @ turn[0]
    ) == pytest.approx(10.0)
    heights = mesh.points @ turn[2]
    assert (heights.min(), heights.max()) == pytest.approx((0.0, 2.0), abs=1e-12)
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1.0)


@pytest.mark.parametrize("sides", [4, 6, 8])
def test_every_edge_has_two_sides(sides):
    angle = np.linspace(0.0, 5.0, 30)
    points = np.column_stack([20 * np.cos(angle), 20 * np.sin(angle), angle])
    mesh, _ = build_tube(points, np.tile([0.0, 0.0, 1.0], (30, 1)), False, sides)
    edges = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    directed, reversed_edges = (
        {tuple(edge) for edge in edges},
        {tuple(edge[::-1]) for edge in edges},
    )
    assert len(directed) == len(edges) and directed == reversed_edges


def test_a_ring_has_the_volume_of_its_section_turned():
    """Pappus: the area of the section times the path of its centre, a polygon of chords."""
    count = 400
    angle = np.linspace(0.0, 2.0 * np.pi, count + 1)
    points = np.column_stack([20 * np.cos(angle), 20 * np.sin(angle), 0 * angle])
    points[-1] = points[0]
    mesh, across = build_tube(points, np.tile([0.0, 0.0, 1.0], (count + 1, 1)), True, 8)
    path_length = 2.0 * 20.0 * count * np.sin(np.pi / count)
    assert volume(mesh) == pytest.approx(path_length * area(8) * 1.5, rel=1e-6)
    assert np.allclose(across.side[0], across.side[-1]) and np.allclose(
        across.turn, 2.0 * np.pi / count
    )


def test_corners_are_mitred_and_sharp_ones_not_without_bound():
    corner = np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0]])
    mesh, across = build_tube(corner, np.tile([0.0, 0.0, 1.0], (3, 1)), False, 4, 2.0, 2.0)
    assert across.mitre == pytest.approx([1.0, np.sqrt(2.0), 1.0]) and across.turn[
        1
    ] == pytest.approx(np.pi / 2)
    assert volume(mesh) == pytest.approx(20.0 * 4.0)
    back = np.array([[0.0, 0, 0], [10, 0, 0], [0, 0, 0]])
    mesh, across = build_tube(back, np.tile([0.0, 0.0, 1.0], (3, 1)), False, 4)
    assert across.mitre.max() == 2.0 and np.isfinite(mesh.points).all()


def test_sections_are_kept_at_ends_at_strides_and_at_corners():
    turn = np.zeros(100)
    turn[[33, 61]] = np.pi / 2
    starts = np.array([0, 50, 100])
    keep = np.flatnonzero(tubes.select_sections(turn, starts, 20))
    assert keep.tolist() == [0, 20, 33, 40, 49, 50, 60, 61, 80, 99]
