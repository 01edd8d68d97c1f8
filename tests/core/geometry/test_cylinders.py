# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bounding cylinders contain their points and are not much larger."""

import numpy as np
import pytest

from freecad_am.core.geometry import cylinders


def spread_on(points, triangles, random, count=4000):
    """Points spread evenly over triangles."""
    corners = points[triangles]
    size = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    indices = random.choice(len(triangles), count, p=size / size.sum())
    a, b = random.uniform(size=(2, count))
    a, b = np.where(a + b > 1.0, 1.0 - a, a), np.where(a + b > 1.0, 1.0 - b, b)
    c = corners[indices]
    return c[:, 0] + a[:, None] * (c[:, 1] - c[:, 0]) + b[:, None] * (c[:, 2] - c[:, 0])


def tube(path, radius, sides=16):
    """A tube of rings about the points of a path in the plane y = 0, with long triangles."""
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.array([0.0, 1.0, 0.0])
    up = np.cross(along, side)
    rings = path[:, None] + radius * (
        np.cos(angle)[None, :, None] * side + np.sin(angle)[None, :, None] * up[:, None]
    )
    k = np.arange((len(path) - 1) * sides)
    right = np.where(k % sides == sides - 1, k - sides + 1, k + 1)
    triangles = np.concatenate(
        [np.stack([k, right, right + sides], 1), np.stack([k, right + sides, k + sides], 1)]
    )
    return rings.reshape(-1, 3), triangles


@pytest.mark.parametrize("seed", range(5))
def test_a_rod_about_points_of_a_turned_cylinder_is_that_cylinder(seed):
    random = np.random.default_rng(seed)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    radius, length = random.uniform(5, 80), random.uniform(5, 300)
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)
    ends = [np.column_stack([ring, np.full(40, z)]) for z in (0.0, length)]
    points = np.concatenate(ends) @ turn.T + random.uniform(-500, 500, 3)
    rod = cylinders.enclosing_cylinder(points)
    assert rod.holds(points).all()
    assert rod.length * rod.radius**2 <= length * radius**2 * 1.0001 + 1e-6


def test_a_row_of_rods_holds_a_bent_shape_between_its_vertices_too():
    """A row of cylinders contains a bent shape between its vertices too."""
    turn = np.linspace(0, np.pi / 2, 7)
    bend = np.stack([300 - 100 * np.cos(turn), np.zeros(7), 100 * np.sin(turn)], 1)
    path = np.concatenate([[[200.0, 0.0, -400.0]], bend, [[700.0, 0.0, 100.0]]])
    points, triangles = tube(path, 40.0)
    rods = cylinders.enclosing_row(points, triangles)
    surface = spread_on(points, triangles, np.random.default_rng(1))
    assert np.any([rod.holds(surface) for rod in rods], axis=0).all()
    single_rod = cylinders.enclosing_cylinder(points)
    volume = sum(rod.length * rod.radius**2 for rod in rods)
    assert (
        2 < len(rods) <= cylinders.MAX_PIECES
        and volume < 0.4 * single_rod.length * single_rod.radius**2
    )


def test_a_ball_is_one_rod():
    angle = np.linspace(0, np.pi, 12)
    path = np.stack([np.zeros(12), np.zeros(12), -30 * np.cos(angle)], 1)
    points, triangles = tube(path, 1.0)
    points[:, :2] *= np.repeat(30 * np.sin(angle), 16)[:, None]
    assert len(cylinders.enclosing_row(points, triangles)) <= 4
    assert np.any(
        [rod.holds(points) for rod in cylinders.enclosing_row(points, triangles)], axis=0
    ).all()


def test_rods_inside_others_are_left_out():
    """Cylinders inside others are dropped."""
    random = np.random.default_rng(2)
    large, small = random.uniform(-100, 100, (200, 3)), random.uniform(-10, 10, (50, 3))
    distant = small + [500.0, 0.0, 0.0]
    sets = [small, large, distant]
    remaining = cylinders.drop_redundant(
        [cylinders.enclosing_cylinder(points) for points in sets], sets
    )
    assert (
        len(remaining) == 2
        and remaining[0].holds(large).all()
        and remaining[1].holds(distant).all()
    )
