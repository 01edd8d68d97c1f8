# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls from open meshes: layers compared with the source of the mesh, starts, repairs,
refusals."""

import Mesh
import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.brep.walls.wall_on import wall_on
from freecad_am.core.geometry.mesh.coarsen import SmoothMesh
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.strategies.walls import fronts as wall_fronts

pytestmark = pytest.mark.any_version

SIDES = 60


def cone_mesh(low, high, height, rows=12, sides=SIDES, floor=False):
    """Return points and triangles of a cone's side from radius `low` at z = 0 to `high`, open at
    both ends or closed by a floor."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    z = np.linspace(0.0, height, rows + 1)
    radius = np.linspace(low, high, rows + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate(
        [np.column_stack([r * ring, np.full(sides, h)]) for r, h in zip(radius, z)]
    )
    faces = []
    for row in range(rows):
        for k in range(sides):
            a, b = row * sides + k, row * sides + (k + 1) % sides
            faces += [(a, b, a + sides), (b, b + sides, a + sides)]
    if floor:
        points = np.vstack([points, [[0.0, 0.0, 0.0]]])
        faces += [(len(points) - 1, (k + 1) % sides, k) for k in range(sides)]
    return points, np.array(faces, dtype=np.int64)


def wall(points, faces, height=4.0, substrate=None, edges=(), mend=5.0):
    return wall_on(Body("Vase", points, faces), (), substrate, height, "Vase", "Block", edges, mend)


def layers(mesh_wall, height=4.0):
    return wall_fronts.plan(
        mesh_wall,
        SurfaceParameters(layer_height=height, chord_error=0.05),
        BuildDirectionParameters(),
        ProcessParameters(),
    ).layers


def codes(mesh_wall):
    return [issue.code for issue in mesh_wall.issues]


def test_the_smooth_surface_of_a_cylinders_mesh_is_the_cylinder():
    points, faces = cone_mesh(30.0, 30.0, 60.0, rows=30, sides=90)
    rng = np.random.default_rng(4)
    angle, r, z = (
        rng.uniform(0.0, 6.28, 400),
        rng.uniform(28.0, 32.0, 400),
        rng.uniform(8.0, 52.0, 400),
    )
    queries = np.column_stack([r * np.cos(angle), r * np.sin(angle), z])
    projected, normals = SmoothMesh(points, faces, 2.0).project(queries)
    assert np.abs(np.hypot(*projected[:, :2].T) - 30.0).max() < 5e-4
    out = projected * [1.0, 1.0, 0.0] / 30.0
    assert np.abs(np.einsum("ij,ij->i", normals, out) - 1.0).max() < 1e-5
    again, _ = SmoothMesh(points, faces, 2.0).project(projected)
    assert np.abs(again - projected).max() < 1e-9


@pytest.mark.parametrize("flip", [False, True])
def test_a_vase_on_the_platform(flip):
    """Layers of a cone are a layer height apart along its side, and each has the length of the
    cone's circle."""
    points, faces = cone_mesh(20.0, 35.0, 40.0)
    if flip:
        faces = faces.copy()
        faces[::5] = faces[::5, ::-1]
    mesh_wall = wall(points, faces)
    assert "FIRST_LAYER" in codes(mesh_wall) and ("MESH_REPAIRED" in codes(mesh_wall)) == flip
    wall_layers = layers(mesh_wall)
    side = np.hypot(15.0, 40.0)
    assert len(wall_layers) == int(side / 4.0) + 1
    sagitta = 35.0 * (1.0 - np.cos(np.pi / SIDES))
    for k, layer in enumerate(wall_layers):
        assert len(layer.beads) == 1 and layer.beads[0].closed
        bead_points = layer.beads[0].points
        share = 4.0 * k / side
        assert np.abs(bead_points[:, 2] - 40.0 * share).max() < 0.05
        radius = np.hypot(bead_points[:, 0], bead_points[:, 1])
        assert np.abs(radius - (20.0 + 15.0 * share)).max() < sagitta + 0.05
        assert layer.beads[0].build[:, 2] == pytest.approx(40.0 / side, abs=0.02)


def test_a_cup_starts_above_its_floor_and_what_stands_on_its_tip_nowhere():
    points, faces = cone_mesh(20.0, 20.0, 30.0, floor=True)
    mesh_wall = wall(points, faces)
    assert "floor" in " ".join(issue.message for issue in mesh_wall.issues)
    heights = [bead.points[:, 2] for layer in layers(mesh_wall) for bead in layer.beads]
    assert min(z.min() for z in heights) == pytest.approx(2.0, abs=0.1) and len(heights) == 8
    tips = 20.0 * np.array(
        [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float
    )
    sides = [(k, (k + 1) % 4, 4) for k in range(4)] + [((k + 1) % 4, k, 5) for k in range(4)]
    with pytest.raises(InputError) as caught:
        wall(tips, np.array(sides, dtype=np.int64))
    assert caught.value.code == "NO_START"


def test_open_ends_are_edges_by_their_height():
    points, faces = cone_mesh(20.0, 30.0, 40.0)
    down = layers(wall(points, faces, edges=("Edge2",)))
    assert down[0].beads[0].points[:, 2] == pytest.approx(40.0, abs=0.05)
    assert down[-1].beads[0].points[:, 2].max() < 4.0
    with pytest.raises(InputError) as caught:
        wall(points, faces, edges=("Edge3",))
    assert caught.value.code == "UNKNOWN_EDGE" and "Edge2 at (0, 0, 40" in caught.value.message


@pytest.mark.parametrize("scan", [False, True])
def test_on_a_substrate_what_lies_in_it_is_not_deposited(scan):
    points, faces = cone_mesh(20.0, 20.0, 40.0)
    block = Part.makeBox(60, 60, 20, Vector(-30, -30, -10))
    mesh_wall = wall(points, faces, substrate=Mesh.Mesh(block.tessellate(1.0)) if scan else block)
    wall_layers = layers(mesh_wall)
    for k, layer in enumerate(wall_layers):
        assert layer.beads[0].points[:, 2] == pytest.approx(10.0 + 4.0 * k, abs=0.05)
    assert len(wall_layers) == 8


def test_small_holes_are_closed_and_the_ends_are_not():
    points, faces = cone_mesh(20.0, 20.0, 40.0, rows=20)
    gone = (faces == 10 * SIDES + 3).any(axis=1)
    mesh_wall = wall(points, faces[~gone], mend=6.0)
    assert "MENDED" in codes(mesh_wall) and "1 holes were closed" in " ".join(
        issue.message for issue in mesh_wall.issues
    )
    assert [len(layer.beads) for layer in layers(mesh_wall)] == [1] * 11
    assert "MENDED" not in codes(wall(points, faces[~gone], mend=1.0))
    assert "MENDED" not in codes(wall(*cone_mesh(1.0, 1.0, 30.0, sides=12), height=1.0))


def test_pieces_that_nothing_starts_on_and_walls_that_cut_themselves_are_refused():
    points, faces = cone_mesh(20.0, 20.0, 40.0)
    above = np.vstack([points, points + [0.0, 0.0, 60.0]])
    with pytest.raises(InputError) as caught:
        wall(above, np.vstack([faces, faces + len(points)]))
    assert caught.value.code == "GAP" and "60" in caught.value.message
    aside = np.vstack([points, points + [25.0, 0.0, 0.0]])
    with pytest.raises(InputError) as caught:
        wall(aside, np.vstack([faces, faces + len(points)]))
    assert caught.value.code == "SELF_INTERSECTION"
    with pytest.raises(InputError) as caught:
        wall(points, faces, height=0.01)
    assert caught.value.code == "TOO_FINE"


def test_facets_that_cross_in_one_place_are_cut_out_and_what_cuts_itself_farther_is_refused():
    """Two vertices of a tube are pulled out, one of them under the facets of the other; next to the
    end of the tube the intended shape is unknown."""
    points, faces = cone_mesh(20.0, 20.0, 40.0, rows=20)

    def crossed(row):
        moved = points.copy()
        for up, out, column_ in ((0, 20.3, 2), (2, 21.0, 2)):
            vertex = (row + up) * SIDES + 3
            moved[vertex] = [
                *(moved[vertex, :2] * out / 20.0),
                moved[row * SIDES, 2] + 2.0 * column_,
            ]
        return moved

    mesh_wall = wall(crossed(10), faces, mend=8.0)
    messages = " ".join(issue.message for issue in mesh_wall.issues if issue.code == "MENDED")
    assert (
        "8 intersecting triangles were removed, as at (" in messages
        and "leaving holes up to 7.4 mm across" in messages
    )
    wall_layers = layers(mesh_wall)
    assert [len(layer.beads) for layer in wall_layers] == [1] * 11
    radii = np.concatenate([np.hypot(*layer.beads[0].points[:, :2].T) for layer in wall_layers])
    assert radii.min() > 19.9 and radii.max() < 21.0 and np.median(np.abs(radii - 20.0)) < 0.02
    for bad, mend in ((crossed(10), 7.0), (crossed(18), 8.0)):
        with pytest.raises(InputError) as caught:
            wall(bad, faces, mend=mend)
        assert (
            caught.value.code == "SELF_INTERSECTION"
            and "6 pairs of triangles cross" in caught.value.message
        )


def test_large_facets_are_followed_where_they_meet():
    """A drum of 40 facets of 30 to 70 mm that meet at 10 to 20 deg: edges of the mesh once ran
    across these borders, up to 0.7 mm off, and beads with them."""
    points, faces = cone_mesh(60.0, 60.0, 80.0, rows=2, sides=20)
    angle = 1.5 * np.pi / 10.0 * points[:, 2] / 40.0
    x, y = points[:, 0].copy(), points[:, 1].copy()
    points[:, 0], points[:, 1] = (
        x * np.cos(angle) - y * np.sin(angle),
        x * np.sin(angle) + y * np.cos(angle),
    )
    mesh_wall = wall(points, faces)
    share = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12.0
    samples = np.einsum("sk,mkc->msc", share, points[faces]).reshape(-1, 3)
    distances = np.linalg.norm(mesh_wall.smooth.project(samples)[0] - samples, axis=1)
    assert distances.max() < 0.25 and distances.max() < mesh_wall.smoothing + 0.05
    assert "SMOOTHED" in codes(mesh_wall)


def lying_bend(sides=60, rows=24):
    """Return points and triangles of a quarter of a torus of 60 and 20 mm with its side on a floor
    next to its open end, at Y = 0, that turns upwards."""
    v, u = np.meshgrid(
        np.linspace(0.0, 0.5 * np.pi, rows + 1),
        2.0 * np.pi * np.arange(sides) / sides,
        indexing="ij",
    )
    radii = 60.0 + 20.0 * np.cos(u)
    points = np.stack([20.0 * np.sin(u), radii * np.sin(v), -radii * np.cos(v)], axis=-1).reshape(
        -1, 3
    )
    k, row = np.meshgrid(np.arange(sides), sides * np.arange(rows))
    a, b = row + k, row + (k + 1) % sides
    return points, np.stack([a, b, a + sides, b, b + sides, a + sides], axis=-1).reshape(-1, 3)


def test_a_first_layer_about_a_floor_goes_on_to_the_open_end_beside_it():
    """The first layer of a real pipe once ended a facet short of its open end, and the next layers,
    around its ends, ran 0.6 mm past the pipe's end."""
    mesh_wall = wall(*lying_bend())
    (first_curve,) = mesh_wall.first
    assert not first_curve.closed
    assert (
        np.abs(first_curve.points[[0, -1], 1]).max() < 0.05
        and np.abs(first_curve.points[:, 2] + 78.0).max() < 1e-5
    )
    for layer in layers(mesh_wall):
        for bead in layer.beads:
            assert bead.points[:, 1].min() > -0.05
