# SPDX-License-Identifier: LGPL-2.1-or-later
"""Twice the points are twice the work: what is evaluated is counted, not timed."""

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
def evaluated(monkeypatch):
    """How many points of surfaces and curves have been evaluated."""
    total = [0]
    surface, curve = Torus.derivatives, SpaceCurve.evaluate_arcs

    def derivatives(self, u, v):
        total[0] += np.broadcast(u, v).size
        return surface(self, u, v)

    def on_arcs(self, arc, t):
        total[0] += np.size(t)
        return curve(self, arc, t)

    monkeypatch.setattr(Torus, "derivatives", derivatives)
    monkeypatch.setattr(SpaceCurve, "evaluate_arcs", on_arcs)
    return total


def cut(rule, first, points):
    if rule == "iso-parameter":
        return [layer.v for layer in iso_parameter.layers(TORUS, first, 5.0, 0.9)]
    if rule == "smooth":
        return [
            smoothed.layer.v
            for smoothed in smooth_spacing.layers(TORUS, first, 5.0, 0.9, points=points)
        ]
    return [layer.v for layer in constant_distance.layers(TORUS, first, 5.0, 0.9, points)]


@pytest.mark.parametrize("rule", ["iso-parameter", "constant-distance", "smooth"])
def test_evaluations_grow_with_the_points_and_no_faster(evaluated, rule):
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    work = []
    for points in COUNTS:
        first = intersect_implicit(TORUS, pipe, (0.0, 1.5), even_grid(TORUS, points))
        evaluated[0] = 0
        made = cut(rule, first, points)
        assert sum(map(len, made)) >= points * len(made)
        work.append(evaluated[0])
    assert work[0] > COUNTS[0] * len(made)  # it is counted
    for before, after in zip(work, work[1:]):
        assert after < 2.2 * before


def test_fronts_on_half_the_height_are_four_times_the_work(evaluated, monkeypatch):
    """Twice the layers of twice the points: places evaluated on curves, and faces of the mesh looked at."""
    looked = [0]
    part = Mesh.part

    def counted(self, faces):
        looked[0] += len(faces)
        return part(self, faces)

    monkeypatch.setattr(Mesh, "part", counted)
    work = []
    for height in (4.0, 2.0):
        wall = tube(HalfSpace(np.zeros(3), np.array([0.2, 0.1, 1.0])), 20.0, 0.5 * height, low=-6.0)
        evaluated[0] = looked[0] = 0
        nodes = sum(
            len(front.w) for layer in fronts.slice_layers(wall, height).fronts for front in layer
        )
        assert evaluated[0] > nodes
        work.append((evaluated[0], looked[0], len(wall.triangles)))
    (curves, faces, mesh), (more_curves, more_faces, finer) = work
    assert more_curves < 1.1 * curves * finer / mesh
    assert more_faces < 1.1 * faces * finer / mesh and more_faces < 8 * finer


def test_of_segments_below_only_the_near_ones_are_tried(monkeypatch):
    tried = [0]
    share = spacing._share

    def counted(offset, along):
        tried[0] += offset.shape[1]
        return share(offset, along)

    monkeypatch.setattr(spacing, "_share", counted)
    work = []
    for points in (1000, 2000, 4000):
        angle = np.linspace(0.0, 2.0 * np.pi, points + 1)
        ring = np.c_[50.0 * np.cos(angle), 50.0 * np.sin(angle), 0.0 * angle]
        ring[-1] = ring[0]
        below = spacing.Curve(*spacing.columns_of(ring, True))
        tried[0] = 0
        found = spacing.distance(ring + [0.0, 0.0, 0.02], below)
        assert found == pytest.approx(0.02, abs=1e-6)
        work.append(tried[0])
    assert all(after < 2.2 * before for before, after in zip(work, work[1:]))


@pytest.mark.parametrize("points", [30, 200, 700])
def test_near_segments_from_a_tree_are_those_that_all_of_them_tell(monkeypatch, points):
    random = np.random.default_rng(points)
    angle = np.linspace(0.0, 2.0 * np.pi, points + 1)
    wave = 50.0 + 3.0 * np.sin(7.0 * angle)
    ring = np.c_[wave * np.cos(angle), wave * np.sin(angle), 0.0 * angle]
    ring[-1] = ring[0]
    below = spacing.Curve(*spacing.columns_of(ring, True))
    places = ring + random.uniform(-1.0, 1.0, ring.shape) + [0.0, 0.0, 1.5]
    found = []
    for most in (0, 10**9):
        monkeypatch.setattr(spacing, "_ALL", most)
        found.append(spacing.distance(places, below))
    assert (found[0] == found[1]).all()
    # no finer way of looking finds a nearer place of the chords
    fine = np.linspace(0.0, 1.0, 40)[:, None, None]
    chords = (below.start + fine * (below.end - below.start)).reshape(-1, 3)
    nearest = np.array([np.linalg.norm(chords - place, axis=1).min() for place in places])
    assert (np.abs(found[0] - nearest) < 0.6 * (2.0 * np.pi * 53.0 / points)).all()


def small_rings(count):
    """Rings of 4 mm in a row, 10 mm apart."""
    angle = np.linspace(0.0, 2.0 * np.pi, 33)
    found = []
    for k in range(count):
        points = np.column_stack(
            [10.0 * k + 2.0 * np.cos(angle), 2.0 * np.sin(angle), np.zeros(33)]
        )
        points[-1] = points[0]
        slope = np.column_stack([-2.0 * np.sin(angle), 2.0 * np.cos(angle), np.zeros(33)])
        found.append(SpaceCurve(angle, points, slope, slope, True))
    return found


def test_of_a_layer_in_many_pieces_each_point_looks_at_those_near_it_alone(evaluated):
    """A real wall whose layers broke into 55 pieces took a minute longer: each point was looked at from each piece."""
    points = np.random.default_rng(4).uniform([0.0, -3.0, -1.0], [390.0, 3.0, 1.0], (2_000, 3))
    work = []
    for count in (5, 40):
        rings = small_rings(count)
        near = points[points[:, 0] < 10.0 * count - 10.0]
        evaluated[0] = 0
        found = nearest_feet(rings, near)
        work.append(evaluated[0] / len(near))
        # the same, to the bit, as from each of them
        every = [ring.nearest(near) for ring in rings]
        front = np.argmin([one[0] for one in every], axis=0)
        assert (found.front == front).all()
        row = np.arange(len(near))
        assert (found.point == np.stack([one[1] for one in every])[front, row]).all()
        assert (found.w == np.stack([one[2] for one in every])[front, row]).all()
    assert work[1] < 1.3 * work[0]
