# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of beads on hubs: no two so close that a controller could not resolve the time of the
move."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.filling.centre import PlaneCurve
from freecad_am.core.geometry.curves.plane_curve import divide_edges
from freecad_am.core.geometry.developable import Developable, Plane
from freecad_am.core.geometry.on_hub import Base
from freecad_am.core.layers.plane_field import PlaneLayer
from freecad_am.core.layers.rotary_field import RoundLayer
from freecad_am.core.layers.surface import Slice
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids.beads import MIN_DISTANCE_MM, bead_of, needed


@pytest.mark.parametrize("seed", range(30))
def test_points_that_all_but_coincide_are_one(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 150))
    angle = rng.uniform(-1.0, 1.0, count)
    steps = 10.0 ** rng.uniform(-9.0, 0.5, (count, 1)) * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    line = np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)])
    got = needed(line, 0.01)
    got = divide_edges(got, RoundLayer(Developable(60.0, 200.0)).pieces(got, 0.01))[0]
    np.testing.assert_array_equal(got[[0, -1]], line[[0, -1]])
    gaps = np.linalg.norm(np.diff(got, axis=0), axis=1)
    if line[-1, 0] > 2.0 * MIN_DISTANCE_MM:
        assert gaps.min() > 0.5 * MIN_DISTANCE_MM
    assert cKDTree(got).query(line)[0].max() < 2.5 * MIN_DISTANCE_MM or len(got) > 2
    # no part of the line is lost: every point of it is near the new one
    share = np.linspace(0.0, 1.0, 50)[:, None, None]
    fine = ((1.0 - share) * got[:-1] + share * got[1:]).reshape(-1, 2)
    assert cKDTree(fine).query(line)[0].max() < 2.5 * MIN_DISTANCE_MM + gaps.max() / 50.0


@pytest.mark.parametrize("seed", range(20))
def test_narrow_beads_have_no_move_of_less_than_a_tenth_of_a_millisecond(seed):
    """Beads of 30 % width are printed 3.3 times as fast: at 20 mm/s points 3 um apart are 0.05 ms
    apart."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 150))
    angle = rng.uniform(-0.5, 0.5, count)
    steps = 10.0 ** rng.uniform(-3.0, -1.0, (count, 1)) * np.stack(
        [np.cos(angle), np.sin(angle)], axis=1
    )
    line = np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)])
    share = rng.uniform(0.3, 1.0, len(line))
    process = ProcessParameters(travel_speed=20.0, acceleration=1e5, bead_width=1.0)
    bead = bead_of(
        PlaneCurve(line, False, "centre", 0, share=share),
        Slice(0, Base("flat", Plane(), np.eye(4)), PlaneLayer(0.5), ()),
        SolidParameters(chord_error=1e-3, bead_spacing=1.0, layer_height=0.5),
        BuildDirectionParameters(),
        process,
        None,
    ).bead
    times = np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]
    assert times.min() >= 1e-4 and bead.speed.max() > 25.0
    np.testing.assert_allclose(bead.points[[0, -1], :2], line[[0, -1]], atol=1e-9)
    fine = np.concatenate(
        [np.linspace(a, b, 200) for a, b in zip(bead.points[:-1, :2], bead.points[1:, :2])]
    )
    assert cKDTree(fine).query(line)[0].max() < 2.0 * 1e-4 * bead.speed.max() + 1e-3
