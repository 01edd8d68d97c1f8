# SPDX-License-Identifier: LGPL-2.1-or-later
"""A surface that cuts itself in a few places, as where a facet is folded over: what crosses there is cut out, and the holes
that this leaves are closed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from .crossing import find_crossings
from .manifold import Hole, fill_holes, find_holes, separate_vertices
from .refined import Edges

ROUNDS = 3  # each cuts out one ring of triangles more


class Uncrossed(NamedTuple):
    """The surface without crossings; how many triangles were cut out, and the holes that were closed, the largest first."""

    vertices: Array
    triangles: Index
    cut_out: int
    closed: list[Hole]


def remove_crossings(
    vertices: Array, triangles: Index, pairs: Index, widest: float, min_length: float
) -> Uncrossed | None:
    """Cut crossing pairs (k, 2) of triangles out of a surface and close the holes.

    Takes vertices (n, 3) and triangles (m, 3). Returns None if that leaves a hole wider than
    `widest` mm, reaches an end of the surface, or if triangles still cross by more than
    `min_length` mm.
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
