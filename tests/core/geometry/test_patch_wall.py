# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls of several exact surfaces: projection across joints against the surfaces' equations; curves
and rims."""

import numpy as np
import pytest

from freecad_am.core.geometry.mesh.edge_runs import runs, tangents
from freecad_am.core.geometry.mesh.triangle_mesh import closest
from freecad_am.core.geometry.walls.patch import CONE, CYLINDER, PLANE, SPHERE, SPLINE, TORUS, Patch
from freecad_am.core.geometry.walls.patch_wall import FirstCurve, PatchWall, Rim

TURN = 2.0 * np.pi
BEND, TUBE = 60.0, 15.0


def pose(origin=(0, 0, 0), x=(1, 0, 0), z=(0, 0, 1)):
    frame = np.eye(4)
    x, z = np.asarray(x, float), np.asarray(z, float)
    frame[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    frame[:3, 3] = origin
    return frame


def grid(patch, u, v):
    """Triangles of a patch over a grid of parameters: corners (m, 3, 3), counter-clockwise from its
    outer side, and uv."""
    uu, vv = np.meshgrid(u, v, indexing="ij")
    uv = np.stack([uu, vv], axis=-1)
    a, b, c, d = uv[:-1, :-1], uv[1:, :-1], uv[1:, 1:], uv[:-1, 1:]
    corners = np.concatenate(
        [np.stack(corner_uv, axis=2).reshape(-1, 3, 2) for corner_uv in ((a, b, c), (a, c, d))]
    )
    if patch.sign < 0.0:
        corners = corners[:, ::-1]
    return patch.at(corners.reshape(-1, 2))[0].reshape(-1, 3, 3), corners


def merge_patches(*patches):
    """Return the wall of several (patch, u, v) grids with equal corners merged."""
    grids = [grid(*patch_grid) for patch_grid in patches]
    corners = np.concatenate([corners_of_patch for corners_of_patch, _ in grids])
    _, index_of_vertex, index = np.unique(
        np.round(corners.reshape(-1, 3), 7), axis=0, return_index=True, return_inverse=True
    )
    vertices = corners.reshape(-1, 3)[index_of_vertex]
    patch = np.repeat(
        np.arange(len(grids)), [len(corners_of_patch) for corners_of_patch, _ in grids]
    )
    return PatchWall(
        vertices,
        np.ravel(index).reshape(-1, 3),
        patch,
        np.concatenate([uv for _, uv in grids]),
        tuple(patch_grid[0] for patch_grid in patches),
        (),
        np.zeros(len(vertices), dtype=bool),
        (),
    )


def elbow(count=48):
    """A tube that runs straight up, bends by a quarter turn towards -X and continues straight."""
    around, along = np.linspace(0.0, TURN, count + 1), np.linspace(0.0, 0.5 * np.pi, 25)
    foot = Patch(CYLINDER, (TUBE,), pose((0, 0, -20)), periods=(TURN, 0.0))
    bend = Patch(TORUS, (BEND, TUBE), pose((-BEND, 0, 0), z=(0, -1, 0)), periods=(TURN, TURN))
    head = Patch(
        CYLINDER, (TUBE,), pose((-BEND, 0, BEND), x=(0, 0, 1), z=(-1, 0, 0)), periods=(TURN, 0.0)
    )
    return merge_patches(
        (foot, around, np.linspace(0.0, 20.0, 8)),
        (bend, along, around),
        (head, around, np.linspace(0.0, 30.0, 11)),
    )


def expected(points):
    """Nearest points and normals of the elbow by its equations, from the nearest point of the
    centre line."""
    x, z = points[:, 0] + BEND, points[:, 2]
    angle = np.clip(np.arctan2(z, x), 0.0, 0.5 * np.pi)
    centre = np.stack([BEND * np.cos(angle) - BEND, 0.0 * x, BEND * np.sin(angle)], axis=1)
    centre[:, 2] = np.where(z < 0.0, z, centre[:, 2])
    centre[:, 0] = np.where((x < 0.0) & (z > 0.0), points[:, 0], centre[:, 0])
    out = points - centre
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    return centre + TUBE * out, out


def test_projection_across_tangent_joints_is_exact():
    wall = elbow()
    rng = np.random.default_rng(3)
    spots = wall.vertices[wall.triangles[rng.integers(len(wall.triangles), size=10000)]]
    queries = np.einsum("nk,nkc->nc", rng.dirichlet(np.ones(3), size=10000), spots) + rng.normal(
        0.0, 0.1, (10000, 3)
    )
    joint = np.stack(
        [TUBE * np.cos(queries[:, 1]), TUBE * np.sin(queries[:, 1]), 0.0 * queries[:, 1]], axis=1
    )
    queries = np.vstack([queries, joint + rng.normal(0.0, 1e-3, joint.shape)])
    queries = queries[(queries[:, 2] > -20.0) & (queries[:, 0] > -BEND - 30.0)]
    points, normals = wall.project(queries)
    foot, out = expected(queries)
    assert np.abs(points - foot).max() < 1e-9
    assert np.abs(normals - out).max() < 1e-9
    assert len({*wall.patch[wall._nearest(queries)[0]]}) == 3


def test_beyond_the_rim_the_surface_goes_on():
    wall = elbow()
    points, normals = wall.project(np.array([[TUBE + 0.3, 0.0, -21.0]]))
    assert points[0] == pytest.approx([TUBE, 0.0, -21.0], abs=1e-12)
    assert normals[0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


def test_the_outer_side_may_be_against_the_surface():
    inner = Patch(CYLINDER, (TUBE,), pose(), -1.0, (TURN, 0.0))
    flat = Patch(PLANE, (), pose((TUBE, 0, 0), x=(0, 1, 0), z=(1, 0, 0)), -1.0)
    even = np.linspace(0.0, 9.0, 5)
    wall = merge_patches((inner, np.linspace(-np.pi, 0.0, 20), even), (flat, even, even))
    points, normals = wall.project(np.array([[TUBE + 0.1, 1e-4, 4.4], [TUBE + 0.1, -1e-4, 4.4]]))
    assert points[0] == pytest.approx([TUBE, 1e-4, 4.4], abs=1e-12) and normals[0] == pytest.approx(
        [-1, 0, 0], abs=1e-12
    )
    assert np.hypot(*points[1, :2]) == pytest.approx(TUBE, abs=1e-12)
    facets = np.cross(
        *(wall.vertices[wall.triangles[:, k]] - wall.vertices[wall.triangles[:, 0]] for k in (1, 2))
    )
    assert (
        np.einsum("ij,ij->i", facets, wall.project(wall.vertices[wall.triangles].mean(axis=1))[1])
        > 0.0
    ).all()


@pytest.mark.parametrize(
    ("patch", "level"),
    [
        (Patch(CONE, (10.0, 0.3), pose((1, 2, 3), x=(0, 1, 0), z=(1, 0, 0))), None),
        (Patch(CONE, (10.0, -0.3), pose((1, 2, 3))), None),
        (Patch(SPHERE, (20.0,), pose((4, 5, 6))), None),
        (Patch(TORUS, (30.0, 8.0), pose((4, 5, 6), x=(0, 0, 1), z=(0, 1, 0))), None),
    ],
    ids=["cone", "narrowing cone", "sphere", "torus"],
)
def test_closed_forms_return_what_was_moved_along_the_normal(patch, level):
    rng = np.random.default_rng(5)
    uv = rng.uniform([-3.0, -1.4], [3.0, 1.4], (500, 2))
    points, normals = patch.at(uv)
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert patch.inverse(points + rng.uniform(-3.0, 3.0, (500, 1)) * normals) == pytest.approx(
        uv, abs=1e-11
    )
    step = 1e-5
    for axis in (0, 1):
        slope = (
            patch.at(uv + step * np.eye(2)[axis])[0] - patch.at(uv - step * np.eye(2)[axis])[0]
        ) / (2.0 * step)
        assert np.abs(np.einsum("ij,ij->i", slope, normals)).max() < 1e-7


def rational_tube():
    """The cylinder of radius 10 and height 40 as a rational spline of four quarters, linear along
    u."""
    corners = np.array(
        [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)], float
    )
    weight = np.where(np.arange(9) % 2, np.sqrt(0.5), 1.0)
    poles = np.empty((2, 9, 4))
    for row, height in enumerate((0.0, 40.0)):
        poles[row] = np.column_stack([10.0 * corners * weight[:, None], height * weight, weight])
    knots = np.r_[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].astype(float)
    return Patch(
        SPLINE, (), np.eye(4), -1.0, (0.0, 4.0), np.array([0.0, 0.0, 1.0, 1.0]), knots, poles
    )


def test_a_rational_spline_is_the_cylinder_it_stands_for():
    """A rational spline that represents a cylinder is projected onto exactly."""
    patch = rational_tube()
    wall = merge_patches((patch, np.linspace(0, 1, 21), np.linspace(0, 4, 33)))
    rng = np.random.default_rng(7)
    angle, height = (
        rng.uniform(0.0, TURN, 5000),
        rng.uniform(-1.0, 41.0, 5000),
    )  # beyond the ends the surface continues straight
    out = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    queries = (10.0 + rng.uniform(-0.3, 0.3, 5000))[:, None] * out + height[:, None] * [
        0.0,
        0.0,
        1.0,
    ]
    points, normals = wall.project(queries)
    assert points == pytest.approx(10.0 * out + height[:, None] * [0.0, 0.0, 1.0], abs=1e-9)
    assert normals == pytest.approx(out, abs=1e-9)


def test_nearest_point_of_a_triangle():
    rng = np.random.default_rng(1)
    a, b, c, p = rng.normal(size=(4, 300, 3))
    distance, share = closest(a, b, c, p)
    assert (share > -1e-12).all() and share.sum(axis=1) == pytest.approx(1.0)
    foot = share[:, :1] * a + share[:, 1:2] * b + share[:, 2:] * c
    assert np.linalg.norm(foot - p, axis=1) == pytest.approx(distance, abs=1e-9)
    for corner in (
        a,
        b,
        c,
    ):  # the angle at the nearest point is obtuse towards every point of the triangle
        assert (np.einsum("ij,ij->i", p - foot, corner - foot) < 1e-9).all()
    assert closest(a, a, b, 0.5 * (a + b))[0] == pytest.approx(0.0, abs=1e-7)


def test_curves_and_rims():
    angle = np.linspace(0.0, TURN, 65)[:-1]
    points = np.stack([9.0 * np.cos(angle), 9.0 * np.sin(angle), 0.0 * angle], axis=1)
    along = np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1)
    curve = FirstCurve(points, along, along, True).curve()
    assert curve.length == pytest.approx(9.0 * TURN, abs=1e-4)
    assert np.hypot(*curve.at(curve.refined(7))[0].T[:2]) == pytest.approx(9.0, abs=1e-5)
    assert Rim(np.vstack([points, points[:1]]), True).closed and not Rim(points, False).closed


def test_runs_part_at_corners_and_meeting_places():
    """Chains of edges split at corners and junctions."""
    square = np.array(
        [(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (2, 2, 0), (1, 2, 0), (0, 2, 0), (0, 1, 0)],
        float,
    )
    edges = np.stack([np.arange(8), (np.arange(8) + 1) % 8], axis=1)
    edges[3] = edges[3, ::-1]
    edge_runs = runs(square, edges)
    assert sorted(len(members) for members, _, _ in edge_runs) == [2, 2, 2, 2]
    assert not any(closed for _, _, closed in edge_runs)
    angle = np.linspace(0.0, TURN, 41)[:-1]
    circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    edges = np.stack([np.arange(40), (np.arange(40) + 1) % 40], axis=1)
    ((members, forward, closed),) = runs(circle, edges)
    assert closed and len(members) == 40
    assert forward.all() or not forward.any()
    slopes = tangents(circle, edges)
    assert slopes[:, 0] == pytest.approx(
        np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle], axis=1), abs=1e-5
    )
