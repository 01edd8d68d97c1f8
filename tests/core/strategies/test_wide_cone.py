# SPDX-License-Identifier: LGPL-2.1-or-later
"""A ring about a very wide cone that a hole all but cuts through: beads more than half a turn of the plane round."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.on_hub import Base
from freecad_am.core.geometry.regions.region import Region
from freecad_am.core.geometry.regions.strip import Strip, strips
from freecad_am.core.layers.rotary_field import RoundLayer
from freecad_am.core.layers.surface import Slice
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids.beads import bead_of
from freecad_am.core.strategies.solids.filling import Pictures

CONE = Developable(60.0, 20.0)  # laid flat a turn is 342 deg
LOW, HIGH = 24.0, 62.0  # mm from the apex: the ring
NEAR, FAR, HALF = 27.0, 59.0, math.radians(14.0)  # and the hole, with 3 mm on either side of it
SPACING = 8.0


def flat(theta, way):
    """Places at azimuths and distances from the apex laid flat."""
    rho = way * math.sin(CONE.taper)
    z = CONE.height - way * math.cos(CONE.taper)
    return CONE.unroll(
        np.stack([rho * np.cos(theta), rho * np.sin(theta), np.broadcast_to(z, rho.shape)], axis=1)
    )


def ring(at):
    """The ring with its hole at the azimuth `at`."""
    theta, across = (
        np.linspace(-math.pi, math.pi, 720, endpoint=False),
        np.linspace(-HALF, HALF, 40),
    )
    along = np.linspace(NEAR, FAR, 20)
    turn = np.r_[across, np.full(20, HALF), across[::-1], np.full(20, -HALF)] + at
    way = np.r_[np.full(40, NEAR), along, np.full(40, FAR), along[::-1]]
    (found,) = strips([
        (flat(theta, np.full(720, HIGH)), 1), (flat(theta[::-1], np.full(720, LOW)), -1), (flat(turn, way), 0),
    ], RoundLayer(CONE).period)  # fmt: skip
    assert isinstance(found, Strip) and len(found.holes) == 1
    return found


@pytest.mark.parametrize("at", [0.0, 0.7, 3.1])
def test_what_is_left_of_a_ring_knows_how_far_round_it_is(at):
    (part,) = ring(at).grown(-0.5 * SPACING, 0.1)
    assert isinstance(part, Region)
    turn = RoundLayer(CONE).period.u_period
    u = math.remainder(
        part.sheet - (at + math.pi) / (2.0 * math.pi) * turn, turn
    )  # opposite to the hole
    assert abs(u) < 1e-3 * turn
    assert part.grown(-1.0, 0.1)[0].sheet == part.simple(0.1).sheet == part.sheet


@pytest.mark.parametrize(
    ("fill", "contour"), [("contours", False), ("lines", False), ("lines", True)]
)
@pytest.mark.parametrize("at", [0.0, 0.7])
@pytest.mark.always
def test_beads_on_both_sides_of_a_hole_stay_out_of_it(fill, contour, at):
    """No bead runs through the hole, and they come as near to it on one side as on the other."""
    strategy = DevelopableParameters(
        bead_spacing=SPACING, fill=fill, contour=contour, chord_error=0.2
    )
    base, process = Base("the hub", CONE, np.eye(4)), ProcessParameters()
    layer = Slice(0, base, RoundLayer(CONE), (ring(at),))
    curves = Pictures(strategy, process).filled(layer, "ring").curves
    points = np.vstack(
        [
            bead_of(curve, layer, strategy, BuildDirectionParameters(), process, None).bead.points
            for curve in curves
        ]
    )
    way = np.hypot(points[:, 0], points[:, 1]) / math.sin(CONE.taper)
    past = (
        np.remainder(np.arctan2(points[:, 1], points[:, 0]) - at + math.pi, 2.0 * math.pi) - math.pi
    )
    beside = np.abs(past) - HALF
    assert not ((beside < -0.01) & (way > NEAR + 0.2) & (way < FAR - 0.2)).any()
    # half a spacing from the hole where that is farthest out, on the cone laid flat
    nearest = math.asin(0.5 * SPACING / FAR) / math.sin(CONE.taper)
    for side in (past > 0.0, past < 0.0):
        assert beside[side].min() == pytest.approx(nearest, abs=0.01)
    assert np.sort(np.diff(np.sort(past)))[-2] < math.radians(3.0)  # nowhere else is there nothing
