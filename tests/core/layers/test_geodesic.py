# SPDX-License-Identifier: LGPL-2.1-or-later
"""Geodesic layers: each within a band of one layer height above the layer below, and together the
whole solid."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.mesh.solid import SolidMesh
from freecad_am.core.layers.geodesic import field

from .shapes import box, tee

HEIGHT = 2.0


@pytest.fixture(scope="module")
def through_tee():
    vertices, triangles = tee()
    return field([SolidMesh(vertices, triangles)], _bottom(vertices, triangles), 0.8)


def _bottom(vertices, triangles):
    corners = vertices[triangles]
    return corners[(corners[:, :, 2] == 0.0).all(axis=1)]


@pytest.fixture(scope="module")
def layers(through_tee):
    """Points (n, 3) spread over each layer, and its area."""
    sampled = []
    for number in range(int(through_tee.top / HEIGHT + 0.5)):
        points, area = [], 0.0
        for patch in through_tee.pieces((number + 0.5) * HEIGHT):
            for region in patch.regions:
                area += region.area
                ring = region.borders()[0]
                axes = [
                    np.arange(low + 0.15, high, 0.3)
                    for low, high in zip(ring.min(axis=0), ring.max(axis=0))
                ]
                flat = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
                points.append(patch.chart.wrap(flat[region.contains(flat)]))
        sampled.append((through_tee.onto(np.vstack(points), number * HEIGHT), area))
    return sampled


def _way(points):
    """Length (n,) of the shortest path from z = 0 to points (n, 3) of the tee: up, then around a
    corner of the stem."""
    x, z = points[:, 0], points[:, 2]
    aside = np.maximum(np.maximum(-x, x - 10.0), 0.0)
    return np.where(aside > 0.0, 20.0 + np.hypot(aside, z - 20.0), z)


def test_points_lie_as_far_through_the_solid_as_their_layer_says(layers):
    for number, (points, _) in enumerate(layers):
        assert np.abs(_way(points) - number * HEIGHT).max() < 0.9, number


def test_each_layer_lies_on_the_one_below(layers):
    ratios = []
    for (below, _), (points, _) in zip(layers, layers[1:]):
        ratios.append(cKDTree(below).query(points)[0] / HEIGHT)
    ratio = np.concatenate(ratios)
    assert ratio.min() > 0.6 and ratio.max() < 1.2
    assert ((ratio > 0.8) & (ratio < 1.2)).mean() > 0.95


def test_areas_are_those_of_the_fans(layers):
    """Areas of the layers agree with the fans around the corners."""
    for number, (_, area) in enumerate(layers):
        distance = (number + 0.5) * HEIGHT
        if distance < 20.0:
            exact = 200.0
        elif distance < 30.0:
            exact = 200.0 + 2.0 * 20.0 * 0.5 * np.pi * (distance - 20.0)
        else:
            continue
        assert area == pytest.approx(exact, rel=0.05), number
    assert sum(area for _, area in layers) * HEIGHT == pytest.approx(13000.0, rel=0.03)


def test_directions_point_from_layer_to_layer(through_tee, layers):
    below, points = layers[13][0], layers[14][0]
    step = points - below[cKDTree(below).query(points)[1]]
    step /= np.linalg.norm(step, axis=1, keepdims=True)
    cosine = (through_tee.directions(points) * step).sum(axis=1)
    assert np.quantile(cosine, 0.05) > np.cos(np.radians(25.0))


def test_what_no_way_leads_to_is_told():
    vertices, triangles = tee()
    solids = [SolidMesh(vertices + [x, 0.0, 0.0], triangles) for x in (0.0, 100.0)]
    assert field(solids, _bottom(vertices, triangles), 1.5).unreached == pytest.approx(
        0.5, abs=0.01
    )
    with pytest.raises(ValueError):
        field(solids, np.zeros((0, 3, 3)), 1.5)


def test_solids_that_touch_are_one():
    """Solids that touch are united."""
    low, triangles = box([20.0, 10.0, 6.0])
    distance_field = field(
        [SolidMesh(low, triangles), SolidMesh(low + [0.0, 0.0, 6.0], triangles)],
        _bottom(low, triangles),
        0.7,
    )
    for distance in (3.0, 6.0, 9.0):
        patches = list(distance_field.pieces(distance))
        assert len(patches) == 1 and len(patches[0].regions) == 1
        assert patches[0].regions[0].area == pytest.approx(200.0, rel=0.01)
