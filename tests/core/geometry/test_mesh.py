# SPDX-License-Identifier: LGPL-2.1-or-later
"""Level lines of meshes: known lines, holes, order and sides; feet on smooth meshes."""

import numpy as np
import pytest

from freecad_am.core.geometry.mesh import coarsen
from freecad_am.core.geometry.mesh.triangle_mesh import Mesh, chains
from freecad_am.core.issues import InputError


def sheet(n=21, side=10.0):
    x = np.linspace(-side, side, n)
    points = np.stack([*np.meshgrid(x, x, indexing="ij"), np.zeros((n, n))], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    return Mesh(points, np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))


def everything(mesh):
    return np.arange(len(mesh.faces))


def test_circles_close_and_keep_the_lower_side_on_their_left():
    mesh = sheet(81)
    values = np.hypot(*mesh.vertices[:, :2].T) - 6.0
    (line,) = mesh.level_lines(values, everything(mesh))
    assert line.closed
    assert np.hypot(*line.points[:, :2].T) == pytest.approx(6.0, abs=0.01)
    around = np.unwrap(np.arctan2(line.points[:, 1], line.points[:, 0]))
    assert (np.diff(around) > 0.0).all() and around[-1] - around[0] > 6.0


def test_a_straight_line_is_exact_and_open():
    mesh = sheet()
    values = mesh.vertices @ np.array([1.0, 0.3, 0.0]) - 0.77
    (line,) = mesh.level_lines(values, everything(mesh))
    assert not line.closed
    assert line.points @ np.array([1.0, 0.3, 0.0]) == pytest.approx(0.77, abs=1e-4)
    assert np.abs(line.points[[0, -1], 1]) == pytest.approx(10.0)
    assert np.abs(line.rims[:, 0]) == pytest.approx(1.0)


def test_several_lines_at_once():
    mesh = sheet(81)
    values = np.cos(mesh.vertices[:, 0]) * np.cos(mesh.vertices[:, 1]) - 0.5
    lines = mesh.level_lines(values, everything(mesh))
    for line in lines:
        x, y, _ = line.points.T
        assert np.cos(x) * np.cos(y) == pytest.approx(0.5, abs=0.03)


def test_faces_that_turn_opposite_ways_are_refused():
    mesh = sheet()
    mixed = mesh.faces.copy()
    mixed[::2] = mixed[::2, ::-1]
    with pytest.raises(InputError, match="opposite orientations"):
        Mesh(mesh.vertices, mixed).level_lines(mesh.vertices[:, 0] - 0.3, everything(mesh))


def test_only_what_is_linked_is_joined():
    mesh = sheet()
    x = mesh.vertices[:, 0]
    members, seeds = (x < 1.0) | (x > 5.0), x < -8.0
    assert (mesh.connected_members(members, seeds) == (x < 1.0)).all()
    assert mesh.longest_edge == pytest.approx(np.sqrt(2.0))
    assert mesh.typical_edge == pytest.approx(1.0)


def test_chains_of_random_successors():
    rng = np.random.default_rng(1)
    names, following, expected = rng.permutation(1000), np.full(1000, -1), {}
    for members, closed in zip(
        np.split(names, [1, 3, 300, 301 + 64, 900]), [False, False, True, False, True, False]
    ):
        following[members[:-1]] = members[1:]
        if closed:
            following[members[-1]] = members[0]
        expected[int(members.min())] = (members, closed)
    for chain, closed in chains(following):
        members, want = expected.pop(int(chain.min()))
        assert closed == want
        start = int(np.flatnonzero(members == chain[0])[0])
        assert chain.tolist() == np.roll(members, -start).tolist()
    assert not expected


def test_edges_are_each_there_once_in_order_and_borders_have_one_face():
    """Against rows sorted by numpy, on random faces."""
    random = np.random.default_rng(12)
    for count in (3, 40, 70_000):  # products of 70,000 do not fit in 32 bits
        faces = random.integers(0, count, (500, 3), dtype=np.int32)
        mesh = Mesh(np.zeros((count, 3)), faces)
        half = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        edges, edge_index, counts = np.unique(
            np.sort(half, axis=1), axis=0, return_inverse=True, return_counts=True
        )
        assert np.array_equal(mesh.edges, edges)
        assert np.array_equal(mesh.border_edges, half[counts[np.ravel(edge_index)] == 1])


def test_projection_from_afar_counts_all_samples(monkeypatch):
    """Points up to 1.5 sample distances off a wavy surface have the feet that a sum over all samples gives."""
    mesh = sheet(21, 10.0)
    samples = mesh.vertices.copy()
    samples[:, 2] = 2.0 * np.sin(0.3 * samples[:, 0]) * np.cos(0.2 * samples[:, 1])
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-6, 6, (200, 2)), np.zeros(200)])
    points[:, 2] = 2.0 * np.sin(0.3 * points[:, 0]) * np.cos(0.2 * points[:, 1])
    points[:, 2] += rng.uniform(-1.5, 1.5, 200)
    feet, normals = coarsen.SmoothMesh(samples, mesh.faces, 1.0).project(points)
    monkeypatch.setattr(coarsen, "NEIGHBOUR_COUNT", len(samples))
    all_feet, all_normals = coarsen.SmoothMesh(samples, mesh.faces, 1.0).project(points)
    np.testing.assert_allclose(feet, all_feet, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(normals, all_normals, rtol=0.0, atol=1e-9)
