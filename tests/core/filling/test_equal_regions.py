# SPDX-License-Identifier: LGPL-2.1-or-later
"""Equal regions of a layer are filled once, wherever they are, with the beads that each would get alone."""

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Plane
from freecad_am.core.geometry.on_hub import Base
from freecad_am.core.geometry.regions.region import regions
from freecad_am.core.layers.plane_field import PlaneLayer
from freecad_am.core.layers.surface import Slice
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids import beads, filling
from freecad_am.core.strategies.solids.beads import BeadMaker, bead_of
from freecad_am.core.strategies.solids.filling import Pictures

SPACING = 2.0  # mm
BLOCK = SPACING * np.array([[0.0, 0.0], [7.3, 0.4], [6.1, 4.9], [0.8, 3.7]])
NARROW = SPACING * np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 0.2]])  # with a place without a bead
PLACES = np.array([[0.0, 0.0], [40.0, 3.0], [-31.7, 55.1], [1000.3, -777.7]])


TILTED = np.array(
    [[1.0, 0.0, 0.0, 3.0], [0.0, 0.6, -0.8, 1.0], [0.0, 0.8, 0.6, 2.0], [0.0, 0.0, 0.0, 1.0]]
)
BASE = Base("a plane", Plane(), TILTED)


def layer_of(loops, number=0):
    return Slice(number, BASE, PlaneLayer(0.7 * number), regions(loops))


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


@pytest.mark.parametrize("direction", ["counter-clockwise", "alternate"])
def test_beads_of_equal_layers_are_made_once_and_moved(monkeypatch, direction):
    """The lowest layer has a class of its own; with directions that alternate there are two kinds of the others."""
    calls = []
    monkeypatch.setattr(beads, "bead_of", lambda *given: calls.append(given) or bead_of(*given))
    strategy = SolidParameters(bead_spacing=SPACING, widths="adaptive")
    parameters = strategy, BuildDirectionParameters(), ProcessParameters(direction=direction), None
    pictures, maker = Pictures(strategy, parameters[2]), BeadMaker(*parameters)
    for number in range(6):
        layer = layer_of([BLOCK, BLOCK + PLACES[1]], number)
        curves = pictures.filled(layer, "islands").curves
        for curve in curves:
            made, alone = maker.bead_of(curve, layer).bead, bead_of(curve, layer, *parameters)
            assert np.abs(made.points - alone.bead.points).max() < 1e-12
            assert made.role == alone.bead.role and (made.speed == alone.bead.speed).all()
    assert len(calls) == (3 if direction == "alternate" else 2) * len(curves)
