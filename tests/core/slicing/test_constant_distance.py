# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance and of constant parameter: the errata's numbers, and distances by brute force."""

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


def paper(tube=15.0, start=0.0, pipe=PIPE):
    torus = Torus(60.0, tube)
    return torus, intersect_implicit(torus, pipe, (0.0, 1.5), even_grid(torus, 360, start))


def fine_line(layer):
    """A fine polyline through a layer, and the tree of its points, which lie in order and need no balance."""
    line = layer.curve.at(layer.curve.refined(80))[0]
    return line, cKDTree(line, compact_nodes=False, balanced_tree=False)


def distances(above, fine, finer):
    """From places on the one curve to a fine polyline through the other: knows nothing of Newton, arcs, branches."""
    points, (line, tree) = above.curve.at(above.curve.refined(finer))[0], fine
    low = tree.query(points)[1]
    found = np.full(len(points), np.inf)
    for k in (low - 1, low):
        a, b = line[k % len(line)], line[(k + 1) % len(line)]
        along = b - a
        t = ((points - a) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
        foot = a + np.clip(t, 0.0, 1.0)[:, None] * along
        found = np.minimum(found, np.linalg.norm(points - foot, axis=1))
    return found


def assert_spacing(layers, height):
    for below, above in zip(layers, layers[1:]):
        fine = fine_line(below)
        assert distances(above, fine, 1) == pytest.approx(height, abs=1e-5)
        assert distances(above, fine, 10) == pytest.approx(height, abs=1e-3)
        assert local_distances(above, below)[1] == pytest.approx(height, abs=1e-9)


@pytest.mark.parametrize("height, before, after", [(5.0, 19, 16), (1.0, 87, 72)])
@pytest.mark.always("5.0-19-16")
def test_layer_counts_of_the_errata(height, before, after):
    torus, first = paper()
    iso = iso_parameter.layers(torus, first, height, END)
    corrected = constant_distance.layers(torus, first, height, END)
    assert (len(iso), len(corrected)) == (before, after)
    assert_spacing(corrected, height)
    if height == 5.0:
        least = min(local_distances(above, below)[1].min() for below, above in zip(iso, iso[1:]))
        assert least == pytest.approx(2.49, abs=0.005)
        last = np.degrees(corrected[-1].u)
        assert (last.min(), last.max()) == pytest.approx((95.0, 127.0), abs=0.5)


@pytest.mark.parametrize("tube, turn", [(15.0, 97.0), (25.0, 105.0)])
def test_the_corner_on_the_outside_of_the_bend(tube, turn):
    torus, first = paper(tube)
    layers = constant_distance.layers(torus, first, 5.0, END)
    assert_spacing(layers, 5.0)
    last = layers[-1].curve
    assert last.w[last.corners] == pytest.approx([0.0], abs=1e-9)
    assert np.degrees(last.turns[last.corners]) == pytest.approx([turn], abs=0.5)
    begin = next(i for i, layer in enumerate(layers) if len(layer.curve.corners))
    assert 3 <= begin <= 5
    assert all(len(layer.curve.corners) == 1 for layer in layers[begin:])


def test_equation_2_is_the_chord_along_v():
    torus, first = paper()
    above = iso_parameter.next_layer(torus, first, 5.0)
    reach = 60.0 + 15.0 * np.cos(first.v)
    assert above.u == pytest.approx(first.u + np.arccos(1.0 - 25.0 / (2.0 * reach**2)), abs=1e-12)
    slope = np.gradient(above.u, above.v)[1:-1]
    _, along, around = torus.derivatives(above.u, above.v)
    assert (above.curve.out - around)[1:-1] == pytest.approx(slope[:, None] * along[1:-1], abs=0.02)


def test_the_seam_may_lie_anywhere():
    one, other = (constant_distance.layers(*paper(start=start), 5.0, END) for start in (0.0, 0.3))
    for a, b in zip(one, other):
        assert a.curve.nearest(b.curve.points)[0] == pytest.approx(0.0, abs=2e-4)


class Waves:
    """A substrate with an up and down of seven waves around the axis Z."""

    def value(self, points):
        x, y, z = np.moveaxis(points, -1, 0)
        turn, pace = np.arctan2(y, x), x**2 + y**2
        lean = -21.0 * np.cos(7.0 * turn) / pace
        return z - 3.0 * np.sin(7.0 * turn), np.stack(
            [-y * lean, x * lean, 1.0 + 0.0 * lean], axis=-1
        )


# flat fronts: every point below is straight under the one above, and the first node of a curve is met to the last bit
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


def test_a_plane_has_a_closed_form():
    """On a cylinder cut open the layer above a ridge is an arc about its tip, above a flat it is straight, and a groove
    keeps its corner."""
    wall, n = cylinder(1000.0), 720
    v = np.linspace(-np.pi, np.pi, n, endpoint=False)
    first = interpolate_polyline(wall, wall.point(500.0 - 200.0 * np.abs(v), v), corner=0.1)
    above = constant_distance.next_layer(wall, first, 20.0, even_grid(wall, n, -np.pi))
    lean = np.hypot(1.0, 0.2)
    top = wall.inverse(above.curve.at(np.array([0.0]))[0])[0]
    flank = wall.inverse(above.curve.at(np.array([1.0]))[0])[0]
    # the chord of a circle of 1000 mm is shorter than its arc by 0.04 parts in a million at 20 mm
    assert top == pytest.approx([520.0], abs=1e-6)
    assert flank == pytest.approx([300.0 + 20.0 * lean], abs=1e-3)
    assert above.curve.w[above.curve.corners] == pytest.approx([-np.pi], abs=1e-9)
    assert distances(above, fine_line(first), 10) == pytest.approx(20.0, abs=1e-3)


def test_a_table_serves_as_the_wall():
    torus, first = paper()
    u, v = np.linspace(-0.2, 2.6, 160), np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    table = Tabulated(u, v, torus.point(*np.meshgrid(u, v, indexing="ij")), 2.0 * np.pi)
    exact = constant_distance.layers(torus, first, 5.0, END)
    found = constant_distance.layers(
        table, intersect_implicit(table, PIPE, (0.0, 1.5), even_grid(table, 360)), 5.0, END
    )
    assert_spacing(found, 5.0)
    assert exact[-1].curve.nearest(found[-1].curve.points)[0] == pytest.approx(0.0, abs=1e-4)


def test_a_layer_higher_than_the_wall_bends_is_refused():
    torus, first = paper()
    for rule in (iso_parameter, constant_distance):
        with pytest.raises(InputError, match="layer height") as refused:
            rule.layers(torus, first, 200.0, END)
        assert refused.value.code == "LAYER_HEIGHT"


def test_points_and_work_grow_together():
    """Linear in the number of points: what is asked of the wall, counted."""
    asked = []
    for points in (720, 1440):
        torus, first = paper()
        counter = Counting(torus)
        constant_distance.layers(counter, first, 5.0, END, points)
        asked.append(counter.asked)
    assert asked[1] < 2.2 * asked[0]


class Counting:
    """A wall that counts the points asked of it."""

    def __init__(self, wall):
        self.wall, self.asked, self.period = wall, 0, wall.period

    def derivatives(self, u, v):
        self.asked += u.size
        return self.wall.derivatives(u, v)
