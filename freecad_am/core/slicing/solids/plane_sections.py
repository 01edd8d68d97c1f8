# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of a closed mesh with parallel planes, all at once.

A vertex on a plane counts as above it, everywhere alike: an edge is crossed once or not at all, a triangle in two of its
edges or in none, so that loops close whatever lies in the plane: vertices, edges, whole faces. What comes out is the limit
of sections from just below. Places where edges are crossed are worked out once for the two triangles beside each edge; a
loop goes from the edge where it comes into a triangle to the one where it leaves it, with the solid to its left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.mesh.triangle_mesh import chains
from ...types import Array, Index, Mask

MOST_SIDES = 16  # pairs of triangles that meet in an edge
AT_ONCE = 1_000_000  # crossings of planes worked on together; bounds the memory


def _paired(key: Index, forward: Mask) -> Index:
    """Numbers (n,) of edges by their keys and which way a triangle goes along them: where a solid touches itself along an
    edge, so that four triangles or more meet there, each number is of two, one of either way. Which two they are is all the
    same: loops that touch bound the same area however they go on."""
    order = np.lexsort((forward, key))
    alike = np.r_[
        False, (np.diff(key[order]) == 0) & (np.diff(forward[order].astype(np.int8)) == 0)
    ]
    at = np.arange(len(key))
    begin = np.maximum.accumulate(np.where(alike, 0, at)) if len(key) else at
    rank = np.empty(len(key), dtype=np.int64)
    rank[order] = np.minimum(at - begin, MOST_SIDES - 1)
    return np.asarray(key * MOST_SIDES + rank)


class PlaneCuts:
    """A mesh prepared for sections z = constant.

    vertices (n, 3) mm; faces (m, 3), every edge between as many of one sense as of the other; triangles: those that planes
    cross.
    """

    def __init__(self, vertices: Array, faces: Index) -> None:
        z = vertices[:, 2][faces]
        flat = z.min(axis=1) == z.max(axis=1)  # never crossed
        self.vertices, self.faces, self.triangles = vertices, faces, faces[~flat]
        following = self.triangles[:, [1, 2, 0]]
        low, high = np.minimum(self.triangles, following), np.maximum(self.triangles, following)
        key = _paired(
            low.astype(np.int64).ravel() * len(vertices) + high.ravel(),
            (self.triangles < following).ravel(),
        )
        known, number = np.unique(key, return_inverse=True)
        self._edge_of: Index = np.ravel(number).reshape(-1, 3).astype(np.intp)
        start, end = np.divmod(known // MOST_SIDES, len(vertices))
        turned = vertices[start, 2] > vertices[end, 2]
        self._lower: Index = np.where(turned, end, start)
        self._upper: Index = np.where(turned, start, end)

    @property
    def top(self) -> float:
        """The largest height, mm."""
        return float(self.vertices[:, 2].max())

    def loops(self, heights: Sequence[float] | Array) -> Iterator[list[Array]]:
        """For each of the rising heights (k,) mm its loops (n, 2), the first point of each not repeated, the solid to their
        left as seen from above."""
        planes = np.asarray(heights, dtype=np.float64)
        z = self.vertices[:, 2]
        # of each edge: the planes above its lower end and not above its upper one
        begin = np.searchsorted(planes, z[self._lower], side="right")
        end = np.searchsorted(planes, z[self._upper], side="right")
        per_plane = np.cumsum(
            np.bincount(begin, minlength=len(planes) + 1)
            - np.bincount(end, minlength=len(planes) + 1)
        )
        at = 0
        while at < len(planes):
            total = np.cumsum(per_plane[at : len(planes)])
            until = at + max(1, int(np.searchsorted(total, AT_ONCE, side="right")))
            yield from self._block(planes, at, until, begin, end)
            at = until

    def _block(
        self, planes: Array, first: int, last: int, begin: Index, end: Index
    ) -> list[list[Array]]:
        """Loops of the planes first to last (not with it)."""
        low, high = np.clip(begin, first, last), np.clip(end, first, last)
        count = high - low
        crossed = np.flatnonzero(count)
        found: list[list[Array]] = [[] for _ in range(last - first)]
        if not len(crossed):
            return found
        offset = np.cumsum(count) - count - low  # + plane: the node of an edge on it
        edge = np.repeat(crossed, count[crossed])
        plane = np.arange(len(edge)) - offset[edge]
        nodes = self._places(edge, planes[plane])
        following = np.full(len(edge), -1, dtype=np.intp)
        self._link(planes, first, last, offset, following)
        for chain, closed in chains(following):
            if closed and len(chain) > 2:
                found[plane[chain[0]] - first].append(nodes[chain])
        return found

    def _places(self, edge: Index, height: Array) -> Array:
        """Where edges are crossed at heights (n,): (n, 2) mm, worked out from the lower end."""
        below, above = self.vertices[self._lower[edge]], self.vertices[self._upper[edge]]
        share = (height - below[:, 2]) / (above[:, 2] - below[:, 2])
        return np.asarray(below[:, :2] + share[:, None] * (above[:, :2] - below[:, :2]))

    def _link(self, planes: Array, first: int, last: int, offset: Index, following: Index) -> None:
        """Fill in what node follows each: from the side on which a triangle goes down to that on which it goes up."""
        z = self.vertices[:, 2][self.triangles]
        low = np.clip(np.searchsorted(planes, z.min(axis=1), side="right"), first, last)
        count = np.clip(np.searchsorted(planes, z.max(axis=1), side="right"), first, last) - low
        some = np.flatnonzero(count)
        row = np.repeat(some, count[some])
        plane = np.arange(len(row)) - np.repeat(
            np.cumsum(count[some]) - count[some] - low[some], count[some]
        )
        below = z[row] < planes[plane][:, None]
        rises = below & ~below[:, [1, 2, 0]]
        falls = ~below & below[:, [1, 2, 0]]
        here = np.arange(len(row))
        comes = self._edge_of[row, falls.argmax(axis=1)[here]]
        leaves = self._edge_of[row, rises.argmax(axis=1)[here]]
        following[offset[comes] + plane] = offset[leaves] + plane
