# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fronts on meshes match those on the parametric wall, also on walls that split, merge, close and
end."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.slicing.fronts.rims import Rims, local_distances
from freecad_am.core.slicing.tubes import constant_distance
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid
from tests.core.patch_walls import ball, bend, brute, samples, sheet, tube

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
FLOOR = HalfSpace(np.zeros(3), np.array([0.0, 0.0, 1.0]))
SILL = HalfSpace(np.zeros(3), np.array([0.0, 1.0, 0.0]))


def assert_spacing(layers, height):
    """Nodes keep the distance to 1e-5 mm; points of a grid ten times finer to 1e-3 mm."""
    for below, above in zip(layers, layers[1:]):
        for front in above:
            assert local_distances(front, below) == pytest.approx(height, abs=1e-5)
            assert brute(front.at(front.refined(10))[0], below) == pytest.approx(height, abs=1e-3)


def largest_distance(wall, layers, clearance=0.0):
    """Largest distance from the wall to the nearest bead, for points farther than `clearance` from
    the rims."""
    beads = np.vstack([front.at(front.refined(20))[0] for layer in layers for front in layer])
    points = samples(wall)
    if clearance > 0.0:
        points = points[
            cKDTree(np.vstack([rim.points for rim in wall.rims])).query(points)[0] > clearance
        ]
    return cKDTree(beads).query(points)[0].max()


def assert_faces_up(wall, layers):
    """Seen from outside, the previous layer is to the right of every bead and the next one to the
    left."""
    for below, above in zip(layers, layers[1:]):
        for front in above:
            points, slope, _ = front.at(front.w[:-1] + 0.5 * front.span)
            leftward = np.cross(wall.project(points)[1], slope)
            feet = np.stack([curve.nearest(points)[1] for curve in below])
            nearest = np.argmin(np.linalg.norm(feet - points, axis=-1), axis=0)
            assert ((feet[nearest, np.arange(len(points))] - points) * leftward).sum(
                axis=1
            ).max() < 0.0


@pytest.fixture(scope="module")
def torus():
    wall = bend(PIPE, 0.3, np.pi / 2, 1.25)
    return wall, fronts.slice_layers(wall, 5.0).fronts


def test_fronts_equal_those_on_the_parametric_wall(torus):
    wall, layers = torus
    surface = Torus(60.0, 15.0)
    first = intersect_implicit(surface, PIPE, (0.0, 1.5), even_grid(surface, 360))
    graph = constant_distance.layers(surface, first, 5.0, np.pi / 2)
    assert_spacing(layers, 5.0)
    assert_faces_up(wall, layers)
    for (front,), reference in zip(layers, graph):
        assert reference.curve.nearest(front.at(front.refined(5))[0])[0] == pytest.approx(
            0.0, abs=2e-4
        )
        assert len(front.corners) == len(reference.curve.corners)


def test_open_beads_finish_the_end_of_the_wall(torus):
    wall, layers = torus
    assert [layer[0].closed for layer in layers] == [True] * 10 + [False] * (len(layers) - 10)
    rims = Rims.of(wall.rims)
    assert [rims.ends_of(layer[0]) for layer in layers] == [False] * 10 + [True] * (
        len(layers) - 10
    )
    for layer in layers[10:]:
        u = np.arctan2(layer[0].points[[0, -1], 2], layer[0].points[[0, -1], 0] + 60.0)
        assert u == pytest.approx(np.pi / 2, abs=1e-9)
    assert largest_distance(wall, layers) < 5.0
    assert largest_distance(wall, layers, 5.0) < 3.0


@pytest.mark.parametrize("step", [1.0, 0.7])
@pytest.mark.always("1.0")
def test_a_front_splits_at_a_hole_and_merges_behind_it(step):
    wall, height = sheet(SILL, [(2.0, 20.0, 9.0)], step=step), 1.7
    layers = fronts.slice_layers(wall, height).fronts
    count = [len(layer) for layer in layers]
    # the hole begins at 11 mm; behind it, fronts that end 3.61 mm apart on its rim do not merge yet
    assert count == [1] * 7 + [2] * 14 + [1] * 10
    assert not any(front.closed for layer in layers for front in layer)
    for number, (front,) in enumerate(layers[:7]):
        assert front.points[:, 1] == pytest.approx(height * number, abs=1e-9)
    for layer in layers[7:21]:
        ends = np.vstack([front.points[[0, -1], :2] for front in layer])
        hole_distance = np.hypot(*(ends - [2.0, 20.0]).T)
        assert np.sort(hole_distance)[:2] == pytest.approx(9.0, abs=1e-5)
        for front in layer:
            points = front.at(front.refined(10))[0]
            assert np.hypot(points[:, 0] - 2.0, points[:, 1] - 20.0).min() > 9.0 - 1e-5
    assert [len(layer[0].corners) for layer in layers[-8:]] == [1] * 8
    assert_spacing(layers, height)
    assert_faces_up(wall, layers)
    assert largest_distance(wall, layers) < height
    assert largest_distance(wall, layers, height) < 0.6 * height


def test_a_front_closes_on_itself():
    height = 1.3
    wall = ball(HalfSpace(np.array([0.0, 0.0, -5.0]), np.array([0.1, 0.3, 1.0])))
    layers = fronts.slice_layers(wall, height).fronts
    assert all(front.closed and not len(front.corners) for layer in layers for front in layer)
    assert_spacing(layers, height)
    # parallel circles: chords of equal length between them
    axis = np.array([0.1, 0.3, 1.0]) / np.linalg.norm([0.1, 0.3, 1.0])
    polar = [np.arccos(np.clip(layer[0].points @ axis / 20.0, -1.0, 1.0)) for layer in layers]
    turn = 2.0 * np.arcsin(height / 40.0)
    for i, angles in enumerate(polar):
        assert angles == pytest.approx(polar[0][0] - i * turn, abs=1e-5)
    assert len(layers) == int(polar[0][0] / turn) + 1


class SlabEnds:
    """Everything outside an inclined slab; fronts start from both sides of the ball."""

    def __init__(self):
        self.sides = (
            HalfSpace(np.array([0.0, 0.0, -12.0]), np.array([0.1, 0.3, 1.0])),
            HalfSpace(np.array([0.0, 3.0, 14.0]), np.array([0.3, 0.1, -1.0])),
        )

    def value(self, points):
        (lower, up), (upper, down) = (side.value(points) for side in self.sides)
        nearer = lower < upper
        return np.where(nearer, lower, upper), np.where(nearer[..., None], up, down)


@pytest.mark.long
def test_two_fronts_merge_with_corners():
    wall, height = ball(SlabEnds()), 1.3
    layers = fronts.slice_layers(wall, height).fronts
    assert [len(layer) for layer in layers][:12] == [2] * 6 + [1] * 6
    assert [len(layer[0].corners) for layer in layers][:12] == [0] * 6 + [2] * 6
    assert_spacing(layers, height)
    assert_faces_up(wall, layers[:12])


def test_a_half_shell_has_open_beads_from_rim_to_rim():
    wall = bend(PIPE, 0.3, 1.3, 1.0, 0.5, np.pi)
    layers = fronts.slice_layers(wall, 2.0).fronts
    assert not any(front.closed for layer in layers for front in layer)
    assert_spacing(layers, 2.0)
    assert_faces_up(wall, layers)
    rim_to_rim = [layer[0] for layer in layers if not Rims.of(wall.rims).ends_of(layer[0])]
    assert len(rim_to_rim) == 17
    for front in rim_to_rim[1:]:  # on the side rims, v = 0.5 and 0.5 + pi, to rounding
        x, y, z = front.points[[0, -1]].T
        v = np.sort(np.arctan2(y, np.hypot(x + 60.0, z) - 60.0) % (2.0 * np.pi))
        assert v == pytest.approx([0.5, 0.5 + np.pi], abs=1e-9)


@pytest.mark.parametrize("width", [2.0 * np.pi, 3.0], ids=["around", "part of a turn"])
def test_a_last_layer_may_coincide_with_the_end(width):
    wall = tube(FLOOR, 20.0, 1.5, width=width)
    layers = fronts.slice_layers(wall, 5.0).fronts
    assert len(layers) == 5
    for i, (front,) in enumerate(layers):
        assert front.points[:, 2] == pytest.approx(5.0 * i, abs=1e-9)
        assert front.closed == (width > 6.0)
        assert not Rims.of(wall.rims).ends_of(front)


def test_a_wall_may_start_at_its_own_edge():
    """Only the edge is behind the first layer."""
    wall = tube(FLOOR, 12.0, 1.5, low=0.0)
    assert not wall.behind.any()
    layers = fronts.slice_layers(wall, 3.0).fronts
    assert [layer[0].points[0, 2] for layer in layers] == pytest.approx(
        [0.0, 3.0, 6.0, 9.0, 12.0], abs=1e-9
    )


def test_a_finer_mesh_gives_the_same_fronts():
    floor = HalfSpace(np.zeros(3), np.array([0.2, 0.3, 1.0]))
    coarse, fine = (
        fronts.slice_layers(tube(floor, 20.0, step, low=-10.0), 2.0).fronts for step in (2.0, 0.9)
    )
    assert [len(layer) for layer in coarse] == [len(layer) for layer in fine]
    for coarse_layer, fine_layer in zip(coarse, fine):
        for front in coarse_layer:
            assert brute(front.at(front.refined(5))[0], fine_layer) == pytest.approx(0.0, abs=2e-4)
