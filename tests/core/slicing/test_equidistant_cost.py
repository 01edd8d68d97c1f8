# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cutting is at most linear in triangles and linear in layers; the tests count evaluations instead
of time."""

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.slicing.solids.equidistant import Facets

SIDES = (32, 64, 128, 256)
CONE = Developable(60.0, 200.0)


@pytest.fixture
def evaluations(monkeypatch):
    """Number of points whose distance or normal from the base was evaluated."""
    total = [0]
    for name in ("distance", "normals", "distance_rate"):
        method = getattr(Developable, name)

        def counted(self, points, *rest, method=method):
            total[0] += points.size // 3
            return method(self, points, *rest)

        monkeypatch.setattr(Developable, name, counted)
    return total


def make_ring(sides, seed=0):
    """Return a closed ring next to the axis with 2 * sides^2 triangles; vertices are perturbed so
    that none is on a cut."""
    u, v = (axis.ravel() for axis in np.meshgrid(*[np.arange(sides)] * 2, indexing="ij"))
    a, b = u * 2.0 * np.pi / sides, v * 2.0 * np.pi / sides
    radius = 30.0 + 12.0 * np.cos(b)
    points = np.stack(
        [110.0 + radius * np.cos(a), 12.0 * np.sin(b), 60.0 + radius * np.sin(a)], axis=1
    )
    points += np.random.default_rng(seed).normal(scale=1e-3, size=points.shape)
    next_u, next_v = (u + 1) % sides * sides + v, u * sides + (v + 1) % sides
    opposite = (u + 1) % sides * sides + (v + 1) % sides
    corner = u * sides + v
    faces = np.concatenate(
        [np.stack([corner, next_u, opposite], axis=1), np.stack([corner, opposite, next_v], axis=1)]
    )
    return points, faces.astype(np.intp)


def count_evaluations(evaluations, sides, layers):
    """Count evaluations for preparing a mesh and for cutting all layers."""
    points, faces = make_ring(sides)
    evaluations[0] = 0
    facets = Facets(CONE, points, faces)
    prepared, evaluations[0] = evaluations[0], 0
    loops = sum(len(facets.cut(distance, 0.05)) for distance in np.linspace(10.0, 70.0, layers))
    assert loops >= layers
    return prepared, evaluations[0]


def test_cutting_is_linear_in_triangles(evaluations):
    counts = np.array([count_evaluations(evaluations, sides, 10) for sides in SIDES], dtype=float)
    triangles = 2.0 * np.array(SIDES) ** 2
    assert (
        counts[:, 0] <= 1.0 * triangles
    ).all()  # once per vertex, and for edges closest to the base between their ends
    # a cut crosses triangles along a line: at most in proportion to their number
    assert (counts[1:, 1] / counts[:-1, 1] < triangles[1:] / triangles[:-1]).all()


def test_cutting_is_linear_in_layers(evaluations):
    counts = [count_evaluations(evaluations, 64, layers)[1] for layers in (10, 20, 40, 80)]
    np.testing.assert_allclose(np.array(counts[1:]) / np.array(counts[:-1]), 2.0, rtol=0.1)
