# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges of a mesh halved where they are asked to be, the triangles beside them with them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...types import Array, Index, Mask
from .refined import Edges


def split(
    vertices: Array, triangles: Index, asked: Callable[[Index], Mask]
) -> tuple[Array, Index, bool]:
    """Vertices (n, 3) and triangles (m, 3) with every edge halved for which `asked` says so of the ends (2, k), and whether
    there was one. What was closed stays closed: a triangle becomes two, three or four."""
    edges = Edges(triangles)
    chosen = np.flatnonzero(asked(edges.ends.T))
    if not len(chosen):
        return vertices, triangles, False
    number = np.full(len(edges.ends), -1, dtype=np.intp)
    number[chosen] = len(vertices) + np.arange(len(chosen))
    vertices = np.vstack(
        [vertices, 0.5 * (vertices[edges.ends[chosen, 0]] + vertices[edges.ends[chosen, 1]])]
    )
    middle = number[edges.of]  # (m, 3) of the edges from each corner to the next
    cut = middle >= 0
    count = cut.sum(axis=1)
    made = [triangles[count == 0]]
    # turned so that the first edge is cut (of two: the first two; of one: the first)
    turn = np.where(count == 2, (np.argmin(cut, axis=1) + 1) % 3, np.argmax(cut, axis=1))
    column = (turn[:, None] + np.arange(3)) % 3
    (a, b, c), (ab, bc, ca) = (
        np.take_along_axis(rows, column, axis=1).T for rows in (triangles, middle)
    )
    one, two, three = count == 1, count == 2, count == 3
    for rows, corners in (
        (one, ((a, ab, c), (ab, b, c))),
        (two, ((a, ab, c), (ab, bc, c), (ab, b, bc))),
        (three, ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))),
    ):
        made += [np.stack([corner[rows] for corner in triple], axis=1) for triple in corners]
    return vertices, np.concatenate(made), True
