# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make triangles a manifold: pair triangles at shared edges, separate vertices, close small holes.

Where four or more triangles share an edge, as with two boxes that touch along an edge, each
triangle is paired with its neighbour across the solid (Gueziec et al. 2001, cutting and stitching).
The mesh then bounds solids that touch at the edge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...types import Array, Index, Mask
from ..walls.surface import dot
from .refine import Edges
from .triangle_mesh import chains

MAX_EDGE_TRIANGLES = 64  # maximum number of triangles to pair at an edge; more do not bound a solid


class Hole(NamedTuple):
    """A loop of edges with a triangle on one side only.

    loop: (n,) vertex indices, against the sense of the triangles. size, middle: diagonal and centre
    (3,) of the bounding box, mm.
    """

    loop: Index
    size: float
    middle: Array


class Manifold(NamedTuple):
    """A mesh in which every edge has at most two triangles.

    vertices: (n, 3) mm. triangles: (m, 3). open: (k, 2) starts and ends of triangle sides without a
    neighbour. split: number of edges at which triangles were separated.
    """

    vertices: Array
    triangles: Index
    open: Index
    split: int


def separate_vertices(vertices: Array, triangles: Index) -> Manifold:
    """Separate vertices at edges of unpaired triangles.

    These edges have more than two triangles, or two triangles of opposite orientation.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) array of int
        Vertex indices of the triangles.

    Returns
    -------
    Manifold
        The triangles, with at most two at each edge.
    """
    edges = Edges(triangles)
    mates = _mates(vertices, triangles, edges)
    sides = np.flatnonzero(mates >= 0)
    face, turn = np.divmod(sides, 3)
    mate_face, back = np.divmod(mates[sides], 3)
    # the end of a side is the start of its mate
    side_ends = np.concatenate([sides, 3 * face + (turn + 1) % 3])
    mate_ends = np.concatenate([3 * mate_face + (back + 1) % 3, mates[sides]])
    count = triangles.size
    links = coo_matrix((np.ones(len(side_ends)), (side_ends, mate_ends)), shape=(count, count))
    corner = connected_components(links, directed=False)[1]
    _, first_corner = np.unique(corner, return_index=True)
    corners = np.ravel(corner).reshape(-1, 3).astype(np.intp)
    bare = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)[mates < 0]
    return Manifold(
        vertices[triangles.ravel()[first_corner]], corners, bare, int((edges.count > 2).sum())
    )


def _mates(vertices: Array, triangles: Index, edges: Edges) -> Index:
    """Return the mate (3 m,) of each triangle side, as 3 triangle + corner; -1 for none."""
    mates = np.full(triangles.size, -1, dtype=np.intp)
    forward = (triangles < np.roll(triangles, -1, axis=1)).ravel()
    edge_numbers = edges.of_triangle.ravel()
    order = np.argsort(edge_numbers, kind="stable")
    begin = np.r_[0, np.cumsum(edges.count)]
    two = np.flatnonzero(edges.count == 2)
    side_a, side_b = order[begin[two]], order[begin[two] + 1]
    agree = forward[side_a] != forward[side_b]
    mates[side_a[agree]], mates[side_b[agree]] = side_b[agree], side_a[agree]
    for edge in np.flatnonzero((edges.count > 2) & (edges.count <= MAX_EDGE_TRIANGLES)).tolist():
        sides = order[begin[edge] : begin[edge + 1]]
        start, end = vertices[edges.ends[edge]]
        tips = vertices[triangles[sides // 3, (sides % 3 + 2) % 3]]
        for a, b in _across_solid(_angles(start, end, tips), forward[sides]):
            mates[sides[a]], mates[sides[b]] = sides[b], sides[a]
    return mates


def _angles(start: Array, end: Array, tips: Array) -> Array:
    """Return the angles (k,) of tips (k, 3) about an edge, relative to the first tip."""
    axis = (end - start) / max(float(np.linalg.norm(end - start)), 1e-300)
    offset = tips - start
    offset = offset - dot(offset, axis)[:, None] * axis
    turn = np.arctan2(dot(np.cross(offset[0], offset), axis), dot(offset, offset[0]))
    angles: Array = np.mod(turn, 2.0 * np.pi)
    return angles


def _across_solid(angles: Array, forward: Mask) -> list[tuple[int, int]]:
    """Pair the triangles about an edge that bound the same solid.

    The normal of a triangle that runs forwards along the edge points towards larger angles. The
    solid therefore extends from a backward triangle to the next forward triangle.
    """
    order = np.lexsort((forward, angles)).tolist()
    pairs: list[tuple[int, int]] = []
    open_: list[int] = []
    for k in order + order:  # a second round pairs triangles still open after the first
        if not forward[k]:
            if all(k not in pair for pair in pairs) and k not in open_:
                open_.append(k)
        elif open_ and all(k not in pair for pair in pairs):
            pairs.append((open_.pop(), k))
    return pairs


def find_holes(mesh: Manifold) -> list[Hole]:
    """Return the holes of a mesh, largest first."""
    start, end = mesh.open.T
    vertices, starts = (
        mesh.vertices,
        np.unique(start),
    )  # at each vertex one side starts and one side ends
    following = np.full(len(starts), -1, dtype=np.intp)
    following[np.searchsorted(starts, end)] = np.searchsorted(starts, start)
    loops = []
    for chain, closed in chains(following):
        if closed:
            loop = starts[chain]
            low, high = vertices[loop].min(axis=0), vertices[loop].max(axis=0)
            loops.append(Hole(loop, float(np.linalg.norm(high - low)), 0.5 * (low + high)))
    return sorted(loops, key=lambda hole: -hole.size)


def fill_holes(vertices: Array, triangles: Index, openings: list[Hole]) -> tuple[Array, Index]:
    """Close holes, each with a single triangle or a fan about its mean point.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    openings : list of Hole
        The holes.

    Returns
    -------
    vertices : array
        Old and new vertices, mm.
    triangles : int array
        Old and new triangles.
    """
    vertex_blocks, added = [vertices], [triangles]
    count = len(vertices)
    for hole in openings:
        if len(hole.loop) == 3:
            added.append(hole.loop[None])
            continue
        tip = np.full(len(hole.loop), count)
        added.append(np.stack([hole.loop, np.roll(hole.loop, -1), tip], axis=1))
        vertex_blocks.append(vertices[hole.loop].mean(axis=0)[None])
        count += 1
    return np.vstack(vertex_blocks), np.vstack(added).astype(np.intp)
