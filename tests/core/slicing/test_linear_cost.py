# SPDX-License-Identifier: LGPL-2.1-or-later
"""Twice the points are twice the work: what is evaluated is counted, not timed."""

import numpy as np
import pytest

from freecad_am.core.geometry.implicit import Round
from freecad_am.core.geometry.space_curve import SpaceCurve
from freecad_am.core.geometry.surface import Torus
from freecad_am.core.process import spacing
from freecad_am.core.slicing import constant_distance, iso_parameter, smooth_spacing
from freecad_am.core.slicing.first_layer import on_implicit
from freecad_am.core.slicing.wall_layer import even_grid

TORUS = Torus(60.0, 15.0)
COUNTS = (180, 360, 720, 1440)


@pytest.fixture
def evaluated(monkeypatch):
    """How many points of surfaces and curves have been evaluated."""
    total = [0]
    surface, curve = Torus.derivatives, SpaceCurve.on_arcs

    def derivatives(self, u, v):
        total[0] += np.broadcast(u, v).size
        return surface(self, u, v)

    def on_arcs(self, arc, t):
        total[0] += np.size(t)
        return curve(self, arc, t)

    monkeypatch.setattr(Torus, "derivatives", derivatives)
    monkeypatch.setattr(SpaceCurve, "on_arcs", on_arcs)
    return total


def cut(rule, first, points):
    if rule == "iso-parameter":
        return [layer.v for layer in iso_parameter.layers(TORUS, first, 5.0, 0.9)]
    if rule == "smooth":
        return [smoothed.layer.v for smoothed in smooth_spacing.layers(TORUS, first, 5.0, 0.9, points=points)]
    return [layer.v for layer in constant_distance.layers(TORUS, first, 5.0, 0.9, points)]


@pytest.mark.parametrize("rule", ["iso-parameter", "constant-distance", "smooth"])
def test_evaluations_grow_with_the_points_and_no_faster(evaluated, rule):
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    work = []
    for points in COUNTS:
        first = on_implicit(TORUS, pipe, (0.0, 1.5), even_grid(TORUS, points))
        evaluated[0] = 0
        made = cut(rule, first, points)
        assert sum(map(len, made)) >= points * len(made)
        work.append(evaluated[0])
    assert work[0] > COUNTS[0] * len(made)  # it is counted
    for before, after in zip(work, work[1:]):
        assert after < 2.2 * before


def test_of_segments_below_only_the_near_ones_are_tried(monkeypatch):
    tried = [0]
    share = spacing._share

    def counted(offset, along):
        tried[0] += len(offset)
        return share(offset, along)

    monkeypatch.setattr(spacing, "_share", counted)
    monkeypatch.setattr(spacing, "_CHUNK", 10_000)
    work = []
    for points in (1000, 2000, 4000):
        angle = np.linspace(0.0, 2.0 * np.pi, points + 1)
        ring = np.c_[50.0 * np.cos(angle), 50.0 * np.sin(angle), 0.0 * angle]
        ring[-1] = ring[0]
        below = spacing.Curve(*spacing._columns(ring, True))
        tried[0] = 0
        found = spacing.distance(ring + [0.0, 0.0, 0.02], below)
        assert found == pytest.approx(0.02, abs=1e-6)
        work.append(tried[0])
    assert all(after < 2.2 * before for before, after in zip(work, work[1:]))
