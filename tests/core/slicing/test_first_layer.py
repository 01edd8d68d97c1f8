# SPDX-License-Identifier: LGPL-2.1-or-later
"""The first layer compared with Chalvin 2019, equation 3, and with the substrate."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.walls.surface import Torus, cylinder
from freecad_am.core.issues import InputError
from freecad_am.core.slicing.first_layer import interpolate_polyline, intersect_implicit
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid

TORUS = Torus(60.0, 15.0)
PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])


def test_torus_on_a_pipe_is_equation_3():
    layer = intersect_implicit(TORUS, PIPE, (0.0, 1.5), even_grid(TORUS, 360))
    reach = 60.0 + 15.0 * np.cos(layer.v)
    u = np.arccos((60.0**2 - 32.0**2 + reach**2) / (2.0 * 60.0 * reach))
    assert layer.u == pytest.approx(u, abs=1e-13)
    x, _, z = layer.curve.points.T
    assert np.hypot(x, z) == pytest.approx(np.full(len(x), 32.0), abs=1e-12)


@pytest.mark.parametrize(
    "substrate, wall, range_",
    [
        (Round.cylinder(32.0, [3, 5, -2], [0.2, 1.0, 0.1]), TORUS, (0.0, 1.5)),
        (Round.sphere(30.0, [4, 5, -10]), TORUS, (-0.2, 1.2)),
        (Round.cone(0.5, [0, 0, 30], [0.3, 0, -1]), cylinder(10.0), (-60.0, 60.0)),
        (
            HalfSpace(np.array([0.0, 0.0, 5.0]), np.array([0.5, 0.2, 1.0])),
            cylinder(10.0),
            (-60.0, 60.0),
        ),
    ],
)
def test_the_curve_stays_on_wall_and_substrate_between_nodes(substrate, wall, range_):
    curve = intersect_implicit(wall, substrate, range_, even_grid(wall, 90)).curve
    refined = curve.at(curve.refined(10))[0]
    assert np.abs(substrate.value(curve.points)[0]).max() < 1e-11
    assert np.abs(substrate.value(refined)[0]).max() < 5e-5
    assert np.linalg.norm(wall.point(*wall.inverse(refined)) - refined, axis=1).max() < 5e-5


def test_a_wall_that_misses_the_substrate_is_rejected():
    with pytest.raises(InputError, match="rise out of the substrate") as caught:
        intersect_implicit(cylinder(40.0), PIPE, (-50.0, 50.0), even_grid(TORUS, 90))
    assert caught.value.code == "NO_INTERSECTION"


@pytest.mark.parametrize("order", [1, -1])
def test_a_polyline_gives_the_same_layer(order):
    exact = intersect_implicit(TORUS, PIPE, (0.0, 1.5), even_grid(TORUS, 360, 0.2))
    layer = interpolate_polyline(TORUS, exact.curve.points[:-1][::order])
    assert np.abs(exact.curve.nearest(layer.curve.at(layer.curve.refined(7))[0])[0]).max() < 1e-7
    assert not len(layer.curve.corners)


def test_corners_of_a_polyline_stay_corners():
    v = np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False)
    wall = cylinder(10.0)
    layer = interpolate_polyline(wall, wall.point(6.0 * np.abs(np.sin(v)), v))
    assert len(layer.curve.corners) == 2
    assert np.degrees(layer.curve.turns[layer.curve.corners]) == pytest.approx(
        2 * np.degrees([np.arctan(0.6)] * 2), abs=0.2
    )


def test_a_polyline_that_does_not_enclose_the_wall_is_rejected():
    v = np.linspace(0.0, 1.0, 20)
    there_and_back = np.r_[v, v[::-1] - 0.01]
    with pytest.raises(InputError, match="once around"):
        interpolate_polyline(TORUS, TORUS.point(0.1 + 0.0 * there_and_back, there_and_back))
