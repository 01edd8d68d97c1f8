# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves of mesh edges: order the edges, split the curves at corners, compute tangents."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .triangle_mesh import chains

CORNER = np.radians(35.0)  # rad; maximum turn angle between edges of a curve


def tangents(vertices: Array, edges: Index) -> Array:
    """Return unit tangents at both ends of edges.

    The tangents are those of smooth curves through the chains of edges. A chain ends where it meets
    other chains and where it turns by more than CORNER.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    edges : (k, 2) int array
        Vertex indices of the edges.

    Returns
    -------
    (k, 2, 3) array
        Tangents at the start and end of each edge.
    """
    chord = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    chord = chord / np.maximum(np.linalg.norm(chord, axis=1, keepdims=True), 1e-300)
    edge_tangents = np.repeat(chord[:, None], 2, axis=1)
    for members, forward, closed in runs(vertices, edges):
        ends = np.where(forward[:, None], edges[members], edges[members][:, ::-1])
        nodes = np.r_[ends[:, 0], ends[-1, 1]]
        points = vertices[nodes]
        w = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
        if len(members) < 3:
            continue
        if closed:
            points[-1] = points[0]
        slope = CubicSpline(w, points, bc_type="periodic" if closed else "not-a-knot")(w, 1)
        slope /= np.linalg.norm(slope, axis=1, keepdims=True)
        sign = np.where(forward, 1.0, -1.0)[:, None]
        end_slopes = np.stack([slope[:-1], slope[1:]], axis=1)
        end_slopes[~forward] = end_slopes[~forward][:, ::-1]
        edge_tangents[members] = sign[:, None] * end_slopes
    return edge_tangents


def runs(vertices: Array, edges: Index, corner: float = CORNER) -> list[tuple[Index, Mask, bool]]:
    """Return the chains that edges form.

    A chain ends at vertices that do not have exactly two edges, and where it turns by more than
    `corner`.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    edges : (k, 2) int array
        Vertex indices of the edges.
    corner : float, optional
        Turn angle at which a chain ends, rad.

    Returns
    -------
    list of tuple
        For each chain: edge indices in order (int array), whether each edge runs forwards (bool
        array), and whether the chain is closed.
    """
    count = len(edges)
    # half edge h < count starts at edges[h, 0]; h + count is the reversed edge
    tail = np.r_[edges[:, 0], edges[:, 1]]
    head = np.r_[edges[:, 1], edges[:, 0]]
    direction = vertices[head] - vertices[tail]
    direction = direction / np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-300)
    degree = np.bincount(tail, minlength=len(vertices))
    order = np.argsort(tail, kind="stable")
    begin = np.searchsorted(tail[order], np.arange(len(vertices) + 1))
    following = np.full(2 * count, -1, dtype=np.intp)
    going = np.flatnonzero(degree[head] == 2)
    pair = order[begin[head[going]][:, None] + np.arange(2)]
    back = (going + count) % (2 * count)
    next_half = np.where(pair[:, 0] == back, pair[:, 1], pair[:, 0])
    smooth = dot(direction[going], direction[next_half]) > np.cos(corner)
    following[going[smooth]] = next_half[smooth]
    ordered, visited = [], np.zeros(count, dtype=bool)
    for members, closed in chains(following):
        if visited[members[0] % count]:
            continue  # this chain reversed
        visited[members % count] = True
        ordered.append((members % count, members < count, closed))
    return ordered
