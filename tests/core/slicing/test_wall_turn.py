# SPDX-License-Identifier: LGPL-2.1-or-later
"""How sharply a circle and an ellipse turn in their plane, also with nodes that coincide except for
rounding."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.space_curve import SpaceCurve
from freecad_am.core.slicing.wall_directions import turns_in_wall

SKEW = 1e-3  # rad, of the tangents where two nodes nearly coincide


def ellipse(a, b, nodes, doubled=(), closed=True):
    """Nodes at equal angles, with one more a nanometre after each node in `doubled`, its tangent
    rotated by SKEW."""
    w = np.linspace(0.0, 2.0 * np.pi if closed else np.pi, nodes)
    w = np.sort(np.r_[w, w[list(doubled)] + 1e-6 / max(a, b)])
    points = np.stack([a * np.cos(w), b * np.sin(w), np.zeros(len(w))], axis=1)
    slope = np.stack([-a * np.sin(w), b * np.cos(w), np.zeros(len(w))], axis=1)
    for k in np.flatnonzero(np.diff(w) < 1e-5) + 1:
        slope[k] = slope[k] @ [[1.0, SKEW, 0.0], [-SKEW, 1.0, 0.0], [0.0, 0.0, 1.0]]
    if closed:
        points[-1], slope[-1] = points[0], slope[0]
    return SpaceCurve(w, points, slope, slope, closed)


def measure_rates(curve):
    return turns_in_wall(curve, np.tile([0.0, 0.0, 1.0], (len(curve.points), 1)))


@pytest.mark.parametrize("doubled", [(), (5,), (0,), (98,), (5, 6, 40)])
@pytest.mark.parametrize("closed", [True, False])
def test_a_circle_turns_by_its_curvature(doubled, closed):
    turn_rates = measure_rates(ellipse(50.0, 50.0, 100, doubled, closed))
    step = (2.0 if closed else 1.0) * np.pi * 50.0 / 99.0
    assert turn_rates == pytest.approx(1.0 / 50.0, abs=1.05 * SKEW / step + 1e-5)


def test_the_sharpest_point_of_an_ellipse_keeps_its_position():
    turn_rates = measure_rates(ellipse(40.0, 10.0, 2001, (500,)))
    assert turn_rates.max() == pytest.approx(40.0 / 10.0**2, rel=0.01)
    assert np.argmax(turn_rates) in (0, len(turn_rates) - 1, 1000, 1001, 999, 1002)
