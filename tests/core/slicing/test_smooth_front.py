# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth fronts on walls of any faces: on a finer grid they stay in the band, turn as reported, and
end on the rims."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.slicing.fronts.curve import Smoothing
from freecad_am.core.slicing.fronts.rims import Rims
from freecad_am.core.slicing.fronts.smooth import turn
from tests.core.patch_walls import ball, bend, brute, sheet

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
SILL = HalfSpace(np.zeros(3), np.array([0.0, 1.0, 0.0]))
BAND, LIMIT = 0.2, np.radians(6.0)
WALLS = {
    "a bend": (lambda: bend(PIPE, 0.3, np.pi / 2, 1.25), 5.0),
    "an opening": (lambda: sheet(SILL, [(2.0, 20.0, 9.0)]), 1.7),
    "a half shell": (lambda: bend(PIPE, 0.3, 1.3, 1.0, 0.5, np.pi), 2.0),
}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(name, marks=pytest.mark.long if name == "an opening" else ()) for name in WALLS
    ],
)
def sliced_wall(request):
    make, height = WALLS[request.param]
    wall = make()
    exact, smooth = (
        fronts.slice_layers(wall, height, smoothing) for smoothing in (None, Smoothing(BAND, LIMIT))
    )
    return request.param, wall, height, exact, smooth


def measure_turn(wall, front):
    """Turn of fine chords within the wall, rad/mm, over 0.3 mm, from differences."""
    w = np.linspace(front.w[0], front.w[-1], max(8, int(front.length / 0.1)))
    points = front.at(w)[0]
    normal = wall.project(points)[1]
    ahead, back = points[6:] - points[3:-3], points[3:-3] - points[:-6]
    side = np.cross(normal[3:-3], back)
    angle = np.abs(np.arctan2((ahead * side).sum(1), (ahead * back).sum(1)))
    return (angle / (0.5 * (np.linalg.norm(ahead, axis=1) + np.linalg.norm(back, axis=1)))).max(
        initial=0.0
    )


@pytest.mark.always("a half shell")
def test_fronts_stay_in_the_band_and_on_the_wall_between_nodes(sliced_wall):
    _, wall, height, _, smooth = sliced_wall
    for below, above in zip(smooth.fronts, smooth.fronts[1:]):
        for front in above:
            points = front.at(front.refined(11))[0]
            distance = brute(points, below)
            assert (
                distance.min() >= (1.0 - BAND) * height and distance.max() <= (1.0 + BAND) * height
            )
            assert np.linalg.norm(wall.project(points)[0] - points, axis=1).max() < 1e-4


def test_corners_are_rounded_as_far_as_the_band_allows(sliced_wall):
    name, wall, height, exact, smooth = sliced_wall
    long_fronts = [
        front for layer in smooth.fronts[1:] for front in layer if front.length > 8.0 * height
    ]
    assert not any(len(front.corners) for front in long_fronts)
    turns = np.array([turn(wall, front) for front in long_fronts])
    measured = np.array([measure_turn(wall, front) for front in long_fronts])
    assert (measured < turns + 1e-3).all()  # never sharper than the reported turn
    exact_turns = [
        turn(wall, front)
        for layer in exact.fronts[1:]
        for front in layer
        if front.length > 8.0 * height
    ]
    assert sum(turn_rate > LIMIT for turn_rate in exact_turns) > 3
    # the band is too small where two fronts merge behind an opening
    assert (turns > LIMIT).sum() <= (8 if name == "an opening" else 0)
    assert turns.max() < 0.5 * max(exact_turns)


def test_ends_stay_on_the_rims(sliced_wall):
    _, wall, _, _, smooth = sliced_wall
    rims = Rims.of(wall.rims)
    for layer in smooth.fronts[1:]:
        for front in layer:
            if not front.closed:  # the first layer is the substrate's
                assert rims.nearest(front.points[[0, -1]])[0] == pytest.approx(0.0, abs=1e-6)


def test_uneven_layers_get_no_closing_beads(sliced_wall):
    _, _, _, exact, smooth = sliced_wall
    assert abs(len(smooth.fronts) - len(exact.fronts)) <= 1
    gaps = [
        len([curve for layer in slicing.closing for curve in layer]) for slicing in (exact, smooth)
    ]
    assert gaps[1] <= gaps[0]


def test_smoothing_keeps_fronts_without_corners():
    wall = ball(HalfSpace(np.array([0.0, 0.0, -5.0]), np.array([0.1, 0.3, 1.0])), 2500)
    exact, smooth = (
        fronts.slice_layers(wall, 2.0, smoothing).fronts
        for smoothing in (None, Smoothing(BAND, LIMIT))
    )
    assert len(exact) == len(smooth)
    for exact_layer, smooth_layer in zip(
        exact, smooth
    ):  # circles; the last ones exceed the limit, and no distance within the band helps
        assert brute(
            exact_layer[0].at(exact_layer[0].refined(4))[0], smooth_layer
        ) == pytest.approx(0.0, abs=1e-3)
