# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers without corners: the distance stays in the band, the turn equals the reported one, and
smooth layers stay unchanged."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Cone, Torus, cylinder
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes import constant_distance, smooth_spacing
from freecad_am.core.slicing.tubes.smooth_spacing import WallLayer, even_grid, local_distances

TORUS = Torus(60.0, 15.0)
HEIGHT, BAND = 5.0, 0.2


@pytest.fixture(scope="module")
def first_layer():
    return intersect_implicit(
        TORUS, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(TORUS, 360)
    )


@pytest.mark.parametrize("degrees, max_degrees", [(6.0, 6.0), (2.0, 4.0)])
def test_layers_of_the_bend_have_no_corners_within_the_band(first_layer, degrees, max_degrees):
    layers = smooth_spacing.layers(
        TORUS, first_layer, HEIGHT, 0.5 * np.pi, BAND, np.radians(degrees)
    )
    below = first_layer
    for smoothed in layers:
        distance = local_distances(smoothed.layer, below, 10)[1]
        assert distance.min() >= (1.0 - BAND) * HEIGHT
        assert distance.max() <= (1.0 + BAND) * HEIGHT
        assert (smoothed.min_distance, smoothed.max_distance) == pytest.approx(
            (distance.min(), distance.max()), abs=1e-3
        )
        assert not len(smoothed.layer.curve.corners)
        assert smoothed.turn <= np.radians(max_degrees)
        below = smoothed.layer
    exact = constant_distance.layers(TORUS, first_layer, HEIGHT, 0.5 * np.pi)
    exact_turns = [smooth_spacing.turns_in_wall(TORUS, layer).max() for layer in exact[6:]]
    assert min(exact_turns) > np.radians(
        200.0
    )  # a corner of 69 degrees or more over the first arc behind it
    assert abs(len(layers) + 1 - len(exact)) <= 1


def test_every_start_of_the_search_finds_a_layer_within_the_limit(first_layer):
    grid, limit = even_grid(TORUS, 360), np.radians(5.0)
    turns = [
        smooth_spacing.next_layer(TORUS, first_layer, HEIGHT, grid, BAND, limit, weight=k).turn
        for k in range(len(smooth_spacing.WEIGHTS))
    ]
    assert max(turns) <= limit
    narrow = [
        smooth_spacing.next_layer(TORUS, first_layer, HEIGHT, grid, 0.01, 1e-3, weight=k)
        for k in range(0, 12, 4)
    ]
    assert all(
        layer.min_distance >= 0.99 * HEIGHT and layer.max_distance <= 1.01 * HEIGHT
        for layer in narrow
    )  # within the band
    assert min(layer.turn for layer in narrow) > 1e-3  # and the result reports the exceeded limit


def test_a_smooth_front_keeps_its_distance(first_layer):
    (layer,) = smooth_spacing.layers(
        TORUS, first_layer, HEIGHT, first_layer.u.min() + 1e-6, BAND, np.radians(6.0)
    )
    assert (layer.min_distance, layer.max_distance) == pytest.approx((HEIGHT, HEIGHT), abs=0.02)
    exact = constant_distance.next_layer(TORUS, first_layer, HEIGHT, even_grid(TORUS, 360))
    assert exact.curve.nearest(layer.layer.curve.points)[0] == pytest.approx(0.0, abs=0.02)


def test_the_turn_within_the_wall_is_the_geodesic_curvature():
    zeros = np.zeros(181)
    disc = Cone(20.0, 0.5 * np.pi)
    ring = WallLayer.of(disc, even_grid(disc, 180), zeros + 10.0, zeros, zeros)
    assert smooth_spacing.turns_in_wall(disc, ring) == pytest.approx(1.0 / 30.0, rel=1e-3)
    tube = cylinder(20.0)
    hoop = WallLayer.of(tube, even_grid(tube, 180), zeros, zeros, zeros)
    assert smooth_spacing.turns_in_wall(tube, hoop) == pytest.approx(0.0, abs=1e-9)
    cone = Cone(20.0, 0.3)
    ring = WallLayer.of(cone, even_grid(cone, 180), zeros, zeros, zeros)
    assert smooth_spacing.turns_in_wall(cone, ring) == pytest.approx(np.sin(0.3) / 20.0, rel=1e-3)


def test_a_corner_counts_with_its_full_turn():
    tube, v = cylinder(20.0), even_grid(cylinder(20.0), 180)
    rise = np.where(v[:-1] < np.pi, 8.0, -8.0)
    zigzag = WallLayer.of(
        tube, v, 8.0 * np.minimum(v, 2 * np.pi - v), np.r_[rise[-1], rise], np.r_[rise, rise[0]]
    )
    turns = smooth_spacing.turns_in_wall(tube, zigzag) * np.linalg.norm(
        np.diff(zigzag.curve.points, axis=0), axis=1
    )
    assert turns[[0, 90]] == pytest.approx(2.0 * np.arctan(0.4), abs=1e-4)
    assert np.delete(turns, [0, 90]) == pytest.approx(0.0, abs=1e-4)


def test_a_layer_height_above_the_wall_is_rejected(first_layer):
    with pytest.raises(InputError, match="layer height"):
        smooth_spacing.layers(TORUS, first_layer, 200.0, 0.5 * np.pi)
