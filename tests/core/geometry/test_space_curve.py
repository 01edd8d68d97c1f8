# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves with corners: nearest points against brute force, interpolation against the sampled
curve."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.space_curve import SpaceCurve


def circle(nodes=40, radius=10.0):
    w = np.linspace(0.0, 2.0 * np.pi, nodes + 1)
    points = radius * np.stack([np.cos(w), np.sin(w), 0.0 * w], axis=1)
    slope = radius * np.stack([-np.sin(w), np.cos(w), 0.0 * w], axis=1)
    return SpaceCurve(w, points, slope, slope, True)


def square(closed=True):
    points = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 0]], dtype=float)
    sides = np.diff(points, axis=0)
    out, into = np.vstack([sides, sides[:1]]), np.vstack([sides[-1:], sides])
    return SpaceCurve(np.arange(5.0), points, into, out, closed)


def brute(curve, points):
    line = curve.at(curve.refined(400))[0]
    a, b = line[:-1], line[1:]
    along = b - a
    t = np.clip(((points[:, None] - a) * along).sum(-1) / (along**2).sum(-1), 0.0, 1.0)
    return np.linalg.norm(points[:, None] - a - t[..., None] * along, axis=-1).min(axis=1)


@pytest.mark.parametrize(
    "curve", [circle(), square(), square(closed=False), circle().started_at(7)]
)
def test_nearest_point_against_brute_force(curve):
    points = np.random.default_rng(5).uniform(-12.0, 12.0, (150, 3))
    distance, foot, w = curve.nearest(points)
    assert distance == pytest.approx(brute(curve, points), abs=2e-6)
    assert np.linalg.norm(points - foot, axis=1) == pytest.approx(distance)
    assert curve.at(w)[0] == pytest.approx(foot, abs=1e-9)


def test_near_the_centre_of_curvature_the_nearest_point_is_still_found():
    ellipse = circle(90)
    squeezed = np.array([1.0, 0.8, 1.0])
    curve = SpaceCurve(
        ellipse.w, ellipse.points * squeezed, ellipse.into * squeezed, ellipse.out * squeezed, True
    )
    centre = np.array([[10.0 - 6.4, 0.0, 0.0]]) + np.linspace(-0.2, 0.2, 21)[:, None] * np.array(
        [1.0, 0.3, 0.0]
    )
    assert curve.nearest(centre)[0] == pytest.approx(brute(curve, centre), abs=1e-7)


def test_corners_are_found_and_kept():
    assert square().corners.tolist() == [0, 1, 2, 3]
    assert square(closed=False).corners.tolist() == [1, 2, 3]
    assert square().turns[:4] == pytest.approx(np.full(4, np.pi / 2))
    assert not len(circle().corners)
    assert square().length == pytest.approx(16.0)
    turned = square().started_at(2)
    assert turned.points[0] == pytest.approx([4, 4, 0])
    assert turned.corners.tolist() == [0, 1, 2, 3]


def test_the_error_estimate_is_the_error():
    curve = circle(20)
    w = curve.w[:-1] + 0.5 * curve.span
    exact = 10.0 * np.stack([np.cos(w), np.sin(w), 0.0 * w], axis=1)
    assert curve.interpolation_error() == pytest.approx(
        np.linalg.norm(curve.at(w)[0] - exact, axis=1), rel=0.02
    )
    assert square().interpolation_error() == pytest.approx(np.zeros(4), abs=1e-12)


def test_what_is_no_curve_is_refused():
    with pytest.raises(ValueError, match="rise"):
        SpaceCurve(
            np.array([0.0, 0.0]), np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 3)), False
        )
    with pytest.raises(ValueError, match="nodes"):
        SpaceCurve(np.zeros(1), np.zeros((1, 3)), np.zeros((1, 3)), np.zeros((1, 3)), False)
    with pytest.raises(ValueError, match="closed"):
        square(closed=False).started_at(1)
