# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cut a closed mesh by parallel planes, all at once.

A vertex on a plane always counts as above the plane. A plane therefore crosses an edge once or not
at all, and a triangle in two edges or none, so that loops close even if vertices, edges or faces
are in the plane. The result is the limit of sections from just below. Crossings of edges are
computed once for both adjacent triangles. A loop runs from the edge where it enters a triangle to
the edge where it leaves the triangle, with the solid on the left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...geometry.mesh.triangle_mesh import chains
from ...types import Array, Index, Mask

MAX_SIDES = 16  # maximum number of triangle pairs at an edge
BLOCK_SIZE = 1_000_000  # number of crossings processed together; limits memory


def _pair_keys(key: Index, forward: Mask) -> Index:
    """Return unique keys (n,) of edges from their vertex keys and the sense of the triangles.

    If a solid touches itself along an edge, four or more triangles meet there. Each unique key then
    belongs to two triangles of opposite sense. The pairing does not matter, because touching loops
    bound equal areas in any case.
    """
    order = np.lexsort((forward, key))
    alike = np.r_[
        False, (np.diff(key[order]) == 0) & (np.diff(forward[order].astype(np.int8)) == 0)
    ]
    position = np.arange(len(key))
    begin = np.maximum.accumulate(np.where(alike, 0, position)) if len(key) else position
    rank = np.empty(len(key), dtype=np.int64)
    rank[order] = np.minimum(position - begin, MAX_SIDES - 1)
    return np.asarray(key * MAX_SIDES + rank)


class PlaneCuts:
    """Mesh prepared for sections z = constant.

    vertices: (n, 3), mm. faces: (m, 3); each edge has equal numbers of faces of either sense.
    `triangles` has the faces that are not horizontal.
    """

    def __init__(self, vertices: Array, faces: Index) -> None:
        z = vertices[:, 2][faces]
        flat = z.min(axis=1) == z.max(axis=1)  # never crossed
        self.vertices, self.faces, self.triangles = vertices, faces, faces[~flat]
        following = self.triangles[:, [1, 2, 0]]
        low, high = np.minimum(self.triangles, following), np.maximum(self.triangles, following)
        key = _pair_keys(
            low.astype(np.int64).ravel() * len(vertices) + high.ravel(),
            (self.triangles < following).ravel(),
        )
        keys, number = np.unique(key, return_inverse=True)
        self._edge_of: Index = np.ravel(number).reshape(-1, 3).astype(np.intp)
        start, end = np.divmod(keys // MAX_SIDES, len(vertices))
        turned = vertices[start, 2] > vertices[end, 2]
        self._lower: Index = np.where(turned, end, start)
        self._upper: Index = np.where(turned, start, end)

    @property
    def top(self) -> float:
        """Maximum height, mm."""
        return float(self.vertices[:, 2].max())

    def loops(self, heights: Sequence[float] | Array) -> Iterator[list[Array]]:
        """Yield the loops of each section.

        Parameters
        ----------
        heights : (k,) array
            Ascending heights, mm.

        Yields
        ------
        list of (n, 2) array
            Closed loops, mm, without repeated first point; the solid is on the left as seen from
            above.
        """
        planes = np.asarray(heights, dtype=np.float64)
        z = self.vertices[:, 2]
        # range of planes that cross each edge: above the lower end and not above the upper end
        begin = np.searchsorted(planes, z[self._lower], side="right")
        end = np.searchsorted(planes, z[self._upper], side="right")
        per_plane = np.cumsum(
            np.bincount(begin, minlength=len(planes) + 1)
            - np.bincount(end, minlength=len(planes) + 1)
        )
        block_start = 0
        while block_start < len(planes):
            total = np.cumsum(per_plane[block_start : len(planes)])
            until = block_start + max(1, int(np.searchsorted(total, BLOCK_SIZE, side="right")))
            yield from self._block(planes, block_start, until, begin, end)
            block_start = until

    def _block(
        self, planes: Array, start: int, stop: int, begin: Index, end: Index
    ) -> list[list[Array]]:
        """Return the loops of the planes start to stop, with stop excluded."""
        low, high = np.clip(begin, start, stop), np.clip(end, start, stop)
        count = high - low
        crossed = np.flatnonzero(count)
        loops_of_plane: list[list[Array]] = [[] for _ in range(stop - start)]
        if not len(crossed):
            return loops_of_plane
        offset = np.cumsum(count) - count - low  # + plane: the node of an edge on it
        edge = np.repeat(crossed, count[crossed])
        plane = np.arange(len(edge)) - offset[edge]
        nodes = self._places(edge, planes[plane])
        following = np.full(len(edge), -1, dtype=np.intp)
        self._link(planes, start, stop, offset, following)
        for chain, closed in chains(following):
            if closed and len(chain) > 2:
                loops_of_plane[plane[chain[0]] - start].append(nodes[chain])
        return loops_of_plane

    def _places(self, edge: Index, height: Array) -> Array:
        """Return the crossings (n, 2), mm, of edges at heights (n,), from the lower ends."""
        below, above = self.vertices[self._lower[edge]], self.vertices[self._upper[edge]]
        share = (height - below[:, 2]) / (above[:, 2] - below[:, 2])
        return np.asarray(below[:, :2] + share[:, None] * (above[:, :2] - below[:, :2]))

    def _link(self, planes: Array, start: int, stop: int, offset: Index, following: Index) -> None:
        """Set the successor of each node, in place.

        A loop runs from the descending to the ascending side of a triangle.
        """
        z = self.vertices[:, 2][self.triangles]
        low = np.clip(np.searchsorted(planes, z.min(axis=1), side="right"), start, stop)
        count = np.clip(np.searchsorted(planes, z.max(axis=1), side="right"), start, stop) - low
        crossing = np.flatnonzero(count)
        row = np.repeat(crossing, count[crossing])
        plane = np.arange(len(row)) - np.repeat(
            np.cumsum(count[crossing]) - count[crossing] - low[crossing], count[crossing]
        )
        below = z[row] < planes[plane][:, None]
        rises = below & ~below[:, [1, 2, 0]]
        falls = ~below & below[:, [1, 2, 0]]
        row_number = np.arange(len(row))
        comes = self._edge_of[row, falls.argmax(axis=1)[row_number]]
        leaves = self._edge_of[row, rises.argmax(axis=1)[row_number]]
        following[offset[comes] + plane] = offset[leaves] + plane
