# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strips around a hub: parallel curves measured in space across the cut, independent of the cut
position."""

import math

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.filling.centre import Beads
from freecad_am.core.filling.fill import fill
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.regions.strip import Period, Strip, strips

HUBS = {
    "cylinder": Developable(30.0),
    "cone": Developable(60.0, 200.0),
    "wide cone": Developable(90.0, 70.0),
}
BEADS = Beads(4.0, 1.5, 0.0)


def period(hub):
    return (
        Period(2.0 * math.pi * hub.radius) if hub.is_cylinder else Period(hub.flat_turn, hub.slant)
    )


def border(hub, height, middle, back=False):
    theta = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    z = height(theta) * math.cos(hub.taper)
    rho = hub.radius if hub.is_cylinder else (hub.height - z) * math.tan(hub.taper)
    points = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    return hub.unroll(points[::-1] if back else points, middle)


def collar(hub, middle=0.0):
    loops = [
        (border(hub, lambda t: 0.6 * np.sin(3.0 * t), middle), 1),
        (border(hub, lambda t: 25.0 + 0.3 * np.cos(2 * t), middle, True), -1),
    ]
    (strip,) = strips(loops, period(hub))
    return strip


def in_space(hub, strip, flat, turns, middle=0.0, step=0.03):
    """Dense points in space of an unrolled border or bead, across its end where it runs around the
    hub."""
    next_start = strip.period.move_turns(flat[:1], turns)
    line = np.vstack([flat, next_start])
    steps = np.diff(line, axis=0)
    count = np.maximum(np.ceil(np.hypot(*steps.T) / step).astype(int), 1)
    edge = np.repeat(np.arange(len(steps)), count)
    share = (np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)) / count[edge]
    return hub.wrap(line[edge] + share[:, None] * steps[edge], middle)


@pytest.mark.parametrize("name", HUBS)
def test_contours_run_on_over_the_cut(name):
    """Contours continue across the cut."""
    hub = HUBS[name]
    strip = collar(hub)
    assert isinstance(strip, Strip)
    curves = [curve for curve in fill(strip, BEADS) if curve.kind == "contour"]
    assert {curve.turns for curve in curves} == {1} and len(curves) == 6
    edges = [in_space(hub, strip, flat, turns) for flat, turns in strip.borders()]
    for curve in curves:
        points = in_space(hub, strip, curve.points, curve.turns)
        assert np.linalg.norm(np.diff(points, axis=0, append=points[:1]), axis=1).max() < 0.04, (
            "closed, no jump at the cut"
        )
        nearest = np.min([cKDTree(edge).query(points[::7])[0] for edge in edges], axis=0)
        # distances in space are shorter than on the hub by the chord of the turn
        expected = (curve.ring + 0.5) * BEADS.spacing
        assert (nearest < expected + 0.01 * BEADS.spacing).all()
        assert (
            nearest > expected * (1.0 - expected**2 / (24.0 * 25.0**2)) - 0.01 * BEADS.spacing
        ).all()


@pytest.mark.parametrize("name", HUBS)
@pytest.mark.parametrize("options", [{}, {"pattern": "lines"}], ids=["contours", "round"])
@pytest.mark.always("contours-cone", "round-cylinder", "contours-cylinder")
def test_cutting_elsewhere_gives_the_same_beads(name, options):
    """The position of the cut does not change the beads."""
    hub = HUBS[name]
    strip_a, strip_b = collar(hub), collar(hub, 1.3)
    curves_a, curves_b = fill(strip_a, BEADS, **options), fill(strip_b, BEADS, **options)
    assert [(c.kind, c.ring) for c in curves_a if c.turns] == [
        (c.kind, c.ring) for c in curves_b if c.turns
    ]
    clouds = [
        np.vstack([in_space(hub, strip, c.points, c.turns, middle) for c in curves if c.turns])
        for strip, curves, middle in ((strip_a, curves_a, 0.0), (strip_b, curves_b, 1.3))
    ]
    for a, b in (clouds, clouds[::-1]):
        assert cKDTree(b).query(a[::11])[0].max() < 0.01 * BEADS.spacing


def test_a_hole_goes_all_the_way_through():
    """Where holes split a strip, the rest no longer runs around the hub."""
    hub = HUBS["cylinder"]
    back = -2.0 * np.pi * np.arange(90) / 90
    flat = np.stack([8.0 * np.cos(back), 13.0 + 8.0 * np.sin(back)], axis=1)
    loops = [
        (border(hub, lambda t: 0.0 * t, 0.0), 1),
        (border(hub, lambda t: 26.0 + 0.0 * t, 0.0, True), -1),
        (flat, 0),
    ]
    (strip,) = strips(loops, period(hub))
    assert len(strip.holes) == 1
    (offset_strip,) = strip.grown(-2.0, 0.01)
    assert isinstance(offset_strip, Strip) and len(offset_strip.holes) == 1
    (offset_strip,) = strip.grown(-4.0, 0.01)
    assert not isinstance(offset_strip, Strip)
    turn = 2.0 * math.pi * hub.radius
    y = np.linspace(-9.0, 9.0, 20001)
    chords = 2.0 * np.sqrt(144.0 - y**2)
    assert offset_strip.area == pytest.approx(
        turn * 18.0 - np.sum(0.5 * (chords[1:] + chords[:-1])) * (y[1] - y[0]), rel=2e-4
    )


@pytest.mark.parametrize("apex", [math.inf, 100.0])
def test_borders_at_one_height_stay_round_a_cone(apex):
    """Borders at constant height are straight in (u, v), but arcs about the apex when unrolled."""
    cone = Period(200.0 if math.isinf(apex) else 2.0, apex)
    u = np.linspace(-0.5 * cone.u_period, 0.5 * cone.u_period, 201)[:-1]
    strip = Strip(
        cone,
        np.stack([u, np.zeros(200)], axis=1),
        np.stack([u[::-1], np.full(200, 20.0)], axis=1),
    )
    area = sum(
        flat_region.area for window in strip.windows(3.0) for flat_region in strip.flat(window)
    )
    expected_area = 4000.0 if math.isinf(apex) else 0.5 * 2.0 * (100.0**2 - 80.0**2)
    assert area == pytest.approx(expected_area, rel=1e-4)
    (inner,) = strip.grown(-3.0, 0.01)
    assert inner.lower[:, 1] == pytest.approx(3.0, abs=1e-3)
    assert inner.upper[:, 1] == pytest.approx(17.0, abs=1e-2)
