# SPDX-License-Identifier: LGPL-2.1-or-later
"""Circles as polylines."""

import numpy as np
import pytest

from freecad_am.core.geometry.step_count import turn_segments


@pytest.mark.parametrize("radius", [0.7, 3.0, 45.0, 5000.0])
@pytest.mark.parametrize("chord_error", [1e-5, 0.01, 1.0])
@pytest.mark.parametrize("turn", [0.1, 2.0, 2.0 * np.pi])
def test_the_fewest_segments_that_hold_the_chord_error(radius, chord_error, turn):
    def sagitta(segments):
        return 2.0 * radius * np.sin(0.25 * turn / segments) ** 2

    n = turn_segments(radius, chord_error, turn, 6)
    assert sagitta(n) <= chord_error * (1.0 + 1e-9)
    fewest = max(2, int(np.ceil(6 * min(1.0, turn / (2.0 * np.pi)) - 1e-9)))
    assert n >= fewest
    assert n == fewest or sagitta(n - 1) > chord_error


def test_small_circles_keep_a_sound_minimum():
    assert turn_segments(0.1, 10.0, 2.0 * np.pi, 24) == 24
    assert turn_segments(1.0, 0.5, 2.0 * np.pi, 24) == 24
    assert turn_segments(1.0, 0.5, np.pi, 24) == 12
