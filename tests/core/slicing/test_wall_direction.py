# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions on walls: what defines them, checked; limits of the turn, held everywhere at little cost."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Cone, Torus, normals
from freecad_am.core.issues import InputError
from freecad_am.core.slicing import wall_directions as wall_direction
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes import constant_distance
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid

TORUS = Torus(60.0, 15.0)


def on_layer(layer):
    """Local build directions (m, 3) at the nodes of a layer of the bend."""
    _, along, _ = TORUS.derivatives(layer.u, layer.v)
    return wall_direction.local_directions(
        normals(TORUS, layer.u, layer.v), layer.curve.into, layer.curve.out, along
    )


@pytest.fixture(scope="module")
def layers():
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    return constant_distance.layers(
        TORUS, intersect_implicit(TORUS, pipe, (0.0, 1.5), even_grid(TORUS, 360)), 5.0, np.pi / 2
    )


def test_local_directions_are_tangent_to_the_wall_and_normal_to_the_bead(layers):
    for layer in layers:
        build = on_layer(layer)
        smooth = layer.curve.turns < 1e-6
        smooth[-1] = smooth[0]
        _, along, _ = TORUS.derivatives(layer.u, layer.v)
        assert np.linalg.norm(build, axis=1) == pytest.approx(1.0)
        assert (build * normals(TORUS, layer.u, layer.v)).sum(axis=1) == pytest.approx(
            0.0, abs=1e-12
        )
        tangent = layer.curve.out / np.linalg.norm(layer.curve.out, axis=1, keepdims=True)
        assert (build * tangent).sum(axis=1)[smooth] == pytest.approx(0.0, abs=1e-9)
        assert (build * along).sum(axis=1).min() > 0.0


def test_local_directions_point_away_from_the_nearest_point_below(layers):
    """A front moves at right angles to itself: the way from the foot, brought into the wall, is the direction."""
    below, above = layers[1:3]
    build = on_layer(above)
    way = above.curve.points - below.curve.nearest(above.curve.points)[1]
    normal = normals(TORUS, above.u, above.v)
    way = way - (way * normal).sum(axis=1)[:, None] * normal
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    assert np.abs(build - way).max() < 1e-7


def test_at_a_corner_the_direction_is_the_bisector(layers):
    """By symmetry it lies in the plane Y = 0, along the bend."""
    build = on_layer(layers[-1])[0]
    u = layers[-1].u[0]
    assert build == pytest.approx([-np.sin(u), 0.0, np.cos(u)], abs=1e-6)


def test_projected_directions_turn_about_one_axis_only(layers):
    build = on_layer(layers[-1])
    flat = wall_direction.project_onto_plane(build, np.array([0.0, 1.0, 0.0]))
    assert flat[:, 1] == pytest.approx(0.0, abs=1e-15)
    assert np.linalg.norm(flat, axis=1) == pytest.approx(1.0)
    assert np.cross(flat, build)[:, [0, 2]] == pytest.approx(
        -build[:, [1]] * flat[:, [2, 0]] * [1, -1], abs=1e-12
    )
    with pytest.raises(InputError, match="plane of symmetry"):
        wall_direction.project_onto_plane(np.array([[0.0, 1.0, 0.0]]), np.array([0.0, 1.0, 0.0]))


def test_the_tool_axis_leads_and_tilts_by_the_angles_asked():
    """A plate run outwards has every direction at hand: build up the radius, outside up the axis."""
    rng = np.random.default_rng(2)
    wall = Cone(20.0, 0.4)
    u, v = rng.uniform(0, 9, 50), rng.uniform(-3, 3, 50)
    _, build, around = wall.derivatives(u, v)
    tangent = around / np.linalg.norm(around, axis=1, keepdims=True)
    outside = np.cross(tangent, build)
    tool = wall_direction.lean_tool(build, tangent, outside, 0.3, 0.2)
    assert np.arcsin((tool * outside).sum(axis=1)) == pytest.approx(0.2)
    assert np.arctan2((tool * tangent).sum(axis=1), (tool * build).sum(axis=1)) == pytest.approx(
        0.3
    )
    assert wall_direction.lean_tool(build, tangent, outside, 0.0, 0.0) is build


@pytest.mark.parametrize("degrees", [1.0, 2.0, 6.0])
def test_the_turn_stays_below_its_limit_and_departs_no_farther_than_told(layers, degrees):
    curve, rate = layers[-1].curve, np.radians(degrees)
    build = on_layer(layers[-1])
    assert wall_direction.turn_rates(curve.points, build).max() > 5.0 * rate
    found, departure = wall_direction.limit_turns(curve.points, build, True, rate)
    assert wall_direction.turn_rates(curve.points, found).max() <= rate
    assert found[0] == pytest.approx(found[-1], abs=1e-12)
    assert np.cos(departure) == pytest.approx((found * build).sum(axis=1), abs=1e-12)
    # the jump at the corner is twice the largest departure at least, but no more than the jump itself
    assert 0.1 < departure.max() < np.radians(100.0)
    if degrees == 6.0:
        assert (departure == 0.0).mean() > 0.4  # far from the corner nothing is touched


def test_a_sharp_jump_on_a_straight_open_bead():
    points = np.linspace(0.0, 100.0, 401)[:, None] * [1.0, 0.0, 0.0]
    build = np.where(
        points[:, :1] < 60.0, [0.0, np.sin(0.5), np.cos(0.5)], [0.0, -np.sin(0.5), np.cos(0.5)]
    )
    found, departure = wall_direction.limit_turns(points, build, False, 0.1)
    assert wall_direction.turn_rates(points, found).max() <= 0.1
    touched = points[departure > 1e-9, 0]
    # no curve of that turn does it in less than 10 mm; ours needs no more than three times that
    assert 10.0 <= np.ptp(touched) <= 30.0
    assert touched.min() > 60.0 - 15.0 and touched.max() < 60.0 + 15.0
    easy = wall_direction.limit_turns(points, found, False, 0.11)
    assert easy.directions is found and not easy.departure.any()


def test_directions_beyond_the_level_stay_below_both_limits():
    """Turned back to a cone beyond the level directions turn faster, and means of those on it lean over more."""
    most, rate = np.radians(100.0), np.radians(3.0)
    points = np.linspace(0.0, 100.0, 401)[:, None] * [1.0, 0.0, 0.0]
    azimuth = np.where(points[:, 0] < 60.0, 0.0, 1.2)
    build = np.stack(
        [np.sin(1.9) * np.cos(azimuth), np.sin(1.9) * np.sin(azimuth), np.full(401, np.cos(1.9))],
        axis=1,
    )
    start, _ = wall_direction.cap_lean(build, most)
    found, _ = wall_direction.limit_turns(points, start, False, rate, max_lean=most)
    assert wall_direction.turn_rates(points, found).max() <= rate
    assert np.arccos(found[:, 2]).max() <= most + 1e-9
    loose, _ = wall_direction.limit_turns(points, start, False, rate)
    assert np.arccos(loose[:, 2]).max() > most + 1e-3


def test_a_limit_that_cannot_be_kept_is_refused():
    angle = np.linspace(0.0, 2.0 * np.pi, 101)
    circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    with pytest.raises(InputError, match="mode fixed") as refused:
        wall_direction.limit_turns(10.0 * circle, circle, True, 0.05)
    assert refused.value.code == "TURN_LIMIT"


def test_a_short_bead_gets_the_mean_of_all_of_it_before_it_is_refused():
    """As one of a real wall, of 1.04 mm, which turns by 30 deg at one end; its mean has a direction."""
    points = np.linspace(0.0, 1.04, 26)[:, None] * [1.0, 0.0, 0.0]
    angle = np.radians(
        np.where(np.arange(26) < 5, -18.0 - np.arange(26), 10.0 - 0.45 * np.arange(26))
    )
    build = np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], axis=1)
    rate = np.radians(20.0)
    found, departure = wall_direction.limit_turns(points, build, False, rate)
    assert wall_direction.turn_rates(points, found).max() <= rate
    assert 0.1 < departure.max() < 0.5


def test_directions_that_lean_over_too_far_are_turned_back_to_the_limit_alone():
    angle = np.linspace(0.0, 2.5, 26)
    leaning = np.stack([np.sin(angle) * 0.6, np.sin(angle) * 0.8, np.cos(angle)], axis=1)
    found, back = wall_direction.cap_lean(leaning, 1.0)
    assert back == pytest.approx(1.5)
    assert np.arccos(found[:, 2]) == pytest.approx(np.minimum(angle, 1.0))
    assert np.cross(found, leaning)[:, 2] == pytest.approx(
        0.0, abs=1e-12
    )  # in the same plane with the vertical
    assert wall_direction.cap_lean(leaning, 2.6)[0] is leaning
