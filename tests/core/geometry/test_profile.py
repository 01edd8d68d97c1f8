# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meridians against curves known in closed form."""

import numpy as np
import pytest
from scipy.integrate import quad

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line, sample_curve


@pytest.mark.parametrize("radius", [0.5, 45.0, 900.0])
def test_an_arc_is_met_everywhere(radius):
    meridian = Meridian.chained([arc((2.0 * radius, 1.0), radius, np.pi, 0.25 * np.pi)])
    assert meridian.length == pytest.approx(0.75 * np.pi * radius, rel=1e-12)
    s = np.random.default_rng(1).uniform(0.0, meridian.length, 20000)
    r, h, t = meridian.at(s)
    angle = np.pi - s / radius
    assert np.abs(r - (2.0 + np.cos(angle)) * radius).max() < 1e-7
    assert np.abs(h - (1.0 + radius * np.sin(angle))).max() < 1e-7
    assert np.abs(t - np.stack([np.sin(angle), -np.cos(angle)], axis=1)).max() < 1e-9
    assert np.abs(np.linalg.norm(t, axis=1) - 1.0).max() < 1e-14


def test_a_curve_of_changing_curvature_is_met_everywhere():
    def wave(t):
        slope = np.stack([0.75 * np.cos(t / 4.0), np.ones_like(t)], axis=1)
        return np.stack([30.0 + 3.0 * np.sin(t / 4.0), t], axis=1), slope

    meridian = Meridian.chained([sample_curve(wave, [0.0, 50.0])])
    truth, _ = quad(
        lambda z: np.hypot(1.0, 0.75 * np.cos(z / 4.0)),
        0.0,
        50.0,
        epsabs=1e-11,
        epsrel=1e-13,
        limit=200,
    )
    assert meridian.length == pytest.approx(truth, abs=1e-7)
    r, h, t = meridian.at(np.linspace(0.0, meridian.length, 30011))
    assert np.abs(r - (30.0 + 3.0 * np.sin(h / 4.0))).max() < 1e-7
    slope = np.arctan2(1.0, 0.75 * np.cos(h / 4.0))
    assert np.abs(np.angle(np.exp(1j * (np.arctan2(t[:, 1], t[:, 0]) - slope)))).max() < 1e-8


def test_kinks_are_kept_and_belong_to_the_piece_below():
    meridian = Meridian.chained([line((10.0, 0.0), (10.0, 5.0)), line((10.0, 5.0), (7.0, 9.0))])
    assert meridian.kinks.tolist() == [5.0]
    assert meridian.length == pytest.approx(10.0, abs=1e-12)
    _, _, t = meridian.at([5.0 - 1e-6, 5.0, 5.0 + 1e-6])
    assert t == pytest.approx(np.array([[0.0, 1.0], [0.0, 1.0], [-0.6, 0.8]]), abs=1e-12)


def test_gaps_are_bridged_by_a_step_and_roundings_jumped():
    below, above = line((10.0, 0.0), (10.0, 5.0)), line((9.94, 5.0), (9.94, 8.0))
    stepped = Meridian.chained([below, above])
    assert stepped.length == pytest.approx(8.06, abs=1e-12)
    assert stepped.kinks == pytest.approx([5.0, 5.06])
    r, h, t = stepped.at([5.03])
    assert (r[0], h[0]) == pytest.approx((9.97, 5.0))
    assert t[0] == pytest.approx([-1.0, 0.0])
    rounded = Meridian.chained([below, line((10.0 + 5e-6, 5.0), (10.0 + 5e-6, 8.0))])
    assert rounded.length == pytest.approx(8.0, abs=1e-12)
    assert len(rounded.kinks) == 0
    assert rounded.at([4.0, 6.0])[0] == pytest.approx([10.0, 10.000005], abs=1e-12)


def test_heights_are_found_wherever_the_curve_crosses_them():
    crest = Meridian.chained([arc((50.0, 0.0), 10.0, 0.0, np.pi)])
    arc_lengths = crest.s_at_height([0.0, 6.0, 10.0, 10.1])
    angle = np.arcsin(0.6)
    assert arc_lengths[0] == pytest.approx([0.0, 10.0 * np.pi], abs=1e-9)
    assert arc_lengths[1] == pytest.approx([10.0 * angle, 10.0 * (np.pi - angle)], abs=1e-8)
    assert arc_lengths[2] == pytest.approx(
        [5.0 * np.pi], abs=1e-3
    )  # where the curve is level, the height hardly determines s
    assert len(arc_lengths[3]) == 0


def test_a_wall_speaks_part_coordinates():
    """Walls return points and directions in part coordinates."""
    turn = np.array(
        [[0.0, -1.0, 0.0, 3.0], [0.0, 0.0, -1.0, 4.0], [1.0, 0.0, 0.0, 5.0], [0.0, 0.0, 0.0, 1.0]]
    )
    wall = RevolvedWall(Meridian.chained([line((10.0, 0.0), (10.0, 5.0))]), turn)
    azimuth = np.array([0.3, 2.0])
    local = np.stack(
        [10.0 * np.cos(azimuth), 10.0 * np.sin(azimuth), [1.0, 2.0], np.ones(2)], axis=1
    )
    assert wall.points(np.full(2, 10.0), np.array([1.0, 2.0]), azimuth) == pytest.approx(
        (local @ turn.T)[:, :3]
    )
    outward = wall.directions(np.array([[1.0, 0.0, 0.0]]), azimuth)
    assert outward == pytest.approx(
        np.stack([np.cos(azimuth), np.sin(azimuth), [0.0, 0.0]], axis=1) @ turn[:3, :3].T
    )


@pytest.mark.parametrize("points", [[[1.0, 0.0]], [[-1.0, 0.0], [1.0, 1.0]]])
def test_what_is_no_curve_is_refused(points):
    points = np.array(points)
    with pytest.raises(ValueError, match="meridian"):
        Meridian(np.arange(len(points), dtype=float), points, np.tile([0.0, 1.0], (len(points), 1)))


def test_a_curve_that_stands_still_is_refused():
    with pytest.raises(ValueError, match="no direction"):
        sample_curve(lambda t: (np.zeros((len(t), 2)), np.zeros((len(t), 2))), [0.0, 1.0])
