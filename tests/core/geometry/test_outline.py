# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cubics through points: a helix with known tangents, an astroid with cusps, the seam of a bead
with a rotated start."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.outline import estimate_outline, outline
from freecad_am.core.toolpath import Bead


def helix(t):
    return np.c_[15 * np.cos(t), 15 * np.sin(t), 4 * t], np.c_[
        -15 * np.sin(t), 15 * np.cos(t), 4 + 0 * t
    ]


def test_points_and_tangents_between_are_the_curves_own():
    """Interpolated points and tangents agree with the curve."""
    steps = np.random.default_rng(3).uniform(0.5, 1.5, 90)
    t = np.r_[0.0, np.cumsum(steps)] / steps.sum() * 2 * np.pi
    points, slope = helix(t)
    tangents = np.repeat((slope / np.linalg.norm(slope, axis=1, keepdims=True))[:, None], 2, axis=1)
    curve = outline(points, tangents)
    segment = np.repeat(np.arange(90), 3)
    share = np.tile([0.25, 0.5, 0.75], 90)
    points_between, along = curve.at(segment, share)
    parameter = points_between[:, 2] / 4  # the height of a point gives the parameter of the helix
    exact, slope = helix(parameter)
    chord = 15 * np.diff(t).max() ** 2 / 8
    assert np.linalg.norm(points_between - exact, axis=1).max() < 1e-5 < chord / 1000
    assert np.abs(along - slope / np.linalg.norm(slope, axis=1, keepdims=True)).max() < 1e-4


def test_on_a_clothoid_whose_curvature_falls_to_a_sixteenth():
    """Curvature 0.8 - 0.25 s per mm: Fresnel integrals by quadrature give the distance of each
    point of the outline."""
    s = np.linspace(0.0, 3.0, 13)
    node, weight = np.polynomial.legendre.leggauss(40)

    def heading(station):
        return 0.8 * station - 0.125 * station * station

    def clothoid(station):
        turned = heading(0.5 * station[:, None] * (1.0 + node))
        return (
            0.5
            * station[:, None]
            * np.c_[np.cos(turned) @ weight, np.sin(turned) @ weight, 0 * station]
        )

    along = np.c_[np.cos(heading(s)), np.sin(heading(s)), 0 * s]
    segment, share = np.repeat(np.arange(12), 9), np.tile(np.linspace(0.1, 0.9, 9), 12)
    points, slope = outline(clothoid(s), np.repeat(along[:, None], 2, axis=1)).at(segment, share)
    station = s[segment] + share * 0.25
    for _ in range(10):  # to the nearest point, by steps along the tangent
        tangent = np.c_[np.cos(heading(station)), np.sin(heading(station)), 0 * station]
        station += ((points - clothoid(station)) * tangent).sum(axis=1)
    tangent = np.c_[np.cos(heading(station)), np.sin(heading(station)), 0 * station]
    chord_error = 0.8 * 0.25**2 / 8
    assert np.linalg.norm(points - clothoid(station), axis=1).max() < chord_error / 3000
    assert np.abs(slope - tangent).max() < 1e-4


def test_a_corner_is_kept_and_both_its_sides_are_curves():
    """Two half circles meet at a right angle: the segments next to the corner are arcs, not
    chords."""
    t = np.linspace(0, np.pi / 2, 21)
    first_arc, second_arc = (
        np.c_[np.sin(t), 1 - np.cos(t), 0 * t],
        np.c_[1 - np.sin(t), 2 - np.cos(t), 0 * t],
    )
    into, out = np.c_[np.cos(t), np.sin(t), 0 * t], np.c_[-np.cos(t), np.sin(t), 0 * t]
    points = 10 * np.r_[first_arc, second_arc[1:]]
    tangents = np.stack([np.r_[into, out[1:]], np.r_[into[:-1], out]], axis=1)
    midpoints, _ = outline(points, tangents).at(np.arange(40), 0.5)
    centre = np.where(np.arange(40) < 20, 0.0, 10.0)[:, None] * [1.0, 0, 0] + np.where(
        np.arange(40) < 20, 10.0, 20.0
    )[:, None] * [0, 1.0, 0]
    assert np.abs(np.linalg.norm(midpoints - centre, axis=1) - 10).max() < 1e-12


def test_tangents_go_with_the_bead():
    """Tangents follow the bead when it is reversed, rotated or cut."""
    t = np.linspace(0, 2 * np.pi, 33)
    points = np.c_[20 * np.cos(t), 9 * np.sin(t), 3 * np.cos(2 * t)]
    points[-1] = points[0]
    slope = np.c_[-20 * np.sin(t), 9 * np.cos(t), -6 * np.sin(2 * t)]
    tangents = np.repeat((slope / np.linalg.norm(slope, axis=1, keepdims=True))[:, None], 2, axis=1)
    up = np.tile([0.0, 0.0, 1.0], (33, 1))
    bead = Bead(points, up, up, t, np.ones(33), True, None, tangents)
    segments = np.arange(32)
    middle = bead.outline.at(segments, 0.5)[0]
    assert np.abs(bead.reversed().outline.at(segments, 0.5)[0] - middle[::-1]).max() < 1e-12
    assert (
        np.abs(bead.started_at(7).outline.at(segments, 0.5)[0] - np.roll(middle, -7, axis=0)).max()
        < 1e-12
    )
    section = bead.part(slice(3, 9))
    assert not section.closed and len(section) == 6
    assert np.abs(section.outline.at(np.arange(5), 0.5)[0] - middle[3:8]).max() < 1e-12


@pytest.mark.parametrize("closed", [True, False])
def test_a_line_between_arcs_stays_straight(closed):
    """A slot of few points with turns of 22.5 deg: a circle through a line and an arc bowed the
    line by 4.8 mm."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, 9)
    right = np.c_[50 + 5 * np.cos(angle), 5 * np.sin(angle), 0 * angle]
    points = np.r_[right, -right, right[:1]]
    midpoints, _ = estimate_outline(points, closed).at(np.arange(len(points) - 1), 0.5)
    deviation = np.abs(np.hypot(np.maximum(np.abs(midpoints[:, 0]) - 50, 0), midpoints[:, 1]) - 5)
    assert deviation.max() <= 5 * (1 - np.cos(np.pi / 16)) + 1e-12  # the sagitta of the chords
