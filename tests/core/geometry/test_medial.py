# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths in the middle of regions."""

import time

import numpy as np

from freecad_am.core.geometry.regions.medial import MANY, spine
from freecad_am.core.geometry.regions.region import regions


def test_the_middle_of_a_strip_is_found_from_very_many_places_too():
    """A gap of 1 % asked for places 0.014 mm apart: exactly on parallel lines they took more than a minute."""
    (strip,) = regions([np.array([[0.0, 0.0], [103.0, 0.0], [103.0, 8.0], [0.0, 8.0]])])
    before = time.process_time()
    path, closed = spine(strip, 0.035, 222.0 / (1.2 * MANY))
    assert time.process_time() - before < 4.0  # more than ten times that before
    assert not closed and np.ptp(path[:, 0]) > 103.0 - 8.0 - 0.1
    between = path[(path[:, 0] > 4.0) & (path[:, 0] < 99.0)]
    assert np.abs(between[:, 1] - 4.0).max() < 1e-4
