# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers trimmed at the end of the wall: they end on it, lie below it, and leave nothing uncovered."""

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
    first = intersect_implicit(TORUS, PIPE, (0.0, 1.5), even_grid(TORUS, 360, request.param))
    return constant_distance.layers(TORUS, first, HEIGHT, END)


def points_of(piece):
    """Ten places per arc of the front, and the ends."""
    w = piece.front.curve.refined(10)
    if not piece.closed:
        w = np.r_[w[:-1], w + piece.front.curve.period]
        w = np.r_[piece.low, w[(w > piece.low) & (w < piece.high)], piece.high]
    return piece.front.curve.at(w)[0]


def test_pieces_end_on_the_line_and_lie_below_it(layers):
    pieces = [trimmed(PLACED, layer, END) for layer in layers]
    assert [len(layer) for layer in pieces] == [1] * 15 + [0]
    assert [layer[0].closed for layer in pieces[:-1]] == [
        layer.u.max() <= END for layer in layers[:-1]
    ]
    assert sum(layer[0].closed for layer in pieces[:-1]) == 10
    for layer, (piece,) in zip(layers, pieces[:-1]):
        points = points_of(piece)
        assert layer.curve.nearest(points)[0] == pytest.approx(0.0, abs=1e-9)
        assert TORUS.inverse(points)[0].max() <= END + 1e-7
        if not piece.closed:
            assert TORUS.inverse(points[[0, -1]])[0] == pytest.approx(END, abs=1e-7)


def test_trimmed_layers_cover_the_wall(layers):
    beads = np.vstack(
        [points_of(piece) for layer in layers for piece in trimmed(PLACED, layer, END)]
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
