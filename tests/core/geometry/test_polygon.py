# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangulated polygons in space: they cover the area once, with the orientation of the polygon."""

import numpy as np
import pytest

from freecad_am.core.geometry.mesh.polygon import triangulate


def random_rotation(seed):
    """A random rotation."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("backwards", [False, True])
def test_triangles_cover_a_star_once(seed, backwards):
    """A star of random radii; its area is half the sum of r_i r_i+1 sin of the angle between."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 25))
    angle = 2.0 * np.pi * np.arange(count) / count
    radius = rng.uniform(1.0, 8.0, count)
    area = 0.5 * float((radius * np.roll(radius, -1)).sum()) * np.sin(2.0 * np.pi / count)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)], axis=1)[
        :: -1 if backwards else 1
    ]
    corners = flat @ random_rotation(seed).T + 50.0
    normal = random_rotation(seed) @ [0.0, 0.0, -1.0 if backwards else 1.0]
    triangles = triangulate(corners)
    assert triangles.shape == (count - 2, 3)
    a, b, c = corners[triangles].swapaxes(0, 1)
    along = 0.5 * np.cross(b - a, c - a) @ normal
    assert along.min() > 0.0 and along.sum() == pytest.approx(area)


def test_corners_on_a_line_are_kept():
    """A square with corners in the middle of its sides; cutting them off one by one must keep all
    corners."""
    square = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]], dtype=float)
    corners = np.column_stack([square, np.full(8, 3.0)])
    triangles = triangulate(corners)
    a, b, c = corners[triangles].swapaxes(0, 1)
    areas = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (
        set(triangles.ravel()) == set(range(8))
        and areas.min() >= 0.0
        and areas.sum() == pytest.approx(4.0)
    )
