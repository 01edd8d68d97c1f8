# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points inside closed bodies against formulas; a nozzle wholly inside a body touches it."""

import numpy as np
import pytest

from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.inside import inside_of
from freecad_am.core.collision.scene import build_bodies
from freecad_am.core.geometry.obstacles import Body, disc

NOZZLE = Frustum(0.5, 0.36, 0.87, 60.0)
UP = np.array([[0.0, 0.0, 1.0]])


def rings(profile, sides=90, name="ring"):
    """A closed body of revolution about z from a counter-clockwise polygon of (radius, height)."""
    angle = 2 * np.pi * np.arange(sides) / sides
    count = len(profile)
    vertices = np.concatenate(
        [np.c_[r * np.cos(angle), r * np.sin(angle), np.full(sides, z)] for r, z in profile]
    )
    current, two = np.arange(sides), np.roll(np.arange(sides), -1)
    faces = []
    for k in range(count):
        a, b = k * sides, (k + 1) % count * sides
        faces += [
            np.stack([a + current, a + two, b + two], 1),
            np.stack([a + current, b + two, b + current], 1),
        ]
    return Body(name, vertices, np.concatenate(faces))


def cube(half, centre=(0.0, 0.0, 0.0)):
    vertices = (
        half * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
        + centre
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Body(
        "cube", vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    )


def together(*bodies):
    begin = np.cumsum([0, *(len(body.vertices) for body in bodies)])
    return Body(
        "all",
        np.concatenate([body.vertices for body in bodies]),
        np.concatenate([body.triangles + b for body, b in zip(bodies, begin)]),
    )


def pipe(inner, outer, half):
    return rings([(inner, -half), (outer, -half), (outer, half), (inner, half)])


def find_contacts(body, tip, axis=UP, nozzle=NOZZLE):
    tip = np.atleast_2d(np.asarray(tip, dtype=float))
    return build_bodies([body], tip, nozzle.reach).find_touching(
        nozzle, tip, np.broadcast_to(axis, tip.shape)
    )


def test_points_in_a_thick_pipe_and_in_overlapping_and_nested_cubes():
    rng = np.random.default_rng(2)
    points = rng.uniform(-60, 60, (20_000, 3))
    sides = 90
    turn = np.mod(np.arctan2(points[:, 1], points[:, 0]), 2 * np.pi / sides) - np.pi / sides
    radius = np.hypot(points[:, 0], points[:, 1]) * np.cos(turn) / np.cos(np.pi / sides)
    within = (radius > 20) & (radius < 50) & (np.abs(points[:, 2]) < 40)
    assert (
        inside_of(pipe(20.0, 50.0, 40.0)).holds(points) == within
    ).all() and 1000 < within.sum() < 19_000

    big = np.abs(points).max(axis=1) < 50
    shifted = np.abs(points - 20).max(axis=1) < 30
    small = np.abs(points).max(axis=1) < 20
    overlapping = together(cube(50.0), cube(30.0, (20.0, 20.0, 20.0)))
    assert (inside_of(overlapping).holds(points) == (big | shifted)).all()
    hollow = together(
        cube(50.0), Body("cavity", cube(20.0).vertices, cube(20.0).triangles[:, ::-1])
    )
    assert (inside_of(hollow).holds(points) == (big & ~small)).all()


def test_turned_over_triangles_and_bare_triangles_do_not_matter():
    rng = np.random.default_rng(4)
    points = rng.uniform(-60, 60, (5000, 3))
    solid = cube(50.0)
    turned = solid.triangles.copy()
    turned[[1, 4, 7]] = turned[[1, 4, 7], ::-1]
    loose = Body("loose", solid.corners().reshape(-1, 3), np.arange(36).reshape(-1, 3))
    truth = np.abs(points).max(axis=1) < 50
    for body in (
        Body("turned", solid.vertices, turned),
        Body("over", solid.vertices, solid.triangles[:, ::-1]),
        loose,
    ):
        assert (inside_of(body).holds(points) == truth).all()


@pytest.mark.parametrize(
    "place, inside",
    [
        ((0, 0, -30), True),
        ((150, -150, 100), True),
        ((0, 0, 200.2), False),
        ((0, 0, -261), False),
        ((223, 0, 0), False),
        ((210, 0, 0), True),
    ],
)
def test_a_nozzle_inside_a_big_cube_touches_it(place, inside):
    assert find_contacts(cube(200.0), place).item() == inside


def test_a_nozzle_in_the_bore_of_a_pipe_is_free_and_in_its_wall_is_not():
    thick = pipe(40.0, 140.0, 150.0)
    tips = [
        [0, 0, -20],
        [10, 5, 30],
        [90, 0, -20],
        [0, -90, 60],
        [30, 0, 0],
        [0, 0, 170],
        [170, 0, 0],
    ]
    assert find_contacts(thick, tips).tolist() == [False, False, True, True, True, False, False]


def test_a_body_with_an_opening_has_no_inside():
    solid = cube(200.0)
    opened = Body("open", solid.vertices, solid.triangles[:-1])
    assert inside_of(opened) is None and inside_of(disc(100.0, np.eye(4))) is None
    assert not find_contacts(opened, [0, 0, -30]).any()
    assert find_contacts(opened, [0, 0, 170]).all()


def test_random_nozzles_against_samples_of_them():
    """Contacts of random nozzles agree with points sampled on their surfaces."""
    rng = np.random.default_rng(6)
    axis = rng.normal(size=(400, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tip = rng.uniform(-160, 160, (400, 3))
    nozzle = Frustum(0.5, 0.3, 0.8, 20.0)
    contacts = find_contacts(cube(100.0), tip, axis, nozzle)
    side = np.cross(axis, np.roll(axis, 1, axis=1))
    side /= np.linalg.norm(side, axis=1)[:, None]
    second_side = np.cross(axis, side)
    height = np.linspace(0.81, 19.99, 40)
    angle = np.linspace(0, 2 * np.pi, 60)
    round_it = (
        np.cos(angle)[:, None] * side[:, None] + np.sin(angle)[:, None] * second_side[:, None]
    )
    skin = (
        tip[:, None, None]
        + height[:, None, None] * axis[:, None, None]
        + ((0.5 + 0.3 * height - 1e-3)[:, None, None] * round_it[:, None])
    )
    sampled = (np.abs(skin) < 100).all(axis=3).any(axis=(1, 2))
    inside = (np.abs(skin) < 100).all(axis=(1, 2, 3))
    assert contacts[sampled].all() and inside.sum() > 20
    assert not contacts[(np.abs(tip + 10 * axis) > 100 + 13).any(axis=1)].any()
