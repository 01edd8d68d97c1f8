# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions on walls: their defining properties, and limits of the turn that every point
keeps with a small departure."""

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


def local_directions_of_layer(layer):
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
        build = local_directions_of_layer(layer)
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


def test_local_directions_point_away_from_the_closest_point_below(layers):
    """A front moves at right angles to itself, so the vector from the closest point, projected into
    the wall, is the direction."""
    below, above = layers[1:3]
    build = local_directions_of_layer(above)
    direction = above.curve.points - below.curve.nearest(above.curve.points)[1]
    normal = normals(TORUS, above.u, above.v)
    direction = direction - (direction * normal).sum(axis=1)[:, None] * normal
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    assert np.abs(build - direction).max() < 1e-7


def test_at_a_corner_the_direction_is_the_bisector(layers):
    """By symmetry the direction is in the plane Y = 0, along the bend."""
    build = local_directions_of_layer(layers[-1])[0]
    u = layers[-1].u[0]
    assert build == pytest.approx([-np.sin(u), 0.0, np.cos(u)], abs=1e-6)


def test_projected_directions_turn_about_one_axis_only(layers):
    build = local_directions_of_layer(layers[-1])
    flat = wall_direction.project_onto_plane(build, np.array([0.0, 1.0, 0.0]))
    assert flat[:, 1] == pytest.approx(0.0, abs=1e-15)
    assert np.linalg.norm(flat, axis=1) == pytest.approx(1.0)
    assert np.cross(flat, build)[:, [0, 2]] == pytest.approx(
        -build[:, [1]] * flat[:, [2, 0]] * [1, -1], abs=1e-12
    )
    with pytest.raises(InputError, match="plane of symmetry"):
        wall_direction.project_onto_plane(np.array([[0.0, 1.0, 0.0]]), np.array([0.0, 1.0, 0.0]))


def test_the_tool_axis_has_the_requested_lead_and_tilt():
    """A cone built outwards provides all directions: build direction along the flank, outside along
    the axis."""
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
def test_the_turn_keeps_its_limit_and_reports_its_departure(layers, degrees):
    curve, rate = layers[-1].curve, np.radians(degrees)
    build = local_directions_of_layer(layers[-1])
    assert wall_direction.turn_rates(curve.points, build).max() > 5.0 * rate
    limited, departure = wall_direction.limit_turns(curve.points, build, True, rate)
    assert wall_direction.turn_rates(curve.points, limited).max() <= rate
    assert limited[0] == pytest.approx(limited[-1], abs=1e-12)
    assert np.cos(departure) == pytest.approx((limited * build).sum(axis=1), abs=1e-12)
    # a jump needs a departure of at least half its angle, and at most the angle
    assert 0.1 < departure.max() < np.radians(100.0)
    if degrees == 6.0:
        assert (departure == 0.0).mean() > 0.4  # directions far from the corner stay


def test_a_jump_on_a_straight_open_bead_is_spread():
    points = np.linspace(0.0, 100.0, 401)[:, None] * [1.0, 0.0, 0.0]
    build = np.where(
        points[:, :1] < 60.0, [0.0, np.sin(0.5), np.cos(0.5)], [0.0, -np.sin(0.5), np.cos(0.5)]
    )
    limited, departure = wall_direction.limit_turns(points, build, False, 0.1)
    assert wall_direction.turn_rates(points, limited).max() <= 0.1
    changed = points[departure > 1e-9, 0]
    # the shortest possible transition is 10 mm; ours takes at most three times as long
    assert 10.0 <= np.ptp(changed) <= 30.0
    assert changed.min() > 60.0 - 15.0 and changed.max() < 60.0 + 15.0
    relaxed = wall_direction.limit_turns(points, limited, False, 0.11)
    assert relaxed.directions is limited and not relaxed.departure.any()


def test_directions_below_horizontal_keep_both_limits():
    """Below horizontal, reducing the lean to a cone makes directions turn faster, and their means
    exceed the cone."""
    max_lean, rate = np.radians(100.0), np.radians(3.0)
    points = np.linspace(0.0, 100.0, 401)[:, None] * [1.0, 0.0, 0.0]
    azimuth = np.where(points[:, 0] < 60.0, 0.0, 1.2)
    build = np.stack(
        [np.sin(1.9) * np.cos(azimuth), np.sin(1.9) * np.sin(azimuth), np.full(401, np.cos(1.9))],
        axis=1,
    )
    start, _ = wall_direction.cap_lean(build, max_lean)
    limited, _ = wall_direction.limit_turns(points, start, False, rate, max_lean=max_lean)
    assert wall_direction.turn_rates(points, limited).max() <= rate
    assert np.arccos(limited[:, 2]).max() <= max_lean + 1e-9
    without_lean_limit, _ = wall_direction.limit_turns(points, start, False, rate)
    assert np.arccos(without_lean_limit[:, 2]).max() > max_lean + 1e-3


def test_an_infeasible_limit_is_rejected():
    angle = np.linspace(0.0, 2.0 * np.pi, 101)
    circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    with pytest.raises(InputError, match="mode fixed") as caught:
        wall_direction.limit_turns(10.0 * circle, circle, True, 0.05)
    assert caught.value.code == "TURN_LIMIT"


def test_a_short_bead_gets_its_mean_direction():
    """Modelled on a bead of 1.04 mm in a real wall that turns by 30 deg at one end; its mean has a
    direction."""
    points = np.linspace(0.0, 1.04, 26)[:, None] * [1.0, 0.0, 0.0]
    angle = np.radians(
        np.where(np.arange(26) < 5, -18.0 - np.arange(26), 10.0 - 0.45 * np.arange(26))
    )
    build = np.stack([np.sin(angle), 0.0 * angle, np.cos(angle)], axis=1)
    rate = np.radians(20.0)
    limited, departure = wall_direction.limit_turns(points, build, False, rate)
    assert wall_direction.turn_rates(points, limited).max() <= rate
    assert 0.1 < departure.max() < 0.5


def test_excessive_lean_is_reduced_to_its_limit():
    angle = np.linspace(0.0, 2.5, 26)
    leaning = np.stack([np.sin(angle) * 0.6, np.sin(angle) * 0.8, np.cos(angle)], axis=1)
    capped, reduction = wall_direction.cap_lean(leaning, 1.0)
    assert reduction == pytest.approx(1.5)
    assert np.arccos(capped[:, 2]) == pytest.approx(np.minimum(angle, 1.0))
    assert np.cross(capped, leaning)[:, 2] == pytest.approx(
        0.0, abs=1e-12
    )  # in the same plane with the vertical
    assert wall_direction.cap_lean(leaning, 2.6)[0] is leaning
