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
    """The pairs (k, 2), lower one first, of balls with middles (n, 3) and radii (n,) that may touch, all of them, in blocks
    of about BLOCK.

    Balls are looked for from the largest of a class of like size among those of its own and smaller classes, so that one
    long needle does not make neighbours of all the small ones around.
    """
    sizes = np.floor(np.log(np.maximum(reach, 1e-12)) / np.log(CLASS_RATIO)).astype(np.intp)
    for size in np.unique(sizes)[::-1]:
        largest = np.flatnonzero(sizes == size)
        others = np.flatnonzero(sizes <= size)
        tree, radius = cKDTree(middle[others]), 2.0 * float(reach[largest].max())
        waiting = [largest]
        while waiting:
            mine = waiting.pop()
            own = cKDTree(middle[mine])
            if len(mine) > 1 and own.count_neighbors(tree, radius) > BLOCK:
                waiting += [mine[len(mine) // 2 :], mine[: len(mine) // 2]]
                continue
            found = own.sparse_distance_matrix(tree, radius, output_type="ndarray")
            one, other = mine[found["i"]], others[found["j"]]
            # pairs of one class are found from both sides
            kept = (found["v"] <= reach[one] + reach[other]) & (
                (sizes[other] < size) | (one < other)
            )
            yield np.sort(np.stack([one[kept], other[kept]], axis=1), axis=1)
