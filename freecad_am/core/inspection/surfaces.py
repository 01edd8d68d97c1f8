# SPDX-License-Identifier: LGPL-2.1-or-later
"""Walls, solids and toolpaths of the plan as surfaces to inspect."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.curves.profile import RevolvedWall
from ..geometry.mesh.collapsed import doubled_areas
from ..geometry.on_hub import SolidsOnHub
from ..geometry.walls.patch_wall import PatchWall
from ..geometry.walls.surface import dot
from ..geometry.walls.surface_wall import SurfaceWall
from ..issues import InputError
from ..toolpath import Bead, Toolpath
from ..types import Array
from .planned import Planned, bead_surface, revolution_surface, triangle_surface

ROWS, COLUMNS = (
    80,
    240,
)  # of the triangles by which points find their place on a wall of one surface
PLAIN = 0.2  # of normals away from the middle of a loop: with less, its neighbour decides which side is outside
FINE = 0.25  # mm between samples of beads


def planned(source: object, name: str) -> Planned:
    """The surface of a feature's wall or solids, or of a toolpath's beads.
    Raises InputError NOT_FOR_FAMILY naming it."""
    if isinstance(source, RevolvedWall):
        return revolution_surface(source)
    if isinstance(source, PatchWall):
        return _patches_surface(source)
    if isinstance(source, SurfaceWall):
        return _wall_surface(source)
    if isinstance(source, SolidsOnHub):
        bodies = [body for group in source.groups for body in group.bodies]
        counts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
        triangles = np.concatenate(
            [body.triangles + start for body, start in zip(bodies, counts[:-1], strict=True)]
        )
        vertices = np.concatenate([body.vertices for body in bodies])
        return triangle_surface(
            source.label, vertices, triangles, source.groups[0].base.frame, chord=source.chord_error
        )
    if isinstance(source, Toolpath):
        return _toolpath_surface(source, name)
    raise InputError(
        "NOT_FOR_FAMILY",
        name,
        "curves and cladding have no planned surface; compare the points with the part",
    )


def _patches_surface(wall: PatchWall) -> Planned:
    def exact(points: Array) -> tuple[Array, Array]:
        foot, normal = wall.project(points)
        return dot(points - foot, normal), normal

    longest = np.linalg.norm(np.ptp(wall.vertices[wall.triangles], axis=1), axis=1).mean()
    return triangle_surface(
        wall.label, wall.vertices, wall.triangles, exact=exact, chord=0.02 * float(longest)
    )


def _wall_surface(wall: SurfaceWall) -> Planned:
    surface = wall.surface()
    period = surface.period or 2.0 * np.pi
    u, v = surface.inverse(wall.first)
    order = np.argsort(np.remainder(v, period))
    around = np.linspace(0.0, period, COLUMNS, endpoint=False)
    start = np.interp(around, np.remainder(v, period)[order], u[order], period=period)
    share = np.linspace(0.0, 1.0, ROWS)[:, None]
    up = np.asarray(start[None] + share * (wall.end - start)[None], float)
    grid = surface.point(up, np.broadcast_to(around, up.shape))
    row, column = np.meshgrid(np.arange(ROWS - 1), np.arange(COLUMNS), indexing="ij")
    a, b = row * COLUMNS + column, row * COLUMNS + (column + 1) % COLUMNS
    triangles = np.concatenate(
        [np.stack([a, b, b + COLUMNS], -1), np.stack([a, b + COLUMNS, a + COLUMNS], -1)]
    )
    middle = ROWS // 2
    sense = _outward(grid[middle], _normals(surface.derivatives(up[middle], around)))
    triangles = triangles.reshape(-1, 3)
    corners = grid.reshape(-1, 3)[triangles]
    turned = doubled_areas(corners)
    where = corners.mean(axis=1)
    normals_ = _normals(surface.derivatives(*surface.inverse(where)))
    if float(dot(turned, normals_).sum()) * sense < 0.0:
        triangles = triangles[:, ::-1]

    def exact(points: Array) -> tuple[Array, Array]:
        derivatives = surface.derivatives(*surface.inverse(points))
        normal = sense * _normals(derivatives)
        return dot(points - derivatives[0], normal), normal

    chord = float(np.linalg.norm(np.diff(grid, axis=1), axis=2).max()) * np.pi / COLUMNS
    return triangle_surface(wall.label, grid.reshape(-1, 3), triangles, wall.frame, exact, chord)


def _normals(derivatives: tuple[Array, Array, Array]) -> Array:
    normal = np.cross(derivatives[1], derivatives[2])
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-300))


def _outward(loop: Array, normals: Array) -> float:
    """1 where normals (n, 3) lead out of a loop of points (n, 3), -1 where into it."""
    return 1.0 if float(dot(loop - loop.mean(axis=0), normals).sum()) >= 0.0 else -1.0


def _toolpath_surface(toolpath: Toolpath, name: str) -> Planned:
    """The wall formed by adjacent beads, in the plane of each bead and its build direction."""
    if toolpath.traits.is_filled:
        raise InputError(
            "NOT_FOR_FAMILY",
            name,
            "its beads fill solids, so most are inside; compare the points with the feature",
        )
    samples: list[Array] = []
    normals: list[Array] = []
    for _, _, bead in toolpath:
        points, normal = _sampled(bead)
        if toolpath.traits.has_axis:
            sense = _turning(points, toolpath.frame)
        elif samples and not (bead.closed and _is_radial(points, normal)):
            nearest = cKDTree(samples[-1]).query(points)[1]
            sense = 1.0 if float(dot(normals[-1][nearest], normal).sum()) >= 0.0 else -1.0
        else:
            sense = _outward(points, normal)
        samples.append(points)
        normals.append(sense * normal)
    step = max(FINE, 0.75 * toolpath.layer_height)
    return bead_surface(
        name, np.concatenate(samples), np.concatenate(normals), toolpath.frame, step
    )


def _turning(points: Array, frame: Array) -> float:
    """1 if a course of points (n, 3) goes round the Z of a frame counter-clockwise, so that its normals are the meridian's; -1 if
    clockwise.
    """
    x, y = ((points - frame[:3, 3]) @ frame[:3, :2]).T
    return 1.0 if float((x[:-1] * y[1:] - y[:-1] * x[1:]).sum()) >= 0.0 else -1.0


def _is_radial(loop: Array, normals: Array) -> bool:
    """Whether normals (n, 3) lead out of a loop of points (n, 3), or into it, rather than along its axis."""
    offsets = loop - loop.mean(axis=0)
    return bool(
        abs(float(dot(offsets, normals).sum()))
        > PLAIN * float(np.linalg.norm(offsets, axis=1).sum())
    )


def _sampled(bead: Bead) -> tuple[Array, Array]:
    """Points along a bead, no farther apart than FINE, with unit normals of the wall there."""
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    count = np.maximum(np.ceil(length / FINE).astype(np.intp), 1)
    segment = np.repeat(np.arange(len(count)), count)
    share = (
        (np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)) / count[segment]
    )[:, None]
    points, tangent = bead.outline.at(segment, share[:, 0])
    build = bead.build[segment] * (1.0 - share) + bead.build[segment + 1] * share
    normal = np.cross(tangent, build)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    is_proper = size[:, 0] > 1e-12
    return points[is_proper], normal[is_proper] / size[is_proper]
