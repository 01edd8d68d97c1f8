# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance and of constant parameter, against the errata and brute-force
distances."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.walls.surface import Cone, Torus, cylinder
from freecad_am.core.geometry.walls.surface_wall import Tabulated
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.first_layer import interpolate_polyline, intersect_implicit
from freecad_am.core.slicing.tubes import constant_distance, iso_parameter
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid, local_distances

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
END = 0.5 * np.pi


def paper_bend(tube=15.0, start=0.0, pipe=PIPE):
    torus = Torus(60.0, tube)
    return torus, intersect_implicit(torus, pipe, (0.0, 1.5), even_grid(torus, 360, start))


def sample_finely(layer):
    """Return a fine polyline through a layer and the tree of its points; sorted points need no
    balanced tree."""
    line = layer.curve.at(layer.curve.refined(80))[0]
    return line, cKDTree(line, compact_nodes=False, balanced_tree=False)


def measure_distances(above, fine, finer):
    """Distance from points on one curve to a fine polyline through the other, independent of Newton
    steps, arcs and branches."""
    points, (line, tree) = above.curve.at(above.curve.refined(finer))[0], fine
    nearest = tree.query(points)[1]
    distances = np.full(len(points), np.inf)
    for start in (nearest - 1, nearest):
        a, b = line[start % len(line)], line[(start + 1) % len(line)]
        along = b - a
        t = ((points - a) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
        foot = a + np.clip(t, 0.0, 1.0)[:, None] * along
        distances = np.minimum(distances, np.linalg.norm(points - foot, axis=1))
    return distances


def assert_spacing(layers, height):
    for below, above in zip(layers, layers[1:]):
        fine = sample_finely(below)
        assert measure_distances(above, fine, 1) == pytest.approx(height, abs=1e-5)
        assert measure_distances(above, fine, 10) == pytest.approx(height, abs=1e-3)
        assert local_distances(above, below)[1] == pytest.approx(height, abs=1e-9)


@pytest.mark.parametrize("height, iso_count, corrected_count", [(5.0, 19, 16), (1.0, 87, 72)])
@pytest.mark.always("5.0-19-16")
def test_layer_counts_match_the_errata(height, iso_count, corrected_count):
    torus, first = paper_bend()
    iso = iso_parameter.layers(torus, first, height, END)
    corrected = constant_distance.layers(torus, first, height, END)
    assert (len(iso), len(corrected)) == (iso_count, corrected_count)
    assert_spacing(corrected, height)
    if height == 5.0:
        min_distance = min(
            local_distances(above, below)[1].min() for below, above in zip(iso, iso[1:])
        )
        assert min_distance == pytest.approx(2.49, abs=0.005)
        last_angles = np.degrees(corrected[-1].u)
        assert (last_angles.min(), last_angles.max()) == pytest.approx((95.0, 127.0), abs=0.5)


@pytest.mark.parametrize("tube, turn", [(15.0, 97.0), (25.0, 105.0)])
def test_a_corner_forms_on_the_outside_of_the_bend(tube, turn):
    torus, first = paper_bend(tube)
    layers = constant_distance.layers(torus, first, 5.0, END)
    assert_spacing(layers, 5.0)
    last_curve = layers[-1].curve
    assert last_curve.w[last_curve.corners] == pytest.approx([0.0], abs=1e-9)
    assert np.degrees(last_curve.turns[last_curve.corners]) == pytest.approx([turn], abs=0.5)
    first_corner = next(i for i, layer in enumerate(layers) if len(layer.curve.corners))
    assert 3 <= first_corner <= 5
    assert all(len(layer.curve.corners) == 1 for layer in layers[first_corner:])


def test_equation_2_is_the_chord_along_v():
    torus, first = paper_bend()
    above = iso_parameter.next_layer(torus, first, 5.0)
    reach = 60.0 + 15.0 * np.cos(first.v)
    assert above.u == pytest.approx(first.u + np.arccos(1.0 - 25.0 / (2.0 * reach**2)), abs=1e-12)
    slope = np.gradient(above.u, above.v)[1:-1]
    _, along, around = torus.derivatives(above.u, above.v)
    assert (above.curve.out - around)[1:-1] == pytest.approx(slope[:, None] * along[1:-1], abs=0.02)


def test_the_seam_position_does_not_change_layers():
    layers, shifted_layers = (
        constant_distance.layers(*paper_bend(start=start), 5.0, END) for start in (0.0, 0.3)
    )
    for layer, shifted in zip(layers, shifted_layers):
        assert layer.curve.nearest(shifted.curve.points)[0] == pytest.approx(0.0, abs=2e-4)


class Waves:
    """A substrate with seven waves around the Z axis."""

    def value(self, points):
        x, y, z = np.moveaxis(points, -1, 0)
        turn, radius_squared = np.arctan2(y, x), x**2 + y**2
        slope = -21.0 * np.cos(7.0 * turn) / radius_squared
        return z - 3.0 * np.sin(7.0 * turn), np.stack(
            [-y * slope, x * slope, 1.0 + 0.0 * slope], axis=-1
        )


# flat fronts: each point has its closest point exactly below, and the first node of a curve is hit exactly
GROUND = HalfSpace(np.zeros(3), np.array([0.0, 0.0, 1.0]))


@pytest.mark.parametrize(
    "wall, substrate, reach, end, height, corners",
    [
        (
            Torus(60.0, 15.0),
            Round.cylinder(32.0, [3, 5, -2], [0.2, 1.0, 0.1]),
            (0.0, 1.5),
            END,
            2.0,
            1,
        ),
        (cylinder(27.0), Round.cylinder(30.0, [0, 2, -30], [1, 0, 0]), (-45.0, 10.0), 40.0, 1.5, 2),
        pytest.param(
            cylinder(10.0),
            Round.cone(0.5, [0, 0, 30], [0.3, 0, -1]),
            (-60.0, 60.0),
            60.0,
            2.0,
            1,
            marks=pytest.mark.long,
        ),
        (
            Cone(20.0, 0.3),
            Round.cylinder(60.0, [0, 0, -58], [1, 0, 0]),
            (-40.0, 10.0),
            40.0,
            3.0,
            0,
        ),
        pytest.param(
            Torus(60.0, 15.0),
            Round.sphere(30.0, [4, 5, -10]),
            (-0.2, 1.2),
            1.8,
            2.0,
            1,
            marks=pytest.mark.long,
        ),
        (cylinder(20.0), Waves(), (-40.0, 30.0), 40.0, 1.0, 7),
        (Torus(60.0, 15.0), GROUND, (-0.3, 0.5), 1.5, 2.0, 1),
        (Cone(20.0, 0.3), GROUND, (-40.0, 30.0), 30.0, 2.0, 0),
    ],
)
@pytest.mark.always(
    "wall0-substrate0-reach0-1.5707963267948966-2.0-1",
    "wall1-substrate1-reach1-40.0-1.5-2",
    "wall3-substrate3-reach3-40.0-3.0-0",
    "wall5-substrate5-reach5-40.0-1.0-7",
    "wall7-substrate7-reach7-30.0-2.0-0",
)
def test_walls_on_substrates(wall, substrate, reach, end, height, corners):
    first = intersect_implicit(wall, substrate, reach, even_grid(wall, 360))
    layers = constant_distance.layers(wall, first, height, end)
    assert_spacing(layers, height)
    assert len(layers[-1].curve.corners) == corners


def test_layers_on_an_unrolled_plane_match_the_closed_form():
    """On an unrolled cylinder the layer above a ridge is an arc around the ridge, above a flank it
    is straight, and a groove keeps its corner."""
    wall, n = cylinder(1000.0), 720
    v = np.linspace(-np.pi, np.pi, n, endpoint=False)
    first = interpolate_polyline(wall, wall.point(500.0 - 200.0 * np.abs(v), v), corner=0.1)
    above = constant_distance.next_layer(wall, first, 20.0, even_grid(wall, n, -np.pi))
    stretch = np.hypot(1.0, 0.2)
    top = wall.inverse(above.curve.at(np.array([0.0]))[0])[0]
    flank = wall.inverse(above.curve.at(np.array([1.0]))[0])[0]
    # the chord of a circle of 1000 mm is shorter than its arc by 0.04 parts in a million at 20 mm
    assert top == pytest.approx([520.0], abs=1e-6)
    assert flank == pytest.approx([300.0 + 20.0 * stretch], abs=1e-3)
    assert above.curve.w[above.curve.corners] == pytest.approx([-np.pi], abs=1e-9)
    assert measure_distances(above, sample_finely(first), 10) == pytest.approx(20.0, abs=1e-3)


def test_a_tabulated_wall_gives_the_same_layers():
    torus, first = paper_bend()
    u, v = np.linspace(-0.2, 2.6, 160), np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    table = Tabulated(u, v, torus.point(*np.meshgrid(u, v, indexing="ij")), 2.0 * np.pi)
    exact = constant_distance.layers(torus, first, 5.0, END)
    layers = constant_distance.layers(
        table, intersect_implicit(table, PIPE, (0.0, 1.5), even_grid(table, 360)), 5.0, END
    )
    assert_spacing(layers, 5.0)
    assert exact[-1].curve.nearest(layers[-1].curve.points)[0] == pytest.approx(0.0, abs=1e-4)


def test_a_layer_higher_than_the_bend_is_rejected():
    torus, first = paper_bend()
    for rule in (iso_parameter, constant_distance):
        with pytest.raises(InputError, match="layer height") as caught:
            rule.layers(torus, first, 200.0, END)
        assert caught.value.code == "LAYER_HEIGHT"


def test_work_is_linear_in_the_number_of_points():
    """Count the points that the algorithm evaluates on the wall."""
    evaluations = []
    for points in (720, 1440):
        torus, first = paper_bend()
        counter = CountingWall(torus)
        constant_distance.layers(counter, first, 5.0, END, points)
        evaluations.append(counter.evaluations)
    assert evaluations[1] < 2.2 * evaluations[0]


class CountingWall:
    """A wall that counts its evaluated points."""

    def __init__(self, wall):
        self.wall, self.evaluations, self.period = wall, 0, wall.period

    def derivatives(self, u, v):
        self.evaluations += u.size
        return self.wall.derivatives(u, v)
