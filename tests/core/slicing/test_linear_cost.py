# SPDX-License-Identifier: LGPL-2.1-or-later
"""Twice the points cost twice the work; the tests count evaluations instead of time."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.curves.space_curve import SpaceCurve
from freecad_am.core.geometry.mesh.triangle_mesh import Mesh
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.process.deposit import spacing
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.slicing.fronts.rims import nearest_feet
from freecad_am.core.slicing.tubes import constant_distance, iso_parameter, smooth_spacing
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid
from tests.core.patch_walls import tube

TORUS = Torus(60.0, 15.0)
COUNTS = (180, 360, 720, 1440)


@pytest.fixture
def evaluations(monkeypatch):
    """Number of evaluated points of surfaces and curves."""
    count = [0]
    surface_derivatives, curve_evaluation = Torus.derivatives, SpaceCurve.evaluate_arcs

    def derivatives(self, u, v):
        count[0] += np.broadcast(u, v).size
        return surface_derivatives(self, u, v)

    def evaluate_arcs(self, arc, t):
        count[0] += np.size(t)
        return curve_evaluation(self, arc, t)

    monkeypatch.setattr(Torus, "derivatives", derivatives)
    monkeypatch.setattr(SpaceCurve, "evaluate_arcs", evaluate_arcs)
    return count


def slice_torus(rule, first, points):
    if rule == "iso-parameter":
        return [layer.v for layer in iso_parameter.layers(TORUS, first, 5.0, 0.9)]
    if rule == "smooth":
        return [
            smoothed.layer.v
            for smoothed in smooth_spacing.layers(TORUS, first, 5.0, 0.9, points=points)
        ]
    return [layer.v for layer in constant_distance.layers(TORUS, first, 5.0, 0.9, points)]


@pytest.mark.parametrize("rule", ["iso-parameter", "constant-distance", "smooth"])
def test_evaluations_are_linear_in_the_points(evaluations, rule):
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    counts = []
    for points in COUNTS:
        first = intersect_implicit(TORUS, pipe, (0.0, 1.5), even_grid(TORUS, points))
        evaluations[0] = 0
        layers = slice_torus(rule, first, points)
        assert sum(map(len, layers)) >= points * len(layers)
        counts.append(evaluations[0])
    assert counts[0] > COUNTS[0] * len(layers)  # the counter works
    for coarse, fine in zip(counts, counts[1:]):
        assert fine < 2.2 * coarse


def test_fronts_at_half_the_height_cost_four_times_the_work(evaluations, monkeypatch):
    """Half the height means twice the layers with twice the points: count points evaluated on
    curves and visited mesh faces."""
    visited = [0]
    take_faces = Mesh.part

    def count_faces(self, faces):
        visited[0] += len(faces)
        return take_faces(self, faces)

    monkeypatch.setattr(Mesh, "part", count_faces)
    counts = []
    for height in (4.0, 2.0):
        wall = tube(HalfSpace(np.zeros(3), np.array([0.2, 0.1, 1.0])), 20.0, 0.5 * height, low=-6.0)
        evaluations[0] = visited[0] = 0
        nodes = sum(
            len(front.w) for layer in fronts.slice_layers(wall, height).fronts for front in layer
        )
        assert evaluations[0] > nodes
        counts.append((evaluations[0], visited[0], len(wall.triangles)))
    (curves, faces, triangles), (fine_curves, fine_faces, fine_triangles) = counts
    assert fine_curves < 1.1 * curves * fine_triangles / triangles
    assert fine_faces < 1.1 * faces * fine_triangles / triangles and fine_faces < 8 * fine_triangles


def test_spacing_checks_only_near_segments(monkeypatch):
    checked = [0]
    project = spacing._share

    def count_segments(offset, along):
        checked[0] += offset.shape[1]
        return project(offset, along)

    monkeypatch.setattr(spacing, "_share", count_segments)
    counts = []
    for points in (1000, 2000, 4000):
        angle = np.linspace(0.0, 2.0 * np.pi, points + 1)
        ring = np.c_[50.0 * np.cos(angle), 50.0 * np.sin(angle), 0.0 * angle]
        ring[-1] = ring[0]
        below = spacing.Curve(*spacing.columns_of(ring, True))
        checked[0] = 0
        distances = spacing.distance(ring + [0.0, 0.0, 0.02], below)
        assert distances == pytest.approx(0.02, abs=1e-6)
        counts.append(checked[0])
    assert all(fine < 2.2 * coarse for coarse, fine in zip(counts, counts[1:]))


@pytest.mark.parametrize("points", [30, 200, 700])
def test_segments_from_a_tree_give_the_same_distances_as_all_segments(monkeypatch, points):
    random = np.random.default_rng(points)
    angle = np.linspace(0.0, 2.0 * np.pi, points + 1)
    wave = 50.0 + 3.0 * np.sin(7.0 * angle)
    ring = np.c_[wave * np.cos(angle), wave * np.sin(angle), 0.0 * angle]
    ring[-1] = ring[0]
    below = spacing.Curve(*spacing.columns_of(ring, True))
    query_points = ring + random.uniform(-1.0, 1.0, ring.shape) + [0.0, 0.0, 1.5]
    distances = []
    for limit in (0, 10**9):
        monkeypatch.setattr(spacing, "_ALL", limit)
        distances.append(spacing.distance(query_points, below))
    assert (distances[0] == distances[1]).all()
    # a finer search finds no closer point on the chords
    fine = np.linspace(0.0, 1.0, 40)[:, None, None]
    chords = (below.start + fine * (below.end - below.start)).reshape(-1, 3)
    nearest = np.array([np.linalg.norm(chords - point, axis=1).min() for point in query_points])
    assert (np.abs(distances[0] - nearest) < 0.6 * (2.0 * np.pi * 53.0 / points)).all()


def make_small_rings(count):
    """Rings of 4 mm in a row, 10 mm apart."""
    angle = np.linspace(0.0, 2.0 * np.pi, 33)
    rings = []
    for k in range(count):
        points = np.column_stack(
            [10.0 * k + 2.0 * np.cos(angle), 2.0 * np.sin(angle), np.zeros(33)]
        )
        points[-1] = points[0]
        slope = np.column_stack([-2.0 * np.sin(angle), 2.0 * np.cos(angle), np.zeros(33)])
        rings.append(SpaceCurve(angle, points, slope, slope, True))
    return rings


def test_points_search_only_near_rings_of_a_layer(evaluations):
    """On a real wall with layers of 55 pieces, searching every piece for each point took a minute
    longer."""
    points = np.random.default_rng(4).uniform([0.0, -3.0, -1.0], [390.0, 3.0, 1.0], (2_000, 3))
    counts = []
    for count in (5, 40):
        rings = make_small_rings(count)
        queries = points[points[:, 0] < 10.0 * count - 10.0]
        evaluations[0] = 0
        feet = nearest_feet(rings, queries)
        counts.append(evaluations[0] / len(queries))
        # bit for bit the result of searching each ring
        references = [ring.nearest(queries) for ring in rings]
        front = np.argmin([reference[0] for reference in references], axis=0)
        assert (feet.front == front).all()
        row = np.arange(len(queries))
        assert (
            feet.point == np.stack([reference[1] for reference in references])[front, row]
        ).all()
        assert (feet.w == np.stack([reference[2] for reference in references])[front, row]).all()
    assert counts[1] < 1.3 * counts[0]
