# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads on walls: no two so close that a controller could not resolve the time between
them."""

import numpy as np
import pytest

from freecad_am.core.geometry.walls.patch_wall import FirstCurve
from freecad_am.core.slicing.curve_points import sample_within_chord
from freecad_am.core.strategies.walls.beads import MIN_DISTANCE_MM, traced

TINY = 3.1e-5


def polygon(points, closed):
    points = np.asarray(points, dtype=float)
    chord = np.roll(points, -1, axis=0) - points
    unit = chord / np.linalg.norm(chord, axis=1, keepdims=True)
    into, out = np.roll(unit, 1, axis=0), unit.copy()
    if not closed:
        into[0], out[-1] = out[0], into[-1]
    return FirstCurve(points, into, out, closed).curve()


@pytest.mark.parametrize("ends", [(0.0, 0.0), (TINY, 0.0), (0.0, TINY), (TINY, TINY)])
def test_corners_next_to_an_end_are_the_end(ends):
    """A U with one side of almost zero length."""
    low, high = ends
    corners = [(0, low or 5, 0), (0, 0, 0), (7, 0, 0), (7, high or 5, 0)]
    curve = polygon(corners, False)
    line = traced(curve, sample_within_chord(curve, curve.w[0], curve.w[-1], 0.01), False)
    assert np.linalg.norm(np.diff(line.points, axis=0), axis=1).min() >= MIN_DISTANCE_MM
    assert line.points[[0, -1]] == pytest.approx(np.array(corners, dtype=float)[[0, -1]], abs=1e-12)
    right = np.array([1.0, 0.0, 0.0])
    if low:
        assert line.tangents[0] == pytest.approx(np.stack([right, right]))
    if high:
        assert line.tangents[-1] == pytest.approx(np.stack([right, right]))


@pytest.mark.parametrize("shift", [TINY, -TINY])
def test_a_seam_next_to_a_corner_keeps_its_place_and_the_turn(shift):
    curve = polygon([(0, 0, 0), (7, 0, 0), (7, 7, 0), (0, 7, 0)], True)
    start = curve.w[1] + shift
    w = sample_within_chord(curve, start, start + curve.period, 0.01)
    line = traced(curve, w, True)
    assert np.linalg.norm(np.diff(line.points, axis=0), axis=1).min() >= MIN_DISTANCE_MM
    assert (line.points[0] == line.points[-1]).all()
    assert line.points[0] == pytest.approx(curve.at(np.array([start]))[0][0], abs=1e-12)
    assert line.tangents[0, 1] == pytest.approx([0, 1, 0]) and line.tangents[
        -1, 0
    ] == pytest.approx([1, 0, 0])


def test_two_corners_side_by_side_are_one_that_turns_by_both():
    """Two adjacent corners become one that turns by both angles."""
    curve = polygon([(0, 0, 0), (6, 0, 0), (6 + TINY, TINY, 0), (6 + TINY, 6, 0)], False)
    line = traced(curve, sample_within_chord(curve, curve.w[0], curve.w[-1], 0.01), False)
    assert np.linalg.norm(np.diff(line.points, axis=0), axis=1).min() >= MIN_DISTANCE_MM
    corner = int(np.argmin(np.linalg.norm(line.points - [6, 0, 0], axis=1)))
    assert line.points[corner] == pytest.approx([6, 0, 0], abs=MIN_DISTANCE_MM)
    assert line.tangents[corner] == pytest.approx(np.array([[1, 0, 0], [0, 1, 0]], dtype=float))


def test_what_is_far_enough_apart_is_left_to_the_bit():
    curve = polygon([(0, 0, 0), (6, 0, 0), (6, 2e-3, 0), (6, 6, 0)], False)
    w = sample_within_chord(curve, curve.w[0], curve.w[-1], 0.01)
    assert (traced(curve, w, False).points == curve.at(w)[0]).all()
