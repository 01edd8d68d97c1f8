# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a wall of several faces must not be: apart, creased, or bent too tightly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from ...core.geometry.formatting import place
from ...core.geometry.mesh.refine import Edges, boundary
from ...core.geometry.walls.mesh_wall import connected_parts
from ...core.geometry.walls.patch_wall import PatchWall
from ...core.geometry.walls.surface import dot, normals
from ...core.geometry.walls.surface_wall import SurfaceWall
from ...core.issues import InputError
from ...core.types import Array, Index, Mask
from .sheet import SEWN

CREASE = np.radians(1.0)  # minimum angle between the normals of two faces at a crease
SLIT = 0.2  # mm; maximum width of an unintended gap between face boundaries
STEP = 1e-5  # parameter step for curvatures, relative to the parameter range
PLACES = 96  # number of radius samples along and around a tube


def refuse_gaps(wall: PatchWall, label: str) -> None:
    """Raise InputError GAP if faces that should join do not, or are far apart."""
    ends, _ = boundary(wall.triangles)
    if not len(ends):
        return
    owner = _owners(wall, ends)
    corner = wall.vertices[ends]
    middle = corner.mean(axis=1)
    tree = cKDTree(middle)
    count, component = connected_parts(wall, np.ones(len(wall.vertices), dtype=bool))
    neighbours = np.asarray(tree.query(middle, k=min(16, len(middle)))[1]).reshape(len(middle), -1)
    foreign = (owner[neighbours] != owner[:, None]) | (
        component[ends[neighbours, 0]] != component[ends[:, 0]][:, None]
    )
    unconnected = ~(ends[neighbours][:, :, :, None] == ends[:, None, None, :]).any(axis=(2, 3))
    gap = _to_segments(middle, corner[neighbours])
    gap[~(foreign & unconnected)] = np.inf
    best = gap.min(axis=1)
    if best.min() < SLIT:
        row = int(np.argmax(np.where(best < SLIT, best, -1.0)))
        k = neighbours[row, int(np.argmin(gap[row]))]
        raise InputError(
            "GAP",
            label,
            "{} and {} are {:.3g} mm apart at {}; close the gap: edges must meet within {:g} mm",
            wall.faces[owner[row]],
            wall.faces[owner[k]],
            best[row],
            place(middle[row]),
            SEWN,
        )
    if count > 1:
        piece_vertices, foreign = (np.flatnonzero(component == k) for k in (0, 1))
        distance, index = cKDTree(wall.vertices[piece_vertices]).query(wall.vertices[foreign])
        k = int(np.argmin(distance))
        names = [
            wall.faces[wall.patch[np.flatnonzero((wall.triangles == v).any(axis=1))[0]]]
            for v in (piece_vertices[index[k]], foreign[k])
        ]
        raise InputError(
            "GAP",
            label,
            "the faces form {} separate pieces: {} and {} are {:.4g} mm apart at {}; choose connected faces, "
            "edges meeting within {:g} mm",
            count,
            names[0],
            names[1],
            distance[k],
            place(wall.vertices[foreign[k]]),
            SEWN,
        )


def _owners(wall: PatchWall, ends: Index) -> Index:
    edges = Edges(wall.triangles)
    face = edges.faces[edges.count == 1, 0]
    keys = edges.ends[edges.count == 1]
    base = len(wall.vertices)
    order = np.argsort(keys[:, 0] * base + keys[:, 1])
    pair = np.sort(ends, axis=1)
    positions = np.searchsorted(
        (keys[:, 0] * base + keys[:, 1])[order], pair[:, 0] * base + pair[:, 1]
    )
    owner: Index = wall.patch[face[order[positions]]]
    return owner


def _to_segments(points: Array, segments: Array) -> Array:
    """Return distances (n, k) of points (n, 3) to segments (n, k, 2, 3)."""
    start, chord = segments[:, :, 0], segments[:, :, 1] - segments[:, :, 0]
    t = np.clip(
        dot(points[:, None] - start, chord) / np.maximum(dot(chord, chord), 1e-300), 0.0, 1.0
    )
    distance: Array = np.linalg.norm(points[:, None] - start - t[..., None] * chord, axis=-1)
    return distance


def refuse_creases(wall: PatchWall, shape: Any, label: str) -> None:
    """Raise InputError CREASE if two faces meet at an angle, BRANCHING_FACES if three meet."""
    edges = Edges(wall.triangles)
    middle = wall.vertices[edges.ends].mean(axis=1)
    if (edges.count > 2).any():
        branch_point = middle[np.argmax(edges.count > 2)]
        raise InputError(
            "BRANCHING_FACES",
            label,
            "more than two faces meet in one edge at {}; remove one of the faces: a wall can "
            "branch only through smooth faces with openings",
            place(branch_point),
        )
    two = edges.count == 2
    pair = wall.patch[edges.faces]
    joint = np.flatnonzero(two & (pair[:, 0] != pair[:, 1]))
    if not len(joint):
        return
    ends = wall.vertices[edges.ends[joint, 0]]
    normals = np.empty((2, len(joint), 3))
    for side in (0, 1):
        for k in np.unique(pair[joint, side]):
            on_patch = pair[joint, side] == k
            normals[side, on_patch] = wall.patches[k].at(wall.patches[k].inverse(ends[on_patch]))[1]
    angle = np.arctan2(
        np.linalg.norm(np.cross(normals[0], normals[1]), axis=1), dot(normals[0], normals[1])
    )
    worst = int(np.argmax(angle))
    if angle[worst] > CREASE:
        names = [wall.faces[k] for k in pair[joint[worst]]]
        raise InputError(
            "CREASE",
            f"{label} {_edge_at(shape, ends[worst])}".strip(),
            "{} and {} meet at an angle of {:.3g} deg at {}; faces of a wall must be tangent "
            "within {:g} deg: round the edge, or deposit the faces in turn",
            names[0],
            names[1],
            np.degrees(angle[worst]),
            place(ends[worst]),
            np.degrees(CREASE),
        )


def _edge_at(shape: Any, point: Array) -> str:
    vertex = Part.Vertex(FreeCAD.Vector(*point))
    nearest_edge = min(
        enumerate(shape.Edges, start=1),
        key=lambda entry: entry[1].distToShape(vertex)[0],
        default=(0, None),
    )
    return f"Edge{nearest_edge[0]}" if nearest_edge[0] else ""


def refuse_tight(wall: PatchWall, selected: Mask, height: float, label: str) -> None:
    """Raise InputError LAYER_HEIGHT if a principal radius of the wall is below the layer height.

    selected: mask (n,) of the vertices to check.
    """
    radius, patch = smallest_radii(wall)
    radius = np.where(selected, radius, np.inf)
    tightest = int(np.argmin(radius))
    _refuse_below(
        height,
        float(radius[tightest]),
        wall.vertices[tightest],
        f"{label} {wall.faces[patch[tightest]]}",
    )


def refuse_tight_tube(tube: SurfaceWall, height: float, label: str) -> None:
    """Raise InputError LAYER_HEIGHT if a principal radius of a tube is below the layer height.

    The tube is checked from its first layer to its end.
    """
    surface = tube.surface()
    low, around = surface.inverse(tube.first[:: max(1, len(tube.first) // PLACES)])
    rise = np.linspace(0.0, 1.0, PLACES)[1:-1, None]  # keep difference steps inside the surface
    u = low + rise * (tube.end - low)
    v = np.broadcast_to(around, u.shape)
    slopes = surface.derivatives(u, v)[1:]
    turns = []
    for step_u, step_v in ((STEP * tube.end, 0.0), (0.0, STEP * tube.period)):
        ahead, back = (
            normals(surface, u + step_u, v + step_v),
            normals(surface, u - step_u, v - step_v),
        )
        turns.append((ahead - back) / (2.0 * (step_u + step_v)))
    radius = principal_radii(slopes, turns)
    tightest = np.unravel_index(int(np.argmin(radius)), radius.shape)
    named = f"{label} {tube.faces[0]}" if len(tube.faces) == 1 else label
    _refuse_below(height, float(radius[tightest]), surface.point(u[tightest], v[tightest]), named)


def _refuse_below(height: float, radius: float, point: Array, where: str) -> None:
    if radius < height * (1.0 - 1e-6):
        raise InputError(
            "LAYER_HEIGHT",
            where,
            "layers of {:g} mm exceed the smallest radius of curvature of the wall, {:.3g} mm at "
            "{}; use lower layers, or a larger radius there",
            height,
            radius,
            place(point),
        )


def smallest_radii(wall: PatchWall) -> tuple[Array, Index]:
    """Return the minimum principal radius (n,), mm, and the patch index (n,), at each vertex."""
    corner = np.zeros(len(wall.vertices), dtype=np.intp)
    corner[wall.triangles.ravel()] = np.arange(wall.triangles.size)
    patch = wall.patch[corner // 3]
    uv = wall.uv.reshape(-1, 2)[corner]
    radius = np.full(len(wall.vertices), np.inf)
    for k in np.unique(patch):
        members = np.flatnonzero(patch == k)
        surface_patch, uv_inside = wall.patches[k], uv[members]
        reach = np.maximum(np.ptp(wall.uv[wall.patch == k].reshape(-1, 2), axis=0), 1e-9)
        middle = wall.uv[wall.patch == k].reshape(-1, 2).mean(axis=0)
        uv_inside = middle + (1.0 - 4.0 * STEP) * (uv_inside - middle)  # keep steps inside
        slopes, turns = [], []
        for axis in (0, 1):
            step = STEP * reach[axis] * np.eye(2)[axis]
            (ahead, up), (back, down) = (
                surface_patch.at(uv_inside + step),
                surface_patch.at(uv_inside - step),
            )
            slopes.append((ahead - back) / (2.0 * STEP * reach[axis]))
            turns.append((up - down) / (2.0 * STEP * reach[axis]))
        radius[members] = principal_radii(slopes, turns)
    return radius, patch


def principal_radii(slopes: Sequence[Array], turns: Sequence[Array]) -> Array:
    """Return the smaller principal radius (...,), mm; infinite at poles.

    slopes, turns: derivatives (..., 3) of point and unit normal along both parameters.
    """
    a, b, c = dot(slopes[0], slopes[0]), dot(slopes[0], slopes[1]), dot(slopes[1], slopes[1])
    e, g = dot(slopes[0], turns[0]), dot(slopes[1], turns[1])
    f = 0.5 * (dot(slopes[0], turns[1]) + dot(slopes[1], turns[0]))
    area = a * c - b * b
    plain = area > 1e-10 * np.median(area)
    safe = np.where(plain, area, 1.0)
    mean, gauss = 0.5 * (e * c - 2.0 * f * b + g * a) / safe, (e * g - f * f) / safe
    bend = np.abs(mean) + np.sqrt(np.maximum(mean * mean - gauss, 0.0))
    radius: Array = np.where(plain, 1.0 / np.maximum(bend, 1e-12), np.inf)
    return radius
