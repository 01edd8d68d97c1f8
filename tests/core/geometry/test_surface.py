# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls: derivatives against differences, inverse against points off the wall, tables against the
tabulated wall."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.walls.surface import Cone, Torus, cylinder, normals
from freecad_am.core.geometry.walls.surface_wall import Tabulated

TORUS = Torus(60.0, 15.0)


def table(rows=120, columns=180):
    u, v = np.linspace(-0.3, 2.0, rows), np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False)
    return Tabulated(u, v, TORUS.point(*np.meshgrid(u, v, indexing="ij")), 2.0 * np.pi)


WALLS = [TORUS, Cone(20.0, 0.4), Cone(20.0, np.pi / 2), cylinder(12.0), table()]


def somewhere(n=200):
    rng = np.random.default_rng(3)
    return rng.uniform(0.1, 1.5, n), rng.uniform(-3.1, 3.1, n)


@pytest.mark.parametrize("wall", WALLS, ids=lambda wall: type(wall).__name__)
def test_derivatives_are_those_of_the_points(wall):
    u, v = somewhere()
    point, along, around = wall.derivatives(u, v)
    step = 1e-5
    assert point == pytest.approx(wall.point(u, v), abs=1e-12)
    assert along == pytest.approx(
        (wall.point(u + step, v) - wall.point(u - step, v)) / (2 * step), abs=1e-6
    )
    assert around == pytest.approx(
        (wall.point(u, v + step) - wall.point(u, v - step)) / (2 * step), abs=1e-6
    )
    assert wall.point(u, v + wall.period) == pytest.approx(point, abs=1e-9)


@pytest.mark.parametrize("wall", WALLS, ids=lambda wall: type(wall).__name__)
def test_the_inverse_finds_the_foot_of_a_point_off_the_wall(wall):
    """The inverse returns the closest point for a point off the wall."""
    u, v = somewhere()
    off = np.random.default_rng(4).uniform(-2.0, 2.0, len(u))
    parameters = wall.inverse(wall.point(u, v) + off[:, None] * normals(wall, u, v))
    assert parameters[0] == pytest.approx(u, abs=1e-9)
    assert parameters[1] == pytest.approx(v, abs=1e-9)


def test_the_torus_turns_about_a_line_parallel_to_y():
    """Errata: the axis runs through (-R, 0, 0); the tube starts upwards in the plane Z = 0."""
    u, v = somewhere()
    x, y, z = TORUS.point(u, v).T
    assert (np.hypot(x + 60.0, z) - 60.0) ** 2 + y**2 == pytest.approx(np.full(len(u), 225.0))
    assert TORUS.point(0.0, 0.0) == pytest.approx([15.0, 0.0, 0.0])


def test_a_table_comes_near_its_wall_with_the_fourth_power_and_goes_on_straight_beyond_it():
    u, v = somewhere()
    coarse, fine = (np.abs(table(n, n).point(u, v) - TORUS.point(u, v)).max() for n in (40, 80))
    assert fine < coarse / 12.0
    wall = table()
    end = wall.derivatives(np.full(5, 2.0), np.arange(5.0))
    assert wall.point(np.full(5, 2.5), np.arange(5.0)) == pytest.approx(end[0] + 0.5 * end[1])
    with pytest.raises(ValueError, match="table"):
        Tabulated(np.arange(3.0), np.arange(5.0), np.zeros((3, 5, 3)))


@pytest.mark.parametrize(
    "solid, point",
    [
        (Round.cylinder(5.0, [1, 2, 3], [0, 2, 0]), [6, 40, 3]),
        (Round.sphere(5.0, [1, 2, 3]), [1, 6, 6]),
        (Round.cone(np.pi / 4, [0, 0, 1], [0, 0, -1]), [3, 4, -4]),
        (HalfSpace(np.array([0, 0, 2.0]), np.array([0, 0, 3.0])), [7, 7, 2]),
    ],
)
def test_solids_are_negative_inside_and_know_their_gradient(solid, point):
    point = np.array([point], dtype=float)
    value, gradient = solid.value(point)
    assert value == pytest.approx([0.0], abs=1e-12)
    step = 1e-6 * np.eye(3)
    numeric = (solid.value(point + step)[0] - solid.value(point - step)[0]) / 2e-6
    assert gradient[0] == pytest.approx(numeric, abs=1e-8)
    assert solid.value(point - 0.1 * gradient)[0] < 0.0
