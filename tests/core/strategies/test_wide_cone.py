# SPDX-License-Identifier: LGPL-2.1-or-later
"""A ring around a very wide cone that a hole almost cuts through: beads that cover more than half a
turn of the plane."""

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

CONE = Developable(60.0, 20.0)  # unrolled, a turn is 342 deg
RING_LOW, RING_HIGH = 24.0, 62.0  # mm from the apex: the ring
HOLE_LOW, HOLE_HIGH, HALF = 27.0, 59.0, math.radians(14.0)  # the hole, with 3 mm on either side
SPACING = 8.0


def flat(theta, distance):
    """Unroll points given by azimuths and distances from the apex."""
    rho = distance * math.sin(CONE.taper)
    z = CONE.height - distance * math.cos(CONE.taper)
    return CONE.unroll(
        np.stack([rho * np.cos(theta), rho * np.sin(theta), np.broadcast_to(z, rho.shape)], axis=1)
    )


def ring(azimuth):
    """The ring with its hole at an azimuth."""
    theta, across = (
        np.linspace(-math.pi, math.pi, 720, endpoint=False),
        np.linspace(-HALF, HALF, 40),
    )
    along = np.linspace(HOLE_LOW, HOLE_HIGH, 20)
    turn = np.r_[across, np.full(20, HALF), across[::-1], np.full(20, -HALF)] + azimuth
    distances = np.r_[np.full(40, HOLE_LOW), along, np.full(40, HOLE_HIGH), along[::-1]]
    (strip,) = strips([
        (flat(theta, np.full(720, RING_HIGH)), 1), (flat(theta[::-1], np.full(720, RING_LOW)), -1), (flat(turn, distances), 0),
    ], RoundLayer(CONE).period)  # fmt: skip
    assert isinstance(strip, Strip) and len(strip.holes) == 1
    return strip


@pytest.mark.parametrize("at", [0.0, 0.7, 3.1])
def test_what_is_left_of_a_ring_knows_how_far_round_it_is(at):
    """The remainder of a ring keeps its position around the cone."""
    (offset_ring,) = ring(at).grown(-0.5 * SPACING, 0.1)
    assert isinstance(offset_ring, Region)
    turn = RoundLayer(CONE).period.u_period
    u = math.remainder(
        offset_ring.sheet - (at + math.pi) / (2.0 * math.pi) * turn, turn
    )  # opposite to the hole
    assert abs(u) < 1e-3 * turn
    assert (
        offset_ring.grown(-1.0, 0.1)[0].sheet == offset_ring.simple(0.1).sheet == offset_ring.sheet
    )


@pytest.mark.parametrize(
    ("fill", "contour"), [("contours", False), ("lines", False), ("lines", True)]
)
@pytest.mark.parametrize("at", [0.0, 0.7])
@pytest.mark.always
def test_beads_on_both_sides_of_a_hole_stay_out_of_it(fill, contour, at):
    """No bead runs through the hole, and beads come equally near on both sides."""
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
    distances = np.hypot(points[:, 0], points[:, 1]) / math.sin(CONE.taper)
    azimuths = (
        np.remainder(np.arctan2(points[:, 1], points[:, 0]) - at + math.pi, 2.0 * math.pi) - math.pi
    )
    angle_to_hole = np.abs(azimuths) - HALF
    assert not (
        (angle_to_hole < -0.01) & (distances > HOLE_LOW + 0.2) & (distances < HOLE_HIGH - 0.2)
    ).any()
    # half a spacing from the hole at its farthest distance from the apex, on the unrolled cone
    nearest = math.asin(0.5 * SPACING / HOLE_HIGH) / math.sin(CONE.taper)
    for side in (azimuths > 0.0, azimuths < 0.0):
        assert angle_to_hole[side].min() == pytest.approx(nearest, abs=0.01)
    assert np.sort(np.diff(np.sort(azimuths)))[-2] < math.radians(3.0)  # no gap elsewhere
