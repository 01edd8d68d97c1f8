# SPDX-License-Identifier: LGPL-2.1-or-later
"""Equal regions of a layer are filled once, wherever they are, with the beads that each would get alone."""

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Plane
from freecad_am.core.geometry.on_hub import Base
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.layers.plane_field import PlaneLayer
from freecad_am.core.layers.surface import Slice
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids import filling
from freecad_am.core.strategies.solids.filling import Pictures

SPACING = 2.0  # mm
BLOCK = SPACING * np.array([[0.0, 0.0], [7.3, 0.4], [6.1, 4.9], [0.8, 3.7]])
NARROW = SPACING * np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 0.2]])  # with a place without a bead
PLACES = np.array([[0.0, 0.0], [40.0, 3.0], [-31.7, 55.1], [1000.3, -777.7]])


def layer_of(loops, number=0):
    return Slice(number, Base("a plane", Plane(), np.eye(4)), PlaneLayer(0.0), regions(loops))


@pytest.fixture
def fills(monkeypatch):
    """One entry for each region that is filled anew."""
    calls, fill = [], filling.fill
    monkeypatch.setattr(filling, "fill", lambda *given: calls.append(given) or fill(*given))
    return calls


@pytest.mark.parametrize("fill", ["contours", "zigzag", "spiral"])
@pytest.mark.parametrize("shape", [BLOCK, NARROW], ids=["block", "narrow"])
def test_islands_of_one_shape_are_filled_once(fills, fill, shape):
    strategy = SolidParameters(bead_spacing=SPACING, fill=fill, narrowest=0.3, widths="adaptive")
    process = ProcessParameters()
    together = Pictures(strategy, process).filled(
        layer_of([shape + at for at in PLACES]), "islands"
    )
    assert len(fills) == 1
    alone = [Pictures(strategy, process).filled(layer_of([shape + at]), "alone") for at in PLACES]
    alone.sort(key=lambda picture: picture.curves[0].points[:, 0].min())
    curves = [curve for picture in alone for curve in picture.curves]
    assert len(together.curves) == len(curves) and len(together.islands) == len(PLACES)
    for curve, other in zip(together.curves, curves):
        assert (curve.kind, curve.ring, curve.closed) == (other.kind, other.ring, other.closed)
        assert np.abs(curve.points - other.points).max() < 1e-6  # mm
    bare = np.array([place.point for place in together.bare])
    expected = np.array([place.point for picture in alone for place in picture.bare])
    assert bare.shape == expected.shape and np.abs(bare - expected).max(initial=0.0) < 1e-6


def test_islands_that_are_turned_or_mirrored_are_filled_each(fills):
    strategy = SolidParameters(bead_spacing=SPACING)
    turned, mirrored = 50.0 - BLOCK, (BLOCK * [-1.0, 1.0] - 50.0)[::-1]
    Pictures(strategy, ProcessParameters()).filled(layer_of([BLOCK, turned, mirrored]), "islands")
    assert len(fills) == 3


def test_sparse_patterns_have_fixed_places(fills):
    """The lines of neighbouring islands continue each other."""
    strategy = SolidParameters(bead_spacing=SPACING, fill="lines", fill_density=0.3)
    islands = layer_of([BLOCK + at for at in PLACES])
    Pictures(strategy, ProcessParameters()).filled(islands, "islands")
    assert len(fills) == len(PLACES)
