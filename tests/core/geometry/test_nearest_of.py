# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nearest points on several rings are those of each ring separately, whichever rings are
skipped."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.plane_curve import nearest, nearest_on_rings, winding


@pytest.fixture(scope="module")
def rings():
    random = np.random.default_rng(5)
    random_rings = []
    for centre in random.uniform(-100.0, 100.0, (25, 2)):
        angle = np.sort(random.uniform(0.0, 2.0 * np.pi, random.integers(3, 40)))
        random_rings.append(
            centre
            + random.uniform(2.0, 30.0, (len(angle), 1)) * np.c_[np.cos(angle), np.sin(angle)]
        )
    return random_rings


@pytest.mark.parametrize("count", [0, 1, 4, 300])
def test_nothing_is_lost_with_rings_that_are_passed_over(rings, count):
    """Skipping distant rings loses no nearest point."""
    points = np.random.default_rng(count).uniform(-150.0, 150.0, (count, 2))
    boxes = (
        np.array([ring.min(axis=0) for ring in rings]),
        np.array([ring.max(axis=0) for ring in rings]),
    )
    nearest_points, distances = nearest_on_rings(rings, boxes, points)
    answers = [nearest(ring, points, closed=True) for ring in rings]
    all_distances = np.array([answer.distance for answer in answers]).reshape(len(rings), count)
    best = all_distances.argmin(axis=0)
    assert np.array_equal(distances, all_distances[best, np.arange(count)])
    assert np.array_equal(
        nearest_points, np.array([answer.points for answer in answers])[best, np.arange(count)]
    )


def test_rings_that_no_point_is_near_count_nothing(rings):
    points = np.random.default_rng(1).uniform(-150.0, 150.0, (40, 2))
    angles = [
        np.arctan2(*(ring[None] - points[:, None]).transpose(2, 0, 1)[::-1]) for ring in rings
    ]
    turns = [np.diff(np.c_[angle, angle[:, 0]], axis=1) for angle in angles]
    turned = sum(((turn + np.pi) % (2.0 * np.pi) - np.pi).sum(axis=1) for turn in turns)
    assert (
        np.array_equal(winding(rings, points), np.rint(turned / (2.0 * np.pi)).astype(int))
        and turned.max() > 6.0
    )
