# SPDX-License-Identifier: LGPL-2.1-or-later
"""Twice the triangles are at most twice the work of cutting, twice the layers twice: what is evaluated is counted, not
timed."""

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.slicing.solids.equidistant import Facets

SIDES = (32, 64, 128, 256)
CONE = Developable(60.0, 200.0)


@pytest.fixture
def evaluated(monkeypatch):
    """At how many points distances and normals of the base have been asked for."""
    total = [0]
    for name in ("distance", "normals", "distance_rate"):
        whole = getattr(Developable, name)

        def counted(self, points, *rest, whole=whole):
            total[0] += points.size // 3
            return whole(self, points, *rest)

        monkeypatch.setattr(Developable, name, counted)
    return total


def ring(sides, seed=0):
    """A closed ring beside the axis, 2 * sides^2 triangles, its vertices a little off so that none lies on a cut."""
    u, v = (part.ravel() for part in np.meshgrid(*[np.arange(sides)] * 2, indexing="ij"))
    a, b = u * 2.0 * np.pi / sides, v * 2.0 * np.pi / sides
    rho = 30.0 + 12.0 * np.cos(b)
    points = np.stack([110.0 + rho * np.cos(a), 12.0 * np.sin(b), 60.0 + rho * np.sin(a)], axis=1)
    points += np.random.default_rng(seed).normal(scale=1e-3, size=points.shape)
    right, up = (u + 1) % sides * sides + v, u * sides + (v + 1) % sides
    across = (u + 1) % sides * sides + (v + 1) % sides
    here = u * sides + v
    faces = np.concatenate(
        [np.stack([here, right, across], axis=1), np.stack([here, across, up], axis=1)]
    )
    return points, faces.astype(np.intp)


def cost(evaluated, sides, layers):
    """What preparing a mesh and what each number of cuts of it evaluate."""
    points, faces = ring(sides)
    evaluated[0] = 0
    facets = Facets(CONE, points, faces)
    prepared, evaluated[0] = evaluated[0], 0
    loops = sum(len(facets.cut(distance, 0.05)) for distance in np.linspace(10.0, 70.0, layers))
    assert loops >= layers
    return prepared, evaluated[0]


def test_cutting_is_linear_in_triangles(evaluated):
    found = np.array([cost(evaluated, sides, 10) for sides in SIDES], dtype=float)
    triangles = 2.0 * np.array(SIDES) ** 2
    assert (
        found[:, 0] <= 1.0 * triangles
    ).all()  # once a vertex, and edges that come nearest between their ends
    # cut are the triangles along a line: no more than in proportion to their number
    assert (found[1:, 1] / found[:-1, 1] < triangles[1:] / triangles[:-1]).all()


def test_cutting_is_linear_in_layers(evaluated):
    found = [cost(evaluated, 64, layers)[1] for layers in (10, 20, 40, 80)]
    np.testing.assert_allclose(np.array(found[1:]) / np.array(found[:-1]), 2.0, rtol=0.1)
