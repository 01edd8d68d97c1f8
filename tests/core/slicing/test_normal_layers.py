# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers normal to the centreline: planes that hold them, and the local distance on a torus in closed form."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Cone, Torus, cylinder
from freecad_am.core.geometry.walls.surface_wall import Tabulated
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes import normal_layers
from freecad_am.core.slicing.tubes.smooth_spacing import WallLayer, even_grid, local_distances


@pytest.mark.parametrize(
    "bend, tube, height",
    [(60.0, 15.0, 5.0), (60.0, 25.0, 5.0), (60.0, 15.0, 1.0), (40.0, 5.0, 2.0)],
)
def test_the_distance_on_a_torus_is_the_closed_form(bend, tube, height):
    torus = Torus(bend, tube)
    first = intersect_implicit(
        torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, 90)
    )
    layers = normal_layers.layers(torus, first, height, 0.5 * np.pi, 180)
    middles = first.u.min() + np.arange(len(layers)) * height / bend
    for layer, middle in zip(layers, middles):
        np.testing.assert_allclose(
            layer.u, middle, atol=1e-7
        )  # planes through the torus' axis cut it in u = const
    assert layers[-2].u.min() < 0.5 * np.pi <= layers[-1].u.min()
    angle = height / bend
    for below, above in zip(layers[:-1:5], layers[1::5]):
        v, found = local_distances(above, below, 4)
        reach = bend + tube * np.cos(v)
        aside = np.hypot(reach * np.cos(angle) - bend, tube * np.sin(v)) - tube
        np.testing.assert_allclose(found, np.hypot(reach * np.sin(angle), aside), atol=2e-6)
        assert found.max() == pytest.approx(2.0 * (bend + tube) * np.sin(0.5 * angle), abs=1e-6)
        assert found.min() == pytest.approx(2.0 * (bend - tube) * np.sin(0.5 * angle), abs=1e-6)


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_on_a_straight_tube_they_are_the_plane_sections(slope):
    cone, still = Cone(20.0, slope), np.zeros(91)
    first = WallLayer.of(cone, even_grid(cone, 90), still + 1.0, still, still)
    layers = normal_layers.layers(cone, first, 3.0 * np.cos(slope), 30.0)
    assert [float(layer.curve.points[7, 2]) for layer in layers] == pytest.approx(
        [(1.0 + 3.0 * k) * np.cos(slope) for k in range(11)]
    )
    for below, above in zip(layers, layers[1:]):
        np.testing.assert_allclose(local_distances(above, below)[1], 3.0, atol=1e-6)


def test_a_table_past_its_end_and_planes_along_the_centreline():
    """A bent tube by samples: each curve lies in one plane, normal to the line through the middles."""
    u, v = np.linspace(0.0, 1.2, 60), np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
    table = Tabulated(u, v, Torus(60.0, 15.0).point(*np.meshgrid(u, v, indexing="ij")), 2 * np.pi)
    still = np.zeros(73)
    first = WallLayer.of(table, even_grid(table, 72), still + 0.05, still, still)
    layers = normal_layers.layers(table, first, 5.0, 1.2, 144)
    assert layers[-1].u.min() >= 1.2
    for layer in layers:
        points = layer.curve.at(layer.curve.refined(3))[0]
        centred = points - points[:-1].mean(axis=0)
        thin = np.linalg.svd(centred, full_matrices=False)[1][-1] / np.sqrt(len(points))
        assert thin < 2e-5


def test_what_planes_do_not_cut_in_one_curve_is_refused():
    tube, still = cylinder(20.0), np.zeros(91)
    low = WallLayer.of(tube, even_grid(tube, 90), still + 1.0, still, still)
    turned = Torus(16.0, 15.5)
    first = WallLayer.of(turned, even_grid(turned, 90), still, still, still)
    assert len(normal_layers.layers(tube, low, 2.0, 8.5)) == 5
    assert len(normal_layers.layers(turned, first, 2.0, 1.5)) > 5  # tight, yet still cut once
    disc = Cone(20.0, 0.5 * np.pi)  # its sections all have one middle: there is no centreline
    with pytest.raises(InputError, match="centre line"):
        normal_layers.layers(
            disc, WallLayer.of(disc, even_grid(disc, 90), still, still, still), 2.0, 9.0
        )
