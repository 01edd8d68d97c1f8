# SPDX-License-Identifier: LGPL-2.1-or-later
"""The boundary curves of a wall, and which of them are ends at which layers finish."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from ...types import Array, Index, Mask
from ..mesh.edge_runs import runs
from ..mesh.refined import Edges, boundary
from .patch_wall import FirstCurve, PatchWall, Rim
from .surface import dot

REACHED = 0.75  # share of an end's length along which the wall comes up to it


def rims_of(wall: PatchWall) -> tuple[Rim, ...]:
    """All rims, none an end yet."""
    ends, _ = boundary(wall.triangles)
    if not len(ends):
        return ()
    found = []
    for members, forward, closed in runs(wall.vertices, ends):
        pairs = np.where(forward[:, None], ends[members], ends[members][:, ::-1])
        if closed:
            pairs = np.vstack([pairs])
        found.append(Rim(wall.vertices[np.r_[pairs[:, 0], pairs[-1, 1]]], False))
    return tuple(found)


def with_ends(
    wall: PatchWall, rims: tuple[Rim, ...], first: tuple[FirstCurve, ...], behind: Mask
) -> tuple[Rim, ...]:
    """The rims with the ends among them marked.

    A rim is an end unless it lies behind, an end of a first curve lies on it (a side), a first curve runs along it, or it
    bounds an opening: there the distance from the first curves, measured along the wall, grows away from the rim on more
    than a quarter of its length, because layers close again beyond it.
    """
    distance = _distance(wall, first, behind)
    beyond = distance.max(initial=0.0, where=np.isfinite(distance))
    tree = cKDTree(wall.vertices)
    inside = _inner_mean(wall, distance)
    near = 1.5 * wall.mesh.longest_edge
    starts = [end for one in first if not one.closed for end in (one.points[0], one.points[-1])]
    marked = []
    for rim in rims:
        at = tree.query(rim.points)[1]
        open_ = ~behind[at]
        side = any(
            np.linalg.norm(rim.points - end, axis=1).min() < near and _runs_on(rim, end, near)
            for end in starts
        )
        start = open_.any() and float(distance[at][open_].mean()) < near
        rises = np.where(np.isfinite(inside[at]), distance[at] > inside[at] - 1e-9, True)
        end = bool(
            open_.mean() > 0.5
            and not side
            and not start
            and rises[open_].mean() > REACHED
            and beyond > 0.0
        )
        marked.append(replace(rim, end=end))
    return tuple(marked)


def _runs_on(rim: Rim, point: Array, near: float) -> bool:
    """Whether a rim leads away from a point on it, rather than being a stretch next to it that is short."""
    return bool(np.linalg.norm(rim.points - point, axis=1).max() > 2.0 * near)


def _distance(wall: PatchWall, first: tuple[FirstCurve, ...], behind: Mask) -> Array:
    """Length (n,) of the shortest way along the mesh from the first curves, inf behind them."""
    edges = Edges(wall.triangles).ends
    edges = edges[~behind[edges].any(axis=1)]
    length = np.linalg.norm(wall.vertices[edges[:, 0]] - wall.vertices[edges[:, 1]], axis=1)
    count = len(wall.vertices)
    graph = coo_matrix((length, (edges[:, 0], edges[:, 1])), shape=(count, count)).tocsr()
    ahead = np.flatnonzero(~behind)
    if not first or not len(ahead):
        return np.full(count, np.inf)
    points = np.vstack([one.points for one in first])
    sources = np.unique(ahead[cKDTree(wall.vertices[ahead]).query(points)[1]])
    found: Array = dijkstra(graph, directed=False, indices=sources, min_only=True)
    return found


def _inner_mean(wall: PatchWall, distance: Array) -> Array:
    """Mean distance (n,) of each vertex's neighbours that are not on the boundary."""
    rim = np.zeros(len(distance), dtype=bool)
    rim[boundary(wall.triangles)[0]] = True
    ends = Edges(wall.triangles).ends
    ends = np.concatenate([ends, ends[:, ::-1]])
    ends = ends[~rim[ends[:, 1]] & np.isfinite(distance[ends[:, 1]])]
    total = np.bincount(ends[:, 0], weights=distance[ends[:, 1]], minlength=len(distance))
    count = np.bincount(ends[:, 0], minlength=len(distance))
    return np.where(count > 0, total / np.maximum(count, 1), np.inf)


def parts(wall: PatchWall, members: Mask) -> tuple[int, Index]:
    """Number of connected parts that the vertices `members` (n,) form along edges of the mesh, and the part (n,) of each,
    -1 for the others."""
    edges = Edges(wall.triangles).ends
    edges = edges[members[edges].all(axis=1)]
    count = len(members)
    graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    part = np.full(count, -1, dtype=np.intp)
    _, part[members] = np.unique(label[members], return_inverse=True)
    return int(part.max(initial=-1)) + 1, part


def outward_volume(wall: PatchWall) -> float:
    """Volume (mm3) that the wall encloses when each boundary is closed by a fan about its middle; negative when the wall's
    outer side looks inwards, zero for what encloses nothing."""
    corners = wall.vertices[wall.triangles]
    origin = wall.vertices[0]
    total = _cones(corners - origin)
    ends, _ = boundary(wall.triangles)
    if len(ends):
        count = len(wall.vertices)
        graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
        loop = connected_components(graph, directed=False)[1][ends[:, 0]]
        for one in np.unique(loop):
            pair = wall.vertices[ends[loop == one]]
            middle = np.broadcast_to(pair.mean(axis=(0, 1)), (len(pair), 3))
            total += _cones(np.stack([pair[:, 1], pair[:, 0], middle], axis=1) - origin)
    return total


def _cones(corners: Array) -> float:
    return float(dot(corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0)
