# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers normal to the centreline: planar, with the closed-form local distance on a torus."""

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
def test_distance_on_a_torus_matches_the_closed_form(bend, tube, height):
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
        v, distances = local_distances(above, below, 4)
        reach = bend + tube * np.cos(v)
        sideways = np.hypot(reach * np.cos(angle) - bend, tube * np.sin(v)) - tube
        np.testing.assert_allclose(distances, np.hypot(reach * np.sin(angle), sideways), atol=2e-6)
        assert distances.max() == pytest.approx(2.0 * (bend + tube) * np.sin(0.5 * angle), abs=1e-6)
        assert distances.min() == pytest.approx(2.0 * (bend - tube) * np.sin(0.5 * angle), abs=1e-6)


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_layers_of_a_straight_tube_are_plane_sections(slope):
    cone, zeros = Cone(20.0, slope), np.zeros(91)
    first = WallLayer.of(cone, even_grid(cone, 90), zeros + 1.0, zeros, zeros)
    layers = normal_layers.layers(cone, first, 3.0 * np.cos(slope), 30.0)
    assert [float(layer.curve.points[7, 2]) for layer in layers] == pytest.approx(
        [(1.0 + 3.0 * k) * np.cos(slope) for k in range(11)]
    )
    for below, above in zip(layers, layers[1:]):
        np.testing.assert_allclose(local_distances(above, below)[1], 3.0, atol=1e-6)


def test_layers_of_a_tabulated_bend_are_planar():
    """Each curve of a sampled bend is in a plane normal to the centreline, also beyond the last
    sample."""
    u, v = np.linspace(0.0, 1.2, 60), np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
    table = Tabulated(u, v, Torus(60.0, 15.0).point(*np.meshgrid(u, v, indexing="ij")), 2 * np.pi)
    zeros = np.zeros(73)
    first = WallLayer.of(table, even_grid(table, 72), zeros + 0.05, zeros, zeros)
    layers = normal_layers.layers(table, first, 5.0, 1.2, 144)
    assert layers[-1].u.min() >= 1.2
    for layer in layers:
        points = layer.curve.at(layer.curve.refined(3))[0]
        centred = points - points[:-1].mean(axis=0)
        thickness = np.linalg.svd(centred, full_matrices=False)[1][-1] / np.sqrt(len(points))
        assert thickness < 2e-5


def test_walls_without_single_plane_sections_are_rejected():
    tube, zeros = cylinder(20.0), np.zeros(91)
    first_of_tube = WallLayer.of(tube, even_grid(tube, 90), zeros + 1.0, zeros, zeros)
    tight_torus = Torus(16.0, 15.5)
    first = WallLayer.of(tight_torus, even_grid(tight_torus, 90), zeros, zeros, zeros)
    assert len(normal_layers.layers(tube, first_of_tube, 2.0, 8.5)) == 5
    assert len(normal_layers.layers(tight_torus, first, 2.0, 1.5)) > 5  # tight, yet still cut once
    disc = Cone(20.0, 0.5 * np.pi)  # all sections have the same centre, so there is no centreline
    with pytest.raises(InputError, match="centre line"):
        normal_layers.layers(
            disc, WallLayer.of(disc, even_grid(disc, 90), zeros, zeros, zeros), 2.0, 9.0
        )
