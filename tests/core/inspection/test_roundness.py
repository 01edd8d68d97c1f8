# SPDX-License-Identifier: LGPL-2.1-or-later
"""Roundness against brute force and against zones known by construction."""

import numpy as np
import pytest
from scipy.optimize import minimize

from freecad_am.core.inspection.figures import least_squares_round, narrowest
from freecad_am.core.issues import InputError


def ring(rng, count, radius=30.0, noise=0.2):
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    distance = radius + noise * (np.cos(3 * angle) + rng.uniform(-1.0, 1.0, count))
    return np.column_stack([np.cos(angle), np.sin(angle)]) * distance[:, None]


def ball(rng, count, radius=30.0, noise=0.2):
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return direction * (radius + noise * rng.uniform(-1.0, 1.0, count))[:, None]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("make", [ring, ball])
@pytest.mark.always("ball-0", "ball-1", "ball-3", "ring-0", "ring-1", "ring-2")
def test_no_centre_tried_by_brute_force_has_a_narrower_zone(make, seed):
    """No centre tried by brute force has a narrower zone."""
    rng = np.random.default_rng(seed)
    points = make(rng, 200) + rng.uniform(-1000.0, 1000.0, 2 if make is ring else 3)
    minimum_zone = narrowest(points, "scan")

    def zone(centre):
        distance = np.linalg.norm(points - centre, axis=1)
        return np.ptp(distance)

    scales = np.repeat([0.3, 0.03, 0.003, 3e-4], 3000)
    trials = [
        minimum_zone.centre + rng.normal(0.0, scale, minimum_zone.centre.shape) for scale in scales
    ]
    assert min(map(zone, trials)) >= minimum_zone.zone - 1e-9
    for start in trials[::2500]:
        assert (
            minimize(zone, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-10}).fun
            >= minimum_zone.zone - 1e-8
        )
    assert minimum_zone.zone == pytest.approx(zone(minimum_zone.centre), abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_zone_held_by_alternating_points_is_found_exactly(seed, dimension):
    """Points on two concentric spheres that alternate all round: no other centre has as narrow a
    zone."""
    rng = np.random.default_rng(seed)
    centre = rng.uniform(-500.0, 500.0, dimension)
    axes = np.concatenate([np.eye(dimension), -np.eye(dimension)])
    turned = axes @ np.linalg.qr(rng.normal(size=(dimension, dimension)))[0]
    inside = (ring if dimension == 2 else ball)(rng, 300, 20.0, 0.0)
    between = inside * rng.uniform(1.0, 1.02, 300)[:, None]
    points = centre + np.concatenate([20.0 * axes, 20.4 * turned, between])
    minimum_zone = narrowest(points, "scan")
    assert np.abs(minimum_zone.centre - centre).max() < 1e-9
    assert (minimum_zone.inner, minimum_zone.outer) == pytest.approx((20.0, 20.4), abs=1e-9)
    assert minimum_zone.radius == pytest.approx(20.2, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("make", [ring, ball])
def test_least_squares_is_stationary_and_beats_its_neighbours(make, seed):
    rng = np.random.default_rng(seed)
    points = make(rng, 150) + 400.0
    fitted = least_squares_round(points, "scan")

    def square(unknown):
        return float(((np.linalg.norm(points - unknown[:-1], axis=1) - unknown[-1]) ** 2).sum())

    best = square(np.append(fitted.centre, fitted.radius))
    for _ in range(200):
        assert (
            square(
                np.append(fitted.centre, fitted.radius)
                + rng.normal(0.0, 1e-3, len(fitted.centre) + 1)
            )
            > best
        )
    assert fitted.zone >= narrowest(points, "scan").zone


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_point_at_the_centre_itself_is_one_as_others(dimension):
    """As in a row-by-row scan of a plate, one point may coincide with the centre."""
    axes = np.meshgrid(*[np.arange(-3.0, 4.0)] * dimension)
    points = np.stack([axis.ravel() for axis in axes], axis=1)
    with np.errstate(all="raise"):
        fitted, minimum_zone = least_squares_round(points, "scan"), narrowest(points, "scan")
    for circle in (fitted, minimum_zone):
        distance = np.linalg.norm(points - circle.centre, axis=1)
        assert (circle.inner, circle.outer) == pytest.approx(
            (distance.min(), distance.max()), abs=1e-12
        )
    assert minimum_zone.zone <= fitted.zone


def test_an_arc_of_thirty_degrees_has_the_right_radius():
    angle = np.radians(np.linspace(10.0, 40.0, 50))
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * 250.0 + [3.0, -7.0]
    fitted = least_squares_round(points, "scan")
    assert fitted.radius == pytest.approx(250.0, abs=1e-8)
    assert fitted.centre == pytest.approx([3.0, -7.0], abs=1e-8)


@pytest.mark.parametrize(
    ("points", "code"),
    [
        (np.zeros((0, 2)), "TOO_FEW_POINTS"),
        (np.array([[0.0, 0.0], [1.0, 0.0]]), "TOO_FEW_POINTS"),
        (np.array([[0.0, 0.0], [1.0, 1.0], [5.0, 5.0], [2.0, 2.0]]), "FLAT_POINTS"),
        (
            np.column_stack([np.random.default_rng(0).normal(size=(20, 2)), np.full(20, 3.0)]),
            "FLAT_POINTS",
        ),
        (np.full((5, 3), 2.0), "FLAT_POINTS"),
    ],
)
def test_points_without_a_centre_are_refused(points, code):
    with pytest.raises(InputError) as caught:
        least_squares_round(points, "scan.csv")
    assert (caught.value.code, caught.value.where) == (code, "scan.csv")
