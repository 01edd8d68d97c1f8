# SPDX-License-Identifier: LGPL-2.1-or-later
"""The area that strokes cover on a raster is the area of their deposit."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.regions.raster import ROUND_END, Raster, Stroke

WIDTH = 4.0


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("last", [0.5, ROUND_END, math.nextafter(ROUND_END, 1.0), 0.999, 3.0])
@pytest.mark.parametrize("turn", [0.0, 0.3, 2.0])
def test_the_round_end_of_a_stroke_is_there_wherever_its_last_vertex_is(last, turn):
    along = np.array([0.0, 10.0, 10.0 + last * WIDTH])
    points = np.column_stack([along * math.cos(turn), along * math.sin(turn)])
    stroke = Stroke(points, np.full(2, WIDTH))
    for line in (stroke, Stroke(points[::-1], stroke.widths)):
        raster = Raster.around(points, WIDTH, WIDTH / 64.0)
        shapes, deposits = raster.counts([line])
        covered = raster.pixel**2 * np.count_nonzero(shapes)
        assert covered == pytest.approx(stroke.area, rel=0.01)
        assert deposits.max() == 1
