# SPDX-License-Identifier: LGPL-2.1-or-later
"""Heights of curved layers, against circles about an axis."""

import numpy as np
import pytest

from freecad_am.core.preflight import checks
from freecad_am.core.process.deposit import on_part
from freecad_am.core.toolpath import Bead, Layer, Toolpath

RADIUS, HEIGHT, SPACING = 60.0, 2.0, 5.0


def rulings(radius, azimuths):
    """Straight beads along a cylinder at azimuths in rad."""
    beads = []
    for azimuth in azimuths:
        out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        points, build = radius * out + np.outer([0.0, 80.0], [0.0, 0.0, 1.0]), np.tile(out, (2, 1))
        beads.append(Bead(points, build, build, np.arange(2.0), np.full(2, 5.0), False))
    return Layer(tuple(beads))


@pytest.mark.parametrize("aside", [0.0, 0.5], ids=["above each other", "between each other"])
def test_the_height_of_layers_about_a_cylinder_is_that_of_their_radii(aside):
    """The height of layers around a cylinder is the difference of their radii."""
    step = SPACING / RADIUS
    azimuths = 0.1 + step * np.arange(16)
    layers = (rulings(RADIUS, azimuths), rulings(RADIUS + HEIGHT, azimuths[:-1] + aside * step))
    toolpath = Toolpath(layers, np.eye(4), HEIGHT, 0.1, family="cladding")
    heights = np.concatenate(on_part.over_layers(toolpath))
    assert np.abs(heights - ((RADIUS + HEIGHT) * np.cos(aside * step) - RADIUS)).max() < 1e-9
    promise = checks.layers(toolpath, ())
    assert promise.ok and abs(promise.worst - HEIGHT) < 0.06
