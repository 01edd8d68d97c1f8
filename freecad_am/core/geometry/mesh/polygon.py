# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pairs of touching balls, and triangulation of nearly flat polygons in space."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index

CLASS_RATIO = 1.5  # ratio of largest to smallest radius in a size class
BLOCK = 2_000_000  # approximate maximum number of pairs in memory


def near_pairs(middle: Array, reach: Array) -> Iterator[Index]:
    """Yield all pairs of balls that may touch, in blocks of about BLOCK.

    Each size class is compared with itself and the smaller classes. A large ball about a needle
    therefore does not enlarge the search radius of small balls.

    Parameters
    ----------
    middle : (n, 3) array
        Centres of the balls, mm.
    reach : (n,) array
        Radii, mm.

    Yields
    ------
    (k, 2) array of int
        Pairs, lower index first.
    """
    sizes = np.floor(np.log(np.maximum(reach, 1e-12)) / np.log(CLASS_RATIO)).astype(np.intp)
    for size in np.unique(sizes)[::-1]:
        largest = np.flatnonzero(sizes == size)
        not_larger = np.flatnonzero(sizes <= size)
        tree, radius = cKDTree(middle[not_larger]), 2.0 * float(reach[largest].max())
        waiting = [largest]
        while waiting:
            block = waiting.pop()
            block_tree = cKDTree(middle[block])
            if len(block) > 1 and block_tree.count_neighbors(tree, radius) > BLOCK:
                waiting += [block[len(block) // 2 :], block[: len(block) // 2]]
                continue
            candidates = block_tree.sparse_distance_matrix(tree, radius, output_type="ndarray")
            a, b = block[candidates["i"]], not_larger[candidates["j"]]
            # pairs within a class occur twice
            touching = (candidates["v"] <= reach[a] + reach[b]) & ((sizes[b] < size) | (a < b))
            yield np.sort(np.stack([a[touching], b[touching]], axis=1), axis=1)


def triangulate(corners: Array) -> Index:
    """Divide a polygon into triangles.

    Clip ears in the plane of the mean normal, the least elongated ear first. Self-intersecting
    polygons are divided too.

    Parameters
    ----------
    corners : (n, 3) array
        Corners, mm, n >= 3.

    Returns
    -------
    (n - 2, 3) array of int
        Corner indices of the triangles, in the sense of the polygon.
    """
    next_corner = np.roll(corners, -1, axis=0)
    normal = np.cross(corners, next_corner).sum(axis=0)  # Newell's method
    drop = int(np.argmax(np.abs(normal)))
    flat = np.delete(corners, drop, axis=1)
    if (normal[drop] < 0.0) != (drop == 1):  # make it counter-clockwise
        flat = flat[:, ::-1]
    remaining, ears = list(range(len(corners))), []
    while len(remaining) > 3:
        ear = _find_ear(flat[remaining])
        ears.append((remaining[ear - 1], remaining[ear], remaining[(ear + 1) % len(remaining)]))
        remaining.pop(ear)
    return np.array([*ears, tuple(remaining)], dtype=np.intp)


def _find_ear(ring: Array) -> int:
    """Return the convex corner of a polygon (n, 2) whose triangle contains no other corner.

    Among several, choose the least elongated triangle. If there is no such corner, choose the most
    convex corner.
    """
    previous, next_corner = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    turn = _cross(ring - previous, next_corner - ring)
    longest = np.maximum.reduce(
        [
            ((a - b) ** 2).sum(axis=1)
            for a, b in ((ring, previous), (next_corner, ring), (previous, next_corner))
        ]
    )
    shape = turn / np.maximum(longest, 1e-300)
    inside = np.ones((len(ring), len(ring)), dtype=bool)  # triangle, corner
    for a, b in ((previous, ring), (ring, next_corner), (next_corner, previous)):
        inside &= _cross((b - a)[:, None], ring[None] - a[:, None]) >= 0.0
    for corner in (previous, ring, next_corner):
        inside &= (ring[None] != corner[:, None]).any(axis=2)
    clear = (turn > 0.0) & ~inside.any(axis=1)
    return int(np.argmax(np.where(clear, shape, -np.inf) if clear.any() else shape))


def _cross(a: Array, b: Array) -> Array:
    product: Array = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product
