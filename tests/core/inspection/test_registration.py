# SPDX-License-Identifier: LGPL-2.1-or-later
"""Registration recovers known motions: with noise, with outliers, from part of a surface and from
any start."""

import numpy as np
import pytest

from freecad_am.core.geometry.frames import inverse, pose, rotation_about
from freecad_am.core.inspection.registration import as_measured, by_extents, by_pairs, register
from freecad_am.core.issues import InputError

HALF = np.array([40.0, 25.0, 12.0])


def box(points):
    """Distance from a box and its gradient, by formula."""
    outside = np.abs(points) - HALF
    distance = np.linalg.norm(np.maximum(outside, 0.0), axis=1) + np.minimum(
        outside.max(axis=1), 0.0
    )
    side = np.sign(points) + (points == 0.0)
    nearest = np.eye(3)[np.argmax(outside, axis=1)]
    off = np.maximum(outside, 0.0)
    length = np.linalg.norm(off, axis=1, keepdims=True)
    slope = np.where(length > 1e-12, off / np.maximum(length, 1e-12), nearest) * side
    return distance, slope


def sphere(points):
    distance = np.linalg.norm(points, axis=1)
    return distance - 30.0, points / distance[:, None]


def cylinder(points):
    distance = np.hypot(points[:, 0], points[:, 1])
    return distance - 20.0, np.column_stack(
        [points[:, :2] / distance[:, None], np.zeros(len(points))]
    )


def sample_box(rng, count):
    points = rng.uniform(-1.0, 1.0, (count, 3)) * HALF
    axis = rng.integers(0, 3, count)
    points[np.arange(count), axis] = np.where(rng.random(count) < 0.5, -1.0, 1.0) * HALF[axis]
    return points


def motion(rng, angle, shift):
    axis = rng.normal(size=3)
    return pose(rotation_about(axis / np.linalg.norm(axis), angle), rng.uniform(-shift, shift, 3))


def apply_motion(points, by):
    return points @ by[:3, :3].T + by[:3, 3]


@pytest.mark.parametrize("seed", range(5))
def test_a_scan_of_a_box_is_laid_back_from_nearby(seed):
    """Registration moves a displaced scan of a box back."""
    rng = np.random.default_rng(seed)
    planned = sample_box(rng, 2000)
    displacement = motion(rng, 0.15, 4.0)
    registration = register(apply_motion(planned, displacement), box, as_measured(), "scan")
    assert np.abs(registration.motion @ displacement - np.eye(4)).max() < 1e-8
    assert np.abs(registration.points - planned).max() < 1e-7
    assert np.abs(registration.distance).max() < 1e-8
    assert registration.free == ()


@pytest.mark.parametrize("seed", range(5))
def test_noise_is_averaged_over_the_points(seed):
    rng = np.random.default_rng(100 + seed)
    count, noise = 5000, 0.05
    planned = sample_box(rng, count)
    scan = planned + box(planned)[1] * rng.normal(0.0, noise, (count, 1))
    displacement = motion(rng, 0.1, 3.0)
    registration = register(apply_motion(scan, displacement), box, as_measured(), "scan")
    residual = apply_motion(np.diag(HALF), registration.motion @ displacement) - np.diag(HALF)
    assert np.abs(residual).max() < 8.0 * noise / np.sqrt(count) * np.linalg.norm(HALF) / HALF.min()
    assert registration.rms == pytest.approx(noise, rel=0.05)


@pytest.mark.parametrize("seed", range(4))
def test_any_attitude_is_found_by_principal_axes(seed):
    """A lid on one corner distinguishes the ends of the box: the distances select the right one of
    24 orientations."""
    rng = np.random.default_rng(200 + seed)

    def marked(points):
        distance, slope = box(points)
        displacement = points - np.array([40.0, 25.0, 12.0])
        radius = np.linalg.norm(displacement, axis=1)
        nearer = radius - 9.0 < distance
        return np.where(nearer, radius - 9.0, distance), np.where(
            nearer[:, None], displacement / radius[:, None], slope
        )

    planned = sample_box(rng, 3000)
    knob = rng.normal(size=(400, 3))
    knob = np.array([40.0, 25.0, 12.0]) + 9.0 * knob / np.linalg.norm(knob, axis=1, keepdims=True)
    planned = np.concatenate([planned, knob])
    planned = planned[np.abs(marked(planned)[0]) < 1e-9]
    displacement = motion(rng, rng.uniform(0.5, 3.1), 500.0)
    scan = apply_motion(planned, displacement)
    registration = register(scan, marked, by_extents(scan, planned), "scan")
    assert np.abs(registration.points - planned).max() < 1e-6


def test_outliers_do_not_count():
    rng = np.random.default_rng(7)
    planned = sample_box(rng, 2000)
    scan = planned.copy()
    scan[:150] += rng.uniform(5.0, 15.0, (150, 3))
    displacement = motion(rng, 0.05, 2.0)
    registration = register(apply_motion(scan, displacement), box, as_measured(), "scan", trim=0.1)
    assert np.abs(registration.points[150:] - planned[150:]).max() < 1e-7
    assert registration.used[150:].sum() >= 1750 and registration.used.sum() == 1800


def test_the_centre_of_a_probes_ball_is_a_radius_away():
    rng = np.random.default_rng(8)
    planned = sample_box(rng, 1000)
    centres = planned + 2.5 * box(planned)[1]
    registration = register(
        apply_motion(centres, motion(rng, 0.1, 2.0)), box, as_measured(), "scan", radius=2.5
    )
    assert np.abs(registration.distance).max() < 1e-8


def test_pairs_begin_from_anywhere():
    rng = np.random.default_rng(9)
    planned = sample_box(rng, 500)
    displacement = motion(rng, 2.5, 900.0)
    scan = apply_motion(planned, displacement)
    rough = apply_motion(planned[:4], displacement) + rng.normal(0.0, 0.5, (4, 3))
    registration = register(scan, box, by_pairs(rough, planned[:4], "pairs"), "scan")
    assert np.abs(registration.points - planned).max() < 1e-7
    exact = by_pairs(scan[:5], planned[:5], "pairs")[0]
    assert np.abs(exact - inverse(displacement)).max() < 1e-9


def test_turns_that_a_round_part_does_not_feel_are_told_and_not_made():
    """Rotations that a round part leaves free are reported and not applied."""
    rng = np.random.default_rng(10)
    direction = rng.normal(size=(800, 3))
    ball = 30.0 * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    registration = register(ball + [0.5, -1.0, 2.0], sphere, as_measured(), "scan")
    assert np.abs(registration.distance).max() < 1e-9
    assert np.abs(apply_motion(np.array([[0.5, -1.0, 2.0]]), registration.motion)).max() < 1e-9
    assert np.abs(registration.motion[:3, :3] - np.eye(3)).max() < 0.01  # and it hardly rotated
    assert len(registration.free) == 3 and all(
        free_motion.startswith("a turn about the axis through (")
        for free_motion in registration.free
    )

    angle, height = rng.uniform(0.0, 2.0 * np.pi, 800), rng.uniform(0.0, 50.0, 800)
    pipe = np.column_stack([20.0 * np.cos(angle), 20.0 * np.sin(angle), height])
    registration = register(pipe + [0.5, -1.0, 2.0], cylinder, as_measured(), "scan")
    assert np.abs(registration.distance).max() < 1e-9
    assert registration.motion[2, 3] == pytest.approx(0.0, abs=1e-6)  # no shift along the axis
    assert len(registration.free) == 2


@pytest.mark.parametrize(
    ("count", "trim", "code"),
    [
        (5, 0.0, "TOO_FEW_POINTS"),
        (0, 0.0, "TOO_FEW_POINTS"),
        (50, 0.5, "OUT_OF_RANGE"),
        (50, -0.1, "OUT_OF_RANGE"),
    ],
)
def test_what_cannot_be_fitted_is_refused(count, trim, code):
    with pytest.raises(InputError) as caught:
        register(sample_box(np.random.default_rng(0), count), box, as_measured(), "scan.csv", trim)
    assert (caught.value.code, caught.value.where) == (code, "scan.csv")


def test_pairs_in_a_line_are_refused():
    line = np.outer(np.arange(4.0), [1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="line"):
        by_pairs(line, line, "pairs")
    with pytest.raises(InputError) as caught:
        by_pairs(line[:2], line[:2], "pairs")
    assert caught.value.code == "TOO_FEW_PAIRS"
