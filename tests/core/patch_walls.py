# SPDX-License-Identifier: LGPL-2.1-or-later
"""Analytic walls for the tests of fronts: patches with meshes, first layers cut by implicit solids,
rims; measures."""

import numpy as np
from scipy.spatial import ConvexHull, Delaunay, cKDTree

from freecad_am.core.geometry.mesh.edge_runs import runs
from freecad_am.core.geometry.mesh.triangle_mesh import Mesh
from freecad_am.core.geometry.walls.patch import CYLINDER, PLANE, SPHERE, TORUS, Patch
from freecad_am.core.geometry.walls.patch_wall import FirstCurve, PatchWall, Rim
from freecad_am.core.geometry.walls.surface import dot

TURN = 2.0 * np.pi
SUBSTRATE = 1e-9  # mm; a rim that is no higher above the substrate is on it


def patch_wall(
    vertices, triangles, patches, owner, substrate, is_end=lambda points: False, label="wall"
):
    """The wall of a mesh whose triangles (m, 3) belong to the patches owner (m,); it starts where
    it leaves `substrate`."""
    uv = np.empty((len(triangles), 3, 2))
    for k, patch in enumerate(patches):
        is_owned = owner == k
        uv[is_owned] = patch.unwrap(
            patch.inverse(vertices[triangles[is_owned]].reshape(-1, 3)).reshape(-1, 3, 2)
        )
    bare = PatchWall(
        vertices,
        triangles,
        owner,
        uv,
        tuple(patches),
        (),
        np.zeros(len(vertices), dtype=bool),
        (),
        label,
    )
    first_curves = tuple(_first(bare, substrate))
    behind = substrate.value(vertices)[0] < 0.0
    rims = tuple(_rims(bare, substrate, is_end))
    return PatchWall(
        vertices, triangles, owner, uv, tuple(patches), first_curves, behind, rims, label
    )


def _first(wall, substrate):
    lines = wall.mesh.level_lines(
        substrate.value(wall.vertices)[0] - SUBSTRATE, np.arange(len(wall.triangles))
    )
    for line in lines:
        points, normal = wall.project(line.points)
        for _ in range(40):
            off, gradient = substrate.value(points)
            slope = gradient - dot(gradient, normal)[:, None] * normal
            if not line.closed:
                slope[[0, -1]] = dot(gradient[[0, -1]], line.rims)[:, None] * line.rims
            points, normal = wall.project(
                points - (off / np.maximum(dot(slope, slope), 1e-6))[:, None] * slope
            )
        length = np.linalg.norm(np.diff(points, axis=0), axis=1)
        keep = np.r_[True, length > 0.2 * np.median(length)]
        if not line.closed:
            keep[-1] = True
        points, normal = points[keep], normal[keep]
        tangent = np.cross(normal, substrate.value(points)[1])
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
        chord = np.diff(np.vstack([points, points[:1]]), axis=0)
        if dot(tangent[:-1], chord[:-1]).sum() < 0.0:
            tangent = -tangent
        yield FirstCurve(points, tangent, tangent, line.closed)


def _rims(wall, substrate, is_end):
    half = wall.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges, count = np.unique(np.sort(half, axis=1), axis=0, return_counts=True)
    edges = edges[count == 1]
    for members, forward, closed in runs(wall.vertices, edges) if len(edges) else ():
        ends = np.where(forward[:, None], edges[members], edges[members][:, ::-1])
        points = wall.vertices[np.r_[ends[:, 0], ends[-1, 1]]]
        if closed:
            points[-1] = points[0]
        yield Rim(
            points, bool((substrate.value(points)[0] > SUBSTRATE).all() and np.all(is_end(points)))
        )


def grid(point, u, v, closed=False):
    """Vertices and triangles over u and v; closed: the last column of v is followed by the
    first."""
    n, m = len(u), len(v)
    vertices = point(*(parameters.ravel() for parameters in np.meshgrid(u, v, indexing="ij")))
    i, j = (
        k.ravel()
        for k in np.meshgrid(np.arange(n - 1), np.arange(m if closed else m - 1), indexing="ij")
    )
    k = (j + 1) % m
    a, b, c, d = i * m + j, (i + 1) * m + j, (i + 1) * m + k, i * m + k
    return vertices, np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def one_patch(patch, vertices, triangles, substrate, is_end=lambda points: False, label="wall"):
    """A wall of a single patch, its triangles oriented to the patch's outer side."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    normal = patch.at(patch.inverse((a + b + c) / 3.0))[1]
    turned = dot(np.cross(b - a, c - a), normal) < 0.0
    triangles = np.where(turned[:, None], triangles[:, ::-1], triangles)
    return patch_wall(
        vertices,
        triangles,
        [patch],
        np.zeros(len(triangles), dtype=np.intp),
        substrate,
        is_end,
        label,
    )


def bend(substrate, low, high, step, start=0.0, width=TURN, radius=60.0, tube=15.0):
    """A bend as in `geometry.surface.Torus`: the angle along it from low to high, the one around it
    from start to start + width."""
    # OpenCASCADE's torus is about its own Z, here -Y of the part, through (-radius, 0, 0)
    frame = np.array([[1.0, 0, 0, -radius], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
    patch = Patch(TORUS, (radius, tube), frame, 1.0, (TURN, TURN))
    closed = width > 6.28
    u = np.linspace(low, high, int(np.ceil((high - low) * (radius + tube) / step)) + 1)
    count = int(np.ceil(width * tube / step))
    v = start + width * np.arange(count + (0 if closed else 1)) / count

    def point(u, v):
        reach = radius + tube * np.cos(v)
        return np.stack([reach * np.cos(u) - radius, tube * np.sin(v), reach * np.sin(u)], axis=1)

    top = np.array([-np.sin(high), 0.0, np.cos(high)])
    at_top = point(np.array([high]), np.array([0.0]))[0]
    return one_patch(
        patch,
        *grid(point, u, v, closed),
        substrate,
        lambda points: np.abs((points - at_top) @ top) < 1e-9,
    )


def tube(substrate, height, step, radius=20.0, low=-5.0, start=0.0, width=TURN):
    """A cylinder about Z, or a sector of one, that ends at Z = height."""
    patch = Patch(CYLINDER, (radius,), np.eye(4), 1.0, (TURN, 0.0))
    closed = width > 6.28
    count = int(np.ceil(width * radius / step))
    v = start + width * np.arange(count + (0 if closed else 1)) / count
    z = np.linspace(low, height, int(np.ceil((height - low) / step)) + 1)
    mesh = grid(
        lambda z, v: np.stack([radius * np.cos(v), radius * np.sin(v), z], axis=1), z, v, closed
    )
    return one_patch(patch, *mesh, substrate, lambda points: np.abs(points[:, 2] - height) < 1e-9)


def ball(substrate, count=6000, radius=20.0):
    """A sphere with evenly spread vertices."""
    i = np.arange(count) + 0.5
    height, turn = np.arccos(1.0 - 2.0 * i / count), np.pi * (1.0 + np.sqrt(5.0)) * i
    points = radius * np.stack(
        [np.cos(turn) * np.sin(height), np.sin(turn) * np.sin(height), np.cos(height)], axis=1
    )
    return one_patch(
        Patch(SPHERE, (radius,), np.eye(4), 1.0, (TURN, 0.0)),
        points,
        ConvexHull(points).simplices,
        substrate,
    )


def sheet(substrate, holes=(), low=(-30.0, -10.0), high=(30.0, 50.0), step=1.0):
    """A flat sheet in Z = 0 with round holes (x, y, radius)."""
    x, y = np.meshgrid(*(np.linspace(a, b, round((b - a) / step) + 1) for a, b in zip(low, high)))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    rounds = []
    for cx, cy, radius in holes:
        points = points[np.hypot(points[:, 0] - cx, points[:, 1] - cy) > radius + 0.4 * step]
        count = int(np.ceil(TURN * radius / step))
        angle = TURN * np.arange(count) / count
        rounds.append(
            np.array([cx, cy]) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        )
    points = np.vstack([points, *rounds])
    faces = Delaunay(points).simplices
    a, b, c = points[faces].transpose(1, 0, 2)
    is_kept = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) > 1e-9
    start = len(points)
    for hole in reversed(rounds):  # faces between vertices of one hole only would fill it
        start -= len(hole)
        is_kept &= ~((faces >= start) & (faces < start + len(hole))).all(axis=1)
    vertices = np.column_stack([points, np.zeros(len(points))])
    return one_patch(
        Patch(PLANE, (), np.eye(4)),
        vertices,
        faces[is_kept],
        substrate,
        lambda points: points[:, 1] > high[1] - 1e-9,
    )


def brute(points, curves, times=60):
    """Distances to fine polylines through the curves."""
    a = np.vstack([curve.at(curve.refined(times))[0][:-1] for curve in curves])
    b = np.vstack([curve.at(curve.refined(times))[0][1:] for curve in curves])
    distances = np.full(len(points), np.inf)
    for k in cKDTree(0.5 * (a + b)).query(points, k=12)[1].T:
        along = b[k] - a[k]
        t = ((points - a[k]) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
        distances = np.minimum(
            distances, np.linalg.norm(points - a[k] - np.clip(t, 0.0, 1.0)[:, None] * along, axis=1)
        )
    return distances


def samples(wall, times=3):
    """Points over the deposited wall: the centres of its triangles divided into times^2, on the
    exact surface."""
    i, j = (k.ravel() for k in np.meshgrid(np.arange(times), np.arange(times), indexing="ij"))
    inside = i + j < times
    share = np.stack([i[inside] + 1.0 / 3.0, j[inside] + 1.0 / 3.0], axis=1) / times
    share = np.column_stack([1.0 - share.sum(axis=1), share])
    ahead = ~wall.behind[wall.triangles].any(axis=1)
    return wall.project(
        np.einsum("sk,mkc->msc", share, wall.vertices[wall.triangles[ahead]]).reshape(-1, 3)
    )[0]


def mesh_of(wall):
    """The mesh of a wall."""
    return Mesh(wall.vertices, wall.triangles)
