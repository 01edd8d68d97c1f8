# SPDX-License-Identifier: LGPL-2.1-or-later
"""If the band is too narrow for the turn limit of smooth layers, the issue says so."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall
from freecad_am.core.issues import NOTE, WARNING
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid
from freecad_am.core.strategies.walls import plan as surface


@pytest.mark.parametrize(
    "band, level, words",
    [
        (0.05, WARNING, ("band of 5 %", "is too narrow", "more than 6 deg/mm")),
        (0.2, NOTE, ("no layer has a corner",)),
    ],
)
def test_a_band_too_narrow_is_told(band, level, words):
    torus = Torus(60.0, 15.0)
    base_layer = intersect_implicit(
        torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, 360)
    )
    wall = SurfaceWall("torus", (60.0, 15.0), np.eye(4), 1.2, base_layer.curve.points[:-1])
    strategy = SurfaceParameters(layer_height=5.0, spacing="smooth", band=band)
    toolpath = surface.plan(
        wall, strategy, BuildDirectionParameters(clearance="none"), ProcessParameters()
    )
    (turn_issue,) = [issue for issue in toolpath.issues if issue.code == "TURN"]
    assert turn_issue.level == level
    assert all(word in turn_issue.message for word in words)
