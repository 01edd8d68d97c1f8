# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances from planned surfaces against closed forms."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall
from freecad_am.core.inspection.planned import (
    revolution_surface,
    sided,
    toolpath_surface,
    triangle_surface,
)
from freecad_am.core.issues import InputError
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from tests.core.inspection_parts import R0, funnel, hemisphere, sampled


def test_a_hemisphere_is_as_far_as_its_radius_tells():
    """The distance from a hemisphere is the radius of the point minus that of the hemisphere."""
    rng = np.random.default_rng(1)
    points = rng.normal(size=(4000, 3))
    points[:, 2] = np.abs(points[:, 2])
    points *= (rng.uniform(20.0, 80.0, 4000) / np.linalg.norm(points, axis=1))[:, None]
    surface_of_dome = revolution_surface(hemisphere())
    radius = np.linalg.norm(points, axis=1)
    for surface in (surface_of_dome.exact, surface_of_dome.nearest):
        distance, normal = surface(points)
        assert np.abs(distance - (radius - R0)).max() < 1e-9
        assert np.abs(normal - points / radius[:, None]).max() < 1e-7
    assert (surface_of_dome.past(points) == 0.0).all() and surface_of_dome.within_edges(
        points
    ).all()
    below = points * [1.0, 1.0, -1.0]
    foot = below * [1.0, 1.0, 0.0]
    foot *= (R0 / np.linalg.norm(foot, axis=1))[:, None]
    assert (
        np.abs(
            np.abs(surface_of_dome.nearest(below)[0]) - np.linalg.norm(below - foot, axis=1)
        ).max()
        < 1e-9
    )
    assert np.abs(surface_of_dome.past(below) + below[:, 2]).max() < 1e-9  # distance below the base
    assert (
        np.abs(surface_of_dome.exact(below)[0] - (np.hypot(below[:, 0], below[:, 1]) - R0)).max()
        < 1e-9
    )


def test_walls_in_any_frame_keep_offsets_along_normals():
    """Walls in any frame return offsets along their normals."""
    rng = np.random.default_rng(2)
    wall = funnel()
    points, normal = sampled(wall, rng, 3000)
    offset = rng.uniform(-3.0, 3.0, 3000)
    distance, normals = revolution_surface(wall).exact(points + offset[:, None] * normal)
    assert np.abs(distance - offset).max() < 1e-8
    assert np.abs(normals - normal).max() < 1e-6


def test_a_corner_is_nearest_to_all_between_its_normals():
    """A cylinder of 20 mm with a flat roof: outside the corner the distance is that from its
    circle."""
    up, down = np.array([0.0, 1.0]), np.array([-1.0, 0.0])
    meridian = Meridian.chained(
        [
            (np.array([[20.0, 0.0], [20.0, 30.0]]), np.array([up, up])),
            (np.array([[20.0, 30.0], [0.0, 30.0]]), np.array([down, down])),
        ]
    )
    surface = revolution_surface(RevolvedWall(meridian, np.eye(4)))
    rng = np.random.default_rng(3)
    angle, r, z = (
        rng.uniform(0, 2 * np.pi, 500),
        rng.uniform(20.0, 30.0, 500),
        rng.uniform(30.0, 40.0, 500),
    )
    points = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    distance, normal = surface.exact(points)
    assert np.abs(distance - np.hypot(r - 20.0, z - 30.0)).max() < 1e-6
    outward = (
        np.column_stack([(r - 20.0) * np.cos(angle), (r - 20.0) * np.sin(angle), z - 30.0])
        / distance[:, None]
    )
    assert np.abs(normal - outward).max() < 1e-3


def test_past_the_sides_of_part_of_a_turn():
    surface = revolution_surface(hemisphere(0.0, np.pi, False))
    probes = np.array(
        [[40.0, -2.0, 10.0], [40.0, 2.0, 10.0], [-40.0, -5.0, 10.0], [0.0, -45.0, 0.0]]
    )
    assert surface.past(probes) == pytest.approx([2.0, 0.0, 5.0, 45.0], abs=0.2)
    assert list(surface.within_edges(probes)) == [False, True, False, False]


def test_sides_of_a_wall_are_half_a_thickness_off():
    surface = revolution_surface(hemisphere())
    rng = np.random.default_rng(4)
    points, normal = sampled(hemisphere(), rng, 200)
    for side, offset in (("outer", 2.0), ("inner", -2.0)):
        distance, normals = sided(surface.exact, side, 3.0)(points + offset * normal)
        assert distance == pytest.approx(0.5, abs=1e-8)
        assert np.abs(normals - np.sign(offset) * normal).max() < 1e-6
    both_sides = np.concatenate([points + 1.6 * normal, points - 1.3 * normal])
    assert sided(surface.exact, "both", 3.0)(both_sides)[0] == pytest.approx(
        np.repeat([0.1, -0.2], 200), abs=1e-8
    )


def test_triangles_of_a_box_are_exact_and_never_end():
    """Distances from the triangles of a box are exact, and a closed surface has no edge."""
    corners = np.array([[x, y, z] for x in (0.0, 60.0) for y in (0.0, 40.0) for z in (0.0, 20.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    surface = triangle_surface("box", corners, triangles)
    points = np.random.default_rng(5).uniform(-15.0, 75.0, (2000, 3))
    out = np.abs(points - [30.0, 20.0, 10.0]) - [30.0, 20.0, 10.0]
    exact = np.linalg.norm(np.maximum(out, 0.0), axis=1) + np.minimum(out.max(axis=1), 0.0)
    distance, normal = surface.exact(points)
    assert np.abs(distance - exact).max() < 1e-9
    step = 1e-5
    assert np.abs(surface.exact(points + step * normal)[0] - distance - step).max() < 1e-9
    assert surface.within_edges(points).all()


def rings(layer_height, radius=30.0):
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    layers = []
    for number in range(12):
        turn = angle if number % 2 else angle[::-1]
        points = np.column_stack(
            [radius * np.cos(turn), radius * np.sin(turn), np.full(181, layer_height * number)]
        )
        up = np.tile([0.0, 0.0, 1.0], (181, 1))
        layers.append(Layer((Bead(points, up, up, turn, np.full(181, 6.0), True),)))
    return layers


def test_beads_of_a_pipe_are_its_surface_whichever_way_they_run():
    """The beads of a pipe represent its surface in either direction of travel."""
    toolpath = Toolpath(tuple(rings(2.0)), np.eye(4), 2.0, 0.01)
    surface = toolpath_surface(toolpath, "Toolpath")
    rng = np.random.default_rng(6)
    angle, height, off = (
        rng.uniform(0, 2 * np.pi, 1000),
        rng.uniform(0.0, 22.0, 1000),
        rng.uniform(-2.0, 2.0, 1000),
    )
    points = np.column_stack([(30.0 + off) * np.cos(angle), (30.0 + off) * np.sin(angle), height])
    distance, normal = surface.exact(points)
    assert np.abs(distance - off).max() < 1e-3
    assert np.abs(normal[:, 2]).max() < 1e-9 and (normal * points).sum(axis=1).min() > 29.0 * 0.9
    assert (
        surface.within_edges(points).all()
        and not surface.within_edges(points + [0.0, 0.0, 40.0]).any()
    )


@pytest.mark.parametrize("sense", [1, -1])
def test_normals_of_beads_are_those_of_the_wall_they_make(sense):
    """A funnel with a flat end, its layers in either direction: the sides agree with its
    meridian."""
    wall = funnel()
    angle = sense * np.linspace(0.0, 2.0 * np.pi, 181)
    layers = []
    for s in np.linspace(0.0, wall.meridian.length, 30):
        radius, height, tangent = wall.meridian.at(np.full(181, s))
        build = wall.directions(
            np.column_stack([tangent[:, 0], np.zeros(181), tangent[:, 1]]), angle
        )
        layers.append(
            Layer(
                (
                    Bead(
                        wall.points(radius, height, angle),
                        build,
                        build,
                        angle,
                        np.full(181, 6.0),
                        True,
                    ),
                )
            )
        )
    beads = toolpath_surface(Toolpath(tuple(layers), wall.frame, 2.4, 0.01), "Toolpath")
    points, normal = sampled(wall, np.random.default_rng(7), 2000)
    off = np.random.default_rng(8).uniform(-2.0, 2.0, 2000)
    distance, bead_normals = beads.exact(points + off[:, None] * normal)
    assert (
        np.abs(distance - off).max() < 2.4**2 / 8.0 / R0 + 0.06
    )  # chord error of the layers, and normals of half a layer away
    assert (bead_normals * normal).sum(axis=1).min() > 0.99


def test_beads_that_fill_solids_are_no_surface():
    toolpath = Toolpath(tuple(rings(2.0)), np.eye(4), 2.0, 0.01, family="developable")
    with pytest.raises(InputError) as caught:
        toolpath_surface(toolpath, "Toolpath")
    assert (caught.value.code, caught.value.where) == ("NOT_FOR_FAMILY", "Toolpath")
