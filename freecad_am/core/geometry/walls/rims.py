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


def find_rims(wall: PatchWall) -> tuple[Rim, ...]:
    """Return all rims, none marked as an end yet."""
    ends, _ = boundary(wall.triangles)
    if not len(ends):
        return ()
    rims = []
    for members, forward, closed in runs(wall.vertices, ends):
        pairs = np.where(forward[:, None], ends[members], ends[members][:, ::-1])
        if closed:
            pairs = np.vstack([pairs])
        rims.append(Rim(wall.vertices[np.r_[pairs[:, 0], pairs[-1, 1]]], False))
    return tuple(rims)


def mark_ends(
    wall: PatchWall, rims: tuple[Rim, ...], start_curves: tuple[FirstCurve, ...], behind: Mask
) -> tuple[Rim, ...]:
    """Return the rims with the ends among them marked.

    A rim is an end unless it is behind, has an end of a start curve on it (a side), has a
    start curve along it, or bounds an opening. At an opening the distance from the start
    curves, measured along the wall, grows away from the rim on more than a quarter of its
    length, because layers close again beyond it.
    """
    distance = _distance(wall, start_curves, behind)
    beyond = distance.max(initial=0.0, where=np.isfinite(distance))
    tree = cKDTree(wall.vertices)
    inside = _inner_mean(wall, distance)
    near_distance = 1.5 * wall.mesh.longest_edge
    starts = [
        end
        for curve in start_curves
        if not curve.closed
        for end in (curve.points[0], curve.points[-1])
    ]
    marked = []
    for rim in rims:
        vertex = tree.query(rim.points)[1]
        open_ = ~behind[vertex]
        side = any(
            np.linalg.norm(rim.points - end, axis=1).min() < near_distance
            and _leads_away(rim, end, near_distance)
            for end in starts
        )
        start = open_.any() and float(distance[vertex][open_].mean()) < near_distance
        rises = np.where(
            np.isfinite(inside[vertex]), distance[vertex] > inside[vertex] - 1e-9, True
        )
        end = bool(
            open_.mean() > 0.5
            and not side
            and not start
            and rises[open_].mean() > REACHED
            and beyond > 0.0
        )
        marked.append(replace(rim, end=end))
    return tuple(marked)


def _leads_away(rim: Rim, point: Array, near_distance: float) -> bool:
    """Return whether a rim leads away from a point on it, rather than being a short stretch near
    it.
    """
    return bool(np.linalg.norm(rim.points - point, axis=1).max() > 2.0 * near_distance)


def _distance(wall: PatchWall, start_curves: tuple[FirstCurve, ...], behind: Mask) -> Array:
    """Return the shortest length (n,) along the mesh from the start curves, inf behind them."""
    edges = Edges(wall.triangles).ends
    edges = edges[~behind[edges].any(axis=1)]
    length = np.linalg.norm(wall.vertices[edges[:, 0]] - wall.vertices[edges[:, 1]], axis=1)
    count = len(wall.vertices)
    graph = coo_matrix((length, (edges[:, 0], edges[:, 1])), shape=(count, count)).tocsr()
    ahead = np.flatnonzero(~behind)
    if not start_curves or not len(ahead):
        return np.full(count, np.inf)
    points = np.vstack([curve.points for curve in start_curves])
    sources = np.unique(ahead[cKDTree(wall.vertices[ahead]).query(points)[1]])
    distances: Array = dijkstra(graph, directed=False, indices=sources, min_only=True)
    return distances


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


def connected_parts(wall: PatchWall, members: Mask) -> tuple[int, Index]:
    """Return the number of connected parts that the vertices `members` (n,) form along edges of
    the mesh.

    Also returns the part (n,) of each vertex, -1 for the others.
    """
    edges = Edges(wall.triangles).ends
    edges = edges[members[edges].all(axis=1)]
    count = len(members)
    graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    label = connected_components(graph, directed=False)[1]
    labels = np.full(count, -1, dtype=np.intp)
    _, labels[members] = np.unique(label[members], return_inverse=True)
    return int(labels.max(initial=-1)) + 1, labels


def outward_volume(wall: PatchWall) -> float:
    """Return the volume (mm3) that the wall encloses when a fan about its middle closes each
    boundary.

    It is negative if the wall's outer side faces inwards, and zero for a wall that encloses
    nothing.
    """
    corners = wall.vertices[wall.triangles]
    origin = wall.vertices[0]
    total = _cones(corners - origin)
    ends, _ = boundary(wall.triangles)
    if len(ends):
        count = len(wall.vertices)
        graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count, count))
        loop = connected_components(graph, directed=False)[1][ends[:, 0]]
        for rim_number in np.unique(loop):
            pair = wall.vertices[ends[loop == rim_number]]
            middle = np.broadcast_to(pair.mean(axis=(0, 1)), (len(pair), 3))
            total += _cones(np.stack([pair[:, 1], pair[:, 0], middle], axis=1) - origin)
    return total


def _cones(corners: Array) -> float:
    return float(dot(corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0)
