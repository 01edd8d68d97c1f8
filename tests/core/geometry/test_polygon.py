# SPDX-License-Identifier: LGPL-2.1-or-later
"""Polygons in space cut into triangles: all of the area, none twice, turning as the polygon does."""

import numpy as np
import pytest

from freecad_am.core.geometry.mesh.polygon import triangulate


def turned(seed):
    """A random rotation."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("backwards", [False, True])
def test_triangles_cover_a_star_once(seed, backwards):
    """A star of random radii, which has as its area half of the sum of r_i r_i+1 sin of the angle between."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 25))
    angle = 2.0 * np.pi * np.arange(count) / count
    radius = rng.uniform(1.0, 8.0, count)
    area = 0.5 * float((radius * np.roll(radius, -1)).sum()) * np.sin(2.0 * np.pi / count)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(count)], axis=1)[
        :: -1 if backwards else 1
    ]
    corners = flat @ turned(seed).T + 50.0
    way = turned(seed) @ [0.0, 0.0, -1.0 if backwards else 1.0]
    found = triangulate(corners)
    assert found.shape == (count - 2, 3)
    a, b, c = corners[found].swapaxes(0, 1)
    along = 0.5 * np.cross(b - a, c - a) @ way
    assert along.min() > 0.0 and along.sum() == pytest.approx(area)


def test_corners_on_a_line_are_kept():
    """A square with corners in the middle of its sides, one after the other of which is cut off."""
    square = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]], dtype=float)
    corners = np.column_stack([square, np.full(8, 3.0)])
    found = triangulate(corners)
    a, b, c = corners[found].swapaxes(0, 1)
    areas = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (
        set(found.ravel()) == set(range(8))
        and areas.min() >= 0.0
        and areas.sum() == pytest.approx(4.0)
    )
