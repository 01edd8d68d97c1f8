# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers trimmed at the end of the wall: they end on it, stay below it and leave no gap."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.geometry.walls.surface_wall import Placed
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes import constant_distance
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid
from freecad_am.core.strategies.walls.plan import trimmed

TORUS, END, HEIGHT = Torus(60.0, 15.0), 0.5 * np.pi, 5.0
PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
PLACED = Placed(TORUS, np.eye(4))


@pytest.fixture(scope="module", params=[0.0, 0.3, np.pi])
def layers(request):
    base_layer = intersect_implicit(TORUS, PIPE, (0.0, 1.5), even_grid(TORUS, 360, request.param))
    return constant_distance.layers(TORUS, base_layer, HEIGHT, END)


def points_of(bead_curve):
    """Ten points per arc of the front, and the ends."""
    w = bead_curve.front.curve.refined(10)
    if not bead_curve.closed:
        w = np.r_[w[:-1], w + bead_curve.front.curve.period]
        w = np.r_[bead_curve.low, w[(w > bead_curve.low) & (w < bead_curve.high)], bead_curve.high]
    return bead_curve.front.curve.at(w)[0]


def test_pieces_end_on_the_line_and_lie_below_it(layers):
    trimmed_layers = [trimmed(PLACED, layer, END) for layer in layers]
    assert [len(layer) for layer in trimmed_layers] == [1] * 15 + [0]
    assert [layer[0].closed for layer in trimmed_layers[:-1]] == [
        layer.u.max() <= END for layer in layers[:-1]
    ]
    assert sum(layer[0].closed for layer in trimmed_layers[:-1]) == 10
    for layer, (bead_curve,) in zip(layers, trimmed_layers[:-1]):
        points = points_of(bead_curve)
        assert layer.curve.nearest(points)[0] == pytest.approx(0.0, abs=1e-9)
        assert TORUS.inverse(points)[0].max() <= END + 1e-7
        if not bead_curve.closed:
            assert TORUS.inverse(points[[0, -1]])[0] == pytest.approx(END, abs=1e-7)


def test_trimmed_layers_cover_the_wall(layers):
    beads = np.vstack(
        [points_of(bead_curve) for layer in layers for bead_curve in trimmed(PLACED, layer, END)]
    )
    u, v = np.meshgrid(
        np.linspace(0.3, END, 150), np.linspace(0.0, 2.0 * np.pi, 150), indexing="ij"
    )
    wall = TORUS.point(u, v).reshape(-1, 3)
    outside = wall[PIPE.value(wall)[0] > 0.0]
    distance = cKDTree(beads).query(outside)[0]
    near_end = TORUS.inverse(outside)[0] > END - HEIGHT / 45.0
    assert distance.max() < HEIGHT
    assert distance[~near_end].max() < 0.6 * HEIGHT
