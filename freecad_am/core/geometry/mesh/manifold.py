# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles made a manifold: paired where several meet in an edge, vertices told apart, small holes closed.

Where four triangles or more meet in an edge, as of two boxes that touch along it, each is paired with the one beside it
across the solid (Gueziec et al. 2001, cutting and stitching): the mesh then bounds solids that touch there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .refined import Edges
from .triangle_mesh import chains

SEVERAL = 64  # triangles of one edge that are told apart; what has more is not a solid


class Hole(NamedTuple):
    """A loop of edges with a triangle on one side alone: its vertices (n,), against the sense of these triangles, its size,
    the diagonal of the box about it, mm, and its middle (3,)."""

    loop: Index
    size: float
    middle: Array


class Manifold(NamedTuple):
    """vertices (n, 3), triangles (m, 3). open: (k, 2) begins and ends of the sides of triangles that have no neighbour.
    split: edges at which triangles were told apart."""

    vertices: Array
    triangles: Index
    open: Index
    split: int


def separated(vertices: Array, triangles: Index) -> Manifold:
    """The same triangles, with vertices of their own where their neighbours are not: across edges that more than two share,
    or that two run along in the same sense."""
    edges = Edges(triangles)
    mates = _mates(vertices, triangles, edges)
    sides = np.flatnonzero(mates >= 0)
    face, turn = np.divmod(sides, 3)
    other, back = np.divmod(mates[sides], 3)
    # the end of a side is the begin of its mate
    here = np.concatenate([sides, 3 * face + (turn + 1) % 3])
    there = np.concatenate([3 * other + (back + 1) % 3, mates[sides]])
    count = triangles.size
    links = coo_matrix((np.ones(len(here)), (here, there)), shape=(count, count))
    corner = connected_components(links, directed=False)[1]
    _, first = np.unique(corner, return_index=True)
    corners = np.ravel(corner).reshape(-1, 3).astype(np.intp)
    bare = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)[mates < 0]
    return Manifold(vertices[triangles.ravel()[first]], corners, bare, int((edges.count > 2).sum()))


def _mates(vertices: Array, triangles: Index, edges: Edges) -> Index:
    """The side (3 m,), 3 triangle + corner, that each side of a triangle is paired with; -1 for none."""
    mates = np.full(triangles.size, -1, dtype=np.intp)
    forward = (triangles < np.roll(triangles, -1, axis=1)).ravel()
    of = edges.of.ravel()
    order = np.argsort(of, kind="stable")
    begin = np.r_[0, np.cumsum(edges.count)]
    two = np.flatnonzero(edges.count == 2)
    one, other = order[begin[two]], order[begin[two] + 1]
    agree = forward[one] != forward[other]
    mates[one[agree]], mates[other[agree]] = other[agree], one[agree]
    for edge in np.flatnonzero((edges.count > 2) & (edges.count <= SEVERAL)).tolist():
        sides = order[begin[edge] : begin[edge + 1]]
        start, end = vertices[edges.ends[edge]]
        tips = vertices[triangles[sides // 3, (sides % 3 + 2) % 3]]
        for a, b in _across_solid(_angles(start, end, tips), forward[sides]):
            mates[sides[a]], mates[sides[b]] = sides[b], sides[a]
    return mates


def _angles(start: Array, end: Array, tips: Array) -> Array:
    """The angle (k,) about an edge at which each of the tips (k, 3) lies, from the first."""
    axis = (end - start) / max(float(np.linalg.norm(end - start)), 1e-300)
    away = tips - start
    away = away - dot(away, axis)[:, None] * axis
    turn = np.arctan2(dot(np.cross(away[0], away), axis), dot(away, away[0]))
    angles: Array = np.mod(turn, 2.0 * np.pi)
    return angles


def _across_solid(angles: Array, forward: Mask) -> list[tuple[int, int]]:
    """Pairs of the triangles about an edge that bound the same solid: its normal turns one that runs forward along the edge
    on about it, so that the solid lies from one that runs backward on to the next that runs forward."""
    order = np.lexsort((forward, angles)).tolist()
    pairs: list[tuple[int, int]] = []
    open_: list[int] = []
    for k in order + order:  # a second round for what is open at its end
        if not forward[k]:
            if all(k not in pair for pair in pairs) and k not in open_:
                open_.append(k)
        elif open_ and all(k not in pair for pair in pairs):
            pairs.append((open_.pop(), k))
    return pairs


def holes(mesh: Manifold) -> list[Hole]:
    """The holes, the largest first."""
    start, end = mesh.open.T
    vertices, known = (
        mesh.vertices,
        np.unique(start),
    )  # a vertex has one side that begins there, and one that ends
    following = np.full(len(known), -1, dtype=np.intp)
    following[np.searchsorted(known, end)] = np.searchsorted(known, start)
    found = []
    for chain, closed in chains(following):
        if closed:
            loop = known[chain]
            low, high = vertices[loop].min(axis=0), vertices[loop].max(axis=0)
            found.append(Hole(loop, float(np.linalg.norm(high - low)), 0.5 * (low + high)))
    return sorted(found, key=lambda hole: -hole.size)


def filled(vertices: Array, triangles: Index, some: list[Hole]) -> tuple[Array, Index]:
    """With holes closed: each by a triangle, or by triangles about its middle."""
    more, added = [vertices], [triangles]
    count = len(vertices)
    for hole in some:
        if len(hole.loop) == 3:
            added.append(hole.loop[None])
            continue
        tip = np.full(len(hole.loop), count)
        added.append(np.stack([hole.loop, np.roll(hole.loop, -1), tip], axis=1))
        more.append(vertices[hole.loop].mean(axis=0)[None])
        count += 1
    return np.vstack(more), np.vstack(added).astype(np.intp)
