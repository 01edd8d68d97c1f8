# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fronts over meshes: the same as on the parametric wall, and on walls that split, merge, close and end."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay, cKDTree

from freecad_am.core.geometry.implicit import HalfSpace, Round
from freecad_am.core.geometry.mesh import Mesh
from freecad_am.core.geometry.surface import Torus, cylinder
from freecad_am.core.issues import InputError
from freecad_am.core.slicing import constant_distance, fronts
from freecad_am.core.slicing.first_layer import on_implicit
from freecad_am.core.slicing.front_curve import ParametricWall
from freecad_am.core.slicing.wall_layer import even_grid

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])


def grid(surface, u, v, closed=True):
    n, m = len(u), len(v)
    points = surface.point(*np.meshgrid(u, v, indexing="ij")).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(m if closed else m - 1), indexing="ij"))
    k = (j + 1) % m
    a, b, c, d = i * m + j, (i + 1) * m + j, (i + 1) * m + k, i * m + k
    return Mesh(points, np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))


class Plane:
    """The plane Z = 0."""

    def project(self, points):
        return points * [1.0, 1.0, 0.0], np.broadcast_to([0.0, 0.0, 1.0], points.shape)


class Ball:
    """The sphere of 20 mm about the origin."""

    def project(self, points):
        normal = points / np.linalg.norm(points, axis=1, keepdims=True)
        return 20.0 * normal, normal


HOLE, HOLE_RADIUS = np.array([2.0, 20.0]), 9.0


def holed():
    """A sheet with a round hole."""
    x, y = np.meshgrid(np.arange(-30.0, 30.5), np.arange(-10.0, 50.5))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    points = points[np.linalg.norm(points - HOLE, axis=1) > HOLE_RADIUS + 0.4]
    angle = np.linspace(0.0, 2.0 * np.pi, 57, endpoint=False)
    points = np.vstack([points, HOLE + HOLE_RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    faces = Delaunay(points).simplices
    inside = np.linalg.norm(points[faces].mean(axis=1) - HOLE, axis=1) < HOLE_RADIUS * np.cos(np.pi / 57) - 1e-9
    a, b, c = points[faces].transpose(1, 0, 2)
    area = np.cross(b - a, c - a)
    faces = np.where((area < 0.0)[:, None], faces[:, ::-1], faces)[~inside & (np.abs(area) > 1e-9)]
    return Mesh(np.column_stack([points, np.zeros(len(points))]), faces)


def ball(count=6000):
    """A sphere of evenly spread points."""
    i = np.arange(count) + 0.5
    height, turn = np.arccos(1.0 - 2.0 * i / count), np.pi * (1.0 + np.sqrt(5.0)) * i
    points = 20.0 * np.stack([np.cos(turn) * np.sin(height), np.sin(turn) * np.sin(height), np.cos(height)], axis=1)
    faces = ConvexHull(points).simplices
    a, b, c = points[faces].transpose(1, 0, 2)
    inwards = (np.cross(b - a, c - a) * a).sum(axis=1) < 0.0
    faces[inwards] = faces[inwards, ::-1]
    return Mesh(points, faces)


def brute(points, curves):
    """Distances to fine polylines through the curves."""
    a = np.vstack([curve.at(curve.refined(60))[0][:-1] for curve in curves])
    b = np.vstack([curve.at(curve.refined(60))[0][1:] for curve in curves])
    found = np.full(len(points), np.inf)
    for k in cKDTree(0.5 * (a + b)).query(points, k=3)[1].T:
        along = b[k] - a[k]
        t = ((points - a[k]) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
        found = np.minimum(found, np.linalg.norm(points - a[k] - np.clip(t, 0.0, 1.0)[:, None] * along, axis=1))
    return found


def assert_spacing(layers, height, on_wall=lambda points: slice(None)):
    for below, above in zip(layers, layers[1:]):
        for front in above:
            assert fronts.local_distances(front, below) == pytest.approx(height, abs=1e-6)
            points = front.at(front.refined(10))[0]
            points = points[on_wall(points)]
            assert brute(points, below) == pytest.approx(height, abs=1e-3)


def farthest(mesh, substrate, layers):
    """Largest distance from the wall outside the substrate to the nearest bead."""
    beads = np.vstack([front.at(front.refined(20))[0] for layer in layers for front in layer])
    outside = mesh.vertices[substrate.value(mesh.vertices)[0] > 0.0]
    return cKDTree(beads).query(outside)[0].max()


@pytest.fixture(scope="module")
def torus():
    surface = Torus(60.0, 15.0)
    mesh = grid(surface, np.arange(0.3, np.pi / 2, 1.0 / 60.0), np.linspace(0.0, 2.0 * np.pi, 94, endpoint=False))
    wall = ParametricWall(surface)
    return surface, mesh, fronts.layers(mesh, wall, fronts.start(mesh, wall, PIPE), 5.0)


def test_the_same_fronts_as_on_the_parametric_wall(torus):
    surface, _, layers = torus
    first = on_implicit(surface, PIPE, (0.0, 1.5), even_grid(surface, 360))
    graph = constant_distance.layers(surface, first, 5.0, np.pi / 2)
    assert_spacing(layers, 5.0)
    for (front,), other in zip(layers, graph):
        assert other.curve.nearest(front.at(front.refined(5))[0])[0] == pytest.approx(0.0, abs=2e-4)
        assert len(front.corners) == len(other.curve.corners)


def test_at_the_end_of_the_wall_the_beads_are_open_and_finish_it(torus):
    surface, mesh, layers = torus
    assert [layer[0].closed for layer in layers] == [True] * 10 + [False] * (len(layers) - 10)
    end = surface.inverse(mesh.vertices)[0].max()
    for layer in layers[10:]:
        assert surface.inverse(layer[0].points[[0, -1]])[0] == pytest.approx(end, abs=1e-3)
    assert farthest(mesh, PIPE, layers) < 5.0


def test_a_front_splits_at_a_hole_and_merges_behind_it():
    mesh, height = holed(), 1.7
    base = HalfSpace(np.zeros(3), np.array([0.0, 1.0, 0.0]))
    layers = fronts.layers(mesh, Plane(), fronts.start(mesh, Plane(), base), height)
    count = [len(layer) for layer in layers]
    first = count.index(2)
    assert first == 7  # the hole begins at 11 mm
    assert count[:first] == [1] * first and count[first : first + 12] == [2] * 12 and count[-9:] == [1] * 9
    assert not any(front.closed for layer in layers for front in layer)
    for i, (front,) in enumerate(layers[:first]):
        assert front.points[:, 1] == pytest.approx(height * i, abs=1e-9)
    assert [len(layer[0].corners) for layer in layers[-8:]] == [1] * 8
    # of a gap at the hole's rim that is thinner than the mesh's edges the mesh knows nothing
    assert_spacing(layers, height, lambda points: np.linalg.norm(points[:, :2] - HOLE, axis=1) > HOLE_RADIUS)
    assert farthest(mesh, base, layers) < height


def test_a_front_closes_on_itself():
    mesh, height = ball(), 1.3
    base = HalfSpace(np.array([0.0, 0.0, -5.0]), np.array([0.1, 0.3, 1.0]))
    layers = fronts.layers(mesh, Ball(), fronts.start(mesh, Ball(), base), height)
    assert all(front.closed and not len(front.corners) for layer in layers for front in layer)
    assert_spacing(layers, height)
    # parallel circles: chords of equal length between them
    axis = np.array([0.1, 0.3, 1.0]) / np.linalg.norm([0.1, 0.3, 1.0])
    polar = [np.arccos(np.clip(layer[0].points @ axis / 20.0, -1.0, 1.0)) for layer in layers]
    turn = 2.0 * np.arcsin(height / 40.0)
    for i, angles in enumerate(polar):
        assert angles == pytest.approx(polar[0][0] - i * turn, abs=1e-5)
    assert len(layers) == int(polar[0][0] / turn) + 1
    assert farthest(mesh, base, layers) < 0.6 * height


class BothEnds:
    """Everything outside a slanted slab: fronts come from both sides of the ball."""

    def __init__(self):
        self.sides = (
            HalfSpace(np.array([0.0, 0.0, -12.0]), np.array([0.1, 0.3, 1.0])),
            HalfSpace(np.array([0.0, 3.0, 14.0]), np.array([0.3, 0.1, -1.0])),
        )

    def value(self, points):
        (one, up), (other, down) = (side.value(points) for side in self.sides)
        nearer = one < other
        return np.where(nearer, one, other), np.where(nearer[..., None], up, down)


def test_two_fronts_merge_with_corners():
    mesh, height = ball(), 1.3
    state = fronts.start(mesh, Ball(), BothEnds())
    layers = [state.fronts]
    for _ in range(11):
        state = fronts.step(mesh, Ball(), state, height)
        layers.append(state.fronts)
    assert [len(layer) for layer in layers] == [2] * 6 + [1] * 6
    assert [len(layer[0].corners) for layer in layers] == [0] * 6 + [2] * 6
    assert_spacing(layers, height)


def test_a_half_shell_has_open_beads_from_rim_to_rim():
    surface = Torus(60.0, 15.0)
    mesh = grid(surface, np.arange(0.3, 1.3, 1.0 / 60.0), np.linspace(0.5, 0.5 + np.pi, 48), closed=False)
    wall = ParametricWall(surface)
    layers = fronts.layers(mesh, wall, fronts.start(mesh, wall, PIPE), 2.0)
    assert all(len(layer) == 1 and not layer[0].closed for layer in layers)
    assert_spacing(layers, 2.0)
    v = np.sort(surface.inverse(layers[5][0].points[[0, -1]])[1] % (2.0 * np.pi))
    assert v == pytest.approx([0.5, 0.5 + np.pi], abs=1e-2)


def test_a_wall_that_misses_the_substrate_is_refused():
    surface = cylinder(40.0)
    mesh = grid(surface, np.arange(0.0, 10.0), np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False))
    with pytest.raises(InputError, match="come out of the substrate"):
        fronts.start(mesh, ParametricWall(surface), Round.sphere(5.0, [0, 0, 0]))
