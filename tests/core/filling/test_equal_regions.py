# SPDX-License-Identifier: LGPL-2.1-or-later
"""Equal regions of a layer are filled once and get the beads that each region would get separately."""

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
NARROW = SPACING * np.array(
    [[0.0, 0.0], [7.0, 0.0], [7.0, 0.2]]
)  # its tip is too narrow for a bead
OFFSETS = np.array([[0.0, 0.0], [40.0, 3.0], [-31.7, 55.1], [1000.3, -777.7]])


TILTED = np.array(
    [[1.0, 0.0, 0.0, 3.0], [0.0, 0.6, -0.8, 1.0], [0.0, 0.8, 0.6, 2.0], [0.0, 0.0, 0.0, 1.0]]
)
BASE = Base("a plane", Plane(), TILTED)


def make_layer(loops, number=0):
    return Slice(number, BASE, PlaneLayer(0.7 * number), regions(loops))


@pytest.fixture
def fill_calls(monkeypatch):
    """Return a list with one entry for each region that is filled again."""
    calls, fill = [], filling.fill
    monkeypatch.setattr(
        filling, "fill", lambda *arguments: calls.append(arguments) or fill(*arguments)
    )
    return calls


@pytest.mark.parametrize("fill", ["contours", "zigzag", "spiral"])
@pytest.mark.parametrize("shape", [BLOCK, NARROW], ids=["block", "narrow"])
def test_equal_islands_are_filled_once(fill_calls, fill, shape):
    strategy = SolidParameters(bead_spacing=SPACING, fill=fill, narrowest=0.3, widths="adaptive")
    process = ProcessParameters()
    together = Pictures(strategy, process).filled(
        make_layer([shape + offset for offset in OFFSETS]), "islands"
    )
    assert len(fill_calls) == 1
    single_layers = [
        Pictures(strategy, process).filled(make_layer([shape + offset]), "alone")
        for offset in OFFSETS
    ]
    single_layers.sort(key=lambda layer: layer.curves[0].points[:, 0].min())
    curves = [curve for layer in single_layers for curve in layer.curves]
    assert len(together.curves) == len(curves) and len(together.islands) == len(OFFSETS)
    for curve, single_curve in zip(together.curves, curves):
        assert (curve.kind, curve.ring, curve.closed) == (
            single_curve.kind,
            single_curve.ring,
            single_curve.closed,
        )
        assert np.abs(curve.points - single_curve.points).max() < 1e-6  # mm
    bare = np.array([bare_place.point for bare_place in together.bare])
    expected = np.array([bare_place.point for layer in single_layers for bare_place in layer.bare])
    assert bare.shape == expected.shape and np.abs(bare - expected).max(initial=0.0) < 1e-6


def test_rotated_and_mirrored_islands_are_filled_separately(fill_calls):
    strategy = SolidParameters(bead_spacing=SPACING)
    rotated, mirrored = 50.0 - BLOCK, (BLOCK * [-1.0, 1.0] - 50.0)[::-1]
    Pictures(strategy, ProcessParameters()).filled(
        make_layer([BLOCK, rotated, mirrored]), "islands"
    )
    assert len(fill_calls) == 3


def test_sparse_patterns_stay_fixed_in_the_layer(fill_calls):
    """The lines of neighbouring islands continue each other."""
    strategy = SolidParameters(bead_spacing=SPACING, fill="lines", fill_density=0.3)
    islands = make_layer([BLOCK + offset for offset in OFFSETS])
    Pictures(strategy, ProcessParameters()).filled(islands, "islands")
    assert len(fill_calls) == len(OFFSETS)


@pytest.mark.parametrize("direction", ["counter-clockwise", "alternate"])
def test_beads_of_equal_layers_are_computed_once_and_moved(monkeypatch, direction):
    """The lowest layer is computed separately; alternating directions give two variants of the
    other layers."""
    calls = []
    monkeypatch.setattr(
        beads, "bead_of", lambda *arguments: calls.append(arguments) or bead_of(*arguments)
    )
    strategy = SolidParameters(bead_spacing=SPACING, widths="adaptive")
    parameters = strategy, BuildDirectionParameters(), ProcessParameters(direction=direction), None
    pictures, maker = Pictures(strategy, parameters[2]), BeadMaker(*parameters)
    for number in range(6):
        layer = make_layer([BLOCK, BLOCK + OFFSETS[1]], number)
        curves = pictures.filled(layer, "islands").curves
        for curve in curves:
            bead, reference = maker.bead_of(curve, layer).bead, bead_of(curve, layer, *parameters)
            assert np.abs(bead.points - reference.bead.points).max() < 1e-12
            assert bead.role == reference.bead.role and (bead.speed == reference.bead.speed).all()
    assert len(calls) == (3 if direction == "alternate" else 2) * len(curves)
