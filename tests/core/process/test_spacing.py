# SPDX-License-Identifier: LGPL-2.1-or-later
"""Spacing against formulas and brute force."""

import numpy as np
import pytest

from freecad_am.core.process.deposit import spacing
from freecad_am.core.toolpath import Bead, Layer, Toolpath


def bead(points, closed):
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return Bead(points, up, up, np.arange(len(points), dtype=float), np.ones(len(points)), closed)


def circle(radius, height, chord_error, start=0.0, turn=2 * np.pi):
    step = 2 * np.arccos(1 - min(chord_error / radius, 0.0085))
    angle = start + np.linspace(0.0, turn, int(np.ceil(abs(turn) / step)) + 1)
    points = np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full_like(angle, height)]
    full = abs(turn) == 2 * np.pi
    if full:
        points[-1] = points[0]
    return bead(points, full)


def path(*beads):
    return Toolpath(tuple(Layer((layer_bead,)) for layer_bead in beads), np.eye(4), 1.0, 0.01)


@pytest.mark.parametrize("chord_error", [0.1, 0.01, 0.001])
def test_layers_of_a_sphere_are_as_far_apart_as_the_sphere_says(chord_error):
    """Distances between layers of a sphere agree with the chord of one layer height."""
    radius, step = 45.0, 1.0
    angles = np.arange(70) * step / radius
    rng = np.random.default_rng(5)
    beads = [
        circle(radius * np.cos(a), radius * np.sin(a), chord_error, rng.uniform(0, 6))
        for a in angles
    ]
    distances = spacing.between_layers(path(*beads))
    exact = 2 * radius * np.sin(step / radius / 2)
    assert len(distances) == 69
    assert [len(layer) for layer in distances] == [len(layer_bead) for layer_bead in beads[1:]]
    worst = max(np.abs(layer - exact).max() for layer in distances)
    assert worst < 2e-4 * chord_error  # the chords alone would be off by the whole chord error


def test_open_beads_of_uneven_steps():
    rng = np.random.default_rng(8)

    def arc(radius):
        angle = np.sort(np.r_[0.0, 2.0, rng.uniform(0.0, 2.0, 90)])
        return bead(np.c_[radius * np.cos(angle), radius * np.sin(angle), 0 * angle], False)

    below, above = arc(30.0), arc(31.0)
    distances = spacing.between_layers(path(below, above))[0]
    largest = np.diff(np.arctan2(below.points[:, 1], below.points[:, 0])).max()
    assert (
        np.abs(distances - 1.0).max() < 30.0 * largest**4
    )  # fourth order in the step, where chords have the second


def test_beyond_the_ends_of_an_open_bead():
    below = circle(30.0, 0.0, 0.01, 0.0, np.pi)
    past = np.array([[30.0, -3.0, 4.0], [-30.0, -6.0, 8.0]])
    distances = spacing.between_layers(path(below, bead(past, False)))[0]
    np.testing.assert_allclose(distances, [5.0, 10.0], atol=1e-9)


def test_corners_are_kept():
    square = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [0, 0, 0]], dtype=float)
    points = np.array(
        [[13.0, 14.0, 0.0], [5.0, -2.0, 0.0], [5.0, 4.0, 0.0], [-3.0, -4.0, 0.0], [10.0, 10.0, 7.0]]
    )
    distances = spacing.distance(points, spacing.curve_of(Layer((bead(square, True),))))
    np.testing.assert_allclose(distances, [5.0, 2.0, 4.0, 5.0, 7.0], atol=1e-12)


@pytest.mark.parametrize("turn", [15.0, 25.0, 38.0])
def test_slight_corners_between_arcs_are_kept(turn):
    """Two arcs of 10 mm that meet at a corner: points above it have the distance from the arcs."""
    half = np.radians(turn) / 2.0
    angle = np.linspace(0.0, 1.2, 40)
    right_arc = (
        10.0 * np.c_[np.sin(angle + half) - np.sin(half), np.cos(angle + half) - np.cos(half)]
    )
    left_arc = right_arc[::-1] * [-1.0, 1.0]
    low = np.c_[np.r_[left_arc, right_arc[1:]], np.zeros(79)]
    inside = np.c_[np.linspace(-1.0, 1.0, 41), np.full(41, 1.5), np.zeros(41)]
    toolpath = path(bead(low, False), bead(inside, False))
    x, y = np.abs(inside[:, 0]) + 10.0 * np.sin(half), inside[:, 1] + 10.0 * np.cos(half)
    at_the_corner = x < y * np.tan(half)
    truth = np.where(at_the_corner, np.hypot(inside[:, 0], inside[:, 1]), np.hypot(x, y) - 10.0)
    assert at_the_corner.any() and not at_the_corner.all()
    assert spacing.between_layers(toolpath)[0] == pytest.approx(truth, abs=1e-4)


def test_nearest_of_all_segments_whatever_their_lengths():
    """Random zigzags with a corner at every point, against all pairs."""
    rng = np.random.default_rng(11)
    for _ in range(20):
        steps = rng.normal(size=(80, 3)) * rng.choice([0.1, 1.0, 20.0], size=(80, 1))
        for previous, step in zip(steps, steps[1:], strict=False):
            step *= -1.0 if previous @ step > 0.0 else 1.0  # each turns by more than 90 degrees
        corners = np.cumsum(steps, axis=0)
        points = rng.normal(size=(300, 3)) * 15.0 + corners[rng.integers(0, len(corners), 300)]
        distances = spacing.distance(points, spacing.curve_of(Layer((bead(corners, False),))))
        start, along = corners[:-1], np.diff(corners, axis=0)
        share = np.clip(
            ((points[:, None] - start) * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0
        )
        brute = np.linalg.norm(points[:, None] - start - share[..., None] * along, axis=-1).min(
            axis=1
        )
        np.testing.assert_allclose(distances, brute, atol=1e-9)


def test_nearest_of_many_segments_whatever_their_lengths():
    """As before with too many segments for all pairs: crowds of short segments, and long ones that
    are nearest although their middles are far away."""
    rng = np.random.default_rng(12)
    steps = rng.normal(size=(900, 3)) * rng.choice(
        [0.05, 0.3, 25.0], size=(900, 1), p=[0.6, 0.35, 0.05]
    )
    for previous, step in zip(steps, steps[1:], strict=False):
        step *= -1.0 if previous @ step > 0.0 else 1.0
    corners = np.cumsum(steps, axis=0)
    points = (
        rng.normal(size=(600, 3)) * rng.choice([0.2, 15.0], size=(600, 1))
        + corners[rng.integers(0, 900, 600)]
    )
    distances = spacing.distance(points, spacing.curve_of(Layer((bead(corners, False),))))
    start, along = corners[:-1], np.diff(corners, axis=0)
    share = np.clip(((points[:, None] - start) * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
    brute = np.linalg.norm(points[:, None] - start - share[..., None] * along, axis=-1).min(axis=1)
    np.testing.assert_allclose(distances, brute, atol=1e-9)


def test_two_beads_in_a_layer_and_one_layer_alone():
    inner, outer = circle(10.0, 0.0, 0.001), circle(20.0, 0.0, 0.001)
    below = Layer((inner, outer))
    above = circle(14.0, 3.0, 0.001)
    distances = spacing.distance(above.points, spacing.curve_of(below))
    np.testing.assert_allclose(distances, 5.0, atol=1e-6)
    assert spacing.between_layers(path(inner)) == ()


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_turns_of_a_spiral_are_one_pitch_apart(way):
    radius, pitch, turns = 20.0, 1.5, 6.3
    angle = np.linspace(0.0, 2 * np.pi * turns, 2000)
    points = np.c_[
        radius * np.cos(angle), way * radius * np.sin(angle), pitch * angle / (2 * np.pi)
    ]
    up = np.tile([0.0, 0.0, 1.0], (2000, 1))
    spiral = Bead(points, up, up, way * angle, np.ones(2000), False)
    distances = np.concatenate(
        spacing.between_layers(Toolpath((Layer((spiral,)),), np.eye(4), 1.5, 0.01))
    )
    assert len(distances) == np.count_nonzero(angle >= 2 * np.pi)
    # the nearest point of the helix turn below, by minimising over its angle on a fine grid
    back = np.linspace(-0.1, 0.1, 200_001)
    chord = 2 * radius * np.sin(back / 2)
    exact = np.sqrt(chord**2 + (pitch - pitch * back / (2 * np.pi)) ** 2).min()
    np.testing.assert_allclose(distances, exact, atol=1e-6)


def test_local_distances_come_bead_by_bead():
    rng = np.random.default_rng(3)
    base_bead = bead(
        np.c_[np.linspace(0, 40, 81), 0.2 * np.sin(np.linspace(0, 6, 81)), np.zeros(81)], False
    )
    heights = (rng.uniform(0.8, 1.2), rng.uniform(0.8, 1.2))
    upper_beads = [
        bead(base_bead.points[a:b] + [0, 0, h], False)
        for (a, b), h in zip(((0, 30), (40, 81)), heights)
    ]
    toolpath = Toolpath((Layer((base_bead,)), Layer(tuple(upper_beads))), np.eye(4), 1.0, 0.01)
    base_distances, *above = spacing.local_distances(toolpath)
    assert np.isnan(base_distances).all() and len(base_distances) == 81
    for distances, upper_bead, height in zip(above, upper_beads, heights, strict=True):
        assert len(distances) == len(upper_bead)
        np.testing.assert_allclose(distances, height, atol=1e-9)
    np.testing.assert_array_equal(np.concatenate(above), spacing.between_layers(toolpath)[0])


@pytest.mark.parametrize("turns", [3.0, 3.25, 3.4])
def test_local_distances_of_a_spiral_are_to_the_turn_before(turns):
    angle = np.linspace(0.0, 2 * np.pi * turns, int(240 * turns) + 1)
    points = np.c_[20 * np.cos(angle), 20 * np.sin(angle), angle / (2 * np.pi)]
    up = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    spiral = Bead(points, up, up, angle, np.ones(len(points)), False)
    (distances,) = spacing.local_distances(Toolpath((Layer((spiral,)),), np.eye(4), 1.0, 0.01))
    np.testing.assert_array_equal(np.isnan(distances), angle < 2 * np.pi)
    slope = 1.0 / (
        2 * np.pi * 20
    )  # nearest point of a helix one turn below, nearly perpendicular to it
    np.testing.assert_allclose(distances[angle >= 2 * np.pi], 1.0 / np.hypot(1.0, slope), atol=2e-6)


def test_known_tangents_keep_corners_however_slight_and_ellipses_exact():
    """An arch of two quarter ellipses that meet at 6 degrees, with points above and next to its
    tip."""
    half = np.radians(3.0)
    angle = np.linspace(0.0, 1.0, 25)
    along, down = 20.0 * np.sin(angle), 12.0 * (np.cos(angle) - 1.0)
    steep, fall = 20.0 * np.cos(angle), -12.0 * np.sin(angle)
    cos, sin = np.cos(half), np.sin(half)
    right = np.c_[along * cos + down * sin, down * cos - along * sin, 0.0 * angle]
    onward = np.c_[steep * cos + fall * sin, fall * cos - steep * sin, 0.0 * angle]
    onward /= np.linalg.norm(onward, axis=1, keepdims=True)
    points = np.concatenate([right[:0:-1] * [-1.0, 1.0, 1.0], right])
    leaving = np.concatenate([onward[:0:-1] * [1.0, -1.0, 1.0], onward])
    arriving = leaving.copy()
    arriving[24] = onward[0] * [1.0, -1.0, 1.0]
    plain = bead(points, False)
    with_tangents = Bead(
        plain.points,
        plain.build,
        plain.tool,
        plain.parameter,
        plain.speed,
        False,
        tangents=np.stack([arriving, leaving], 1),
    )
    above = np.array([[0.0, 2.0, 0.0], [0.3, 2.0, 0.0], [0.0, -2.0, 0.0]])
    fine = np.linspace(0.0, 1.0, 2_000_001)
    arch = np.c_[
        20.0 * np.sin(fine) * cos + 12.0 * (np.cos(fine) - 1.0) * sin,
        12.0 * (np.cos(fine) - 1.0) * cos - 20.0 * np.sin(fine) * sin,
    ]
    arch = np.concatenate([arch, arch * [-1.0, 1.0]])
    exact = [np.linalg.norm(arch - point[:2], axis=1).min() for point in above]
    distances = spacing.distance(above, spacing.curve_of(Layer((with_tangents,))))
    np.testing.assert_allclose(distances, exact, atol=2e-6)
    guessed = spacing.distance(above, spacing.curve_of(Layer((plain,))))
    assert np.abs(guessed - exact).max() > 1e-4  # without tangents such a corner is rounded


@pytest.mark.parametrize("copies", [1, 400])
def test_between_a_long_and_a_short_segment_at_a_corner_the_curve_counts(copies):
    """A valley of two arcs that meet at a corner, one in long segments, one in short: points on the
    bisector are equally far from both, although the long chords are nearer."""

    def arc(count):
        angle = np.linspace(0.0, 0.4, count + 1)
        return 10.0 * np.c_[
            np.sin(angle + 0.5) - np.sin(0.5), np.cos(0.5) - np.cos(angle + 0.5)
        ], np.c_[np.cos(angle + 0.5), np.sin(angle + 0.5)]

    (right_arc, onward), (left_arc, back) = arc(120), arc(4)
    points = np.concatenate([(left_arc * [-1, 1])[::-1], right_arc[1:]])
    leaving = np.concatenate([(back * [1, -1])[:0:-1], onward])
    arriving = leaving.copy()
    arriving[4] = onward[0] * [1, -1]
    flat = np.c_[points, np.zeros(len(points))]
    plain = bead(flat, False)
    tangents = np.stack(
        [np.c_[arriving, 0 * points[:, 0]], np.c_[leaving, 0 * points[:, 0]]], axis=1
    )
    low = Bead(
        plain.points,
        plain.build,
        plain.tool,
        plain.parameter,
        plain.speed,
        False,
        tangents=tangents,
    )
    height = np.tile(np.linspace(0.8, 2.0, 30), copies)
    for side in (0.0, 1e-4, -1e-4):
        above = np.c_[np.full_like(height, side), height, 0 * height]
        # the centres of the arcs are above the valley on either side
        centre_distance = np.hypot(np.abs(side) + 10.0 * np.sin(0.5), height - 10.0 * np.cos(0.5))
        distances = spacing.distance(above, spacing.curve_of(Layer((low,))))
        np.testing.assert_allclose(distances, 10.0 - centre_distance, atol=1e-6)
