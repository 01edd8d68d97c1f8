# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pairs of balls, such as those around triangles, that may touch: few at a time, whatever their sizes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index

CLASS_RATIO = 1.5  # largest to smallest ball of a class in which they are looked for together
BLOCK = 2_000_000  # pairs held at a time


def near_pairs(middle: Array, reach: Array) -> Iterator[Index]:
    """Yield all pairs (k, 2), lower number first, of balls that may touch, in blocks of about
    BLOCK.

    Balls have middles (n, 3) and radii (n,). Each size class searches among itself and the
    smaller classes, so that one long needle does not become a neighbour of all the small
    balls around it.
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
            # pairs within one class occur from both sides
            touching = (candidates["v"] <= reach[a] + reach[b]) & ((sizes[b] < size) | (a < b))
            yield np.sort(np.stack([a[touching], b[touching]], axis=1), axis=1)
