# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads on hubs: none so near to the next that no controller could tell the time of the move."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.layers.round_layer import RoundLayer
from freecad_am.core.strategies.solids.beads import CLOSE, dense


@pytest.mark.parametrize("seed", range(30))
def test_points_that_all_but_coincide_are_one(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 150))
    angle = rng.uniform(-1.0, 1.0, count)
    steps = 10.0 ** rng.uniform(-9.0, 0.5, (count, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    line = np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)])
    got = dense(line, RoundLayer(Developable(60.0, 200.0)), 0.01)
    np.testing.assert_array_equal(got[[0, -1]], line[[0, -1]])
    gaps = np.linalg.norm(np.diff(got, axis=0), axis=1)
    if line[-1, 0] > 2.0 * CLOSE:
        assert gaps.min() > 0.5 * CLOSE
    assert cKDTree(got).query(line)[0].max() < 2.5 * CLOSE or len(got) > 2
    # nothing of the line is left out: every point of it is near the new one
    share = np.linspace(0.0, 1.0, 50)[:, None, None]
    fine = ((1.0 - share) * got[:-1] + share * got[1:]).reshape(-1, 2)
    assert cKDTree(fine).query(line)[0].max() < 2.5 * CLOSE + gaps.max() / 50.0
