# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads at speeds that hold their width: side bending of beads that fill no region, and the
resulting speeds."""

import dataclasses
import math

import numpy as np
import pytest

from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.process import model_notes
from freecad_am.core.process.wire import load, process_model
from freecad_am.core.toolpath import Bead, Layer, Toolpath

M, P, T = 85.550, 52.742, -1.7542  # Dai 2020, table 1 refitted (errata)


def ring(radius, lean, count=720, height=0.0):
    """A closed bead around a cone whose wall leans out by `lean`, growing along it: points and
    build directions."""
    angle = np.linspace(0.0, 2.0 * math.pi, count + 1)
    out = np.stack([np.cos(angle), np.sin(angle), np.zeros(count + 1)], axis=1)
    points = radius * out + [0.0, 0.0, height]
    points[-1] = points[0]
    return points, math.sin(lean) * out + [0.0, 0.0, math.cos(lean)]


def make_bead(points, build, closed, speed=6.0):
    arc_length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    return Bead(points, build, build, arc_length, np.full(len(points), speed), closed)


@pytest.mark.parametrize("lean", [0.0, 0.6, 1.2])
def test_a_ring_on_a_cone_bends_to_its_side_as_the_cone_laid_flat_does(lean):
    """Unrolled, the ring is an arc whose radius is the distance to the apex of the cone of the
    wall's normals, radius / cos(lean)."""
    points, build = ring(40.0, lean)
    # within a window of 8 mm the heading advances in steps of 0.35 mm: (0.35 / 8)^2 / 12
    np.testing.assert_allclose(
        model_notes.side_radii(points, build, True, 8.0), 40.0 / math.cos(lean), rtol=2e-4
    )


def test_a_ring_on_a_plane_disc_laid_edgewise_does_not_bend_to_its_side():
    points, build = ring(40.0, math.pi / 2.0)
    assert model_notes.side_radii(points, build, True, 8.0).min() > 1e6


def test_in_the_plane_it_is_the_radius_of_the_bead_laid_flat():
    rng = np.random.default_rng(3)
    angle = np.sort(rng.uniform(0.0, 2.0 * math.pi, 200))
    size = 50.0 + 4.0 * np.sin(3.0 * angle)
    flat = np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)
    for closed in (True, False):
        line = np.vstack([flat, flat[:1]]) if closed else flat
        points = np.c_[line, np.full(len(line), 7.0)]
        side_radii = model_notes.side_radii(
            points, np.tile([0.0, 0.0, 1.0], (len(line), 1)), closed, 9.0
        )
        np.testing.assert_allclose(side_radii, model_notes.radii(line, closed, 9.0), rtol=1e-9)


def toolpath(beads):
    return Toolpath(tuple(Layer((bead,)) for bead in beads), np.eye(4), 2.5, 0.05, bead_width=9.5)


def test_rings_are_as_wide_as_asked_for_at_the_speed_of_the_model():
    """Rings have the requested width at the speed of the model."""
    process = ProcessParameters(bead_model="csw", bead_width=9.5)
    path = toolpath([make_bead(*ring(radius, 0.3), True) for radius in (31.0, 45.0, 80.0)])
    with_speeds = model_notes.hold_widths(path, process, process_model(process))
    for (_, _, bead), radius in zip(with_speeds, (31.0, 45.0, 80.0), strict=True):
        speed = (M / (9.5 - P * math.cos(0.3) / radius - T)) ** 3 / 60.0
        np.testing.assert_allclose(bead.speed, speed, rtol=5e-4)
        np.testing.assert_allclose(bead.width, 9.5, atol=2e-3)
    codes = [issue.code for issue in with_speeds.issues]
    assert codes == ["BEAD_MODEL", "BEAD_HEIGHT"] and with_speeds.law is not None


def test_where_a_bead_bends_its_speed_changes_no_faster_than_asked_for():
    straight, bent = (
        np.linspace([-80.0, -32.0], [0.0, -32.0], 161),
        np.linspace(-math.pi / 2.0, math.pi / 2.0, 200)[1:],
    )
    flat = np.vstack([straight, 32.0 * np.stack([np.cos(bent), np.sin(bent)], axis=1)])
    points = np.c_[flat, np.zeros(len(flat))]
    process = ProcessParameters(bead_model="csw", bead_width=9.5, acceleration=5.0)
    path = toolpath([make_bead(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), False)])
    ((_, _, bead),) = model_notes.hold_widths(path, process, process_model(process))
    assert bead.speed.max() > 1.4 * bead.speed.min()
    time = np.linalg.norm(np.diff(points, axis=0), axis=1) / bead.speed[1:]
    change = np.abs(np.diff(bead.speed[1:])) / (0.5 * (time[1:] + time[:-1]))
    assert change.max() < 5.0 * 1.01


def test_wire_in_proportion_keeps_the_section_of_every_ring():
    wire = WireParameters(feed_mode="proportional")
    process = ProcessParameters(bead_model="csw", bead_width=9.5, wire=wire)
    path = toolpath([make_bead(*ring(radius, 0.0), True) for radius in (31.0, 80.0)])
    beads = [bead for _, _, bead in model_notes.hold_widths(path, process, process_model(process))]
    sections = np.concatenate([bead.width * bead.height for bead in beads])
    np.testing.assert_allclose(sections, sections[0], rtol=1e-9)
    straight = (M / (9.5 - T)) ** 3 / 60.0
    assert all(
        bead.wire_share == pytest.approx(6500.0 / 60.0 / straight, rel=2e-4) for bead in beads
    )


def li_2025():
    """Wire feed m/min, travel speed mm/min, width and height mm: Li 2025, table 5, at 2 kW, 10 %
    and 1."""
    rows = [
        (7, 600, 8.49, 2.69),
        (8, 700, 7.14, 2.54),
        (7, 600, 7.85, 2.60),
        (7, 600, 8.36, 2.52),
        (6, 700, 7.25, 2.54),
        (6, 500, 7.79, 2.56),
        (8, 500, 10.17, 3.02),
        (7, 600, 8.49, 2.59),
    ]
    return np.array(rows, float).T


def test_straight_beads_at_several_wire_feeds_count_by_their_wire():
    """Least squares by the normal equations in the cube root of the wire volume per mm of bead."""
    feed, speed, width, height = li_2025()
    model = load("li-2025")
    share = np.cbrt(feed / feed.mean() / speed)
    for measured, ours in ((width, model.width), (height, model.height)):
        slope = ((share - share.mean()) * (measured - measured.mean())).sum() / (
            (share - share.mean()) ** 2
        ).sum()
        assert ours.m == pytest.approx(slope, rel=1e-9) and ours.p == 0.0
        assert ours.t == pytest.approx(measured.mean() - slope * share.mean(), rel=1e-9)
        residual = measured - (slope * share + ours.t)
        assert ours.rmse == pytest.approx(math.sqrt((residual**2).sum() / 6.0), rel=1e-9)
    for f, v in ((6, 650.0), (7.5, 600.0), (8, 700.0)):
        model_at_feed = model.at_feed(f * 1000.0 / 60.0)
        expected = model.width.m * np.cbrt(f / feed.mean() / v) + model.width.t
        assert float(
            model_at_feed.widths(np.array([v / 60.0]), np.array([np.inf]))[0]
        ) == pytest.approx(expected, rel=1e-12)
        assert model_at_feed.wire_feed == pytest.approx(f * 1000.0 / 60.0)
    # no more wire per mm than measured, and no speed outside the table
    low, high = (60.0 * end for end in model.at_feed(8000.0 / 60.0).speeds)
    assert (low, high) == pytest.approx((500.0, 700.0))
    assert 60.0 * model.at_feed(6000.0 / 60.0).speeds[0] == pytest.approx(500.0)
    assert model.at_feed(9000.0 / 60.0) is model and load("csw").at_feed(1.0) == load("csw")


def test_the_process_says_at_which_feed_the_model_is_asked():
    process = ProcessParameters(bead_model="li-2025", wire=WireParameters(feed=8000.0 / 60.0))
    assert process_model(process).wire_feed == pytest.approx(8000.0 / 60.0)
    auto = dataclasses.replace(process, wire=WireParameters())
    assert process_model(auto).wire_feed == pytest.approx(7000.0 / 60.0)
    assert process_model(ProcessParameters()) is None
