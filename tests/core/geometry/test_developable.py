# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unrolled cones and cylinders keep every length; offsets are equidistant; slim cones approach
cylinders."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable

BASES = [
    Developable(60.0, 200.0),
    Developable(60.0),
    Developable(3.0, 0.5),
    Developable(60.0, 1e7),
    Developable(250.0, 90.0),
    Developable(0.4, 3.0),
]


def sample_points(base, n, seed):
    """Random points (n, 3) of the surface well below an apex."""
    rng = np.random.default_rng(seed)
    theta = rng.uniform(-math.pi, math.pi, n)
    z = rng.uniform(-2.0, 0.9, n) * min(base.height, 4.0 * base.radius)
    rho = base.radius * (1.0 - z / base.height)
    return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("middle", [0.0, 2.5, -17.0])
def test_there_and_back(base, middle):
    points = sample_points(base, 4000, 1)
    size = np.abs(points).max()
    np.testing.assert_allclose(
        base.wrap(base.unroll(points, middle), middle), points, atol=1e-12 * size
    )


@pytest.mark.parametrize("base", BASES)
def test_lengths_of_curves_stay(base):
    # a curve on the surface, its length by fine chords in space and in the plane
    t = np.linspace(0.0, 1.0, 200001)
    theta, z = -2.0 + 4.0 * t, 0.5 * min(base.height, base.radius) * np.sin(5.0 * t)
    rho = base.radius * (1.0 - z / base.height)
    space = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    lengths = [
        np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in (space, base.unroll(space))
    ]
    np.testing.assert_allclose(lengths[1], lengths[0], rtol=1e-9)


@pytest.mark.parametrize("base", BASES)
def test_angles_stay(base):
    """Unrolling keeps angles and orientation."""
    points = sample_points(base, 500, 2)
    points = points[np.abs(base.azimuth(points)) < 3.0]
    normal = base.normals(points)
    around = np.stack([-points[:, 1], points[:, 0], np.zeros(len(points))], axis=1)
    around /= np.linalg.norm(around, axis=1)[:, None]
    up = np.cross(normal, around)
    step = 1e-5 * base.radius
    flat = base.unroll(points)
    moved = [
        (base.unroll(points + step * direction) - base.unroll(points - step * direction))
        / (2.0 * step)
        for direction in (around, up)
    ]
    # derivatives of an isometry rotate the tangent plane rigidly, with its outer side up
    for tangent in moved:
        np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose((moved[0] * moved[1]).sum(axis=1), 0.0, atol=1e-6)
    assert (moved[0][:, 0] * moved[1][:, 1] - moved[0][:, 1] * moved[1][:, 0] > 0.0).all()
    assert flat.shape == (len(points), 2)


@pytest.mark.parametrize("base", BASES)
def test_offsets_are_equidistant(base):
    for distance in (0.3, 5.0, 40.0):
        further = base.offset(distance)
        points = sample_points(further, 1000, 3)
        np.testing.assert_allclose(
            base.distance(points), distance, atol=1e-12 * np.abs(points).max()
        )
        foot = points - distance * base.normals(points)
        keep = foot[:, 2] < base.height  # the part above the surface, not above its apex
        keep &= (foot[:, :2] * points[:, :2]).sum(axis=1) > 0.0
        np.testing.assert_allclose(
            base.distance(foot[keep]), 0.0, atol=1e-12 * np.abs(points).max()
        )


def test_offsets_of_the_paper():
    further = Developable(60.0, 200.0).offset(3.0)
    assert further.radius == pytest.approx(60.0 + math.sqrt(109.0) / 10.0 * 3.0, abs=1e-12)
    assert further.height == pytest.approx(200.0 + math.sqrt(109.0) / 3.0 * 3.0, abs=1e-12)


def test_a_slim_cone_is_nearly_a_cylinder():
    cone, cylinder = Developable(60.0, 1e9), Developable(60.0)
    points = sample_points(cylinder, 100, 4)
    np.testing.assert_allclose(cone.unroll(points), cylinder.unroll(points), atol=1e-4)
    np.testing.assert_allclose(cone.distance(points), cylinder.distance(points), atol=1e-4)


def test_only_the_nappe_below_the_apex():
    base = Developable(60.0, 200.0)
    mirrored = np.array([[60.0, 0.0, 400.0]])  # on the double cone of eq. 1, above the apex
    assert base.distance(mirrored)[0] > 100.0


@pytest.mark.parametrize(
    "radius, height", [(0.0, 10.0), (-1.0, 10.0), (5.0, 0.0), (5.0, -3.0), (float("nan"), 1.0)]
)
def test_nonsense_is_refused(radius, height):
    with pytest.raises(ValueError):
        Developable(radius, height)


def test_an_offset_past_the_axis_is_refused():
    with pytest.raises(ValueError):
        Developable(5.0).offset(-6.0)
