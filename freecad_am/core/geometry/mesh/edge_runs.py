# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves known as edges of a mesh: put in order, told apart at corners, with their tangents."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .triangle_mesh import chains

CORNER = np.radians(35.0)  # a curve turns less from edge to edge


def tangents(vertices: Array, edges: Index) -> Array:
    """Unit tangents (k, 2, 3) at both ends of edges (k, 2), along each, of smooth curves through the chains that the edges
    form; chains end where they meet others and where they turn by more than CORNER."""
    chord = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    chord = chord / np.maximum(np.linalg.norm(chord, axis=1, keepdims=True), 1e-300)
    found = np.repeat(chord[:, None], 2, axis=1)
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
        both = np.stack([slope[:-1], slope[1:]], axis=1)
        both[~forward] = both[~forward][:, ::-1]
        found[members] = sign[:, None] * both
    return found


def runs(vertices: Array, edges: Index, corner: float = CORNER) -> list[tuple[Index, Mask, bool]]:
    """The chains that edges (k, 2) form: edges in order, whether each runs forward, whether the chain closes on itself.

    They end at vertices that have not two edges, and where they turn by more than `corner` rad.
    """
    count = len(edges)
    # half edge h < count leaves edges[h, 0]; h + count is the same edge backwards
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
    after = np.where(pair[:, 0] == back, pair[:, 1], pair[:, 0])
    smooth = dot(direction[going], direction[after]) > np.cos(corner)
    following[going[smooth]] = after[smooth]
    found, seen = [], np.zeros(count, dtype=bool)
    for members, closed in chains(following):
        if seen[members[0] % count]:
            continue  # the same chain the other way round
        seen[members % count] = True
        found.append((members % count, members < count, closed))
    return found
