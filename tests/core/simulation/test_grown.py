# SPDX-License-Identifier: LGPL-2.1-or-later
"""Heights of a predicted deposit at the points of a motion."""

import numpy as np

from freecad_am.core.simulation.table_links import MIN_HEIGHT_MM, heights


def test_each_point_has_the_height_of_the_nearest_piece_of_its_layer():
    """Each point takes the height of the nearest voxel of its layer."""
    rng = np.random.default_rng(4)
    laid = np.column_stack(
        [rng.uniform(0.0, 50.0, (200, 3)), rng.integers(0, 3, 200), rng.uniform(-1.0, 4.0, 200)]
    )
    points, layer = rng.uniform(0.0, 50.0, (80, 3)), rng.integers(0, 4, 80)
    predicted = heights(laid, points, layer)
    for k in range(80):
        same_layer = laid[laid[:, 3] == layer[k]]
        if not len(same_layer):
            assert layer[k] == 3 and np.isnan(predicted[k])
            continue
        nearest = min(same_layer, key=lambda row: float(np.sum((row[:3] - points[k]) ** 2)))
        assert predicted[k] == max(nearest[4], MIN_HEIGHT_MM)
