# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points on a curve within a chord error, measured by brute force."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.curves.outline import outline
from freecad_am.core.geometry.curves.space_curve import SpaceCurve
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.slicing.curve_points import sample_within_chord
from freecad_am.core.slicing.first_layer import interpolate_polyline, intersect_implicit
from freecad_am.core.slicing.tubes import constant_distance
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])


@pytest.fixture(scope="module")
def fronts():
    torus = Torus(60.0, 15.0)
    first = intersect_implicit(torus, PIPE, (0.0, 1.5), even_grid(torus, 360))
    return constant_distance.layers(torus, first, 5.0, 0.5 * np.pi)


def largest_chord_error(curve, w):
    """Largest distance between dense samples of the curve and the polyline through w."""
    ends = curve.at(w)[0]
    error = 0.0
    for a, b, start, end in zip(ends[:-1], ends[1:], w[:-1], w[1:]):
        points = curve.at(np.linspace(start, end, 60))[0] - a
        share = np.clip(points @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        error = max(error, np.linalg.norm(points - share[:, None] * (b - a), axis=1).max())
    return error


@pytest.mark.parametrize("error", [0.5, 0.01, 0.0005])
@pytest.mark.parametrize("index", [0, 3, 9, 15])
def test_chords_keep_the_tolerance_and_corners_are_points(fronts, index, error):
    curve = fronts[index].curve
    start = curve.w[0] + 0.3
    w = sample_within_chord(curve, start, start + curve.period, error)
    assert (np.diff(w) > 0.0).all()
    assert w[0] == start and w[-1] == start + curve.period
    assert largest_chord_error(curve, w) <= error * (1.0 + 1e-3)
    parameters = curve.wrap(w)
    for corner in curve.w[curve.corners]:
        assert np.abs(parameters - corner).min() < 1e-9


def test_a_circle_gets_the_minimum_number_of_points():
    circle = make_ring().curve
    w = sample_within_chord(circle, circle.w[0], circle.w[-1], 0.01)
    needed = np.pi / np.arccos(1.0 - 0.01 / 15.0)
    assert needed <= len(w) - 1 <= needed + 2


def make_ring():
    """Return a circle with the torus's small radius."""
    torus = Torus(60.0, 15.0)
    v = 2.0 * np.pi * np.arange(360) / 360
    return interpolate_polyline(torus, torus.point(np.full(360, 0.1), v))


def test_the_outline_follows_the_curve_where_its_curvature_jumps():
    """In a rounded rectangle the curvature jumps between straight parts and arcs."""
    half, radius = np.array([20.0, 10.0]), 8.0
    angle = np.arange(0, 361, 3) * np.pi / 180.0
    centre = np.sign(np.stack([np.cos(angle + 1e-9), np.sin(angle + 1e-9)], axis=1)) * half
    flat, along = [], []
    for k, a in enumerate(angle[:-1]):
        ends = [centre[k]] if k % 30 else [centre[k - 1] if k else centre[-2], centre[k]]
        for corner in ends:  # both ends of a straight part have the same tangent
            flat.append(corner + radius * np.array([np.cos(a), np.sin(a)]))
            along.append([-np.sin(a), np.cos(a)])
    flat, along = (
        np.column_stack([rows + rows[:1], np.zeros(len(rows) + 1)]) for rows in (flat, along)
    )
    w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(flat, axis=0), axis=1))]
    curve = SpaceCurve(w, flat, along, along, True)

    def measure_offset(points):
        out = np.abs(points[:, :2]) - half
        return np.abs(
            np.where((out > 0).all(axis=1), np.linalg.norm(out, axis=1), out.max(axis=1)) - radius
        )

    assert measure_offset(curve.at(curve.refined(7))[0]).max() < 1e-5
    for start in (0.0, 1.7, 9.3):
        parameters = sample_within_chord(curve, start, start + curve.period, 0.01)
        points, slope, _ = curve.at(parameters)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        drawn = outline(points, np.stack([slope, slope], axis=1))
        segment = np.repeat(np.arange(len(parameters) - 1), 15)
        assert (
            measure_offset(
                drawn.at(segment, np.tile(np.arange(1, 16) / 16.0, len(parameters) - 1))[0]
            ).max()
            < 1e-4
        )
