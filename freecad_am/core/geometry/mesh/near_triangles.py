# SPDX-License-Identifier: LGPL-2.1-or-later
"""Candidate pairs of crossing triangles: descend a tree of bounding boxes for all pairs at
once.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..columns import columns

BITS = 10  # of each coordinate in the order of the leaves
MAX_BLOCK_PAIRS = 500_000  # pairs tested together
PARALLEL = 1e-9  # 1 - cosine of the angle between normals that are one


class _Level(NamedTuple):
    """Nodes (n,) of one level of the tree.

    low, high: (3, n) mm, bounding boxes. normal: (n, 3) mean normals of the triangles.
    bottom, top: (n,) mm, heights along these between which the triangles are.
    """

    low: Array
    high: Array
    normal: Array
    bottom: Array
    top: Array


def near_pairs(corners: Array, normals: Array, deep: float) -> Iterator[Index]:
    """Yield the pairs (k, 2) of triangles whose boxes overlap by more than `deep` mm along each
    axis, each pair once.

    Triangles (m, 3, 3) have unit normals (m, 3). Coplanar triangles, as on a flat face, are
    left out by their common normal. The axes are the principal axes of the normals, which
    suit the long triangles of round shapes. Both kinds of pairs can be very numerous.
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
    """The order (n,) of points along Morton's curve: neighbours in it are mostly neighbours in space."""
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
    """Return the levels of the tree: pairs of neighbouring triangles first, up to one node for
    all.

    Empty triangles fill up the lowest level.
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
    """Return the pairs of the halves of node pairs.

    A node paired with itself gives each half with itself and both halves with each other.
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
