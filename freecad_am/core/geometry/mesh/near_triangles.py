# SPDX-License-Identifier: LGPL-2.1-or-later
"""Crossing triangles: find candidate pairs with a tree of bounding boxes; remove crossings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..columns import columns
from ..walls.surface import dot
from .coarsen import doubled_areas
from .manifold import Hole, fill_holes, find_holes, separate_vertices
from .refine import Edges

BITS = 10  # bits per coordinate in the order of the leaves
MAX_BLOCK_PAIRS = 500_000  # pairs tested together
PARALLEL = 1e-9  # 1 - cosine of the maximum angle between parallel normals


class _Level(NamedTuple):
    """Nodes (n,) of one level of the tree.

    low, high: (3, n) bounding boxes, mm. normal: (n, 3) mean normals of the triangles. bottom, top:
    (n,) range of the triangles along the mean normals, mm.
    """

    low: Array
    high: Array
    normal: Array
    bottom: Array
    top: Array


def near_pairs(corners: Array, normals: Array, deep: float) -> Iterator[Index]:
    """Yield each pair of triangles whose bounding boxes overlap, once.

    Coplanar triangles, as on a flat face, are skipped. The boxes are aligned with the principal
    axes of the normals, which suits the long triangles of round shapes. Both measures prevent very
    large numbers of pairs.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Triangles, mm.
    normals : (m, 3) array
        Unit normals of the triangles.
    deep : float
        Overlap along each axis to ignore, mm.

    Yields
    ------
    (k, 2) int array
        A block of pairs.
    """
    if len(corners) < 2:
        return
    axes = np.linalg.eigh(normals.T @ normals)[1]
    corners, normals = corners @ axes, normals @ axes
    order = _spatial_order(corners.mean(axis=1))
    levels = _levels(corners[order], normals[order])
    stack = [(len(levels) - 1, np.zeros((1, 2), dtype=np.intp))]
    while stack:
        depth, pairs = stack.pop()
        pairs = pairs[_find_overlaps(levels[depth], pairs, deep)]
        if depth == 0:
            pairs = pairs[pairs[:, 0] != pairs[:, 1]]
            if len(pairs):
                yield order[pairs]
        elif len(pairs):
            below = _child_pairs(pairs)
            stack += [
                (depth - 1, block)
                for block in np.array_split(below, -(-len(below) // MAX_BLOCK_PAIRS))
            ]


def _spatial_order(middles: Array) -> Index:
    """Return the order (n,) of points along the Morton curve, which keeps neighbours together."""
    size = float(np.ptp(middles, axis=0).max()) or 1.0
    cells = np.minimum(
        ((middles - middles.min(axis=0)) / size * 2**BITS).astype(np.int64), 2**BITS - 1
    )
    code = np.zeros(len(cells), dtype=np.int64)
    for bit in range(BITS):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    order: Index = np.argsort(code, kind="stable")
    return order


def _levels(corners: Array, normals: Array) -> list[_Level]:
    """Return the levels of the tree, from single triangles up to one node for all.

    Empty triangles pad the lowest level.
    """
    depth = max(int(np.ceil(np.log2(len(corners)))), 1)
    spare = 2**depth - len(corners)
    low, high = corners.min(axis=1), corners.max(axis=1)
    low, high = (
        np.vstack([side, np.full((spare, 3), fill)])
        for side, fill in ((low, np.inf), (high, -np.inf))
    )
    total = np.vstack([normals, np.zeros((spare, 3))])
    levels = []
    for level in range(depth + 1):
        if level:
            low, high = np.minimum(low[::2], low[1::2]), np.maximum(high[::2], high[1::2])
            total = total[::2] + total[1::2]
        normal = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
        owner = np.arange(len(corners)) >> level
        height = (corners * normal[owner][:, None]).sum(axis=2)
        starts = np.flatnonzero(np.diff(owner, prepend=-1))
        bottom, top = np.full(len(low), np.inf), np.full(len(low), -np.inf)
        bottom[: len(starts)] = np.minimum.reduceat(height.min(axis=1), starts)
        top[: len(starts)] = np.maximum.reduceat(height.max(axis=1), starts)
        levels.append(_Level(columns(low), columns(high), normal, bottom, top))
    return levels


def _find_overlaps(level: _Level, pairs: Index, deep: float) -> Mask:
    a, b = pairs.T
    overlaps = np.ones(len(pairs), dtype=bool)
    for low, high in zip(level.low, level.high):
        overlaps &= (high[a] - low[b] > deep) & (high[b] - low[a] > deep)
    remaining = np.flatnonzero(overlaps)
    a, b = a[remaining], b[remaining]
    alike = (level.normal[a] * level.normal[b]).sum(axis=1) > 1.0 - PARALLEL
    remaining, a, b = remaining[alike], a[alike], b[alike]
    above, below = level.top[a] - level.bottom[b], level.top[b] - level.bottom[a]
    overlaps[remaining] = (above > deep) & (below > deep)
    return overlaps


def _child_pairs(pairs: Index) -> Index:
    """Return the pairs of the child nodes of node pairs.

    For a node paired with itself: each child with itself, and both children together.
    """
    a, b = (2 * pairs).T
    distinct = a != b
    return np.concatenate(
        [
            np.stack([a, b], axis=1),
            np.stack([a, b + 1], axis=1),
            np.stack([a + 1, b + 1], axis=1),
            np.stack([a + 1, b], axis=1)[distinct],
        ]
    )


class Crossings(NamedTuple):
    """Crossing triangles.

    pairs: (k, 2) triangle indices. length: (k,) lengths of the crossings, mm. positions: (k, 3)
    approximate positions, mm.
    """

    pairs: Index
    length: Array
    positions: Array


def find_crossings(vertices: Array, triangles: Index, min_length: float) -> Crossings:
    """Find crossing triangles.

    Two triangles cross if each reaches both sides of the other and they overlap along the
    intersection line of their planes. Triangles that only touch, such as neighbours along an edge,
    and coplanar triangles do not cross. A shared vertex is in both planes, regardless of rounding.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    min_length : float
        Minimum length of a crossing, mm.

    Returns
    -------
    Crossings
        Pairs with lengths and positions.
    """
    corners = vertices[triangles]
    planes = _planes(corners)
    blocks = [
        _cross_pairs(corners, triangles, planes, pairs, min_length)
        for pairs in near_pairs(corners, planes[:, :3], min_length)
    ]
    if not blocks:
        return Crossings(np.zeros((0, 2), dtype=np.intp), np.zeros(0), np.zeros((0, 3)))
    return Crossings(*(np.concatenate(column) for column in zip(*blocks)))


def _planes(corners: Array) -> Array:
    """Return the planes (m, 4) of triangles (m, 3, 3): unit normals and distances from the origin.

    Zero for triangles without area.
    """
    normals = doubled_areas(corners)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    units = np.where(length > 1e-12, normals / np.maximum(length, 1e-300), 0.0)
    planes: Array = np.c_[units, dot(units, corners[:, 0])]
    return planes


def _cross_pairs(
    corners: Array, triangles: Index, planes: Array, pairs: Index, min_length: float
) -> Crossings:
    """Return the crossings among pairs (k, 2)."""
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T), min_length)]
    pairs = pairs[_both_sides(_plane_distances(corners, planes, *pairs.T[::-1]), min_length)]
    a, b = pairs.T
    same = triangles[a][:, :, None] == triangles[b][:, None, :]
    along = np.cross(planes[a, :3], planes[b, :3])
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300)
    start, end = _triangle_span(
        corners[a],
        np.where(same.any(axis=2), 0.0, _plane_distances(corners, planes, b, a)),
        along,
    )
    distance = np.where(same.any(axis=1), 0.0, _plane_distances(corners, planes, a, b))
    low, high = _triangle_span(corners[b], distance, along)
    overlap_start = np.maximum(dot(start, along), dot(low, along))
    overlap_end = np.minimum(dot(end, along), dot(high, along))
    keep = overlap_end - overlap_start > min_length
    middle = start + (0.5 * (overlap_start + overlap_end) - dot(start, along))[:, None] * along
    return Crossings(pairs[keep], (overlap_end - overlap_start)[keep], middle[keep])


def _plane_distances(corners: Array, planes: Array, a: Index, b: Index) -> Array:
    """Return corner heights (k, 3) of triangles `b` above the planes of triangles `a`, mm."""
    height: Array = (corners[b] * planes[a, None, :3]).sum(axis=2) - planes[a, 3, None]
    return height


def _both_sides(height: Array, min_length: float) -> Mask:
    crosses_plane: Mask = (height.max(axis=1) > min_length) & (height.min(axis=1) < -min_length)
    return crosses_plane


def _triangle_span(corners: Array, height: Array, along: Array) -> tuple[Array, Array]:
    """Return the ends (k, 3) of the sections of triangles (k, 3, 3) by a plane.

    height: (k, 3) heights of the corners above the plane. along: direction of the section line.
    """
    ahead, up = np.roll(corners, -1, axis=1), np.roll(height, -1, axis=1)
    passed = height * up < 0.0
    share = np.where(passed, height / np.where(passed, height - up, 1.0), 0.0)
    candidates = np.concatenate([corners + share[:, :, None] * (ahead - corners), corners], axis=1)
    position = np.einsum("kcx,kx->kc", candidates, along)
    in_plane = np.concatenate([passed, height == 0.0], axis=1)
    row = np.arange(len(candidates))
    return (
        candidates[row, np.argmin(np.where(in_plane, position, np.inf), axis=1)],
        candidates[row, np.argmax(np.where(in_plane, position, -np.inf), axis=1)],
    )


ROUNDS = 3  # each round cuts out another ring of triangles


class Uncrossed(NamedTuple):
    """A surface without crossings: number of removed triangles, and closed holes, largest first."""

    vertices: Array
    triangles: Index
    cut_out: int
    closed: list[Hole]


def remove_crossings(
    vertices: Array, triangles: Index, pairs: Index, widest: float, min_length: float
) -> Uncrossed | None:
    """Cut crossing triangles out of a surface and close the holes.

    Parameters
    ----------
    vertices : (n, 3) array
        Vertices, mm.
    triangles : (m, 3) int array
        Triangles.
    pairs : (k, 2) int array
        Crossing pairs.
    widest : float
        Maximum size of a hole to close, mm.
    min_length : float
        Minimum length of a crossing, mm.

    Returns
    -------
    Uncrossed or None
        None if a wider hole remains, the cut reaches an end of the surface, or triangles still
        cross.
    """
    edges = Edges(triangles)
    at_end = np.zeros(len(vertices), dtype=bool)
    at_end[edges.ends[edges.count == 1]] = True
    removed: Mask = np.zeros(len(triangles), dtype=bool)
    removed[pairs] = True
    for _ in range(ROUNDS):
        if at_end[triangles[removed]].any():
            return None
        remaining = triangles[~removed]
        manifold = separate_vertices(vertices, remaining)
        origin = np.empty(len(manifold.vertices), dtype=np.intp)
        origin[manifold.triangles] = remaining
        openings = [hole for hole in find_holes(manifold) if not at_end[origin[hole.loop]].any()]
        if any(hole.size > widest for hole in openings):
            return None
        points, corners = fill_holes(manifold.vertices, manifold.triangles, openings)
        if not len(find_crossings(points, corners, min_length).pairs):
            return Uncrossed(points, corners, int(removed.sum()), openings)
        adjacent = np.zeros(len(vertices), dtype=bool)
        adjacent[triangles[removed]] = True
        removed = adjacent[triangles].any(axis=1)
    return None
