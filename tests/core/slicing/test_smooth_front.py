# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth fronts on walls of any faces: the band is held on a finer grid, the turn is what it says, rims are kept."""

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
def cut(request):
    make, height = WALLS[request.param]
    wall = make()
    exact, smooth = (
        fronts.slice_layers(wall, height, how) for how in (None, Smoothing(BAND, LIMIT))
    )
    return request.param, wall, height, exact, smooth


def sharpest(wall, front):
    """Turn of fine chords within the wall, rad/mm, over stretches of 0.3 mm, by differences alone."""
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
def test_the_band_is_held_and_the_wall_kept_between_the_nodes(cut):
    _, wall, height, _, smooth = cut
    for below, above in zip(smooth.fronts, smooth.fronts[1:]):
        for front in above:
            points = front.at(front.refined(11))[0]
            distance = brute(points, below)
            assert (
                distance.min() >= (1.0 - BAND) * height and distance.max() <= (1.0 + BAND) * height
            )
            assert np.linalg.norm(wall.project(points)[0] - points, axis=1).max() < 1e-4


def test_corners_are_rounded_to_what_is_asked_or_what_the_band_allows(cut):
    name, wall, height, exact, smooth = cut
    long = [front for layer in smooth.fronts[1:] for front in layer if front.length > 8.0 * height]
    assert not any(len(front.corners) for front in long)
    turns = np.array([turn(wall, front) for front in long])
    measured = np.array([sharpest(wall, front) for front in long])
    assert (measured < turns + 1e-3).all()  # and no sharper than they say
    before = [
        turn(wall, front)
        for layer in exact.fronts[1:]
        for front in layer
        if front.length > 8.0 * height
    ]
    assert sum(rate > LIMIT for rate in before) > 3
    # where two fronts stand against the back of an opening and merge, the band does not suffice
    assert (turns > LIMIT).sum() <= (8 if name == "an opening" else 0)
    assert turns.max() < 0.5 * max(before)


def test_ends_stay_on_the_rims(cut):
    _, wall, _, _, smooth = cut
    rims = Rims.of(wall.rims)
    for layer in smooth.fronts[1:]:
        for front in layer:
            if not front.closed:  # the first layer is the substrate's
                assert rims.nearest(front.points[[0, -1]])[0] == pytest.approx(0.0, abs=1e-6)


def test_uneven_layers_are_taken_for_no_gaps(cut):
    _, _, _, exact, smooth = cut
    assert abs(len(smooth.fronts) - len(exact.fronts)) <= 1
    gaps = [len([curve for layer in found.closing for curve in layer]) for found in (exact, smooth)]
    assert gaps[1] <= gaps[0]


def test_where_fronts_turn_little_nothing_is_changed():
    wall = ball(HalfSpace(np.array([0.0, 0.0, -5.0]), np.array([0.1, 0.3, 1.0])), 2500)
    exact, smooth = (
        fronts.slice_layers(wall, 2.0, how).fronts for how in (None, Smoothing(BAND, LIMIT))
    )
    assert len(exact) == len(smooth)
    for one, other in zip(
        exact, smooth
    ):  # circles; the last ones turn more than asked, and by nothing can be helped
        assert brute(one[0].at(one[0].refined(4))[0], other) == pytest.approx(0.0, abs=1e-3)
