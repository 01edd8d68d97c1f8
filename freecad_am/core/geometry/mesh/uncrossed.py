# SPDX-License-Identifier: LGPL-2.1-or-later
"""A surface that cuts itself in a few places, as where a facet is folded over: what crosses there is cut out, and the holes
that this leaves are closed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...types import Array, Index, Mask
from .crossing import crossings
from .manifold import Hole, filled, holes, separated
from .refined import Edges

ROUNDS = 3  # each cuts out one ring of triangles more


class Uncrossed(NamedTuple):
    """The surface without crossings; how many triangles were cut out, and the holes that were closed, the largest first."""

    vertices: Array
    triangles: Index
    cut_out: int
    closed: list[Hole]


def uncrossed(
    vertices: Array, triangles: Index, pairs: Index, widest: float, least: float
) -> Uncrossed | None:
    """A surface of vertices (n, 3) and triangles (m, 3), of which pairs (k, 2) cross. None where that would leave a hole
    wider than `widest` mm, or reaches an end of the surface, or where triangles cross by more than `least` mm even then."""
    edges = Edges(triangles)
    at_end = np.zeros(len(vertices), dtype=bool)
    at_end[edges.ends[edges.count == 1]] = True
    gone: Mask = np.zeros(len(triangles), dtype=bool)
    gone[pairs] = True
    for _ in range(ROUNDS):
        if at_end[triangles[gone]].any():
            return None
        kept = triangles[~gone]
        found = separated(vertices, kept)
        origin = np.empty(len(found.vertices), dtype=np.intp)
        origin[found.triangles] = kept
        left = [hole for hole in holes(found) if not at_end[origin[hole.loop]].any()]
        if any(hole.size > widest for hole in left):
            return None
        points, corners = filled(found.vertices, found.triangles, left)
        if not len(crossings(points, corners, least).pairs):
            return Uncrossed(points, corners, int(gone.sum()), left)
        adjacent = np.zeros(len(vertices), dtype=bool)
        adjacent[triangles[gone]] = True
        gone = adjacent[triangles].any(axis=1)
    return None
