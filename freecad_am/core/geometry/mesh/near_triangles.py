# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which triangles of a mesh may cross: a tree of boxes about them, descended for all pairs at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from ..columns import columns

BITS = 10  # of each coordinate in the order of the leaves
MANY = 500_000  # pairs looked at together
PARALLEL = 1e-9  # 1 - cosine of the angle between normals that are one


class _Level(NamedTuple):
    """Nodes (n,) of the tree: their boxes low, high (3, n) mm, the mean normals (n, 3) of their triangles and between which
    heights along these, bottom, top (n,) mm, the triangles lie."""

    low: Array
    high: Array
    normal: Array
    bottom: Array
    top: Array


def near_pairs(corners: Array, normals: Array, deep: float) -> Iterator[Index]:
    """Pairs (k, 2) of triangles (m, 3, 3) with unit normals (m, 3) whose boxes reach into one another by more than `deep` mm
    along each axis, each pair once; some at a time.

    Triangles in one plane, as those of a flat face, are left out by their common normal, and the axes are those of the
    mesh's own normals, along which the long triangles of something round lie: of either there may be very many.
    """
    if len(corners) < 2:
        return
    own = np.linalg.eigh(normals.T @ normals)[1]
    corners, normals = corners @ own, normals @ own
    order = _neighbourly(corners.mean(axis=1))
    levels = _levels(corners[order], normals[order])
    stack = [(len(levels) - 1, np.zeros((1, 2), dtype=np.intp))]
    while stack:
        at, pairs = stack.pop()
        pairs = pairs[_meet(levels[at], pairs, deep)]
        if at == 0:
            pairs = pairs[pairs[:, 0] != pairs[:, 1]]
            if len(pairs):
                yield order[pairs]
        elif len(pairs):
            below = _below(pairs)
            stack += [(at - 1, part) for part in np.array_split(below, -(-len(below) // MANY))]


def _neighbourly(middles: Array) -> Index:
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
    """The triangles, those of two neighbours each, and so on to the one node of all; empty ones fill up."""
    depth = max(int(np.ceil(np.log2(len(corners)))), 1)
    spare = 2**depth - len(corners)
    low, high = corners.min(axis=1), corners.max(axis=1)
    low, high = (
        np.vstack([side, np.full((spare, 3), fill)])
        for side, fill in ((low, np.inf), (high, -np.inf))
    )
    total = np.vstack([normals, np.zeros((spare, 3))])
    found = []
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
        found.append(_Level(columns(low), columns(high), normal, bottom, top))
    return found


def _meet(level: _Level, pairs: Index, deep: float) -> Mask:
    one, other = pairs.T
    met = np.ones(len(pairs), dtype=bool)
    for low, high in zip(level.low, level.high):
        met &= (high[one] - low[other] > deep) & (high[other] - low[one] > deep)
    left = np.flatnonzero(met)
    one, other = one[left], other[left]
    alike = (level.normal[one] * level.normal[other]).sum(axis=1) > 1.0 - PARALLEL
    left, one, other = left[alike], one[alike], other[alike]
    above, below = level.top[one] - level.bottom[other], level.top[other] - level.bottom[one]
    met[left] = (above > deep) & (below > deep)
    return met


def _below(pairs: Index) -> Index:
    """The pairs of the halves of pairs of nodes; of a node and itself, its halves with themselves and with each other."""
    one, other = (2 * pairs).T
    apart = one != other
    return np.concatenate(
        [
            np.stack([one, other], axis=1),
            np.stack([one, other + 1], axis=1),
            np.stack([one + 1, other + 1], axis=1),
            np.stack([one + 1, other], axis=1)[apart],
        ]
    )
