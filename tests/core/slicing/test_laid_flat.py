# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that only touch the cutting surface give the same loops whatever the rounding."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.curves.plane_curve import doubled_area
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.slicing.solids.equidistant import Facets, cut
from tests.core.slicing.test_equidistant import hull

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (-10.0, 10.0) for z in (-20.0, 20.0)])


@pytest.mark.parametrize("angle", [0.0, 0.8, math.pi / 2])
@pytest.mark.parametrize("offset", [-3e-5, -1e-9, 0.0, 1e-9, 3e-5])
@pytest.mark.parametrize(
    "surface", [Developable(60.0), Developable(60.0, 200.0)], ids=["cylinder", "cone"]
)
def test_a_flat_top_that_touches_a_layer_does_not_divide_it(surface, offset, angle):
    """The top of a box is in the tangent plane of the layer at 16 mm, rotated about the normal: one
    loop with the area of its cut, and none for a box that stands on that plane."""
    cos, sin = math.cos(surface.taper), math.sin(surface.taper)
    foot = np.array([0.0 if math.isinf(surface.height) else 60.0 * (1.0 - 30.0 / 200.0), 0.0, 30.0])
    foot[0] = foot[0] or 60.0
    out, upward = np.array([cos, 0.0, sin]), np.array([-sin, 0.0, cos])
    sideways = np.array([0.0, 1.0, 0.0])
    along, across = (
        math.cos(angle) * upward + math.sin(angle) * sideways,
        math.cos(angle) * sideways - math.sin(angle) * upward,
    )
    assert abs(float(surface.distance(foot[None])[0])) < 1e-12

    def cut_box(bottom, top):
        depth = bottom + (top - bottom) * CORNERS[:, :1]
        vertices, faces, _ = hull(
            foot + depth * out + CORNERS[:, 1:2] * across + CORNERS[:, 2:] * along
        )
        return cut(Facets(surface, vertices, faces), 16.0, 0.0125)

    (loop,) = cut_box(-8.0, 16.0 + offset)
    assert loop.turns == 0
    assert np.abs(surface.distance(loop.points) - 16.0).max() < 1e-9
    area = 0.5 * doubled_area(surface.offset(16.0).unroll(loop.points))
    assert 800.0 < area < 830.0  # of 20 x 40 mm seen along the normal
    assert cut_box(16.0 + offset, 30.0) == []
