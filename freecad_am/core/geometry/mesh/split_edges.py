# SPDX-License-Identifier: LGPL-2.1-or-later
"""Halve selected edges of a mesh and the triangles adjacent to them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...types import Array, Index, Mask
from .refined import Edges


def split_edges(
    vertices: Array, triangles: Index, is_split: Callable[[Index], Mask]
) -> tuple[Array, Index, bool]:
    """Halve every edge that `is_split` selects by its ends (2, k).

    Takes vertices (n, 3) and triangles (m, 3); also returns whether any edge was halved. A
    closed mesh stays closed: a triangle becomes two, three or four.
    """
    edges = Edges(triangles)
    halved = np.flatnonzero(is_split(edges.ends.T))
    if not len(halved):
        return vertices, triangles, False
    number = np.full(len(edges.ends), -1, dtype=np.intp)
    number[halved] = len(vertices) + np.arange(len(halved))
    vertices = np.vstack(
        [vertices, 0.5 * (vertices[edges.ends[halved, 0]] + vertices[edges.ends[halved, 1]])]
    )
    middle = number[edges.of_triangle]  # (m, 3) of the edges from each corner to the next
    cut = middle >= 0
    count = cut.sum(axis=1)
    blocks = [triangles[count == 0]]
    # turned so that the first edge is cut (with two cuts: the first two edges)
    turn = np.where(count == 2, (np.argmin(cut, axis=1) + 1) % 3, np.argmax(cut, axis=1))
    column = (turn[:, None] + np.arange(3)) % 3
    (a, b, c), (ab, bc, ca) = (
        np.take_along_axis(rows, column, axis=1).T for rows in (triangles, middle)
    )
    single, two, three = count == 1, count == 2, count == 3
    for rows, corners in (
        (single, ((a, ab, c), (ab, b, c))),
        (two, ((a, ab, c), (ab, bc, c), (ab, b, bc))),
        (three, ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))),
    ):
        blocks += [np.stack([corner[rows] for corner in triple], axis=1) for triple in corners]
    return vertices, np.concatenate(blocks), True
